//! Segments in any order → chains, ordered by connection and set out by where they lie: the order of a file means
//! nothing.

use std::collections::HashMap;

/// A chord counts as upright if its x differs by no more than this share of its length.
const UPRIGHT: f64 = 1e-6;

/// The nodes of every chain in order; a closed one ends with its first node.
///
/// # Errors
/// A node at which more than two segments meet.
pub fn chains(segments: &[[usize; 2]]) -> Result<Vec<Vec<usize>>, usize> {
    let mut at: HashMap<usize, Vec<usize>> = HashMap::with_capacity(segments.len() + 1);
    for (index, ends) in segments.iter().enumerate() {
        for end in ends {
            at.entry(*end).or_default().push(index);
        }
    }
    if let Some(node) = segments.iter().flatten().find(|node| at[node].len() > 2) {
        return Err(*node);
    }
    let mut used = vec![false; segments.len()];
    let mut chains = Vec::new();
    let mut walk = |first: usize, segment: usize, used: &mut Vec<bool>| {
        let (mut chain, mut next) = (vec![first], Some(segment));
        while let Some(segment) = next {
            used[segment] = true;
            let [a, b] = segments[segment];
            let node = if chain.last() == Some(&a) { b } else { a };
            chain.push(node);
            next = at[&node].iter().copied().find(|other| !used[*other]);
        }
        chains.push(chain);
    };
    // Open chains from one of their ends; what is left is closed.
    for (index, ends) in segments.iter().enumerate() {
        if let Some(end) = ends.iter().find(|end| at[end].len() == 1)
            && !used[index]
        {
            walk(*end, index, &mut used);
        }
    }
    for (index, ends) in segments.iter().enumerate() {
        if !used[index] {
            walk(ends[0], index, &mut used);
        }
    }
    Ok(chains)
}

/// The chain from its end with the smaller x, or y if it is upright; a closed one counter-clockwise from its leftmost
/// (then lowest) node.
pub fn oriented(mut chain: Vec<usize>, position: &dyn Fn(usize) -> [f64; 2]) -> Vec<usize> {
    let (first, last) = (chain[0], chain[chain.len() - 1]);
    if first != last {
        let ([ax, ay], [bx, by]) = (position(first), position(last));
        let (dx, dy) = (bx - ax, by - ay);
        let is_upright = dx.abs() <= UPRIGHT * dx.hypot(dy);
        if if is_upright { dy < 0.0 } else { dx < 0.0 } {
            chain.reverse();
        }
        return chain;
    }
    chain.pop();
    let positions: Vec<[f64; 2]> = chain.iter().map(|node| position(*node)).collect();
    let low = positions.iter().fold([f64::INFINITY; 2], |low, x| [low[0].min(x[0]), low[1].min(x[1])]);
    let high = positions.iter().fold([f64::NEG_INFINITY; 2], |high, x| [high[0].max(x[0]), high[1].max(x[1])]);
    let near = UPRIGHT * (high[0] - low[0]).hypot(high[1] - low[1]);
    let leftmost = (0..chain.len()).filter(|k| positions[*k][0] <= low[0] + near);
    let start = leftmost.min_by(|a, b| positions[*a][1].total_cmp(&positions[*b][1])).unwrap_or(0);
    chain.rotate_left(start);
    if signed_area(&positions) < 0.0 {
        chain[1..].reverse();
    }
    chain.push(chain[0]);
    chain
}

/// Area of a closed polygon, > 0 counter-clockwise.
pub fn signed_area(corners: &[[f64; 2]]) -> f64 {
    let Some(origin) = corners.first() else { return 0.0 };
    let from = |k: usize| [corners[k][0] - origin[0], corners[k][1] - origin[1]];
    let n = corners.len();
    let twice = |k: usize| from(k)[0] * from((k + 1) % n)[1] - from((k + 1) % n)[0] * from(k)[1];
    0.5 * (0..n).map(twice).sum::<f64>()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Nodes 0 … 7 on the corners of an octagon, the first to the right.
    fn octagon(node: usize) -> [f64; 2] {
        let angle = node as f64 * std::f64::consts::FRAC_PI_4;
        [angle.cos(), angle.sin()]
    }

    #[test]
    fn order_comes_from_connection_and_place() {
        let found = chains(&[[2, 3], [1, 0], [1, 2]]).unwrap();
        assert_eq!(found.len(), 1);
        // 0 is at x = 1, 3 at x = −0.7.
        assert_eq!(oriented(found[0].clone(), &octagon), [3, 2, 1, 0]);
        // From 7 (below) to 1 (above) it is upright, whatever the last digits say.
        let noisy = |node: usize| [octagon(node)[0] - 1e-11 * node as f64, octagon(node)[1]];
        for segments in [[[7, 0], [0, 1]], [[1, 0], [0, 7]]] {
            assert_eq!(oriented(chains(&segments).unwrap().remove(0), &noisy), [7, 0, 1]);
        }
    }

    #[test]
    fn rings_start_leftmost_and_run_counter_clockwise() {
        let ring: Vec<[usize; 2]> = (0..8).rev().map(|k| [(k + 1) % 8, k]).collect();
        let found = chains(&ring).unwrap();
        assert_eq!(oriented(found[0].clone(), &octagon), [4, 5, 6, 7, 0, 1, 2, 3, 4]);
    }

    #[test]
    fn pieces_and_branches() {
        assert_eq!(chains(&[[0, 1], [2, 3], [3, 4]]).unwrap().len(), 2);
        assert_eq!(chains(&[[0, 1], [1, 2], [3, 1]]), Err(1));
    }
}
