//! Six steps through the paper's Example 1, from sticking to the ray.

use super::Step;
use crate::tui::pane::{Pane, Plot};

pub const STEPS: &[Step] = &[
    Step {
        text: "A beam lies on six supports, F = 100 kN on each, and is pulled at its right end. With F2 = 40 kN the \
               pull stays below f F = 50 kN, the bound of one support: every pair sticks, nothing moves, and the main \
               system (every joint on) is the answer without a pivot.",
        commands: "load beam; set F2 40",
        pane: Pane::Structure,
        plot: Plot::Force,
    },
    Step {
        text: "F2 = 100 kN: the last support alone cannot hold it. c6 slips at its bound of 50 kN and c5 takes over \
               the rest. Friction is used up from the pulled end inwards; the slip ends where the pull is consumed.",
        commands: "set f 0.5; set F 100; set F2 100",
        pane: Pane::Plot,
        plot: Plot::Slip,
    },
    Step {
        text: "F2 = 250 kN, seen from the start of the run. Lemke's algorithm first holds everything by an extra \
               tightening p, here 133.3 kN: the least under which all pairs stick. It then lets p down to 0.",
        commands: "set f 0.5; set F 100; set F2 250; step first",
        pane: Pane::Pivots,
        plot: Plot::P,
    },
    Step {
        text: "Each pivot turns one joint on or off. At pivot 2 p has fallen to 22.2 kN: c6 and c5 slip. The left and \
               right arrows move along the pivots and every pane follows; at p = 0 the extra tightening is gone and \
               the working scheme, which joints are on, is that of the answer.",
        commands: "set f 0.5; set F 100; set F2 250; step to 2",
        pane: Pane::Pivots,
        plot: Plot::Slip,
    },
    Step {
        text: "F2 = 300 kN = 6 f F: the limit. Every support carries its bound of 50 kN; c1 has no reserve left but \
               need not slip yet. This is still an answer; any more is too much.",
        commands: "set f 0.5; set F 100; set F2 300",
        pane: Pane::Plot,
        plot: Plot::Force,
    },
    Step {
        text: "F2 = 330 kN: 30 kN more than friction can hold. p cannot fall below 30/(6 x 1.5) = 3.33 kN, the run \
               ends in a ray, and its direction is the collapse: the beam slides off as a whole. m lets it move. Now \
               vary f, F and F2 yourself: + and - in Parameters.",
        commands: "set f 0.5; set F 100; set F2 330",
        pane: Pane::Structure,
        plot: Plot::Ray,
    },
];
