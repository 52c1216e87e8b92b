//! Why a path ends.

use super::beside::nine_digits;
use crate::answer::record::Ray;
use crate::lcp::outcome::RayDirection;
use crate::text::number::rounded;
use crate::text::words::short;

/// Why a path over a load or over friction ends.
#[derive(Clone, Debug, PartialEq)]
pub enum PathEnd {
    /// At the target.
    Target,
    /// At a turning point of the load: beyond it there is no answer near the one followed.
    Turning,
    /// At the limit load.
    Limit(RayDirection),
    /// Where nothing resists the motion in which the path ends, or where no answer near the one followed leads on, while a
    /// run of its own finds an answer just beyond, at this value.
    AnswerBeyond(f64),
    /// At a value beyond which a collapse on Coulomb's cone is certified.
    Collapse(Box<Ray>),
    /// Nowhere: the last scheme holds for every larger load.
    Unbounded,
    /// Back at the start, through turning points of the load.
    Returned,
    /// At a value of friction where the answer followed ends and no other was found beyond.
    NoAnswer,
}

impl PathEnd {
    /// The value just beyond at which there is an answer all the same.
    pub fn answer_beyond(&self) -> Option<f64> {
        match self {
            PathEnd::AnswerBeyond(value) => Some(*value),
            _ => None,
        }
    }

    /// In a sentence; `name` is what was followed, `at` where the path ended.
    pub fn sentence(&self, name: &str, at: f64) -> String {
        let end = nine_digits(at);
        let at = short(at);
        match self {
            PathEnd::Target => format!("the target {name} = {at} is reached"),
            PathEnd::Turning => format!(
                "turning point at {name} = {at}: the path goes on with a falling load only; beyond it the structure \
                 jumps to another answer or has none (`--through` follows the path)"
            ),
            PathEnd::Limit(_) => {
                format!("limit load: beyond {name} = {at} nothing resists the motion in which the path ends")
            }
            PathEnd::Collapse(ray) => {
                format!(
                    "limit: beyond {name} = {at} there is no answer, which is certified by a collapse: {}",
                    ray.mode
                )
            }
            PathEnd::AnswerBeyond(beyond) => {
                format!(
                    "the path ends at {name} = {end}, but just beyond, at {name} = {}, an answer exists",
                    rounded(*beyond, 12)
                )
            }
            PathEnd::Unbounded => format!("beyond {name} = {at} nothing changes any more, however large the load"),
            PathEnd::Returned => format!("the path came back to {name} = {at} through turning points"),
            PathEnd::NoAnswer => {
                format!("the answer that was followed ends at {name} = {at}, and no other was found beyond")
            }
        }
    }
}
