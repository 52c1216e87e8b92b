//! What each command does, one file an idea: its arguments and help, what may be typed next, and the doing. The table
//! lists them; a new command is a file and its name here.

pub(in crate::session) mod along;
pub(in crate::session) mod calibrate;
pub(in crate::session) mod check;
pub(in crate::session) mod combine;
pub(in crate::session) mod compare;
pub(in crate::session) mod critical;
pub(in crate::session) mod cycle;
pub(in crate::session) mod enumerate;
pub(in crate::session) mod envelope;
pub(in crate::session) mod expect;
pub(in crate::session) mod exports;
pub(in crate::session) mod find;
pub(in crate::session) mod help;
pub(in crate::session) mod history;
pub mod import;
pub(in crate::session) mod limit;
pub mod load;
pub(in crate::session) mod map;
pub mod new;
pub(in crate::session) mod parameters;
pub(in crate::session) mod pivots;
pub(in crate::session) mod plot_path;
mod plot_structure;
mod plot_traction;
mod plot_zone;
pub(in crate::session) mod plots;
pub(in crate::session) mod prove;
pub(in crate::session) mod quit;
pub(in crate::session) mod ray;
pub(in crate::session) mod ray_guide;
pub(in crate::session) mod record;
pub mod reload;
pub(in crate::session) mod restore;
pub(in crate::session) mod sample;
pub(in crate::session) mod save;
pub mod screen;
pub mod script;
pub(in crate::session) mod sensitivity;
pub(in crate::session) mod set;
pub(in crate::session) mod show;
pub(in crate::session) mod side;
pub(in crate::session) mod solve;
pub(in crate::session) mod stages;
pub(in crate::session) mod summary;
pub mod sweep;
pub(in crate::session) mod tableau;
pub(in crate::session) mod tables;
pub(in crate::session) mod trace;
pub(in crate::session) mod undo;
pub(in crate::session) mod view;
pub(in crate::session) mod why;

use crate::session::language::command::Command;

/// Every command, by the groups of `help`, in the order shown.
pub static GROUPS: &[(&str, &[Command])] = &[
    (
        "scenario",
        &[
            load::LOAD,
            new::NEW,
            load::SCENARIOS,
            save::SAVE,
            reload::EDIT,
            reload::RELOAD,
            reload::WATCH,
            parameters::PARAMS,
            set::SET,
            set::RESET,
            undo::UNDO,
            undo::REDO,
            parameters::DIFF,
            import::IMPORT,
        ],
    ),
    (
        "answer",
        &[
            solve::SOLVE,
            solve::STATUS,
            tables::PAIRS,
            tables::DISPLACEMENTS,
            tables::MEMBERS,
            tables::REACTIONS,
            show::SHOW,
            summary::SUMMARY,
            combine::COMBINE,
            envelope::ENVELOPE,
            check::CHECK,
            prove::PROVE,
        ],
    ),
    ("pivots", &[pivots::PIVOTS, pivots::STEP, why::WHY, tableau::TIES, tableau::TABLEAU]),
    ("trouble", &[ray::RAY, compare::COMPARE, enumerate::ENUMERATE, critical::CRITICAL]),
    (
        "paths",
        &[
            sweep::SWEEP,
            trace::TRACE,
            limit::LIMIT,
            find::FIND,
            map::MAP,
            sample::SAMPLE,
            sensitivity::SENSITIVITY,
            stages::STAGES,
            cycle::CYCLE,
            calibrate::CALIBRATE,
        ],
    ),
    ("pictures", &[plots::PLOT, view::VIEW, screen::TUI]),
    ("scripts", &[script::SOURCE, record::RECORD, expect::EXPECT, exports::EXPORT, script::ECHO, restore::RESTORE]),
    ("help", &[help::HELP, screen::TOUR, history::HISTORY, quit::QUIT]),
];

/// Every command.
pub fn all() -> impl Iterator<Item = &'static Command> {
    GROUPS.iter().flat_map(|(_, commands)| commands.iter())
}
