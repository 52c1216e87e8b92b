//! Rays: class by the signs of method §4, verdict, the motion in words and the work of the loads on it. Never more than
//! was proved.

use nalgebra::DVector;

use super::balance::is_balanced;
use super::certificate::certify;
use super::kernel::releasable_kernel;
use super::misfit::{Misfit, misfit};
use super::mode::{Mode, mode, pair_words};
use super::motions::{FreeMotions, direction_of};
use super::proof::{BUDGET, Certificate};
use super::remedy::digits;
use super::sliding::sliding;
use crate::answer::record::{Direction, PairDirection, Ray, RayClass, Verdict};
use crate::contact::problem::ContactProblem;
use crate::contact::system::{ContactSystem, JointLoad};
use crate::contact::written::ContactLcp;
use crate::fem::MainSystem;
use crate::lcp::outcome::RayDirection;
use crate::lcp::problem::NOISE;
use crate::model::rules::Covering;
use crate::model::structure::Structure;
use crate::text::words::{list, short};

/// z̄ whose part outside the kernel is below this share of it costs no energy.
const NO_ENERGY: f64 = 1e-7;
/// A power below this multiple of the terms it sums is rounding.
const NO_POWER: f64 = NOISE;
/// What a collapse means whose motion is that of its proof.
const OF_PROOF: &str = "The run ended in slips that cancel one another and move nothing; the motion is that of the proof, without \
                        what opens for its sake only. It costs no energy and the loads do work on it.";

/// Work of a load case on the mode, per unit of its largest entry.
#[derive(Clone, Debug, PartialEq)]
pub struct CasePower {
    /// Name of the case.
    pub case: String,
    /// Its factor.
    pub factor: f64,
    /// −factor·RF·z̄: > 0 drives the motion, < 0 resists it.
    pub power: f64,
}

/// Everything known of a ray of a contact problem.
#[derive(Clone, Debug, PartialEq)]
pub struct RayReport {
    /// Class.
    pub class: RayClass,
    /// What has been proved.
    pub verdict: Option<Verdict>,
    /// p at the last vertex, user's units.
    pub p: f64,
    /// Name of the entering variable; empty where no ray led to the collapse, only its certificate.
    pub driver: String,
    /// z̄ over the joints, largest entry 1.
    pub direction: DVector<f64>,
    /// For an artefact, the pair whose slips grow together and cancel: z⁺ and z⁻, in space along several facets.
    pub artefact: Option<usize>,
    /// The motion of the structure, where z̄ costs no energy; found by [`explain`].
    pub mode: Option<Mode>,
    /// Work of each load case on z̄.
    pub powers: Vec<CasePower>,
    /// The proof of *certified*: a motion and the work on it.
    pub certificate: Option<Certificate>,
    /// Another one: parts that do not fit together.
    pub misfit: Option<Misfit>,
    /// Whether the motion is that of the certificate, since the run ended in slips that cancel one another.
    pub of_proof: bool,
    /// Whether the search for a proof was given up when its time was used up.
    pub out_of_time: bool,
    /// The motion of the structure behind the certificate; found by [`explain`].
    pub certificate_mode: Option<Mode>,
    /// Whether forces within the laws' bounds that balance the loads were found by a linear program; by [`explain`].
    pub balanced: bool,
}

/// The structure behind a contact problem and its main system, where it has one.
pub type Built<'a> = Option<(&'a Structure, &'a MainSystem)>;

