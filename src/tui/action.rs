//! What can happen to the screen, and what it asks for in return.

use std::path::PathBuf;
use std::sync::Arc;

use crate::model::quantity::Quantity;
use crate::session::{AllAnswers, Gauge, Next};

use super::entry::Edit;
use super::pane::Pane;
use super::shown::Shown;

/// What a key can be bound to.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Do {
    /// Back to where the full screen was started from.
    Leave,
    /// End the program.
    Exit,
    /// Go to the command line.
    ToRepl,
    /// Show the keys.
    Help,
    /// Open the command line.
    Command,
    /// Focus the next pane.
    NextPane,
    /// Focus the pane before.
    PreviousPane,
    /// Focus this pane.
    Focus(Pane),
    /// Give the focused pane the whole screen, or take it away.
    Maximize,
    /// Up in the focused pane.
    Up,
    /// Down in the focused pane.
    Down,
    /// A page up.
    PageUp,
    /// A page down.
    PageDown,
    /// One pivot on.
    StepOn,
    /// One pivot back.
    StepBack,
    /// The first pivot.
    StepFirst,
    /// The end of the run.
    StepLast,
    /// Run through the pivots, or stop.
    Play,
    /// Change the selected parameter by tenths of its step.
    Vary(i8),
    /// Type a value.
    TypeValue,
    /// The selected parameter back to the file's value.
    Reset,
    /// Take back.
    Undo,
    /// Do again.
    Redo,
    /// The next plot.
    NextPlot,
    /// The plot before.
    PreviousPlot,
    /// All answers side by side.
    Answers,
    /// Why the selected pair is in its state.
    Why,
    /// What was tied at the pivot shown.
    Ties,
    /// Open the line of a search.
    Search,
    /// The next row that was sought.
    FindNext,
    /// The one before.
    FindPrevious,
    /// Copy what is under the cursor.
    CopyValue,
    /// Copy the command that leads there or shows it.
    CopyCommand,
    /// Type a `show`.
    Ask,
    /// Ask no longer for the selected quantity.
    Forget,
    /// The cursor of the map this many cells to the right.
    Across(i8),
    /// Set the parameters of the map to the place of its cursor.
    SetHere,
    /// The cursor of the map into the next region.
    NextRegion,
    /// The cursor of the map back to the present values.
    CursorHome,
    /// Show what was last printed again.
    Output,
    /// Let the ray's mode move.
    Mode,
    /// Show or hide the answer before.
    Before,
    /// Show or hide the line that explains each pane.
    Explain,
    /// Stop what is computed or shown.
    Stop,
    /// Draw everything anew.
    Redraw,
    /// Stop the program until `fg`.
    Suspend,
    /// Take the mouse or leave it to the terminal.
    Mouse,
    /// Look at the structure otherwise.
    Look(LookChange),
    /// Sort the pairs by the next key.
    Sort,
    /// Turn the order round.
    SortReverse,
    /// The next step of the tour.
    TourNext,
    /// The step before.
    TourBack,
    /// End the tour.
    TourEnd,
    /// Close what lies over the panes.
    Close,
    /// Top of what lies over the panes.
    Top,
    /// Its end.
    Bottom,
    /// Take the line.
    Accept,
    /// Drop the line.
    Cancel,
    /// Complete the word.
    Complete,
    /// The line before in the history.
    HistoryBack,
    /// The line after.
    HistoryOn,
    /// Change the line.
    Edit(Edit),
}

/// How the structure is looked at.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum LookChange {
    /// Enlarge it.
    ZoomIn,
    /// Shrink it.
    ZoomOut,
    /// The whole structure.
    Fit,
    /// Move the picture: right, up.
    Pan(i8, i8),
    /// Displacements larger.
    DeformMore,
    /// Displacements smaller.
    DeformLess,
    /// Displacements at the automatic scale.
    DeformAuto,
    /// Show or hide the loads.
    Loads,
    /// The viewer walks round a structure in space: degrees to the right, up.
    Turn(i8, i8),
    /// The next of the named views.
    NextView,
}

