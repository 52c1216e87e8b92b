//! What is rounding beside the other numbers of a result: `show`, `expect` and every table read 0 there.

use super::record::{EndForces, MemberForces, Reaction};

/// Largest share of a column's largest entry that is rounding noise and shown as 0. The smallest difference the
/// solver tells apart in a load is 1e-10 of it (method §4).
const NOISE: f64 = 1e-12;

/// Largest finite |value|, in the unit of the values: the scale against which a column's noise is judged.
pub fn largest(values: impl IntoIterator<Item = f64>) -> f64 {
    values.into_iter().filter(|value| value.is_finite()).fold(0.0, |largest, value| f64::max(largest, value.abs()))
}

/// `value`, or 0 if it is only noise beside `scale`.
pub fn denoised(value: f64, scale: f64) -> f64 {
    if value.abs() <= NOISE * scale { 0.0 } else { value }
}

/// A sum; 0 where it is what rounding leaves of its terms.
pub fn balance(terms: impl Iterator<Item = f64>) -> f64 {
    let (sum, size) = terms.fold((0.0, 0.0), |(sum, size), term: f64| (sum + term, size + term.abs()));
    if sum.abs() <= crate::lcp::problem::NOISE * size { 0.0 } else { sum }
}

/// The largest force and the largest moment of the reactions: what each of them is judged by.
pub fn of_reactions(reactions: &[Reaction]) -> [f64; 2] {
    [largest(reactions.iter().flat_map(Reaction::force)), largest(reactions.iter().flat_map(Reaction::moment))]
}

/// The same of forces (N and Q) and moments at the ends of bar elements.
pub fn of_members<'m>(members: impl Iterator<Item = &'m MemberForces> + Clone) -> [f64; 2] {
    let ends = members.flat_map(|member| [member.start, member.end]);
    let [forces, moments] = [0, 1].map(|moment| {
        let of_end = move |end: EndForces| {
            let [vz, my, t] = end.space.unwrap_or_default();
            if moment == 0 { [end.n, end.q, vz] } else { [end.m, my, t] }
        };
        largest(ends.clone().flat_map(of_end))
    });
    [forces, moments]
}
