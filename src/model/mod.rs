//! What the user describes: scenario file → checked scenario. No linear algebra.
//!
//! `load` (text) → `locate` (tree with places) → `decode` (typed, all problems in one pass; `grid`, `edge` make
//! plates, `mortar` joins edges) → `scenario` (what everything later works on).

pub mod amend;
pub mod bar_axes;
pub mod brick;
pub mod catalog;
mod decode;
pub mod dimension;
pub mod edge;
pub mod element;
pub mod embedded;
pub mod expression;
pub mod face;
pub mod faces;
pub mod grid;
pub mod groups;
pub mod jet;
pub mod joints;
pub mod left_by_rounding;
pub mod load;
pub mod load_case;
pub mod locate;
pub mod measurement;
pub(crate) mod memory;
pub mod mesh;
pub mod mortar;
pub mod node;
pub mod pair;
pub mod parameter;
pub mod plate;
pub mod plausible;
pub mod problem;
pub mod quantity;
pub mod rules;
pub mod scenario;
pub mod schema;
pub mod shape;
pub mod shape_functions;
pub mod siconos;
mod solid_shape;
pub mod space_section;
pub mod structure;
pub mod superelement;
pub mod support;
pub mod template;
mod tree;
pub mod tributary;
pub mod units;
pub mod uses;
pub mod vector;
pub mod words;
