//! stickslip: what a structure with frictional contact really does.
//!
//! # The problem
//!
//! A linear elastic structure touches something else at m contact pairs. Each pair has a normal joint (force x_n > 0
//! in compression, opening z_n) and a tangential joint (force x_τ, slip z_τ). With every joint on, the structure is
//! the *main system*; its response to dislocations z of the joints and to the loads is
//!
//! ```text
//!   λ = R (z − (g, 0)) + RF        R: CSM, 2m × 2m, symmetric, positive semidefinite
//!                                  RF: CLV, 2m;  λ = (x_n, x_τ);  g: initial gaps, m
//! ```
//!
//! Unilateral contact and Coulomb friction with r_f = f x_n + c, reserves x⁺ = r_f + x_τ, x⁻ = r_f − x_τ and
//! z_τ = z⁺ − z⁻ make it a linear complementarity problem of 3m rows,
//!
//! ```text
//!   w = M z + q,   w ≥ 0,  z ≥ 0,  wᵀ z = 0,      w = (x_n, x⁺, x⁻),  z = (z_n, z⁺, z⁻)
//! ```
//!
//! which Lemke's algorithm solves: w = M z + q + d p with the artificial variable p, the *tightening weight*; every
//! pivot turns one joint on or off, a change of the *working scheme*. (Popov & Lovtsov, Magazine of Civil Engineering
//! 100(8), 2020, doi 10.18720/MCE.100.1.)
//!
//! # Units and signs
//!
//! Nothing is converted: lengths and forces are in the units of the scenario, angles and rotations in radians, and all
//! other units follow (R in force per length, a work in force · length, a stress in force per area, friction without
//! one). Where numbers are scaled, as in the dictionary of the pivots, or are shares, pixels, bytes, their comment says
//! so. Vectors are (x, y, z) in global axes, right-handed; in the plane their z is 0. x_n > 0 presses, z_n > 0 is open,
//! x_τ acts on the second side, N > 0 and stresses > 0 are tension, reactions act on the structure, moments and
//! rotations are counter-clockwise seen from the tip of their axis; docs/signs.md has all of them.
//!
//! # Data flow
//!
//! scenario file → [`model`] → [`fem`] (R, RF) → [`contact`] (LCP) → [`lcp`] (pivots) → [`answer`] → [`explain`],
//! [`solve`], [`path`] → [`view`], [`export`] → [`session`] → [`repl`], [`tui`], [`cli`]. A module imports only from
//! those before it; only the last three read or write the terminal.

#![forbid(unsafe_code)]
// Module pages may link to private items.
#![allow(rustdoc::private_intra_doc_links)]

pub mod answer;
pub mod cli;
pub mod contact;
pub mod doubled;
pub mod explain;
pub mod export;
pub mod fem;
pub mod lcp;
pub mod model;
pub mod path;
pub mod repl;
pub mod session;
pub mod signals;
pub mod solve;
pub mod text;
pub mod tui;
pub mod view;

pub use stickslip_numerics::watch;
