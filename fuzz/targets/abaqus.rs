//! Any bytes as an .inp file: a mesh and its overview, or problems in words.

#![no_main]

use libfuzzer_sys::fuzz_target;
use stickslip::model::mesh::overview::Overview;
use stickslip::model::mesh::read_abaqus;

fuzz_target!(|bytes: &[u8]| match read_abaqus(bytes, "a.inp", None) {
    Ok(mesh) => drop(Overview::of(&mesh)),
    Err(problems) => assert!(!problems.is_empty()),
});
