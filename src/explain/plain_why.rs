//! Why a variable of a bare LCP has its value: the terms of its row, and what its complement does.

use serde::Serialize;

use crate::answer::record::{PivotRecord, PlainSolution};
use crate::lcp::mirrored::MirroredLcp;
use crate::text::words::short;

/// Terms of a row that are written out; the smaller ones are counted.
const WRITTEN: usize = 8;

/// One variable at one vertex.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct PlainWhy {
    /// `z[1]`.
    pub variable: String,
    /// Its value.
    pub value: f64,
    /// Its complement.
    pub complement: String,
    /// The value of the complement.
    pub complement_value: f64,
    /// What holds it there, in a sentence.
    pub cause: String,
    /// The row of the couple with its numbers: w = q + M z + d p.
    pub row: String,
    /// The pivots at which it or its complement entered or left.
    pub pivots: Vec<PivotRecord>,
}

/// A vertex of a bare LCP and its run so far.
pub struct Vertex<'a> {
    /// M, q, d.
    pub lcp: &'a MirroredLcp,
    /// Names of the rows.
    pub names: &'a [String],
    /// z and w there.
    pub solution: &'a PlainSolution,
    /// p there.
    pub p: f64,
    /// The pivots that led to it.
    pub pivots: &'a [PivotRecord],
}

impl Vertex<'_> {
    /// The letter and row of `z[NAME]` or `w[NAME]`; `None` where there is no such row.
    pub fn find(&self, variable: &str) -> Option<(char, usize)> {
        let name = |letter: char| variable.strip_prefix(letter)?.strip_prefix('[')?.strip_suffix(']');
        ['z', 'w'].into_iter().find_map(|letter| {
            let row = self.names.iter().position(|known| Some(known.as_str()) == name(letter))?;
            Some((letter, row))
        })
    }

    /// The variable explained.
    pub fn why(&self, letter: char, row: usize) -> PlainWhy {
        let name = &self.names[row];
        let (z, w) = (self.solution.z[row], self.solution.w[row]);
        let (own, other) = if letter == 'z' { (z, w) } else { (w, z) };
        let [variable, complement] =
            if letter == 'z' { ['z', 'w'] } else { ['w', 'z'] }.map(|l| format!("{l}[{name}]"));
        let at = short(own);
        let cause = match (own > 0.0, other > 0.0, letter) {
            (true, false, 'z') => {
                format!("it holds {complement} at zero; with {variable} = 0 the row would not be met")
            }
            (true, false, _) => format!("the row is more than met, so {complement} = 0"),
            (false, true, 'z') => format!("{complement} = {} > 0: the row is met without it", short(other)),
            (false, true, _) => format!("{complement} = {} > 0 holds it at zero", short(other)),
            (false, false, _) => format!("it and {complement} are both zero: a degenerate couple"),
            // In the couple that waits to enter while p > 0, both are zero; in no couple are both positive.
            (true, true, _) => format!("{complement} = {} too: the couple is not complementary", short(other)),
        };
        let cause = format!("{variable} = {at}: {cause}");
        let names = [&variable, &complement];
        let turned = |pivot: &&PivotRecord| names.iter().any(|name| [&pivot.entering, &pivot.leaving].contains(name));
        PlainWhy {
            value: own,
            complement_value: other,
            cause,
            row: self.row(row),
            pivots: self.pivots.iter().filter(turned).cloned().collect(),
            variable,
            complement,
        }
    }

    /// `w[1] = -5 - 1.5·27 (z[1]) + 2·22.75 (z[2]) = 0`.
    fn row(&self, row: usize) -> String {
        let z = &self.solution.z;
        let mut terms: Vec<(f64, f64, String)> = (0..z.len())
            .filter(|&j| self.lcp.base[(row, j)] != 0.0 && z[j] != 0.0)
            .map(|j| (self.lcp.base[(row, j)], z[j], format!("z[{}]", self.names[j])))
            .collect();
        if self.p != 0.0 {
            terms.push((self.lcp.covering[row], self.p, "p".to_owned()));
        }
        let mut sizes: Vec<f64> = terms.iter().map(|(a, b, _)| (a * b).abs()).collect();
        sizes.sort_by(|a, b| b.total_cmp(a));
        let least = sizes.get(WRITTEN - 1).copied().unwrap_or(0.0);
        let mut text = format!("w[{}] = {}", self.names[row], short(self.lcp.q[row]));
        let mut written = 0;
        for (a, b, name) in terms.iter().filter(|(a, b, _)| (a * b).abs() >= least).take(WRITTEN) {
            let sign = if *a < 0.0 { '-' } else { '+' };
            text += &format!(" {sign} {}·{} ({name})", short(a.abs()), short(*b));
            written += 1;
        }
        if written < terms.len() {
            text += &format!(" + {} smaller terms", terms.len() - written);
        }
        text + &format!(" = {}", short(self.solution.w[row]))
    }
}
