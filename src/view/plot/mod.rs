//! Pictures in characters. The data of every plot is there apart from its drawing (`*_series`), because the
//! full-screen interface draws the same data its own way.

pub mod bar_line;
pub mod canvas;
pub mod case_loads;
pub mod chart;
pub mod depth;
pub mod diagram;
pub mod face_map;
pub mod lines;
pub mod load_arrow;
pub mod loads;
pub mod path;
pub mod scene;
pub mod skeleton;
pub mod structure;
pub mod surface;
pub mod ticks;
pub mod trace;
pub mod zone;

/// A curve: its name and its points in the order they are joined.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Series {
    /// Name for the legend.
    pub label: String,
    /// (abscissa, ordinate) in the author's units.
    pub points: Vec<(f64, f64)>,
}
