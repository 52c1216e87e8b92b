//! Five steps with linear complementarity problems that fail, and what each is known for.

use super::Step;
use crate::tui::pane::{Pane, Plot};

pub const STEPS: &[Step] = &[
    Step {
        text: "A bare LCP: w = M z + q with w, z >= 0 and w z = 0. This one is the contact of a rod that slides on a rough \
               line (Painleve, 1895). M = -0.05: pressing it lowers w further, and with q = -1 no z helps. The run ends \
               in a ray; that there is no answer is proved by trying both bases.",
        commands: "load painleve; set q -1",
        pane: Pane::Answer,
        plot: Plot::P,
    },
    Step {
        text: "q = 1: now z = 0 is an answer, found without a pivot, and z = 20 is another one. Lemke's algorithm finds \
               one of them, not all: `:enumerate` goes through all bases in exact arithmetic. No answer or two: that is \
               what a negative M does.",
        commands: "set q 1",
        pane: Pane::Answer,
        plot: Plot::P,
    },
    Step {
        text: "Here every ratio test is tied. Always taking the first tied row, variables come and go at zero while p \
               stays at 1, until a basis returns after pivot 7: the run goes in a circle and is stopped. The column \
               `ties` under Pivots shows it, `:ties` in full.",
        commands: "load cycling; set tie-break first-row",
        pane: Pane::Pivots,
        plot: Plot::P,
    },
    Step {
        text: "The same problem under the lexicographic rule, the default: ties are broken as if q were moved a little, \
               so that no basis can return. Four pivots, z = 1/3 each. `:compare` shows in one table what every \
               tie-break and engine makes of a problem.",
        commands: "load cycling",
        pane: Pane::Pivots,
        plot: Plot::P,
    },
    Step {
        text: "Nothing fails here, it only takes long: 64 = 2^6 pivots for six unknowns, p falls by 2 at each, and the \
               bases count in binary (Murty, 1978). Contact problems are not like that: they take about as many pivots \
               as pairs change. For a ray of your own: `:help ray`.",
        commands: "load murty6",
        pane: Pane::Plot,
        plot: Plot::P,
    },
];
