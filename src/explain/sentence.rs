//! Pivots as changes of the working scheme, in sentences.

use super::remedy::told_apart;
use crate::answer::record::{PivotRecord, Turned, TurnedJoint};
use crate::contact::polygon::{Polygon, angle, degrees};
use crate::contact::rows::{Quantity, RowKind};
use crate::contact::schemes::scheme::{PairScheme, Tangential};
use crate::contact::system::ContactSystem;
use crate::contact::written::ContactLcp;
use crate::lcp::pivot::Pivot;
use crate::lcp::variable::Variable;
use crate::text::words::{list, short};

/// The records of a contact run; p in the user's units.
pub fn pivot_records(pivots: &[Pivot], contact: &ContactLcp, system: &ContactSystem) -> Vec<PivotRecord> {
    let mut schemes =
        Schemes { pairs: vec![PairScheme::STICK; system.pairs.len()], facets: vec![Vec::new(); system.pairs.len()] };
    // What a run starts from: the joints on, those in force form off.
    for meaning in contact.rows.iter().zip(&contact.swapped).filter(|(_, swapped)| **swapped).map(|(row, _)| row) {
        match meaning.couple {
            RowKind::Normal => schemes.pairs[meaning.pair].open = true,
            _ => schemes.pairs[meaning.pair].tangential = Tangential::PLUS,
        }
    }
    pivots
        .iter()
        .map(|pivot| {
            let turned = turn(&mut schemes, pivot.entering, contact, system);
            let unit = contact.force_unit;
            let sentence = Sentence {
                contact,
                system,
                before: pivot.p_before * unit,
                after: pivot.p_after * unit,
                ended: pivot.leaving == Variable::P,
            }
            .tell(pivot, turned.as_ref(), &schemes);
            PivotRecord {
                step: pivot.step,
                entering: contact.name(pivot.entering, system),
                leaving: contact.name(pivot.leaving, system),
                p: pivot.p_after * unit,
                ties: pivot.ties.iter().map(|&tie| contact.name(tie, system)).collect(),
                turned,
                sentence,
            }
        })
        .collect()
}

/// The working scheme on the way.
struct Schemes {
    pairs: Vec<PairScheme>,
    /// In space: the facets along which each pair slips, one or at a corner two, in the order in which they were released.
    facets: Vec<Vec<usize>>,
}

/// Applies the entering variable to the working scheme.
fn turn(schemes: &mut Schemes, entering: Variable, contact: &ContactLcp, system: &ContactSystem) -> Option<Turned> {
    let (row, quantity) = contact.quantity(entering)?;
    let released = quantity == Quantity::Displacement;
    let meaning = contact.rows[row];
    if let (Some(facet), true) = (meaning.couple.facet(), system.pairs[meaning.pair].is_in_space()) {
        let facets = &mut schemes.facets[meaning.pair];
        let word = |facets: &[usize]| (if facets.is_empty() { "stick" } else { "slip" }).to_owned();
        let from = word(facets);
        match released {
            true => facets.push(facet),
            false => facets.retain(|own| *own != facet),
        }
        let to = word(facets);
        return Some(Turned { pair: system.pairs[meaning.pair].id.clone(), joint: TurnedJoint::Tangential, from, to });
    }
    let scheme = &mut schemes.pairs[meaning.pair];
    let frictionless = !system.pairs[meaning.pair].rubs();
    let closed_word = match () {
        () if frictionless => "closed".to_owned(),
        () if !schemes.facets[meaning.pair].is_empty() => "slip".to_owned(),
        () => scheme.tangential.word(Polygon::PLANE),
    };
    let (joint, from, to) = match (meaning.couple, released) {
        (RowKind::Normal, true) => {
            scheme.open = true;
            (TurnedJoint::Normal, closed_word, "open".to_owned())
        }
        (RowKind::Normal, false) => {
            scheme.open = false;
            (TurnedJoint::Normal, "open".to_owned(), closed_word)
        }
        (couple, released) => {
            let from = scheme.tangential.word(Polygon::PLANE);
            scheme.tangential = match (couple, released) {
                (RowKind::PLUS, true) => Tangential::PLUS,
                (RowKind::Facet(_), true) => Tangential::MINUS,
                _ => Tangential::Stick,
            };
            (TurnedJoint::Tangential, from, scheme.tangential.word(Polygon::PLANE))
        }
    };
    Some(Turned { pair: system.pairs[meaning.pair].id.clone(), joint, from, to })
}

