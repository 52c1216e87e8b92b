//! Conjugate gradients in doubled precision with the f64 factor as preconditioner.
//!
//! Flexible ones (Golub, Ye 1999): the preconditioner, rounded, is not quite symmetric.

use num_traits::Zero;
use stickslip_numerics::doubled::{add_multiple, dot};

use crate::doubled::Doubled;

/// They go on until the square of the error's energy norm has fallen to this share of the first, or no longer falls:
/// 1e-24 of the displacements where the preconditioner is good.
const CONVERGED: f64 = 1e-48;

/// Steps without progress after which they end.
const PATIENCE: usize = 8;

/// The largest share that counts as an answer: with a preconditioner off by a factor of 1e16, still 1e-10 of the
/// displacements. What is left is returned and goes into the check of equilibrium.
const ANSWERED: f64 = 1e-36;

/// Far more steps than there are motions that the preconditioner does not know.
const MOST_STEPS: usize = 400;

/// What the main system answers, and what is left of the energy of the error.
pub type Solution = (Vec<Doubled>, f64);

/// One right side on the way to its solution. Of a residual r, z is what the preconditioner makes of it.
pub struct Descent {
    v: Vec<Doubled>,
    residual: Vec<Doubled>,
    direction: Vec<Doubled>,
    /// K · direction, and what the direction costs.
    response: Vec<Doubled>,
    stiffness: f64,
    /// rᵀ z at the start and now.
    first: f64,
    now: f64,
    /// The least of them, and where.
    best: (f64, Vec<Doubled>),
    steps: usize,
    idle: usize,
}

impl Descent {
    /// From v = 0 to K v = `right`, with the z of that.
    pub fn new(right: Vec<Doubled>, z: Vec<Doubled>) -> Descent {
        let v = vec![Doubled::zero(); right.len()];
        let first = dot(&right, &z).to_f64();
        Descent {
            best: (first, v.clone()),
            v,
            residual: right,
            direction: z,
            response: Vec::new(),
            stiffness: 0.0,
            first,
            now: first,
            steps: 0,
            idle: 0,
        }
    }

    /// Whether another step leads on.
    pub fn goes_on(&self) -> bool {
        let is_done = self.now.is_nan() || self.now <= CONVERGED * self.first || self.idle > PATIENCE;
        !is_done && self.steps < MOST_STEPS
    }

    /// Where the next step goes.
    pub fn direction(&self) -> &[Doubled] {
        &self.direction
    }

    /// What is left of the right side.
    pub fn residual(&self) -> &[Doubled] {
        &self.residual
    }

    /// As far along the direction as it leads down, with K times the direction.
    pub fn step(&mut self, response: Vec<Doubled>) {
        self.stiffness = dot(&self.direction, &response).to_f64();
        let step = Doubled::from(dot(&self.residual, &self.direction).to_f64() / self.stiffness);
        add_multiple(&mut self.v, step, &self.direction);
        add_multiple(&mut self.residual, -step, &response);
        self.response = response;
        self.steps += 1;
    }

    /// Into the next direction, with the z of what is left after the step.
    pub fn turn(&mut self, mut z: Vec<Doubled>) {
        // Rounding may turn the sign of what is next to nothing.
        self.now = dot(&self.residual, &z).to_f64().abs();
        self.idle += 1;
        if self.now < self.best.0 {
            self.best.0 = self.now;
            self.best.1.copy_from_slice(&self.v);
            self.idle = 0;
        }
        // It is conjugate to the last one, whatever the preconditioner did.
        let turn = Doubled::from(-dot(&z, &self.response).to_f64() / self.stiffness);
        add_multiple(&mut z, turn, &self.direction);
        self.direction = z;
    }

    /// The solution; `None` if it did not converge.
    pub fn solution(self) -> Option<Solution> {
        let (error, v) = self.best;
        (error <= ANSWERED * self.first).then_some((v, error))
    }
}
