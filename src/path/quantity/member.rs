//! Internal forces of bars.

use super::facts::Facts;
use super::value::NoValue;
use crate::answer::diagram::Diagram;
use crate::answer::record::MemberForces;
use crate::answer::rounding::{denoised, of_members};
use crate::model::quantity::{BarPlace, Internal, Over};

impl Facts<'_> {
    pub(super) fn members(&self) -> Result<&[MemberForces], NoValue> {
        let (_, u) = (self.structure()?, self.displacements()?);
        Ok(self.members.get_or_init(|| {
            let at_end = self.answer.filter(|_| self.at_end).and_then(|answer| answer.members.clone());
            at_end.or_else(|| self.prepared?.members(u, &self.factors)).unwrap_or_default()
        }))
    }

    pub(super) fn of_bar(&self, which: Internal, bar: &str, place: BarPlace) -> Result<f64, NoValue> {
        let members = self.members()?;
        let diagram = Diagram::of(members, bar).ok_or_else(|| self.missing())?;
        let [force, moment] = of_members(members.iter());
        let scale = if which.is_moment() { moment } else { force };
        let [least, largest] = diagram.extremes(which).map(|place| place.value);
        let beyond = |s: f64| NoValue(format!("{s} is beyond the bar {bar}, which is {} long", diagram.length()));
        match place {
            BarPlace::Start => diagram.at(which, 0.0).ok_or_else(|| self.missing()),
            BarPlace::End => diagram.at(which, diagram.length()).ok_or_else(|| self.missing()),
            BarPlace::At(s) => diagram.at(which, s).ok_or_else(|| beyond(s)),
            BarPlace::Over(Over::Min) => Ok(least),
            BarPlace::Over(_) => Ok(largest),
            BarPlace::Extreme => Ok(if least.abs() > largest.abs() { least } else { largest }),
        }
        .map(|value| denoised(value, scale))
    }
}
