//! Why: pivots in sentences, rays by class, in the words of the structure.

pub mod ray;
pub mod sentence;
pub mod words;
