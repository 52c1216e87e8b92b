//! Help on what belongs to no single command, each topic on one screen.

use crate::view::style::Style;

/// A topic of `help`.
pub struct Topic {
    /// Its word.
    pub name: &'static str,
    /// A line about it.
    pub about: &'static str,
    /// Labels and the texts that hang after them.
    lines: &'static [(&'static str, &'static str)],
}

/// All of them.
pub const TOPICS: &[Topic] = &[
    Topic { name: "method", about: "The theory on one screen", lines: METHOD },
    Topic { name: "signs", about: "What is positive, from gaps to moments", lines: SIGNS },
];

/// The topic of a word.
pub fn find(word: &str) -> Option<&'static Topic> {
    TOPICS.iter().find(|topic| topic.name == word)
}

impl Topic {
    /// The topic at the width of `style`.
    pub fn text(&self, style: &Style) -> String {
        hanging(self.lines.iter().copied(), style)
    }
}

/// Labels with texts that hang after them.
pub fn hanging<'l>(lines: impl Iterator<Item = (&'l str, &'l str)>, style: &Style) -> String {
    let lines = lines.flat_map(|(label, text)| style.hanging(label, text));
    lines.map(|line| line.trim_end().to_owned() + "\n").collect()
}

const METHOD: &[(&str, &str)] = &[
    (
        "pairs   ",
        "Two nodes that may touch, or a node and the ground. A pair is pressed (x_n > 0) or open by z_n > 0; within its bound r = f x_n + c it sticks, at it it slips by z_τ.",
    ),
    (
        "joints  ",
        "The structure is condensed to the joints of its pairs, x = R z + RF: R from one factorization, the loads RF linear in the load cases.",
    ),
    (
        "LCP     ",
        "With the reserves x⁺ = r + x_τ, x⁻ = r − x_τ and z_τ = z⁺ − z⁻ this reads w = M z + q, w ≥ 0, z ≥ 0, and of each couple one is 0.",
    ),
    (
        "scheme  ",
        "The working scheme says which joints hold. If nothing is violated with all of them on, that is the answer: `trivial`.",
    ),
    (
        "Lemke   ",
        "Otherwise a tightening p that makes every pair stick is added and let down. At each pivot one joint is at the end of what it can do: it is released, or takes hold again; `pivots` tells each.",
    ),
    (
        "the end ",
        "p = 0: the answer, `normal`. Or nothing stops the motion at a p > 0: a ray, which is a collapse, or a run that failed: `help ray`.",
    ),
    ("check   ", "Each answer is checked afresh from R, RF, the laws and K; `check exact` proves it in rationals."),
    ("several ", "With friction there may be several answers: `enumerate`, `critical`."),
    (
        "paths   ",
        "Loads and friction are followed exactly from one change of the scheme to the next: `trace`, `limit`, `find`; `stages` remembers slips.",
    ),
];

const SIGNS: &[(&str, &str)] = &[
    ("n, t        ", "n points from `against` to `node`; t is n turned clockwise: n = (0, 1) gives t = (1, 0)"),
    ("x_n         ", "> 0: pressed together"),
    ("z_n         ", "> 0: open"),
    ("x_τ         ", "on the side of `node`, > 0 along +t; it resists: at slip+ it is −(f x_n + c)"),
    ("z_τ         ", "of the side of `node`, > 0 along +t: slip+; < 0: slip-"),
    ("x⁺, x⁻      ", "reserves f x_n + c + x_τ and f x_n + c − x_τ; x⁺ = 0 at slip+, x⁻ = 0 at slip-"),
    ("gap         ", "> 0: open before any load; < 0: an interference"),
    ("p           ", "≥ 0, falls to 0; while p > 0 the forces contain the tightening"),
    ("resultant e ", "> 0 towards later nodes of the edge"),
    ("N           ", "> 0: tension"),
    ("M           ", "> 0: tension on the −y side; local y is the bar's axis turned by +90°"),
    ("Q           ", "dM/dx"),
    ("moments     ", "and rotations: counter-clockwise"),
    ("reactions   ", "of the support on the structure; those of the ground stand under pairs"),
    ("stresses    ", "> 0: tension"),
    ("in space    ", "t1: global x on the plane of contact; t2 = n × t1; M_y > 0: tension on −z"),
];

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_topic_fits_on_a_screen() {
        for topic in TOPICS {
            let text = topic.text(&Style::default());
            assert!(text.lines().count() <= 22, "{}: {}", topic.name, text.lines().count());
            assert!(text.lines().all(|line| line.chars().count() <= 80), "{}", topic.name);
        }
    }
}
