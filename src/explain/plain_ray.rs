//! The ray of a bare LCP: what drives it, where it goes, and why nothing stops it, where that can be said.

use super::sentence::plain_name;
use crate::answer::record::{Direction, Ray, RayClass, VariableRate, Verdict};
use crate::lcp::bimatrix::Bimatrix;
use crate::lcp::mirrored::MirroredLcp;
use crate::lcp::outcome::RayDirection;
use crate::lcp::pivot::PivotLog;
use crate::lcp::variable::Variable;
use crate::text::words::{list, short};

/// Variables named in the sentence of the motion.
const NAMED: usize = 4;

/// What is known of the ray a bare LCP ended in.
#[derive(Clone, Debug, PartialEq)]
pub struct PlainRay {
    /// The entering variable.
    pub entering: Variable,
    /// Its name.
    pub driver: String,
    /// p at the last vertex.
    pub p: f64,
    /// Rates of all variables that grow, largest 1, the driver first.
    pub direction: Vec<VariableRate>,
    /// Why nothing stops it, in sentences; empty where nothing can be said.
    pub reason: String,
    /// No covering vector d > 0 gets further than the first pivot.
    pub whatever_the_covering: bool,
    /// Whether it is a ray in exact arithmetic too; `None` where that was not examined.
    pub exact: Option<bool>,
}

impl PlainRay {
    /// Reads the ray of a run.
    pub fn new(lcp: &MirroredLcp, names: &[String], log: &PivotLog, ray: &RayDirection, p: f64) -> PlainRay {
        let driver = plain_name(ray.entering, names);
        let rates = [(Variable::P, ray.p)]
            .into_iter()
            .chain(ray.z.iter().enumerate().map(|(i, rate)| (Variable::Z(i), *rate)))
            .chain(ray.w.iter().enumerate().map(|(i, rate)| (Variable::W(i), *rate)));
        let mut growing: Vec<(Variable, f64)> = rates.filter(|(_, rate)| *rate > 0.0).collect();
        growing.sort_by_key(|(variable, _)| *variable != ray.entering);
        let largest = growing.iter().fold(0.0, |a: f64, (_, rate)| a.max(*rate));
        let direction = growing
            .iter()
            .map(|&(variable, rate)| VariableRate { variable: plain_name(variable, names), rate: rate / largest })
            .collect();
        let (reason, whatever_the_covering) = match (log.count(), ray.entering) {
            (1, Variable::Z(r)) if blocks_nothing(lcp, r) => {
                let column = format!(
                    "The column of {driver} is ≥ 0 and its diagonal entry is 0, so nothing falls when it grows, not even p: \
                     no d > 0 gets past this pivot"
                );
                if (0..lcp.size()).any(|r| lcp.q[r] < 0.0 && !blocks_nothing(lcp, r)) {
                    (format!("{column} (another row may need p first under another d)."), false)
                } else {
                    let game = if Bimatrix::of(lcp).is_some() { GAME } else { "" };
                    (format!("{column}, and every other row with q < 0 is of this kind.{game}"), true)
                }
            }
            _ if ray.p > 0.0 => (
                "Along it p grows too, so zᵀM z < 0 there: M is not copositive, hence not positive semidefinite."
                    .into(),
                false,
            ),
            _ => (String::new(), false),
        };
        PlainRay { entering: ray.entering, driver, p, direction, reason, whatever_the_covering, exact: None }
    }

    /// The motion in words.
    fn mode(&self) -> String {
        let others: Vec<String> = self.direction.iter().skip(1).map(|rate| rate.variable.clone()).collect();
        let driver = &self.driver;
        match others.len() {
            0 => format!("{driver} grows without bound and moves nothing else"),
            n if n <= NAMED => format!("{driver} grows without bound, and {} with it", list(&others)),
            n => {
                let mut named = others[..NAMED - 1].to_vec();
                named.push(format!("{} more", n - named.len()));
                format!("{driver} grows without bound, and {} with it", list(&named))
            }
        }
    }

    /// As it stands in the result; `proof` says what is known of the answers.
    pub fn record(&self, verdict: Verdict, proof: &str) -> Ray {
        let reason = if self.reason.is_empty() { String::new() } else { format!("{} ", self.reason) };
        let exact = if self.exact == Some(true) { " (in exact arithmetic too)" } else { "" };
        Ray {
            class: RayClass::NoEquilibrium,
            verdict: Some(verdict),
            p: self.p,
            driver: self.driver.clone(),
            direction: Direction::Variables(self.direction.clone()),
            mode: self.mode(),
            explanation: format!(
                "No row blocks {} at p = {}{exact}: Lemke's algorithm found no answer. {reason}{proof}",
                self.driver,
                short(self.p)
            ),
            misfit: false,
            of_this_load: false,
        }
    }
}

/// What the answer of a bimatrix game is; said where it was not found.
const GAME: &str = " This is a bimatrix game with M = [0 A; C 0]. With the players' values u and v as unknowns, rows A y - u e, \
                    C x - v e, eᵀx - 1, eᵀy - 1 for z = (x, y, u, v), Lemke's algorithm ends in an equilibrium where A, C > 0; \
                    it is an answer here only where u and v are > 0.";

/// Whether z_r can grow without making any w, or p, fall, where w_r has made room for p: M_rr = 0 and the rest of its
/// column ≥ 0.
fn blocks_nothing(lcp: &MirroredLcp, r: usize) -> bool {
    let column = lcp.base.column(r);
    column[r] == 0.0 && column.iter().all(|entry| *entry >= 0.0)
}
