//! The pictures of the panes as they are kept, and what each is made of. Where a picture is as of old, a key costs what
//! is seen of it, however large the model is.

use std::sync::Arc;

use ratatui::buffer::Buffer;
use ratatui::text::Line;

use crate::session::{Remedies, Solved};

use super::kept::{Kept, The};
use super::listing::Listing;
use super::pane::{Plot, SortKey};
use super::shown::Moment;
use super::theme::Look;
use super::viewport::Viewport;

/// The pictures.
#[derive(Default)]
pub struct Pictures {
    /// Order of the pairs.
    pub order: Kept<(The<Moment>, SortKey, bool), Order>,
    /// Table of the pairs.
    pub pairs: Kept<(The<Moment>, SortKey, bool, Sheet), Listing>,
    /// Table of the pivots.
    pub pivots: Kept<(The<Solved>, Sheet), Listing>,
    /// How the structure moves.
    pub shape: Kept<The<Moment>, Shape>,
    /// The structure.
    pub structure: Kept<StructureKey, StructurePicture>,
    /// The plots.
    pub plots: Kept<PlotKey, Buffer>,
    /// The answer in words.
    pub answer: Kept<AnswerKey, Vec<Line<'static>>>,
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
    /// Of each pair, its place in the order.
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

/// How the structure moves.
pub struct Shape {
    /// u_x, u_y and the rotation of every node; `None` where nothing is known to move.
    pub u: Option<Vec<[f64; 3]>>,
    /// Likewise of the answer before, where it is worth showing.
    pub before: Option<Vec<[f64; 3]>>,
    /// The automatic scale.
    pub automatic: f64,
}

/// What the picture of the structure is made of.
#[derive(PartialEq)]
pub struct StructureKey {
    /// The state.
    pub moment: The<Moment>,
    /// Columns and rows.
    pub size: (u16, u16),
    /// Colours and characters.
    pub look: Look,
    /// The part in view.
    pub view: Viewport,
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
    /// What it is written on.
    pub sheet: Sheet,
}

impl AnswerKey {
    /// Of these.
    pub fn new(moment: &Arc<Moment>, remedies: Option<&Arc<Remedies>>, looking: bool, sheet: Sheet) -> Self {
        AnswerKey { moment: The::one(moment), remedies: remedies.map(The::one), looking, sheet }
    }
}

impl Pictures {
    /// Forgets them all.
    pub fn clear(&mut self) {
        *self = Pictures::default();
    }
}
