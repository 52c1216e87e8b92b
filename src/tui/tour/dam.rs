//! Five steps to the foot of a dam: where it presses, where it opens, when it slides.

use super::Step;
use crate::tui::pane::{Pane, Plot};

pub const STEPS: &[Step] = &[
    Step {
        text: "A slice of a concrete dam, 30 m high, on rock. The reservoir is empty, z = 0: only its weight acts, 10080 \
               kN, 3.81 m upstream of the middle of the base. All seven pairs stick; the rock is pressed most near the \
               heel, at the left.",
        commands: "load dam; set z 0",
        pane: Pane::Structure,
        plot: Plot::Pressure,
    },
    Step {
        text: "z = 28 m: the water pushes with 3846 kN and presses upwards under the base, where drains leave 0.6 of the \
               pressure at the heel. The resultant moves to 0.67 m downstream of the middle, within the kern (B/6 = \
               4 m): the whole base stays pressed. At the heel, where it is pressed least, a pair slips.",
        commands: "reset",
        pane: Pane::Plot,
        plot: Plot::Pressure,
    },
    Step {
        text: "z = 30 m and the drains are blocked, drain = 1. Uplift takes 3532 kN of the weight, 6548 kN are left, and \
               the resultant stands 3.03 m downstream of the middle: by the books, which take the dam as rigid, the base \
               is still pressed everywhere. It is elastic, and its heel, rock[0], is open.",
        commands: "reset; set drain 1; set z 30",
        pane: Pane::Plot,
        plot: Plot::Gap,
    },
    Step {
        text: "z = 28 m with drains again. How far is it from sliding? `:limit water` says 1.58 times this push: f N/T, \
               friction against thrust. `:summary` shows resultants and the safety of every load on one screen.",
        commands: "reset; set z 28",
        pane: Pane::Plot,
        plot: Plot::Force,
    },
    Step {
        text: "f = 0.45: f N = 3646 kN is less than the push of 3846 kN. No answer: the run ends in a ray, certified, \
               and its direction is the dam sliding off as a whole. `:ray` tells what would stop it. Now vary z, drain \
               and f yourself: + and - in Parameters.",
        commands: "reset; set f 0.45",
        pane: Pane::Structure,
        plot: Plot::Ray,
    },
];
