//! Problems with known answers, one file each: a sketch, the formula, the figures.

#[path = "../common/mod.rs"]
mod common;

mod balance;
mod beam;
mod block;
mod cantilever_gap;
mod edge_cases;
mod foundation;
mod foundations;
mod frame;
mod greco;
mod klarbring;
mod loads;
mod method;
mod plates;
mod press_fit;
mod random_structures;
mod repeated_joints;
mod rigid;
mod rings;
mod settlements;
mod slope;
mod springs;
mod structures;
mod unit_square;
