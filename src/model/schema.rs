//! JSON Schema of the scenario format, for editors and other programs.
//!
//! The decoder reads the tree by hand, to collect all problems with their places; the file says the same once more. The
//! tests hold the two together, key by key and word by word.

/// The schema, JSON Schema draft 2020-12.
pub const SCHEMA: &str = include_str!("../../schemas/stickslip-1.json");

#[cfg(test)]
mod tests;
