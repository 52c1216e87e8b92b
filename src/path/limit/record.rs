//! What is known of the limit of a load: factor, safety, how the structure collapses, and what has been proved of it.

use crate::answer::record::{Ray, RayClass, Verdict};
use crate::path::beside::{BESIDE, nine_digits, search, size};
use crate::path::end::PathEnd;
use crate::path::load::LoadPath;
use crate::text::number::short;

/// What was found about the limit of a load.
#[derive(Clone, Debug)]
pub struct Limit {
    /// The load case or parameter.
    pub name: String,
    /// The path that led there; none in space, where runs of their own bracket the limit.
    pub path: Option<LoadPath>,
    /// Its last value with an answer.
    pub last: f64,
    /// Present factor.
    pub present: f64,
    /// The limit factor; `None` where the path ended otherwise (see [`Limit::end_sentence`]).
    pub factor: Option<f64>,
    /// limit / present, where the present is not 0.
    pub safety: Option<f64>,
    /// How the run beyond the limit ended: see [`Limit::collapse`].
    pub(super) collapse: Option<Ray>,
    /// Whether `solve`, with all its retries, finds an answer just below the limit and none just above. A limit of 0 has
    /// no such places.
    pub confirmed: bool,
    /// A factor just beyond the end of the path at which there is an answer all the same: that end is no limit.
    pub beyond: Option<f64>,
    /// Where no answer was found just before the end of the path, so that it may have led on only by rounding: the runs
    /// of their own between which the limit lies, one with an answer, one with a proof that there is none.
    pub bracket: Option<[f64; 2]>,
    /// Where it is proved that there is no answer, where that lies beyond the bracket.
    pub proof: Option<f64>,
    /// Whether the polygon has an answer at the end of the bracket, where none on the cone was found.
    pub polygon_only: bool,
    /// Whether no answer was found just before the end of the path.
    pub(super) lost: bool,
}

impl Limit {
    /// The collapse: mode, direction, class and verdict; `None` for a ray that is the run's own and nothing of the structure.
    pub fn collapse(&self) -> Option<&Ray> {
        self.collapse.as_ref().filter(|ray| is_of_structure(ray))
    }

    /// How the path ended, in a sentence.
    pub fn end_sentence(&self) -> String {
        let name = &self.name;
        let Some(path) = &self.path else {
            return match self.bracket {
                None => format!("there is an answer at {name} = {}, and no collapse was found", nine_digits(self.last)),
                Some([answer, none]) => {
                    let proof = match self.is_proved() {
                        true => "prove that there is none",
                        false if self.polygon_only => "one of the friction polygon only, none on Coulomb's cone,",
                        false => "find none",
                    };
                    let farther = self
                        .proof
                        .map_or(String::new(), |proof| format!(" (and prove that there is none at {name} = {proof})"));
                    format!(
                        "runs of their own find an answer at {name} = {answer} and {proof} at {name} = {none}{farther}{}",
                        self.no_collapse_words()
                    )
                }
            };
        };
        if let (None, Some([answer, none])) = (self.factor, self.bracket) {
            return format!(
                "the path leads on for rounding only; runs of their own find an answer at {name} = {answer} and prove that \
                 there is none at {name} = {none}"
            );
        }
        match (&path.end, path.breakpoints.last()) {
            // a service limit is looked for as well as a collapse: what happens on the way is said
            (PathEnd::Unbounded, Some(last)) => format!(
                "{} lies at {name} = {}, where {}; beyond it nothing changes any more, however large the load \
                 (`trace {name}` shows the way)",
                if path.breakpoints.len() > 1 { "the last change" } else { "the only change" },
                nine_digits(last.value),
                last.sentence
            ),
            _ => path.end_sentence(),
        }
    }

    /// What is known of the loads beyond the limit, in a sentence; `None` without a limit.
    ///
    /// A motion on which the loads do more work than contact can take just beyond the limit, and do not where there still is
    /// an answer, is driven harder by every load beyond. Anything else is known of one load only.
    pub fn beyond_sentence(&self) -> Option<String> {
        let collapse = self.collapse()?;
        if collapse.verdict == Some(Verdict::Certified) && !collapse.misfit && !collapse.of_this_load {
            return Some("no load beyond it can be carried: proved".to_owned());
        }
        let factor = self.factor?;
        let size = size(factor, self.present);
        let reach = if factor.abs() < size { size.copysign(self.present) } else { factor };
        let search = search(&self.name, factor + BESIDE * reach, reach);
        Some(format!("whether loads beyond it can be carried is not proved: {search} looks"))
    }

    /// Takes a collapse at the limit, with what it means in a sentence. Where runs of their own alone tell of a limit, one that
    /// ended in a ray of its own rules leaves none: answers end there only as far as they were found.
    pub(super) fn put_collapse(&mut self, collapse: Ray) {
        if !is_of_structure(&collapse) {
            if self.path.is_none() && self.bracket.is_some() {
                (self.factor, self.safety) = (None, None);
            }
            self.collapse = Some(collapse);
            return;
        }
        let moving = format!("At this load the structure is on the point of moving: {}", collapse.mode);
        self.collapse = Some(collapse);
        let beyond = self.beyond_sentence().map_or(String::new(), |beyond| format!("; {beyond}"));
        if let Some(collapse) = &mut self.collapse {
            collapse.explanation = format!("{moving}{beyond}.");
        }
    }

