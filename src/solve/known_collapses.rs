//! Collapses proved by a motion that proved others before: neighbouring ones mostly share it.

use std::sync::{Arc, Mutex, PoisonError};

use crate::contact::problem::ContactProblem;
use crate::contact::system::ContactSystem;
use crate::explain::certificate::certify_again;
use crate::explain::motions::FreeMotions;
use crate::explain::proof::Certificate;
use crate::explain::ray::Built;
use crate::lcp::exact::dyadic::nearest;

/// Motions that are kept, the latest first.
const KEPT: usize = 8;

/// The motions of one system that have proved a collapse.
#[derive(Default)]
pub struct KnownCollapses(Mutex<Option<Known>>);

#[derive(Clone)]
struct Known {
    system: Arc<ContactSystem>,
    motions: Arc<FreeMotions>,
    /// Amounts of the free motions.
    amounts: Vec<Arc<[f64]>>,
}

impl Clone for KnownCollapses {
    fn clone(&self) -> Self {
        KnownCollapses(Mutex::new(self.0.lock().unwrap_or_else(PoisonError::into_inner).clone()))
    }
}

impl KnownCollapses {
    /// Takes over what the other one knows.
    pub fn become_as(&self, other: &KnownCollapses) {
        let other = other.clone().0.into_inner().unwrap_or_else(PoisonError::into_inner);
        *self.0.lock().unwrap_or_else(PoisonError::into_inner) = other;
    }

    /// Whether one of them proves that this problem has no answer.
    pub(super) fn prove(&self, problem: &ContactProblem) -> bool {
        let known = self.0.lock().unwrap_or_else(PoisonError::into_inner).clone();
        let Some(known) = known.filter(|known| Arc::ptr_eq(&known.system, &problem.system)) else { return false };
        known.amounts.iter().any(|amounts| certify_again(problem, &known.motions, amounts).is_some())
    }

    /// Keeps the motion that proved a collapse of this problem, where it is given by its free motions; those of another
    /// system are forgotten.
    pub(super) fn learn(&self, problem: &ContactProblem, built: Built<'_>, certificate: &Certificate) {
        if certificate.amounts.is_empty() {
            return;
        }
        let mut known = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        if known.as_ref().is_none_or(|known| !Arc::ptr_eq(&known.system, &problem.system)) {
            *known = Some(Known {
                system: Arc::clone(&problem.system),
                motions: Arc::new(FreeMotions::new(&problem.system, built)),
                amounts: Vec::new(),
            });
        }
        if let Some(known) = known.as_mut() {
            known.amounts.insert(0, certificate.amounts.iter().map(nearest).collect());
            known.amounts.truncate(KEPT);
        }
    }
}
