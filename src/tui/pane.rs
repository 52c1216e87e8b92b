//! What the screen is made of: panes, plots, orders of the pairs.

/// A pane.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Pane {
    /// The structure, deformed, with the states of its pairs.
    Structure,
    /// The parameters as sliders.
    Parameters,
    /// The table of the pairs.
    Pairs,
    /// The pivots.
    Pivots,
    /// Curves over the contact zone and over the pivots.
    Plot,
    /// Outcome, check, rules.
    Answer,
    /// Probes, and what was asked for.
    Quantities,
    /// Combinations of the loads and stages of their history.
    Loading,
    /// The plane of two parameters, cut into regions of equal working scheme.
    Map,
}

impl Pane {
    /// All panes, in the order of their numbers.
    pub const ALL: [Pane; 9] = [
        Pane::Structure,
        Pane::Parameters,
        Pane::Pairs,
        Pane::Pivots,
        Pane::Plot,
        Pane::Answer,
        Pane::Quantities,
        Pane::Loading,
        Pane::Map,
    ];

    /// Its title.
    pub fn title(self) -> &'static str {
        match self {
            Pane::Structure => "Structure",
            Pane::Parameters => "Parameters",
            Pane::Pairs => "Pairs",
            Pane::Pivots => "Pivots",
            Pane::Plot => "Plots",
            Pane::Answer => "Answer",
            Pane::Quantities => "Quantities",
            Pane::Loading => "Loading",
            Pane::Map => "Map",
        }
    }

    /// The title where there is little room.
    pub fn short(self) -> &'static str {
        match self {
            Pane::Structure => "Struct",
            Pane::Parameters => "Params",
            Pane::Quantities => "Quant",
            Pane::Loading => "Load",
            pane => pane.title(),
        }
    }

    /// The title where there is less.
    pub fn shortest(self) -> &'static str {
        match self {
            Pane::Structure => "Str",
            Pane::Parameters => "Par",
            Pane::Pairs => "Pair",
            Pane::Pivots => "Piv",
            Pane::Plot => "Plot",
            Pane::Answer => "Ans",
            Pane::Quantities => "Qty",
            Pane::Loading => "Load",
            Pane::Map => "Map",
        }
    }

    /// What it is for, in a line; `plain` says that there is a bare LCP and no contact.
    pub fn explanation(self, plain: bool) -> &'static str {
        match (self, plain) {
            (Pane::Structure, false) => "what sticks, slips, opens",
            (Pane::Structure, true) => "",
            (Pane::Parameters, _) => "+ and - vary it at once",
            (Pane::Pairs, false) => "forces and motion of each contact pair",
            (Pane::Pairs, true) => "z and w at the pivot shown",
            (Pane::Pivots, false) => "each turns one joint",
            (Pane::Pivots, true) => "each swaps two variables",
            (Pane::Plot, false) => "along the contact; p: the next plot",
            (Pane::Plot, true) => "p falls to 0, or ends in a ray",
            (Pane::Answer, _) => "how the run ended, and its check",
            (Pane::Quantities, _) => "probes, and what `:show` asks for",
            (Pane::Loading, _) => "combinations and stages, shown one by one",
            (Pane::Map, _) => "arrows: the answer there; Enter sets both",
        }
    }

    /// Its place in [`Pane::ALL`].
    pub fn index(self) -> usize {
        Pane::ALL.iter().position(|pane| *pane == self).unwrap_or_default()
    }
}

/// What is plotted.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Plot {
    /// z_τ.
    Slip,
    /// x_τ within its bounds.
    Force,
    /// x_n.
    Pressure,
    /// z_n.
    Gap,
    /// p over the pivots.
    P,
    /// M along the bars.
    Moment,
    /// Q along the bars.
    Shear,
    /// N along the bars.
    Axial,
    /// V_z along bars in space.
    ShearZ,
    /// T along bars in space.
    Torsion,
    /// M_y along bars in space.
    MomentY,
    /// Direction of the ray.
    Ray,
}

impl Plot {
    /// What it is called.
    pub fn title(self) -> &'static str {
        match self {
            Plot::Slip => "slip",
            Plot::Force => "force",
            Plot::Pressure => "pressure",
            Plot::Gap => "opening gap",
            Plot::P => "p over the pivots",
            Plot::Moment => "moment",
            Plot::Shear => "shear",
            Plot::Axial => "axial",
            Plot::ShearZ => "shear V_z",
            Plot::Torsion => "torque",
            Plot::MomentY => "moment M_y",
            Plot::Ray => "ray mode",
        }
    }

    /// The command that draws it; the ray's direction over the zone has none.
    pub fn command(self) -> Option<&'static str> {
        Some(match self {
            Plot::Slip => "plot slip",
            Plot::Force => "plot force",
            Plot::Pressure => "plot pressure",
            Plot::Gap => "plot gap",
            Plot::P => "plot p",
            Plot::Moment => "plot moment",
            Plot::Shear => "plot shear",
            Plot::Axial => "plot axial",
            Plot::ShearZ => "plot Vz",
            Plot::Torsion => "plot T",
            Plot::MomentY => "plot My",
            Plot::Ray => return None,
        })
    }
}

/// Order of the pairs.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SortKey {
    /// As in the file.
    File,
    /// By state.
    State,
    /// By |z_τ|.
    Slip,
    /// By x_n.
    Pressure,
    /// By the smaller reserve.
    Reserve,
    /// By z_n.
    Gap,
}

impl SortKey {
    /// In the order in which they follow each other.
    pub const ALL: [SortKey; 6] =
        [SortKey::File, SortKey::State, SortKey::Slip, SortKey::Pressure, SortKey::Reserve, SortKey::Gap];

    /// In words.
    pub fn word(self) -> &'static str {
        match self {
            SortKey::File => "as in the file",
            SortKey::State => "by state",
            SortKey::Slip => "by slip",
            SortKey::Pressure => "by x_n",
            SortKey::Reserve => "by reserve",
            SortKey::Gap => "by opening",
        }
    }
}