    /// What is to be said of a run beyond the answers that ended in a ray of its own.
    fn no_collapse_words(&self) -> &'static str {
        match self.collapse.as_ref().filter(|ray| !is_of_structure(ray)).map(|ray| ray.class) {
            Some(RayClass::Artefact) => {
                ", where the pivots end in an artefact: that is no collapse, and an answer may exist"
            }
            Some(RayClass::Fault) => {
                ", where the run failed: the structure stands without its contacts, so an answer exists"
            }
            _ => "",
        }
    }

    /// Whether it is proved that there is no answer at the end of the bracket.
    fn is_proved(&self) -> bool {
        self.collapse.as_ref().and_then(|collapse| collapse.verdict).is_some_and(Verdict::is_proof)
    }

    /// Whether the limit is proved to lie in its bracket; that of a path ends in a proof.
    pub fn is_bracketed(&self) -> bool {
        self.bracket.is_some() && (self.path.is_some() || self.is_proved())
    }

    /// What runs of their own say of the limit, in a sentence.
    pub fn confirmation(&self) -> String {
        match self.bracket {
            Some([answer, none]) if self.confirmed => {
                format!(
                    "confirmed: runs of their own find an answer at {answer} and prove that there is none at {none}"
                )
            }
            Some([answer, none]) => {
                let farther =
                    self.proof.map_or(String::new(), |proof| format!(", and prove that there is none at {proof}"));
                let found = if self.polygon_only { "one of the friction polygon only" } else { "none" };
                format!("not proved: runs of their own find an answer at {answer} and {found} at {none}{farther}")
            }
            None if self.confirmed => {
                "confirmed: a run of its own finds an answer at 0.999999 of it and none at 1.000001".to_owned()
            }
            None => "not confirmed: runs of their own at 0.999999 and 1.000001 of it do not tell an answer from none"
                .to_owned(),
        }
    }
}

/// Whether a ray tells how the structure moves, or is proved to leave no answer.
fn is_of_structure(ray: &Ray) -> bool {
    ray.class.is_of_structure() || ray.verdict.is_some_and(Verdict::is_proof)
}

impl Limit {
    /// In a few words: why there is no limit, or that no run of its own confirms it; empty for a confirmed one.
    pub fn brief(&self) -> String {
        let at = short(self.last);
        match (self.factor, self.bracket, self.beyond, self.path.as_ref().map(|path| &path.end)) {
            (Some(factor), ..) if self.confirmed || factor == 0.0 => String::new(),
            (Some(_), ..) => "not confirmed by a run of its own".to_owned(),
            (None, Some([answer, none]), ..) => format!("between {} and {}", short(answer), short(none)),
            (None, None, Some(_), _) => format!("none: the path ends at {at}, with answers beyond"),
            (None, None, None, Some(PathEnd::Unbounded)) => "none, however large the load".to_owned(),
            (None, None, None, Some(PathEnd::Turning)) => format!("none found: the path turns back at {at}"),
            (None, None, None, Some(_)) => format!("none found: the path ends at {at}"),
            (None, None, None, None) => format!("none found up to {at}"),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::answer::record::Direction;

    /// What runs of their own leave: answers up to 2, none at 2.0001, where a run ended in a ray of this class.
    fn limit(class: RayClass, verdict: Option<Verdict>) -> Limit {
        let mut limit = Limit {
            name: "F".to_owned(),
            path: None,
            last: 2.0,
            present: 1.0,
            factor: Some(2.0),
            safety: Some(2.0),
            collapse: None,
            confirmed: false,
            beyond: None,
            bracket: Some([2.0, 2.0001]),
            proof: None,
            polygon_only: false,
            lost: false,
        };
        limit.put_collapse(Ray {
            class,
            verdict,
            p: 0.0,
            driver: String::new(),
            direction: Direction::Pairs(Vec::new()),
            mode: "c slips".to_owned(),
            explanation: String::new(),
            misfit: false,
            of_this_load: false,
        });
        limit
    }

    #[test]
    fn a_ray_of_the_run_is_no_collapse_and_no_limit() {
        for (class, words) in
            [(RayClass::Artefact, "an artefact: that is no collapse"), (RayClass::Fault, "the run failed")]
        {
            let found = limit(class, None);
            assert_eq!((found.factor, found.safety, found.collapse()), (None, None, None));
            let sentence = found.end_sentence();
            assert!(
                sentence.starts_with("runs of their own find an answer at F = 2 and find none at F = 2.0001, where")
            );
            assert!(sentence.contains(words), "{sentence}");
            assert_eq!(found.brief(), "between 2 and 2.0001");
            assert!(!found.is_bracketed());
        }
    }

    #[test]
    fn a_motion_or_a_proof_is_one() {
        for (class, verdict) in [
            (RayClass::Mechanism, Some(Verdict::Undecided)),
            (RayClass::NoEquilibrium, None),
            (RayClass::Artefact, Some(Verdict::Proved)),
        ] {
            let found = limit(class, verdict);
            assert_eq!((found.factor, found.safety), (Some(2.0), Some(2.0)));
            assert_eq!(found.collapse().map(|ray| ray.class), Some(class));
        }
    }
}
