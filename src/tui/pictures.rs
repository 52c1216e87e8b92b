//! The pictures of the panes as they are kept, and what each is made of. Where a picture has not changed, a key costs
//! only what is seen of it, however large the model is.

use std::ops::Range;

use ratatui::buffer::Buffer;
use ratatui::text::Line;

use crate::session::{DrawnMap, Remedies, Solved};

use super::kept::{Kept, The};
use super::listing::Listing;
use super::pane::{Plot, SortKey};
use super::shown::{Moment, Motion};
use super::theme::Look;
use super::viewport::Viewport;
use crate::view::plot::case_loads::CaseLoads;
use crate::view::plot::skeleton::Skeleton;
use crate::view::projection::Viewpoint;

/// What the table of the pairs shows: rows in an order, on a sheet.
type PairsKey = (The<Moment>, SortKey, bool, Sheet, Range<usize>);

/// The pictures.
#[derive(Default)]
pub struct Pictures {
    /// Order of the pairs.
    pub order: Kept<(The<Moment>, SortKey, bool), Order>,
    /// Table of the pairs.
    pub pairs: Kept<PairsKey, Listing>,
    /// Table of the pivots.
    pub pivots: Kept<(The<Solved>, Sheet), Listing>,
    /// The loads of each case where the structure has them, and as it is displaced.
    pub loads: Kept<(The<Skeleton>, The<Motion>), CaseLoads>,
    /// The structure.
    pub structure: Kept<StructureKey, StructurePicture>,
    /// The plots.
    pub plots: Kept<PlotKey, Buffer>,
    /// The answer in words.
    pub answer: Kept<AnswerKey, Vec<Line<'static>>>,
    /// The map.
    pub map: Kept<MapKey, Vec<Line<'static>>>,
}

/// What a text or a table is written on.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sheet {
    /// Its columns.
    pub width: usize,
    /// Its colours and characters.
    pub look: Look,
}

/// The pairs in an order.
#[derive(Debug, Default)]
pub struct Order {
    /// Indices of the pairs.
    pub pairs: Vec<usize>,
    /// For each pair, its place in the order.
    places: Vec<usize>,
}

impl Order {
    /// These pairs in this order.
    pub fn new(pairs: Vec<usize>) -> Order {
        let mut places = vec![0; pairs.len()];
        for (place, pair) in pairs.iter().enumerate() {
            places[*pair] = place;
        }
        Order { pairs, places }
    }

    /// Where a pair stands; at the top if it is none.
    pub fn place(&self, pair: usize) -> usize {
        self.places.get(pair).copied().unwrap_or_default()
    }
}

/// What the picture of the structure is made of.
#[derive(PartialEq)]
pub struct StructureKey {
    /// The state.
    pub moment: The<Moment>,
    /// How the structure moves.
    pub motion: The<Motion>,
    /// Columns and rows.
    pub size: (u16, u16),
    /// Colours and characters.
    pub look: Look,
    /// The part in view.
    pub view: Viewport,
    /// From where it is seen.
    pub viewpoint: Viewpoint,
    /// Scale of the displacements.
    pub scale: f64,
    /// Part of a full swing of a ray's mode.
    pub phase: Option<u32>,
    /// Whether the answer before is shown too.
    pub ghost: bool,
    /// Whether the loads are shown.
    pub loads: bool,
}

/// The structure as drawn, with the places of its pairs.
pub struct StructurePicture {
    /// Its characters.
    pub buffer: Buffer,
    /// Column and row of every pair in view.
    pub pairs: Vec<Option<(u16, u16)>>,
}

/// What the plots are made of.
#[derive(PartialEq)]
pub struct PlotKey {
    /// The state.
    pub moment: The<Moment>,
    /// Columns and rows.
    pub size: (u16, u16),
    /// Colours and characters.
    pub look: Look,
    /// Whether forces of the bars are there.
    pub whole: bool,
    /// The first plot.
    pub plot: Plot,
    /// Whether the answer before is shown too.
    pub ghost: bool,
}

/// What the answer in words is made of.
#[derive(PartialEq)]
pub struct AnswerKey {
    /// The state.
    pub moment: The<Moment>,
    /// What would stop a collapse, once it is known.
    pub remedies: Option<The<Remedies>>,
    /// Whether it is being looked for.
    pub looking: bool,
    /// Whether displacements and the check of equilibrium are there.
    pub whole: bool,
    /// What it is written on.
    pub sheet: Sheet,
}

/// What the picture of a map is made of.
#[derive(PartialEq)]
pub struct MapKey {
    /// The map.
    pub map: Option<The<DrawnMap>>,
    /// Columns and rows of its plane.
    pub size: (usize, usize),
    /// Colours and characters.
    pub look: Look,
}

impl Pictures {
    /// Forgets them all.
    pub fn clear(&mut self) {
        *self = Pictures::default();
    }
}
