//! `cycle` of two nodes whose slips press one another on and off, judged by a follower of its own in rationals.
//!
//! ```text
//!   x_n = (1 + c b, 1 − c a)      x_τ = (A + 2 a − b, B + 2 b − a)      f = 1/2
//! ```
//! with the slips a, b and the pushes A, B; both nodes stay pressed.

use std::array::from_fn;

use num_rational::BigRational;
use num_traits::{One, Signed, Zero};

use super::cycle::{lost, two_nodes};
use super::find::{near, number, report};

fn ratio(above: i64, below: i64) -> BigRational {
    BigRational::new(above.into(), below.into())
}

fn nearest(number: &BigRational) -> f64 {
    stickslip::lcp::exact::dyadic::nearest(number)
}

/// Slips and pushes of both nodes, and the coupling.
#[derive(Clone)]
struct Nodes {
    slip: [BigRational; 2],
    push: [BigRational; 2],
    coupling: BigRational,
}

/// Reserves f x_n + x_τ and f x_n − x_τ of both nodes, or their rates.
type Reserves = [[BigRational; 2]; 2];

impl Nodes {
    /// Of the weight: 1 for forces, 0 for rates.
    fn reserves(&self, slip: &[BigRational; 2], push: &[BigRational; 2], weight: i64) -> (Reserves, [BigRational; 2]) {
        let [a, b] = slip;
        let normal = [ratio(weight, 1) + &self.coupling * b, ratio(weight, 1) - &self.coupling * a];
        let friction = [&push[0] + ratio(2, 1) * a - b, &push[1] + ratio(2, 1) * b - a];
        let reserves = from_fn(|i| [&normal[i] / ratio(2, 1) + &friction[i], &normal[i] / ratio(2, 1) - &friction[i]]);
        assert!(weight == 0 || normal.iter().all(Signed::is_positive), "a node is not pressed");
        (reserves, friction)
    }

    /// Rates of slip under the rate of the pushes: of all choices of stick, slip + and slip − those whose signs are right.
    fn rates(&self, reserves: &Reserves, push: &[BigRational; 2]) -> [BigRational; 2] {
        let half = self.coupling.clone() / ratio(2, 1);
        let mut found: Vec<[BigRational; 2]> = Vec::new();
        for (one, other) in [(0, 0), (0, 1), (0, -1), (1, 0), (-1, 0), (1, 1), (1, -1), (-1, 1), (-1, -1)] {
            let way: [i64; 2] = [one, other];
            let side = |i: usize| usize::from(way[i] < 0);
            if (0..2).any(|i| way[i] != 0 && !reserves[i][side(i)].is_zero()) {
                continue;
            }
            // Rows of the rate of a slipping node's reserve: 2 s, c/2 − s for the first, −c/2 − s, 2 s for the second.
            let sign = way.map(|s| ratio(s, 1));
            let two = ratio(2, 1);
            let [p, q] = [-(&sign[0] * &push[0]), -(&sign[1] * &push[1])];
            let (across, back) = (&half - &sign[0], -&half - &sign[1]);
            let rate = match way {
                [0, 0] => [ratio(0, 1), ratio(0, 1)],
                [_, 0] => [p / (&two * &sign[0]), ratio(0, 1)],
                [0, _] => [ratio(0, 1), q / (&two * &sign[1])],
                _ => {
                    let (d, e) = (&two * &sign[0], &two * &sign[1]);
                    let determinant = &d * &e - &across * &back;
                    [(&p * &e - &across * &q) / &determinant, (&d * &q - &back * &p) / &determinant]
                }
            };
            let (change, _) = self.reserves(&rate, push, 0);
            let holds = |i: usize| {
                !(&sign[i] * &rate[i]).is_negative()
                    && (0..2).all(|k| !reserves[i][k].is_zero() || !change[i][k].is_negative())
            };
            if (0..2).all(holds) && !found.contains(&rate) {
                found.push(rate);
            }
        }
        assert_eq!(found.len(), 1, "rates");
        found.remove(0)
    }