/// z̄ over the joints, scaled to largest 1; the class; the pair of an artefact.
pub fn classify(
    problem: &ContactProblem,
    contact: &ContactLcp,
    ray: &RayDirection,
) -> (DVector<f64>, RayClass, Option<usize>) {
    let system = &*problem.system;
    let joints = contact.joint_displacements(system, &ray.z);
    let largest_z = ray.z.iter().fold(0.0, |a: f64, b| a.max(*b));
    let largest_w = ray.w.iter().fold(0.0, |a: f64, b| a.max(*b));
    // Work per z of the stiffest joint: what a w has to be compared with.
    let response = system.stiffness.amax() * contact.length_unit / contact.force_unit;
    if largest_z > 0.0
        && largest_w <= 1e-9 * response * largest_z
        && ray.p <= 1e-9 * response * largest_z
        && joints.amax() <= 1e-9 * largest_z
    {
        let pair = (0..system.pairs.len()).find(|&i| {
            let grows =
                |row: Option<usize>| row.is_some_and(|row| !contact.swapped[row] && ray.z[row] > 0.5 * largest_z);
            match contact.facet_rows.as_slice() {
                [plus, minus] => grows(plus[i]) && grows(minus[i]),
                // Slips of several facets that cancel each other.
                facets => facets.iter().any(|rows| grows(rows[i])),
            }
        });
        if pair.is_some() {
            return (DVector::zeros(system.joint_count()), RayClass::Artefact, pair);
        }
    }
    let direction = direction_of(joints);
    let kernel = releasable_kernel(system);
    if kernel.ncols() == 0 {
        // Joints that repeat one another may demand what no displacement gives: then no answer need exist.
        let class = if system.repeats_joints() { RayClass::NoEquilibrium } else { RayClass::Fault };
        return (direction, class, None);
    }
    let inside = &kernel * (kernel.transpose() * &direction);
    let costs_nothing = direction.amax() > 0.0 && (&inside - &direction).norm() <= NO_ENERGY * direction.norm();
    let (power, terms) = power(&system.forces_of(&problem.load), &inside);
    let class = if costs_nothing && power > NO_POWER * terms { RayClass::Mechanism } else { RayClass::NoEquilibrium };
    (direction, class, None)
}

/// −RF·z̄ and the sum of the sizes of its terms.
fn power(load: &DVector<f64>, z: &DVector<f64>) -> (f64, f64) {
    load.iter().zip(z.iter()).fold((0.0, 0.0), |(sum, terms), (a, b)| (sum - a * b, terms + (a * b).abs()))
}

/// Work of each load case on a motion.
fn powers(problem: &ContactProblem, direction: &DVector<f64>) -> Vec<CasePower> {
    let system = &*problem.system;
    let of_case = |(load, factor): (&JointLoad, &f64)| {
        let forces = system.forces_of(&load.vector);
        let (power, _) = power(&forces, direction);
        let noise = power.abs() <= 1e-12 * forces.amax();
        CasePower { case: load.name.clone(), factor: *factor, power: if noise { 0.0 } else { factor * power } }
    };
    system.loads.iter().zip(&problem.factors).map(of_case).collect()
}

/// Class, direction and power; nothing proved, nothing put into words of the structure yet.
pub fn look(problem: &ContactProblem, contact: &ContactLcp, ray: &RayDirection, p: f64) -> RayReport {
    let system = &*problem.system;
    let (direction, class, artefact) = classify(problem, contact, ray);
    let mut report =
        RayReport { p, driver: contact.name(ray.entering, system), artefact, ..RayReport::of_motion(class, direction) };
    if report.moves() {
        report.powers = powers(problem, &report.direction);
    }
    report
}

/// Looks for a certificate; true if it proves that there is no answer.
pub fn certify_ray(report: &mut RayReport, problem: &ContactProblem, built: Built<'_>) -> bool {
    if report.certificate.is_some() {
        return true;
    }
    if !report.moves() {
        return false;
    }
    let search = certify(problem, &FreeMotions::new(&problem.system, built));
    report.certificate = search.certificate;
    report.out_of_time = search.out_of_time;
    if report.certificate.is_none() {
        report.misfit = misfit(problem);
    }
    report.take_motion_of_proof(problem);
    let certified = report.certificate.is_some() || report.misfit.is_some();
    report.verdict = Some(if certified { Verdict::Certified } else { Verdict::Undecided });
    certified
}

