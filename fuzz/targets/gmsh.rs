//! Any bytes as a file of Gmsh: a mesh and its overview, or problems in words.

#![no_main]

use libfuzzer_sys::fuzz_target;
use stickslip::model::mesh::overview::Overview;
use stickslip::model::mesh::read_gmsh;

fuzz_target!(|bytes: &[u8]| match read_gmsh(bytes, "a.msh") {
    Ok(mesh) => drop(Overview::of(&mesh)),
    Err(problems) => assert!(!problems.is_empty()),
});