/// What the mouse did, at a character of the screen.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Mouse {
    /// The left button went down.
    Press(u16, u16),
    /// It moved while held.
    Drag(u16, u16),
    /// The wheel turned up.
    WheelUp(u16, u16),
    /// The wheel turned down.
    WheelDown(u16, u16),
}

/// Work for the thread of the session.
#[derive(Clone, Debug, PartialEq)]
pub enum Job {
    /// A slider moved.
    Set {
        /// The parameter.
        name: String,
        /// Its new value.
        value: f64,
    },
    /// A slider moves by these tenths of its step from wherever a command that was typed before has put it.
    Vary {
        /// The parameter.
        name: String,
        /// Key by key.
        tenths: Vec<i8>,
    },
    /// Show this pivot.
    Step(usize),
    /// A command line.
    Line {
        /// As typed.
        text: String,
        /// Whether its output is shown.
        shows: bool,
    },
    /// All answers.
    Answers,
    /// The pivots of an answer that was found by a warm start.
    Pivots,
    /// Show the answer under this loading.
    Show(Loading),
    /// What moves at the place shown: its states are drawn first.
    Motion,
    /// Probes, and these quantities, in the state shown.
    Quantities(Vec<Quantity>),
    /// What would stop the collapse shown.
    Remedies,
    /// The answer at a place of the map, beside the session.
    Glance {
        /// Names of the axes with the values there.
        settings: [(String, f64); 2],
    },
}

impl Job {
    /// Whether nobody asked for it: it gives way to whatever is asked for.
    pub fn is_background(&self) -> bool {
        matches!(self, Job::Pivots | Job::Motion | Job::Quantities(_) | Job::Remedies)
    }
}

/// Under which loads an answer is shown.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Loading {
    /// The factors of the scenario.
    Own,
    /// A combination.
    Combination(String),
    /// The end of a stage of the history, from 0.
    Stage(usize),
}

/// How a job ended.
#[derive(Clone)]
pub struct Done {
    /// The job.
    pub job: Job,
    /// The session after it.
    pub shown: Arc<Shown>,
    /// What it printed, with colour codes.
    pub output: String,
    /// Why it failed.
    pub error: Option<String>,
    /// Whether it was stopped.
    pub interrupted: bool,
    /// What follows.
    pub next: Next,
    /// All answers, if they were asked for.
    pub answers: Option<AllAnswers>,
    /// Values of the probes and quantities, if they were asked for.
    pub gauges: Option<Vec<Gauge>>,
    /// Quantities that a line asked for, to be shown from now on.
    pub asked: Vec<Quantity>,
}

impl std::fmt::Debug for Done {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Done")
            .field("job", &self.job)
            .field("error", &self.error)
            .field("next", &self.next)
            .finish_non_exhaustive()
    }
}

/// What happens to the screen.
#[derive(Clone, Debug)]
pub enum Action {
    /// A bound key.
    Do(Do),
    /// A character for the open line.
    Type(char),
    /// A pasted text.
    Paste(String),
    /// The mouse.
    Mouse(Mouse),
    /// The terminal has this many columns and rows.
    Resize(u16, u16),
    /// The next picture of a motion.
    Tick,
    /// A job reports how far it is.
    Progress {
        /// What is done.
        what: String,
        /// The part that is ready, 0 … 1.
        fraction: f64,
    },
    /// A job ended.
    Done(Box<Done>),
    /// A watched file was saved.
    Saved,
    /// The editor ended; with an error if it could not be used.
    Edited(Option<String>),
}

/// Where the full screen goes when it ends.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Leave {
    /// The program ends.
    Quit,
    /// The command line.
    Repl,
}

/// What the screen asks for.
#[derive(Clone, Debug, PartialEq)]
pub enum Effect {
    /// Work; only one at a time.
    Run(Job),
    /// The running job is to stop.
    Stop,
    /// The end.
    Leave(Leave),
    /// Stop the program until `fg`.
    Suspend,
    /// Let the user edit this file.
    Edit(PathBuf),
    /// Draw everything anew.
    Redraw,
    /// To the clipboard of the terminal.
    Copy(String),
    /// Take or leave the mouse.
    Mouse(bool),
}
