//! How a structure could move with its contact joints off, judged from its parts alone: a look at a file without any
//! factorization.

use super::element::stiffness;
use super::error::MainSystemError;
use super::kernel;
use super::loose::{LooseMotions, Motion, loose_motions};
use super::outline::Outline;
use super::watch::check_stop;
use crate::model::pair::Joint;
use crate::model::structure::Structure;
use crate::watch::Watch;

/// Elements and springs whose stiffnesses differ by no more than this leave no doubt whether what holds a part holds it
/// in the digits of f64 and beyond; the softest shape of n membranes is 1/n⁴ as stiff as they are, and doubled
/// precision resolves 1e-22.
const CONTRAST: f64 = 1e6;

/// Elements looked at between two looks at the watcher.
const ELEMENTS_PER_LOOK: usize = 4096;

/// See the module.
pub struct Kinematics {
    outline: Outline,
    motions: Vec<Motion>,
    complete: bool,
}

impl Kinematics {
    /// Looks at the parts.
    ///
    /// # Errors
    /// As [`MainSystem::new`](super::MainSystem::new), but for mechanisms inside the structure where
    /// [`Kinematics::is_complete`] is false.
    pub fn new(structure: &Structure, joints: &[Joint], watch: &dyn Watch) -> Result<Kinematics, MainSystemError> {
        watch.progress(&format!("looking at {} elements", structure.elements.len()), 0.0);
        let outline = Outline::new(structure, joints, watch)?;
        let contrast = contrast(structure, watch)?;
        let LooseMotions { motions, complete } = loose_motions(structure, &outline.dofs);
        kernel::rigid_kernel(structure, &outline.joints, &motions)?;
        let membranes = structure.elements.iter().all(|element| element.nodes.len() > 2);
        let complete = complete && membranes && structure.superelement.is_none() && contrast <= CONTRAST;
        Ok(Kinematics { outline, motions, complete })
    }

    pub(super) fn outline(&self) -> &Outline {
        &self.outline
    }

    /// Motions that cost nothing, as far as they are seen from the parts.
    pub fn motions(&self) -> &[Motion] {
        &self.motions
    }

    /// Whether there are surely no others: no bars, no superelement, not too many parts connected to one another, and
    /// no part so much softer than another that only the numbers could tell whether it holds.
    pub fn is_complete(&self) -> bool {
        self.complete
    }

    /// Work of each load case per unit factor on each of the motions, and the magnitude of its terms; force · length.
    pub fn works(&self) -> Vec<Vec<[f64; 2]>> {
        let u: Vec<Vec<f64>> = self.motions.iter().map(|motion| self.outline.dofs.gather(&motion.u)).collect();
        let work = |f: &Vec<f64>, u: &Vec<f64>| {
            std::iter::zip(f, u).fold([0.0, 0.0], |[sum, size], (f, u)| [sum + f * u, size + (f * u).abs()])
        };
        self.outline.f.iter().map(|f| u.iter().map(|u| work(f, u)).collect()).collect()
    }
}

/// Stiffness of the stiffest element or spring over that of the softest.
///
/// # Errors
/// An element without shape; interrupted.
fn contrast(structure: &Structure, watch: &dyn Watch) -> Result<f64, MainSystemError> {
    let rigid = structure.rigid_elements();
    let (mut softest, mut stiffest) = (f64::INFINITY, 0.0_f64);
    let mut take = |k: f64| (softest, stiffest) = (softest.min(k), stiffest.max(k));
    for index in (0..structure.elements.len()).filter(|&index| !rigid[index]) {
        if index % ELEMENTS_PER_LOOK == 0 {
            check_stop(watch)?;
        }
        take(stiffness::<f64>(structure, index)?.diagonal().max());
    }
    let springs = structure.springs.iter().map(|spring| spring.stiffness);
    springs.filter(|stiffness| *stiffness > 0.0).for_each(take);
    Ok(if stiffest > 0.0 { stiffest / softest } else { 1.0 })
}
