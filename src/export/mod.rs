//! Results for other programs: JSON, CSV, meshes, and writing a file so that a crash never leaves half of one.

pub mod atomic;
pub mod csv;
pub mod history;
pub mod json;
pub mod lcp;
pub mod mesh;
pub mod path;
pub mod proof;
pub mod stiffness;
pub mod table;
pub mod vtu;

#[cfg(test)]
mod tests;