/// Adds what the words need: the motions of the structure, and whether balanced forces exist where nothing is proved.
pub fn explain(report: &mut RayReport, problem: &ContactProblem, built: Built<'_>) {
    if !report.moves() {
        return;
    }
    let of_structure = |direction: &DVector<f64>| built.and_then(|(structure, main)| mode(structure, main, direction));
    report.mode = of_structure(&report.direction);
    report.certificate_mode = report.certificate.as_ref().and_then(|found| of_structure(&found.direction));
    if report.verdict == Some(Verdict::Undecided) && !problem.system.is_in_space() {
        let found = is_balanced(problem, &FreeMotions::new(&problem.system, built), BUDGET.as_secs_f64());
        report.balanced = found == Some(true);
    }
}

/// A ray of a path: class and mode, certified where there is a certificate; without a structure explained by pairs.
pub fn report(problem: &ContactProblem, built: Built<'_>, contact: &ContactLcp, ray: &RayDirection, p: f64) -> Ray {
    let mut report = look(problem, contact, ray, p);
    certify_ray(&mut report, problem, built);
    explain(&mut report, problem, built);
    report.record(&problem.system, Covering::default())
}

/// The motion of the collapse that a certificate proves, largest entry 1: pairs that slip stay closed.
fn collapse_of(problem: &ContactProblem, certificate: &Certificate) -> DVector<f64> {
    sliding(problem, &certificate.direction).unwrap_or_else(|| direction_of(certificate.direction.clone()))
}

impl RayReport {
    /// A motion of this class of which nothing else is known yet.
    fn of_motion(class: RayClass, direction: DVector<f64>) -> RayReport {
        RayReport {
            class,
            verdict: None,
            p: 0.0,
            driver: String::new(),
            direction,
            artefact: None,
            mode: None,
            powers: Vec::new(),
            certificate: None,
            misfit: None,
            of_proof: false,
            out_of_time: false,
            certificate_mode: None,
            balanced: false,
        }
    }

    /// Parts that do not fit together, where the run ended in what would be an answer if their joints yielded.
    pub fn of_misfit(problem: &ContactProblem, misfit: Misfit) -> RayReport {
        RayReport {
            verdict: Some(Verdict::Certified),
            misfit: Some(misfit),
            ..RayReport::of_motion(RayClass::NoEquilibrium, DVector::zeros(problem.system.joint_count()))
        }
    }

    /// A collapse on Coulomb's cone where the run on the polygon ended in an answer: the motion of its certificate, where
    /// pairs that slip stay closed.
    pub fn of_certificate(problem: &ContactProblem, certificate: Certificate) -> RayReport {
        let direction = collapse_of(problem, &certificate);
        RayReport {
            verdict: Some(Verdict::Certified),
            powers: powers(problem, &direction),
            certificate: Some(certificate),
            ..RayReport::of_motion(RayClass::Mechanism, direction)
        }
    }

    /// Close to the limit a run may end in slips along several facets that cancel one another. Where no pair moves then, the
    /// collapse is the motion of its certificate, where there is one.
    fn take_motion_of_proof(&mut self, problem: &ContactProblem) {
        if let Some(certificate) = self.certificate.as_ref().filter(|_| self.direction.amax() == 0.0) {
            let direction = collapse_of(problem, certificate);
            (self.class, self.of_proof) = (RayClass::Mechanism, true);
            self.powers = powers(problem, &direction);
            self.direction = direction;
        }
    }

    /// Whether it is a motion, of which a certificate may exist.
    fn moves(&self) -> bool {
        matches!(self.class, RayClass::Mechanism | RayClass::NoEquilibrium)
    }

    /// Whether the search for a certificate ran out of time, where it found none.
    pub fn in_vain(&self) -> Option<bool> {
        (self.verdict == Some(Verdict::Undecided)).then_some(self.out_of_time)
    }

