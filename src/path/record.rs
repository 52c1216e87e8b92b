//! A followed path as data: for plots and files, whatever was followed.

use serde::Serialize;

use super::change::Breakpoint;
use super::friction::FrictionPath;
use super::load::LoadPath;
use super::on_cone::ConePath;
use super::stages::History;
use crate::answer::record::PairState;
use crate::answer::rounding::{denoised, largest};

/// What was followed.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Followed {
    /// A load case or load parameter.
    Load,
    /// A friction parameter.
    Friction,
    /// The stages of the scenario.
    Stages,
}

/// A place on a path.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct PathPlace {
    /// Stage, from 1; null where there are none.
    pub stage: Option<usize>,
    /// Value of what was followed; in a stage the part of it that is done, 0 … 1.
    pub value: f64,
    /// Factor of every load case; empty on a friction path.
    pub factors: Vec<f64>,
    /// What changes here, in words; empty where nothing does.
    pub change: String,
    /// The pairs.
    pub pairs: Vec<PairState>,
}

/// A path: between places everything is affine in the load (on a friction path only nearly so).
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct PathRecord {
    /// What was followed.
    pub followed: Followed,
    /// Its name; `stages` for stages.
    pub name: String,
    /// Names of the load cases; empty on a friction path.
    pub cases: Vec<String>,
    /// The places, in order.
    pub places: Vec<PathPlace>,
    /// How it ended, in a sentence.
    pub end: String,
}

/// What changes at a place, in words; empty where nothing does.
fn change_at(breakpoints: &[Breakpoint], place: usize) -> String {
    let found = breakpoints.iter().find(|breakpoint| breakpoint.place == place);
    found.map_or(String::new(), |breakpoint| breakpoint.sentence.clone())
}

/// Places without those that repeat the one before: a path turns there in nothing but its equations (joints that reach their
/// bounds together, a target that is reached where a scheme ends).
fn told_once(places: impl Iterator<Item = PathPlace>) -> Vec<PathPlace> {
    let mut told: Vec<PathPlace> = Vec::new();
    for place in places {
        if !(place.change.is_empty() && told.last().is_some_and(|last| last.is_as(&place))) {
            told.push(place);
        }
    }
    told
}

impl PathPlace {
    /// Whether value, states and numbers of the pairs are those of another place, but for rounding.
    fn is_as(&self, other: &PathPlace) -> bool {
        let same = |of: &dyn Fn(&PairState) -> [f64; 2]| {
            let scale = largest(self.pairs.iter().chain(&other.pairs).flat_map(of));
            let both = self.pairs.iter().zip(&other.pairs).flat_map(|(a, b)| of(a).into_iter().zip(of(b)));
            both.into_iter().all(|(a, b)| denoised(a - b, scale) == 0.0)
        };
        denoised(self.value - other.value, self.value.abs()) == 0.0
            && self.pairs.iter().zip(&other.pairs).all(|(a, b)| a.state == b.state)
            && same(&|pair| [pair.x_n, pair.x_t])
            && same(&|pair| [pair.z_n, pair.z_t])
    }
}

impl PathRecord {
    /// Of a load path; `cases` are the names of all load cases.
    pub fn of_load(path: &LoadPath, cases: &[String]) -> PathRecord {
        let places = path.factors.iter().zip(&path.pairs).enumerate().map(|(knot, (&value, pairs))| PathPlace {
            stage: None,
            value,
            factors: path.case_factors(value).into_iter().take(cases.len()).collect(),
            change: change_at(&path.breakpoints, knot),
            pairs: pairs.clone(),
        });
        PathRecord {
            followed: Followed::Load,
            name: path.parameter.name.clone(),
            cases: cases.to_vec(),
            places: told_once(places),
            end: path.end_sentence(),
        }
    }

    /// Of a friction path.
    pub fn of_friction(path: &FrictionPath) -> PathRecord {
        let places = path.samples.iter().enumerate().map(|(place, (value, pairs))| PathPlace {
            stage: None,
            value: *value,
            factors: Vec::new(),
            change: change_at(&path.breakpoints, place),
            pairs: pairs.clone(),
        });
        PathRecord {
            followed: Followed::Friction,
            name: path.name.clone(),
            cases: Vec::new(),
            places: told_once(places),
            end: path.end_sentence(),
        }
    }

    /// Of a path in space; `cases` are the names of all load cases.
    pub fn of_cone(path: &ConePath, cases: &[String]) -> PathRecord {
        let places = path.places.iter().enumerate().map(|(place, at)| PathPlace {
            stage: None,
            value: at.value,
            factors: at.factors.clone(),
            change: change_at(&path.breakpoints, place),
            pairs: at.pairs.clone(),
        });
        PathRecord {
            followed: if path.over.is_friction() { Followed::Friction } else { Followed::Load },
            name: path.name.clone(),
            cases: if path.over.is_friction() { Vec::new() } else { cases.to_vec() },
            places: told_once(places),
            end: path.end_sentence(),
        }
    }

    /// Of a history.
    pub fn of_history(history: &History) -> PathRecord {
        let places = history
            .stages
            .iter()
            .enumerate()
            .flat_map(|(index, stage)| {
                stage.moments.iter().map(move |moment| PathPlace {
                    stage: Some(index + 1),
                    value: moment.t,
                    factors: moment.factors.clone(),
                    change: moment.sentence.clone(),
                    pairs: moment.pairs.clone(),
                })
            })
            .collect();
        PathRecord {
            followed: Followed::Stages,
            name: "stages".to_owned(),
            cases: history.cases.clone(),
            places,
            end: history.end_sentence(),
        }
    }

    /// Index of the case that a plot of a history has as abscissa where none is chosen: the one that goes to and fro most,
    /// its way as a multiple of its largest factor, so that no unit counts; of equal ones that which moves last.
    pub fn busiest_case(&self) -> Option<usize> {
        let steps = |case: usize| self.places.windows(2).map(move |ends| ends[1].factors[case] - ends[0].factors[case]);
        let turns = |case: usize| {
            let largest = self.places.iter().map(|place| place.factors[case].abs()).fold(0.0, f64::max);
            let way: f64 = steps(case).map(f64::abs).sum();
            // Equal but for the rounding of the sum.
            if largest > 0.0 { (way / largest * 1e6).round() } else { 0.0 }
        };
        let last = |case: usize| steps(case).rposition(|step| step != 0.0);
        (0..self.cases.len())
            .max_by(|&a, &b| turns(a).total_cmp(&turns(b)).then_with(|| last(a).cmp(&last(b))).then(b.cmp(&a)))
    }

    /// Abscissas of the places: the value followed in its own unit, or the factor of a case, which has none.
    pub fn abscissas(&self, case: Option<usize>) -> Vec<f64> {
        self.places
            .iter()
            .map(|place| match case {
                Some(case) => place.factors.get(case).copied().unwrap_or(place.value),
                None => place.value,
            })
            .collect()
    }
}
