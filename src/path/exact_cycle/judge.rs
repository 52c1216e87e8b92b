//! What a loop of rational states has to fulfil, however it was found.

use num_rational::BigRational;
use num_traits::{One, Signed, Zero};

use super::question::{Place, Question, Refused};
use crate::lcp::exact::dyadic::{nearest, rational};
use crate::lcp::problem::NOISE;
use crate::text::number::short;

/// Quantities of a pair at a place, none of which may be negative, and its slip.
struct PairSigns {
    /// `None` where the pair never opens.
    x_n: Option<BigRational>,
    z_n: BigRational,
    /// z_τ, x⁺, x⁻; `None` without a tangential joint.
    tangential: Option<(BigRational, [BigRational; 2])>,
}

impl Question<'_> {
    fn signs(&self, place: &Place, pair: usize) -> PairSigns {
        let law = &self.problem().laws[pair];
        let tangential = self.problem().system.pairs[pair].plane_tangential().map(|joint| {
            let bound = rational(law.friction()) * &place.force[pair] + rational(law.fixed_bound());
            (place.z[joint].clone(), [&bound + &place.force[joint], bound - &place.force[joint]])
        });
        PairSigns {
            x_n: (!law.is_bilateral()).then(|| place.force[pair].clone()),
            z_n: place.z[pair].clone(),
            tangential,
        }
    }
}

/// The largest slip left behind by a loop that obeys the laws at every moment and ends with the forces and gaps with which
/// it begins.
pub(super) fn judged(question: &Question<'_>, places: &[Place]) -> Result<BigRational, Refused> {
    let pairs = question.problem().laws.len();
    let id = |pair: usize| &question.problem().system.pairs[pair].id;
    let (Some(first), Some(last)) = (places.first(), places.last()) else { return Err("it is empty".to_owned()) };
    let ends = (first.half, first.t.is_zero(), last.half, last.t.is_one());
    if ends != (0, true, 1, true) {
        return Err("its way is not one there and back".to_owned());
    }
    for ends in places.windows(2) {
        let turns = ends[0].half < ends[1].half && ends[0].t.is_one();
        if !turns && (ends[0].half != ends[1].half || ends[1].t < ends[0].t) || ends[1].t > BigRational::one() {
            return Err("its events stand in another order in rationals".to_owned());
        }
    }
    for pair in 0..pairs {
        let all: Vec<PairSigns> = places.iter().map(|place| question.signs(place, pair)).collect();
        for (place, signs) in places.iter().zip(&all) {
            let where_ = || format!("at {} of the way {}", short(nearest(&place.t)), ["there", "back"][place.half]);
            if let Some((name, value)) = signs.wrong() {
                let value = nearest(&value);
                let touches = name != "z_n" && value.abs() <= NOISE * question.terms();
                let why = match touches {
                    true => {
                        ", nothing but rounding: there the cycle comes to a limit and not beyond. Whether the numbers as they \
                         are stored let it repeat to the last digit stays open; of a load a little less or more it may be \
                         proved"
                    }
                    false => ", which has the wrong sign",
                };
                return Err(format!("{}, {name} of {} is {value:.1e} in rationals{why}", where_(), id(pair)));
            }
        }
        if let Some(what) = all.windows(2).find_map(|ends| ends[0].wrong_way(&ends[1])) {
            return Err(format!("{} {what} in rationals", id(pair)));
        }
        if all[0].z_n != all[all.len() - 1].z_n {
            return Err(format!("the gap of {} does not come back in rationals", id(pair)));
        }
    }
    if first.force != last.force {
        return Err("its forces do not come back in rationals".to_owned());
    }
    let net = first.z.iter().zip(&last.z).map(|(a, b)| (b - a).abs());
    Ok(net.fold(BigRational::zero(), |a, b| if b > a { b } else { a }))
}

impl PairSigns {
    /// What is negative that must not be.
    fn wrong(&self) -> Option<(&'static str, BigRational)> {
        if self.z_n.is_negative() || self.x_n.is_none() && !self.z_n.is_zero() {
            return Some(("z_n", self.z_n.clone()));
        }
        let reserves = self.tangential.iter().flat_map(|(_, reserves)| ["x+", "x-"].into_iter().zip(reserves));
        let forces = self.x_n.iter().map(|x_n| ("x_n", x_n)).chain(reserves);
        forces.into_iter().find(|(_, force)| force.is_negative()).map(|(name, force)| (name, force.clone()))
    }

    /// What the laws forbid between here and the next place: everything is linear in between.
    fn wrong_way(&self, next: &PairSigns) -> Option<&'static str> {
        let closed = self.z_n.is_zero() && next.z_n.is_zero();
        let free = |x_n: &Option<BigRational>| x_n.as_ref().is_some_and(Zero::is_zero);
        let open = free(&self.x_n) && free(&next.x_n);
        if !closed && !open {
            return Some("opens or closes under a force");
        }
        let ((from, here), (to, there)) = (self.tangential.as_ref()?, next.tangential.as_ref()?);
        let side = match () {
            () if to > from => 0,
            () if to < from => 1,
            () => return None,
        };
        (!here[side].is_zero() || !there[side].is_zero()).then_some("slips short of its bound")
    }
}