    /// Takes over that the search for a certificate was in vain.
    pub fn leave_undecided(&mut self, out_of_time: bool) {
        if self.moves() {
            (self.verdict, self.out_of_time) = (Some(Verdict::Undecided), out_of_time);
        }
    }

    /// The motion in words.
    pub fn mode_words(&self, system: &ContactSystem) -> String {
        if let Some(pair) = self.artefact {
            let id = &system.pairs[pair].id;
            return match system.pairs[pair].is_in_space() {
                true => format!("no motion: slips of pair {id} in several directions grow together"),
                false => format!("no motion: z+ and z- of pair {id} grow together"),
            };
        }
        let parts: Vec<String> =
            self.mode.iter().flat_map(|mode| &mode.parts).map(super::mode::PartMotion::words).collect();
        let mut pairs = pair_words(system, &self.direction);
        if self.class == RayClass::Mechanism
            && let [only] = pairs.as_slice()
            && parts.is_empty()
            && let Some(names) = only.strip_suffix(" slip +").or(only.strip_suffix(" slip -"))
        {
            let sign = &only[only.len() - 1..];
            pairs = vec![format!("slip {sign} of {names}")];
        }
        let pairs = if pairs.is_empty() { "no relative motion of the pairs".to_owned() } else { pairs.join("; ") };
        if parts.is_empty() { pairs } else { format!("{}: {pairs}", parts.join("; ")) }
    }

    /// What the ray means, in sentences.
    pub fn explanation(&self, system: &ContactSystem, covering: Covering) -> String {
        match self.class {
            RayClass::Artefact => self.artefact_words(system, covering),
            RayClass::Fault => {
                let why = if covering == Covering::Ones {
                    " With covering `ones` and friction above 1 a pair cannot open while p > 0 (its reserves sum to \
                     2(1 − f)p < 0), so an answer with open pairs is out of reach."
                } else {
                    ""
                };
                format!(
                    "The structure stands without its contacts, so an answer exists for every load and every friction: \
                     this ray is a failure of the chosen rules, not a collapse.{why}"
                )
            }
            RayClass::Mechanism | RayClass::NoEquilibrium => self.no_answer(system, covering),
        }
    }

    fn artefact_words(&self, system: &ContactSystem, covering: Covering) -> String {
        let pair = self.artefact.map_or(String::new(), |pair| format!(" {}", system.pairs[pair].id));
        let [both, used_up, leaves, slips] = match system.is_in_space() {
            false => {
                ["both reserves", "its two friction reserves", "its second reserve", "slip in both directions at once"]
            }
            true => [
                "all reserves",
                "its friction reserves on opposite sides",
                "reserves on opposite sides",
                "slip along all of these facets at once",
            ],
        };
        let (cause, choice) = match covering {
            Covering::Ones => (
                "With friction above 1, covering `ones` takes more friction from every pair than it gives ((1 − f)p)"
                    .to_owned(),
                format!("{used_up} are used up before its contact force is"),
            ),
            _ => (
                format!(
                    "An open pair has no friction under covering `weight`, so at the moment of opening {both} are zero \
                     together with the contact force"
                ),
                format!("the tie-break let {leaves} leave before its contact force"),
            ),
        };
        format!(
            "This says nothing about the structure. {cause}: where pair{pair} should open, {choice}, and {slips}, which \
             moves nothing, can grow without end."
        )
    }

