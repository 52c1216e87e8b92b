//! Problems with known answers, one file each: a sketch, the formula, the figures.

#[path = "../common/mod.rs"]
mod common;

mod arches;
mod at_rest;
mod balance;
mod beam;
mod block;
mod cantilever_gap;
mod contact_system;
mod edge_cases;
mod elements;
mod far_apart;
mod foundation;
mod foundations;
mod frame;
mod greco;
mod guides;
mod klarbring;
mod loads;
mod meshes;
mod method;
mod mortar;
mod pairs_at_a_node;
mod plates;
mod press_fit;
mod random_structures;
mod repeated_histories_in_space;
mod repeated_in_space;
mod repeated_joint_histories;
mod repeated_joints;
mod repeated_paths_in_space;
mod rigid;
mod rings;
mod rollers;
mod settlements;
mod slope;
mod space;
mod space_scenarios;
mod springs;
mod structures;
mod superelement;
mod template_arch;
mod templates;
mod unit_square;
mod units;
