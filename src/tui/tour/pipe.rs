//! Six steps along a hot pipe on resting supports: friction decides what its nozzle bears.

use super::Step;
use crate::tui::pane::{Pane, Plot};

pub const STEPS: &[Step] = &[
    Step {
        text: "A pipe leaves a nozzle downwards, turns by an elbow and runs over six supports on which it only rests. \
               Cold, T = 0, it lies on all six by its weight. Nothing slides, and the nozzle feels next to nothing: a \
               moment of -0.10 kNm.",
        commands: "load pipeline; set T 0",
        pane: Pane::Structure,
        plot: Plot::Pressure,
    },
    Step {
        text: "T = 1: hot, by 180 K. The riser grows downwards and lifts the run off c2 and c3; the run grows by 44 mm \
               over the other supports. Without friction, f = 0, the nozzle bears -5.1 kNm: the usual calculation.",
        commands: "reset; set f 0",
        pane: Pane::Plot,
        plot: Plot::Gap,
    },
    Step {
        text: "f = 0.3, steel on steel. The four supports that carry hold the run back with f x_n each, all at their \
               bounds, and the moment at the nozzle has changed its sign: 8.4 kNm. Leaving friction out was not on \
               the safe side.",
        commands: "reset; set f 0.3",
        pane: Pane::Plot,
        plot: Plot::Force,
    },
    Step {
        text: "f = 0.6: the first support sticks, and however much more friction there is, the nozzle bears 20 kNm. Where \
               that begins is found exactly: type `:find f 0..1 where state c1 = stick`; it says 0.4815.",
        commands: "reset; set f 0.6",
        pane: Pane::Pairs,
        plot: Plot::Force,
    },
    Step {
        text: "f = 0.1287: the two effects cancel, the moment is zero. `:find f 0..1 where nozzle_moment = 0` finds the \
               place; nozzle_moment is a probe, a name that the scenario gives to a quantity. `:envelope nozzle_moment \
               over f 0..1` shows its least and largest value.",
        commands: "reset; set f 0.1287187701",
        pane: Pane::Pairs,
        plot: Plot::Force,
    },
    Step {
        text: "A pipe is heated again and again. `:stages` follows cold, hot, cold, hot with memory: after cooling its \
               end stays 2.9 mm out, and c1 hangs free. Now vary f, T, a and h yourself: + and - in Parameters.",
        commands: "reset",
        pane: Pane::Structure,
        plot: Plot::Slip,
    },
];
