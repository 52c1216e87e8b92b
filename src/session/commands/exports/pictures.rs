//! Pictures as SVG: what `plot` draws with characters.

use std::path::Path;

use super::exported::Exported;
use crate::answer::diagram::{Diagram, Internal};
use crate::answer::record::OutcomeKind;
use crate::export::atomic;
use crate::session::commands::plot_structure::Shape;
use crate::session::commands::plot_zone::ZonePicture;
use crate::session::{CommandError, Session};
use crate::text::number::{heading, short, with_unit};
use crate::view::members::extremes;
use crate::view::plot::chart::Chart;
use crate::view::plot::scene::Scene;
use crate::view::plot::zone::Quantity;
use crate::view::plot::{diagram, trace};
use crate::view::svg::{self, Caption};
use crate::watch::Watch;

/// More parameters than this are counted, not named.
const MOST_PARAMETERS: usize = 12;

impl Session {
    /// A picture to FILE.svg.
    pub(super) fn export_picture(
        &self,
        what: Exported,
        of: &[String],
        path: &Path,
        watch: &dyn Watch,
    ) -> Result<(), CommandError> {
        let figure = self.figure(what, of, watch)?;
        atomic::write(path, |out| out.write_all(figure.as_bytes()))
            .map_err(|error| CommandError::Refused(error.to_string()))
    }

    /// The text of a picture.
    pub(super) fn figure(&self, what: Exported, of: &[String], watch: &dyn Watch) -> Result<String, CommandError> {
        let units = &self.now.scenario.units;
        let zone = |quantity| -> Result<String, CommandError> {
            Ok(self.zone_figure(&self.zone_picture(quantity, &self.zone_states(of)?)))
        };
        match what {
            Exported::Slip => zone(Quantity::Slip),
            Exported::Force => zone(Quantity::Force),
            Exported::Gap => zone(Quantity::Gap),
            Exported::Pressure => zone(Quantity::Pressure),
            Exported::Traction => Ok(self.zone_figure(&self.tractions(&self.zone_states(of)?)?.1)),
            Exported::P => Ok(self.chart_figure(&trace::drawing(self.some_pivots()?, self.position, units), "")),
            Exported::Path => {
                let end = &self.need_path()?.end;
                let note = self.stale_path().map_or(end.clone(), |stale| format!("The path was {stale}. {end}"));
                Ok(self.chart_figure(&self.path_chart(of, watch)?.0, &note))
            }
            Exported::Map => {
                let drawn = self.need_map()?;
                let [a, b] = &drawn.map.axes;
                let caption = self.caption(&format!("Working schemes over {} and {}", a.name, b.name));
                Ok(svg::map::figure(&drawn.map, &drawn.labels(&self.now.scenario), &caption))
            }
            Exported::Mode => self.shape_figure(&self.mode_shape()?),
            Exported::Moment => self.forces_figure(Internal::Moment, of),
            Exported::Shear => self.forces_figure(Internal::Shear, of),
            Exported::Axial => self.forces_figure(Internal::Axial, of),
            Exported::ShearZ => self.forces_figure(Internal::ShearZ, of),
            Exported::Torsion => self.forces_figure(Internal::Torsion, of),
            Exported::MomentY => self.forces_figure(Internal::MomentY, of),
            // the only picture that is left
            _ => self.shape_figure(&self.shape()?),
        }
    }

    fn chart_figure(&self, chart: &Chart, note: &str) -> String {
        svg::chart::figure(chart, &self.about(), note)
    }

    fn zone_figure(&self, picture: &ZonePicture) -> String {
        match &picture.chart {
            Some(chart) if picture.maps.is_empty() => self.chart_figure(chart, ""),
            chart => svg::face_map::figure(&picture.maps, chart.as_ref(), &self.about()),
        }
    }

    fn shape_figure(&self, shape: &Shape<'_>) -> Result<String, CommandError> {
        let scene = Scene::new(&shape.picture(0), Some(self.quantity_factors()));
        Ok(svg::structure::figure(&scene, &self.now.scenario.units, &self.caption(&scene.title)))
    }

    /// The forces of one bar over its length, or of all bars on the structure.
    fn forces_figure(&self, force: Internal, of: &[String]) -> Result<String, CommandError> {
        let units = &self.now.scenario.units;
        let (force, members, bars) = self.bars(force, of.first().map(String::as_str))?;
        let notes = bars.iter().filter_map(|bar| {
            let found = Diagram::of(members, bar)?;
            Some(format!("{bar}: {}", extremes(&found, force, units)))
        });
        if let ([bar], false) = (&bars[..], of.is_empty()) {
            let note = notes.collect::<Vec<_>>().join("; ");
            let chart = diagram::chart(members, bar, force, units)
                .ok_or_else(|| CommandError::Refused(format!("no member forces of bar {bar}")))?;
            return Ok(self.chart_figure(&chart, &note));
        }
        let mut shape = self.shape()?;
        (shape.displacements, shape.pairs) = (None, None);
        let (name, unit) = diagram::name(force, units);
        let name = heading(name, unit.as_deref());
        let side = match force {
            _ if force.is_bending() => ", on the tension side",
            Internal::ShearZ => ", > 0 on the +z side of each bar",
            _ => ", > 0 on the +y side of each bar",
        };
        let caption = self.caption(&format!("{}: {name}{side}", self.short_name()));
        let scene = Scene::new(&shape.picture(0), None);
        let bars = svg::forces::Bars { structure: shape.structure, members, bars: &bars, force };
        Ok(svg::forces::figure(&scene, &bars, units.length.as_deref(), &caption))
    }

    fn caption(&self, title: &str) -> Caption {
        Caption { title: title.to_owned(), about: self.about() }
    }

    /// Of what a figure is, with which parameters.
    fn about(&self) -> String {
        let scenario = &self.now.scenario;
        let mut about = vec![scenario.title.clone()];
        let named: Vec<String> = self
            .now
            .values
            .free()
            .map(|(name, value)| {
                // kept together where the line is broken
                format!("{name} = {}", with_unit(&short(value), scenario.unit_of(name))).replace(' ', "\u{a0}")
            })
            .collect();
        if !named.is_empty() {
            let more = named.len().saturating_sub(MOST_PARAMETERS);
            let more = if more > 0 { format!(" and {more} more") } else { String::new() };
            about.push(format!("{}{more}", named[..named.len().min(MOST_PARAMETERS)].join(", ")));
        }
        about.extend(self.quantity_answer().map(|answer| match (&answer.ray, answer.outcome) {
            (Some(ray), OutcomeKind::Ray) => format!("ray: {}", ray.class.word()),
            (_, outcome) => outcome.word().to_owned(),
        }));
        about.join(" · ")
    }
}
