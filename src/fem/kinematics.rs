//! How a structure could move with its contact joints off, judged from its parts alone: a look at a file without any
//! factorization.

use super::contrast::Stiffnesses;
use super::element::stiffness;
use super::error::MainSystemError;
use super::kernel;
use super::loose::{EFFORT, LooseMotions, Motion, loose_motions};
use super::outline::Outline;
use super::watch::check_stop;
use crate::model::pair::Joint;
use crate::model::structure::Structure;
use crate::watch::Watch;

/// Elements looked at between two looks at the watcher.
const ELEMENTS_PER_LOOK: usize = 4096;

/// See the module.
pub struct Kinematics {
    outline: Outline,
    loose: LooseMotions,
}

impl Kinematics {
    /// Looks at the parts.
    ///
    /// # Errors
    /// As [`MainSystem::new`](super::MainSystem::new), but for elements without shape, and for mechanisms inside the
    /// structure where [`Kinematics::is_complete`] is false.
    pub fn new(structure: &Structure, joints: &[Joint], watch: &dyn Watch) -> Result<Kinematics, MainSystemError> {
        watch.progress(&format!("looking at {} elements", structure.elements.len()), 0.0);
        let outline = Outline::new(structure, joints, watch)?;
        let loose = loose_motions(structure, &outline.dofs, &[], EFFORT);
        kernel::rigid_kernel(structure, &outline.joints, &loose.motions)?;
        Ok(Kinematics { outline, loose })
    }

    pub(super) fn outline(&self) -> &Outline {
        &self.outline
    }

    pub(super) fn loose(&self) -> &LooseMotions {
        &self.loose
    }

    /// Motions that cost nothing, as far as they are seen from the parts.
    pub fn motions(&self) -> &[Motion] {
        &self.loose.motions
    }

    /// Whether there are surely no others: [`super::loose::LooseMotions::are_all`].
    ///
    /// # Errors
    /// An element without shape; interrupted.
    pub fn is_complete(&self, structure: &Structure, watch: &dyn Watch) -> Result<bool, MainSystemError> {
        Ok(self.loose.may_be_all(structure) && self.loose.are_all(structure, &stiffnesses(structure, watch)?))
    }

    /// Work of each load case per unit factor on each of the motions, and the magnitude of its terms; force · length.
    pub fn works(&self) -> Vec<Vec<[f64; 2]>> {
        let u: Vec<Vec<f64>> = self.loose.motions.iter().map(|motion| self.outline.dofs.gather(&motion.u)).collect();
        let work = |f: &Vec<f64>, u: &Vec<f64>| {
            std::iter::zip(f, u).fold([0.0, 0.0], |[sum, size], (f, u)| [sum + f * u, size + (f * u).abs()])
        };
        self.outline.f.iter().map(|f| u.iter().map(|u| work(f, u)).collect()).collect()
    }
}

/// The softest and the stiffest element or spring.
///
/// # Errors
/// An element without shape; interrupted.
fn stiffnesses(structure: &Structure, watch: &dyn Watch) -> Result<Stiffnesses, MainSystemError> {
    let rigid = structure.rigid_elements();
    let mut all = Stiffnesses::of_springs(structure);
    for index in (0..structure.elements.len()).filter(|&index| !rigid[index]) {
        if index % ELEMENTS_PER_LOOK == 0 {
            check_stop(watch)?;
        }
        all.take(&stiffness::<f64>(structure, index)?);
    }
    Ok(all)
}