struct Sentence<'a> {
    contact: &'a ContactLcp,
    system: &'a ContactSystem,
    before: f64,
    after: f64,
    ended: bool,
}

impl Sentence<'_> {
    fn tell(&self, pivot: &Pivot, turned: Option<&Turned>, schemes: &Schemes) -> String {
        let Some(turned) = turned else {
            let others: Vec<String> = pivot
                .ties
                .iter()
                .filter(|&&tie| tie != pivot.leaving)
                .map(|&tie| self.contact.name(tie, self.system))
                .collect();
            let tied = if others.is_empty() { String::new() } else { format!(" (tied with {})", list(&others)) };
            return format!(
                "p enters at {}, the least {}; {}{tied}",
                short(self.after),
                if self.contact.swapped.contains(&true) {
                    "under which every pair obeys its law before any joint is turned"
                } else {
                    "that keeps every pair closed and sticking"
                },
                self.limit(pivot.leaving, schemes)
            );
        };
        let open = match pivot.entering {
            Variable::W(row) | Variable::Z(row) => schemes.pairs[self.contact.rows[row].pair].open,
            Variable::P => false,
        };
        let pair = &turned.pair;
        let in_space = self.slip_in_space(pivot.entering, turned, (open, schemes));
        let change = match (turned.joint, turned.to.as_str(), open) {
            _ if in_space.is_some() => in_space.unwrap_or_default(),
            (TurnedJoint::Normal, "open", _) => format!("pair {pair} opens"),
            (TurnedJoint::Normal, _, _) => format!("pair {pair} closes"),
            (TurnedJoint::Tangential, "stick", false) => format!("pair {pair} sticks"),
            (TurnedJoint::Tangential, "stick", true) => format!("open pair {pair} stops sliding"),
            (TurnedJoint::Tangential, "slip+", false) => format!("pair {pair} slips +"),
            (TurnedJoint::Tangential, "slip+", true) => format!("open pair {pair} slides +"),
            (TurnedJoint::Tangential, _, false) => format!("pair {pair} slips -"),
            (TurnedJoint::Tangential, _, true) => format!("open pair {pair} slides -"),
        };
        if self.ended {
            return format!("{change}; p falls from {} to 0: the answer is reached", short(self.before));
        }
        let course = course(pivot.degenerate, self.before, self.after);
        format!("{change}; {course}, where {}", self.limit(pivot.leaving, schemes))
    }

    /// What an entering slip or reserve of a pair in space does.
    fn slip_in_space(&self, entering: Variable, turned: &Turned, (open, schemes): (bool, &Schemes)) -> Option<String> {
        let (row, quantity) = self.contact.quantity(entering)?;
        let meaning = self.contact.rows[row];
        let facet = meaning.couple.facet().filter(|_| self.system.pairs[meaning.pair].is_in_space())?;
        let pair = if open { format!("open pair {}", turned.pair) } else { format!("pair {}", turned.pair) };
        let facets = &schemes.facets[meaning.pair];
        Some(match (quantity, facets.as_slice()) {
            (Quantity::Displacement, [_]) if open => format!("{pair} slides towards {}", self.direction(facet)),
            (Quantity::Displacement, [_]) => format!("{pair} slips towards {}", self.direction(facet)),
            (Quantity::Displacement, _) => format!("{pair} turns towards {}", self.direction(facet)),
            (Quantity::Force, []) if open => format!("{pair} stops sliding"),
            (Quantity::Force, []) => format!("{pair} sticks"),
            (Quantity::Force, [.., last]) => format!("{pair} slips on towards {}", self.direction(*last)),
        })
    }

    /// `45° from t1`: the direction of a facet.
    fn direction(&self, facet: usize) -> String {
        format!("{} from t1", degrees(angle(self.contact.polygon.direction(facet))))
    }

    /// What happens to the leaving variable.
    fn limit(&self, leaving: Variable, schemes: &Schemes) -> String {
        let Some((row, quantity)) = self.contact.quantity(leaving) else {
            return "nothing more is needed".to_owned();
        };
        let force = quantity == Quantity::Force;
        let meaning = self.contact.rows[row];
        let pair = &self.system.pairs[meaning.pair].id;
        let open = schemes.pairs[meaning.pair].open;
        if let (Some(facet), true) = (meaning.couple.facet(), self.system.pairs[meaning.pair].is_in_space()) {
            let left = schemes.facets[meaning.pair].iter().find(|own| **own != facet);
            return match (force, left) {
                (true, _) => format!("pair {pair} uses up its reserve towards {}", self.direction(facet)),
                (false, Some(left)) => format!("the slip of pair {pair} has turned to {}", self.direction(*left)),
                (false, None) if open => format!("the slip of open pair {pair} comes back to zero"),
                (false, None) => format!("pair {pair} has slipped back to zero"),
            };
        }
        match (meaning.couple, force) {
            (RowKind::Normal, true) => format!("pair {pair} loses its contact force"),
            (RowKind::Normal, false) => format!("pair {pair} comes back into contact"),
            (RowKind::PLUS, true) => format!("pair {pair} uses up its reserve x+"),
            (RowKind::Facet(_), true) => format!("pair {pair} uses up its reserve x-"),
            (_, false) if open => format!("the slip of open pair {pair} comes back to zero"),
            (_, false) => format!("pair {pair} has slipped back to zero"),
        }
    }
}

