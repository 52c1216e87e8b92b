//! Warm start after a change of loads: the last answer followed along the change in a kept dictionary.

use std::ops::ControlFlow;
use std::sync::Arc;

use crate::contact::complementarity::{ContactLcp, contact_lcp};
use crate::contact::load_path::{is_answer, order, path_lcp};
use crate::contact::numbers::ContactNumbers;
use crate::contact::system::ContactSystem;
use crate::lcp::outcome::Point;
use crate::lcp::parametric::{End, Parametric, Reach};
use crate::lcp::vertex::{Basis, vertex};
use crate::model::rules::Covering;
use crate::watch::Watch;

/// A path with more pivots than this is no shorter than a cold run.
const PIVOTS: usize = 2_000;

/// The dictionary of an answer, kept for the next change of loads.
#[derive(Clone, Debug)]
pub struct Kept {
    engine: Parametric,
    /// The numbers it stands at.
    numbers: ContactNumbers,
}

/// An answer found from the last one.
#[derive(Clone, Debug)]
pub struct WarmAnswer {
    /// The LCP of the new numbers, under the covering asked for.
    pub contact: ContactLcp,
    /// The final scheme.
    pub basis: Basis,
    /// Its vertex, computed afresh from the data; dimensionless, in the units of `contact`.
    pub point: Point,
    /// Pivots on the way.
    pub pivots: usize,
}

/// Whether only the loads differ.
fn same_laws(a: &ContactNumbers, b: &ContactNumbers) -> bool {
    a.friction == b.friction && a.cohesion == b.cohesion && a.gap == b.gap && a.bound == b.bound
}

/// Follows the answer `basis` of the numbers `from` to those of `to`, which differ in the load only.
///
/// `kept` holds the dictionary from one call to the next; it is used where it stands at `from`, built where it does
/// not, and dropped where the path fails. `None`: solve cold (the laws differ, the path turns or ends in a limit
/// before the target, the vertex at its end does not pass as an answer, or `watch` asked to stop). The caller runs
/// the fresh check on what it makes of the answer.
pub fn follow_load(
    system: &ContactSystem,
    from: &ContactNumbers,
    basis: &Basis,
    to: &ContactNumbers,
    covering: Covering,
    kept: &mut Option<Kept>,
    watch: &dyn Watch,
) -> Option<WarmAnswer> {
    let last = kept.take();
    if !same_laws(from, to) {
        return None;
    }
    let increment = &to.load - &from.load;
    let path = path_lcp(system, from, &increment);
    let mut engine = match last {
        Some(kept) if kept.numbers == *from && kept.engine.basis() == *basis => {
            let mut engine = kept.engine;
            engine.reload(Arc::clone(&path.lcp)).then_some(engine)?
        }
        _ => Parametric::new(Arc::clone(&path.lcp), basis, order(&path))?,
    };
    let reach = Reach {
        target: 1.0,
        through: false,
        pivots: PIVOTS,
    };
    let pivots = engine.walk(reach, &mut |_| {
        if watch.stop() {
            ControlFlow::Break(())
        } else {
            ControlFlow::Continue(())
        }
    });
    let (End::Target, pivots) = pivots else {
        return None;
    };
    let basis = engine.basis();
    let contact = contact_lcp(system, to, covering).ok()?;
    if !is_answer(&contact.lcp, &basis) {
        return None;
    }
    let point = vertex(&contact.lcp, &basis)?;
    *kept = Some(Kept {
        engine,
        numbers: to.clone(),
    });
    Some(WarmAnswer {
        contact,
        basis,
        point,
        pivots,
    })
}
