//! What the elements can do in assembled structures: patch tests of every kind of element and bending against the closed
//! form, the figures of docs/elements.md.

mod bars;
mod bending;
mod membranes;
mod mesh;
mod solids;