/// What happens to p at a pivot.
fn course(degenerate: bool, before: f64, after: f64) -> String {
    let [mut from, mut to] = [before, after].map(short);
    if degenerate {
        return format!("nothing moves: a degenerate pivot at p = {to}");
    }
    if (after - before).abs() <= 1e-12 * before.abs() {
        return format!("p stays at {to}");
    }
    if from == to {
        (from, to) = told_apart(before, after);
    }
    let way = if after < before { "falls" } else { "rises" };
    format!("p {way} from {from} to {to}")
}

/// The records of a bare LCP; `names` are the names of its rows.
pub fn plain_records(pivots: &[Pivot], names: &[String]) -> Vec<PivotRecord> {
    let name = |variable: Variable| plain_name(variable, names);
    pivots
        .iter()
        .map(|pivot| {
            let (entering, leaving) = (name(pivot.entering), name(pivot.leaving));
            let sentence = if pivot.step == 0 {
                format!("p enters at {}; {leaving} is the row that needs it", short(pivot.p_after))
            } else if pivot.leaving == Variable::P {
                format!("{entering} enters; p falls from {} to 0", short(pivot.p_before))
            } else {
                let zero = if pivot.degenerate { "is zero already" } else { "reaches zero" };
                let course = course(pivot.degenerate, pivot.p_before, pivot.p_after);
                format!("{entering} enters; {course}, where {leaving} {zero}")
            };
            PivotRecord {
                step: pivot.step,
                entering,
                leaving,
                p: pivot.p_after,
                ties: pivot.ties.iter().map(|&tie| name(tie)).collect(),
                turned: None,
                sentence,
            }
        })
        .collect()
}

/// Name of a variable of a bare LCP: `w[1]`, `z[rod]`, `p`.
pub fn plain_name(variable: Variable, names: &[String]) -> String {
    match variable {
        Variable::P => "p".to_owned(),
        Variable::W(row) => format!("w[{}]", names[row]),
        Variable::Z(row) => format!("z[{}]", names[row]),
    }
}

#[cfg(test)]
mod tests {
    use super::course;

    #[test]
    fn a_change_of_p_shows_digits_that_differ() {
        assert_eq!(course(false, 50.0, 25.0), "p falls from 50.0 to 25.0");
        assert_eq!(course(false, 25.0802, 25.0754), "p falls from 25.0802 to 25.0754");
        assert_eq!(course(false, 1.000_000_01, 1.000_000_02), "p rises from 1.00000001 to 1.00000002");
        assert_eq!(course(false, 3.0, 3.0), "p stays at 3.0");
        assert_eq!(course(true, 3.0, 3.0), "nothing moves: a degenerate pivot at p = 3.0");
    }
}