    /// Pushes to these values; the work lost in friction.
    fn push(&mut self, target: [BigRational; 2]) -> BigRational {
        let rate: [BigRational; 2] = from_fn(|i| &target[i] - &self.push[i]);
        let (mut left, mut work) = (BigRational::one(), BigRational::zero());
        while left.is_positive() {
            let (reserves, friction) = self.reserves(&self.slip, &self.push, 1);
            let slips = self.rates(&reserves, &rate);
            let (change, turn) = self.reserves(&slips, &rate, 0);
            let mut step = left.clone();
            for (reserve, change) in reserves.iter().flatten().zip(change.iter().flatten()) {
                if change.is_negative() {
                    step = step.min(-(reserve / change));
                }
            }
            for i in 0..2 {
                work -= &slips[i] * (&friction[i] * &step + &turn[i] * &step * &step / ratio(2, 1));
                self.slip[i] += &slips[i] * &step;
                self.push[i] += &rate[i] * &step;
            }
            left -= step;
        }
        work
    }

    /// The work lost in a cycle of both pushes between 0 and this, once the same slips come back.
    fn cycle(&mut self, amplitude: &BigRational) -> BigRational {
        for _ in 0..40 {
            let before = self.slip.clone();
            let mut work = self.push(from_fn(|_| amplitude.clone()));
            work += self.push(from_fn(|_| BigRational::zero()));
            if self.slip == before {
                return work;
            }
        }
        panic!("no cycle repeats")
    }
}

/// Every pair of a coupling and an amplitude, from the unloaded nodes and after the second was pushed by 1.5 and let go: what
/// a cycle loses in the end, and the slips at which it does. Where both starts come to one cycle the start does not decide.
#[test]
fn what_a_cycle_loses_depends_on_the_start_or_does_not() {
    let zero = || [ratio(0, 1), ratio(0, 1)];
    let mut session = two_nodes();
    for (coupling, amplitude, expected) in [
        (ratio(0, 1), ratio(1, 1), [ratio(0, 1), ratio(0, 1)]),
        (ratio(0, 1), ratio(21, 20), [ratio(1, 10), ratio(1, 10)]),
        (ratio(0, 1), ratio(11, 10), [ratio(1, 5), ratio(1, 5)]),
        (ratio(0, 1), ratio(6, 5), [ratio(2, 5), ratio(2, 5)]),
        (ratio(9, 10), ratio(3, 5), [ratio(0, 1), ratio(0, 1)]),
        (ratio(9, 10), ratio(4, 5), [ratio(26816, 4558225), ratio(23260303, 583452800)]),
        (ratio(9, 10), ratio(9, 10), [ratio(1213831, 18232900), ratio(43194371, 583452800)]),
        (ratio(9, 10), ratio(19, 20), [ratio(6732011, 72931600), ratio(6732011, 72931600)]),
        (ratio(9, 10), ratio(1, 1), [ratio(20961, 182329), ratio(20961, 182329)]),
        // Both nodes slip to and fro here.
        (ratio(9, 10), ratio(6, 5), [ratio(14882368, 71290639), ratio(14882368, 71290639)]),
    ] {
        report(&mut session, &format!("set c {}", nearest(&coupling))).unwrap();
        let mut unloaded = Nodes { slip: zero(), push: zero(), coupling: coupling.clone() };
        let mut pushed = unloaded.clone();
        pushed.push([ratio(0, 1), ratio(3, 2)]);
        pushed.push(zero());
        let from = pushed.slip.each_ref().map(nearest);
        let commands = [
            format!("cycle L 0..{}", nearest(&amplitude)),
            format!("cycle L 0..{} from a={:e} b={:e}", nearest(&amplitude), from[0], from[1]),
        ];
        for ((nodes, command), expected) in [&mut unloaded, &mut pushed].into_iter().zip(&commands).zip(&expected) {
            assert_eq!(nodes.cycle(&amplitude), *expected, "{command}");
            let found = report(&mut session, command).unwrap();
            assert_eq!(found["kind"], if expected.is_zero() { "shakes-down" } else { "alternates" }, "{command}");
            let last = found["cycles"].as_array().unwrap().last().unwrap();
            assert!((lost(last) - nearest(expected)).abs() < 1e-12, "{command}: {last}");
            for (pair, slip) in last["pairs"].as_array().unwrap().iter().zip(&nodes.slip) {
                near(&pair["total"], nearest(slip), 1e-12);
                assert!(number(&pair["net"]).abs() < 1e-12, "{command}: {pair}");
            }
        }
    }
}
