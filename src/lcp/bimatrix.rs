//! Bimatrix games among LCPs: M = [0 A; C 0] ≥ 0, its rows in any order, and q < 0.
//!
//! Lemke's algorithm ends in a ray at its first pivot there, whatever d. With the values u and v of the two players as
//! unknowns it does find an equilibrium (Cottle, Pang & Stone, "The Linear Complementarity Problem", §1.4, §4.4):
//!
//! ```text
//!     A y − u e ≥ 0 ⟂ x,   C x − v e ≥ 0 ⟂ y,   eᵀx ≥ 1 ⟂ u,   eᵀy ≥ 1 ⟂ v
//! ```
//! whose x / v and y / u are an answer of the LCP where q = −e. Any other q becomes −e by scaling the rows.

use super::mirrored::MirroredLcp;
use super::problem::{Lcp, Scale};

/// An LCP that is a game.
pub struct Bimatrix<'a> {
    lcp: &'a MirroredLcp,
    /// The player, 0 or 1, to whom the strategy of each row belongs.
    player: Vec<usize>,
}

impl<'a> Bimatrix<'a> {
    /// The LCP as a game; `None` where it is not one: the two sets of rows with zero diagonal blocks are found as the
    /// two colours of a graph.
    pub fn of(lcp: &'a MirroredLcp) -> Option<Bimatrix<'a>> {
        let (n, m) = (lcp.size(), &lcp.base);
        let has_mirrors = lcp.mirrors.iter().any(Option::is_some);
        if has_mirrors || lcp.q.iter().any(|q| *q >= 0.0) || m.iter().any(|entry| *entry < 0.0) {
            return None;
        }
        let mut player: Vec<Option<usize>> = vec![None; n];
        for start in 0..n {
            let mut waiting = vec![start];
            player[start] = Some(player[start].unwrap_or(0));
            while let Some(i) = waiting.pop() {
                for j in (0..n).filter(|&j| m[(i, j)] != 0.0 || m[(j, i)] != 0.0) {
                    match player[j] {
                        None => {
                            player[j] = player[i].map(|player| 1 - player);
                            waiting.push(j);
                        }
                        Some(other) if Some(other) == player[i] => return None,
                        Some(_) => {}
                    }
                }
            }
        }
        let player: Vec<usize> = player.into_iter().flatten().collect();
        player.contains(&1).then_some(Bimatrix { lcp, player })
    }

    /// The LCP in (x, y, u, v): the rows as they stand, then those of the two values.
    pub fn with_values(&self) -> Lcp<f64> {
        let n = self.lcp.size();
        let mut matrix = vec![vec![0.0; n + 2]; n + 2];
        for (i, &player) in self.player.iter().enumerate() {
            for (j, entry) in matrix[i][..n].iter_mut().enumerate() {
                *entry = self.lcp.base[(i, j)] / -self.lcp.q[i];
            }
            let value = n + player;
            (matrix[i][value], matrix[value][i]) = (-1.0, 1.0);
        }
        let mut q = vec![0.0; n];
        q.extend([-1.0; 2]);
        Lcp { scale: Scale::plain(&matrix), matrix, q, covering: vec![1.0; n + 2] }
    }

    /// z of the LCP from an equilibrium (x, y, u, v); `None` where a value is 0.
    pub fn answer(&self, equilibrium: &[f64]) -> Option<Vec<f64>> {
        let n = self.lcp.size();
        let values = &equilibrium[n..];
        let of_other = |i: usize| values[1 - self.player[i]];
        values.iter().all(|value| *value > 0.0).then(|| (0..n).map(|i| equilibrium[i] / of_other(i)).collect())
    }
}