    fn no_answer(&self, system: &ContactSystem, covering: Covering) -> String {
        let p = short(self.p);
        let missing = match covering {
            Covering::Cohesive => {
                format!("an extra pressing force p = {p} and as much cohesion in every pair")
            }
            Covering::Weight => format!("an extra pressing force p = {p} in every pair"),
            Covering::Ones => format!("an extra p = {p} in every contact force and every reserve"),
        };
        // In force form p adds to distances too and to some reserves twice: it is not the force that is missing.
        let forced = system.force_form.is_some();
        let mut text = match (self.class == RayClass::Mechanism, forced) {
            _ if self.of_proof => OF_PROOF.to_owned(),
            _ if self.driver.is_empty() && self.misfit.is_some() => {
                "There is an answer only if joints that repeat one another yield.".to_owned()
            }
            _ if self.driver.is_empty() => {
                "The motion costs no energy and the loads do work on it. The friction polygon holds it, whose corners lie \
                 outside of Coulomb's cone; the cone does not."
                    .to_owned()
            }
            (true, false) => {
                format!("The motion costs no energy and the loads do work on it; only {missing} would just hold it.")
            }
            (true, true) => "The motion costs no energy and the loads do work on it.".to_owned(),
            (false, false) => format!(
                "The run found no state that obeys the laws of contact with less than {missing}; its direction is not a pure \
                 mechanism."
            ),
            (false, true) => {
                "The run found no state that obeys the laws of contact; its direction is not a pure mechanism.".to_owned()
            }
        };
        if forced && !self.of_proof {
            text += &format!(
                " It ended at p = {p}; where joints repeat one another this adds to distances as well as to forces: it is \
                 not the force that is missing."
            );
        }
        match self.verdict {
            Some(Verdict::Certified) if self.misfit.is_some() => {
                if let Some(misfit) = &self.misfit {
                    text += &format!(" Proved: the parts do not fit together: {}.", misfit.words(system));
                }
            }
            Some(Verdict::Certified) => {
                text += match &self.certificate {
                    Some(found) if found.of_this_load => {
                        " Proved: no slip is felt along the normals, so that the load alone decides by what forces the pairs are \
                         pressed, and no friction within the bounds that these give balances the loads"
                    }
                    _ => " Proved: no contact forces within the laws' bounds balance the loads",
                };
                if let Some(certificate) = &self.certificate {
                    let taken = if certificate.dissipation > 0.0 {
                        format!("at most {} of it", short(certificate.dissipation))
                    } else {
                        "none of it".to_owned()
                    };
                    text += &format!(
                        " (there is a motion on which they do the work {} and contact can take {taken})",
                        short(certificate.power)
                    );
                }
                text += ".";
            }
            Some(Verdict::Proved) => {
                text += " Proved: every working scheme was tried, none is an answer.";
            }
            _ if self.balanced => {
                text += " Not proved: forces within friction that balance the loads do exist, but none that obeys the law \
                         of slip was found.";
            }
            _ => text += " Whether there is an answer is not proved.",
        }
        if self.out_of_time {
            text += &format!(" The search for a proof was given up after {} s.", BUDGET.as_secs());
        }
        let powers: Vec<String> = self
            .powers
            .iter()
            .filter(|power| power.power != 0.0)
            .map(|power| {
                let word = if power.power > 0.0 { "drives" } else { "resists" };
                format!("`{}` {word} it ({})", power.case, digits(power.power))
            })
            .collect();
        if self.class == RayClass::Mechanism && !powers.is_empty() {
            text += &format!(" Work of the loads per unit of the motion: {}.", list(&powers));
        }
        text
    }

    /// As it stands in the result.
    pub fn record(&self, system: &ContactSystem, covering: Covering) -> Ray {
        Ray {
            class: self.class,
            verdict: self.verdict,
            p: self.p,
            driver: self.driver.clone(),
            direction: Direction::Pairs(
                (0..system.pair_count()).map(|i| PairDirection::of(system, i, &self.direction)).collect(),
            ),
            mode: self.mode_words(system),
            explanation: self.explanation(system, covering),
            misfit: self.misfit.is_some(),
            of_this_load: self.certificate.as_ref().is_some_and(|found| found.of_this_load),
        }
    }
}

#[cfg(test)]
#[path = "ray_tests.rs"]
mod tests;
