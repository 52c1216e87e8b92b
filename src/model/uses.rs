//! Where the parameters stand, and what a change of one makes necessary.

use std::collections::{BTreeMap, BTreeSet};

use super::parameter::{Formulas, ParameterValues};

/// The part of a scenario in which a number stands, from the cheapest to change to the dearest.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Region {
    /// A number of a law, or of the q of an LCP: only the LCP changes.
    Law,
    /// A factor of a load case, a stage or a combination: only the LCP changes.
    Factor,
    /// A number in which the load vector of its case is linear, like a force.
    Amount,
    /// Any other number of the loads: their vectors change, the stiffness does not.
    Load,
    /// Geometry or stiffness: everything changes.
    Geometry,
}

/// What was computed anew for an answer; each includes those before it.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord)]
pub enum Redone {
    /// The LCP, with R and RF as they were.
    #[default]
    Lcp,
    /// RF, with the kept factorization.
    Loads,
    /// K, its factorization and R.
    Stiffness,
}

impl Redone {
    /// `LCP`, `RF` or `K`.
    pub fn symbol(self) -> &'static str {
        match self {
            Redone::Lcp => "LCP",
            Redone::Loads => "RF",
            Redone::Stiffness => "K",
        }
    }
}

impl Region {
    /// What a change in this region makes necessary.
    pub fn redone(self) -> Redone {
        match self {
            Region::Law | Region::Factor => Redone::Lcp,
            Region::Amount | Region::Load => Redone::Loads,
            Region::Geometry => Redone::Stiffness,
        }
    }
}

/// For every parameter that can be set: the regions in which it stands, itself or through formulas, and a place in
/// each (a JSON path).
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Uses(BTreeMap<String, BTreeMap<Region, String>>);

impl Uses {
    /// From the places of names, formulas included.
    pub fn new(places: impl IntoIterator<Item = (String, Region, String)>, formulas: &Formulas) -> Uses {
        let mut uses = Uses::default();
        for (name, region, place) in places {
            for free in formulas.free([name.as_str()]) {
                uses.0.entry(free).or_default().entry(region).or_insert_with(|| place.clone());
            }
        }
        uses
    }

    /// Where the parameter stands in a region.
    pub fn place(&self, parameter: &str, region: Region) -> Option<&str> {
        self.0.get(parameter)?.get(&region).map(String::as_str)
    }

    /// Whether it stands anywhere.
    pub fn is_used(&self, parameter: &str) -> bool {
        self.0.contains_key(parameter)
    }

    /// The parameters that stand in a region of this kind.
    pub fn of(&self, redone: Redone) -> BTreeSet<&str> {
        let stands = |regions: &BTreeMap<Region, String>| regions.keys().any(|region| region.redone() == redone);
        self.0.iter().filter(|(_, regions)| stands(regions)).map(|(name, _)| name.as_str()).collect()
    }

    /// What must be computed anew to come from one set of values to another.
    pub fn between(&self, from: &ParameterValues, to: &ParameterValues) -> Redone {
        let differs = |name: &str| from.get(name).map(|v| v.to_bits()) != to.get(name).map(|v| v.to_bits());
        self.0
            .iter()
            .filter(|(name, _)| differs(name))
            .filter_map(|(_, regions)| regions.keys().map(|region| region.redone()).max())
            .max()
            .unwrap_or_default()
    }
}
