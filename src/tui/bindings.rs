//! The keys: one table. What a key does, the help, the line of hints and the names in the configuration file all
//! come from [`BINDINGS`].

use super::action::Do;
use super::action::LookChange::{DeformAuto, DeformLess, DeformMore, Fit, Loads, NextView, Pan, Turn, ZoomIn, ZoomOut};
use super::entry::Edit;
use super::pane::Pane;

/// Where a key is looked for.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Context {
    /// In every pane, unless the pane has the key for itself.
    Everywhere,
    /// In a pane.
    Pane(Pane),
    /// During the tour, ahead of the panes.
    Tour,
    /// While something lies over the panes.
    Overlay,
    /// While a line is typed.
    Entry,
}

impl Context {
    /// In the order of the help.
    pub const ALL: [Context; 13] = [
        Context::Everywhere,
        Context::Pane(Pane::Structure),
        Context::Pane(Pane::Parameters),
        Context::Pane(Pane::Pairs),
        Context::Pane(Pane::Pivots),
        Context::Pane(Pane::Plot),
        Context::Pane(Pane::Answer),
        Context::Pane(Pane::Quantities),
        Context::Pane(Pane::Loading),
        Context::Pane(Pane::Map),
        Context::Tour,
        Context::Overlay,
        Context::Entry,
    ];

    /// Its heading in the help.
    pub fn title(self) -> &'static str {
        match self {
            Context::Everywhere => "Everywhere",
            Context::Pane(pane) => pane.title(),
            Context::Tour => "Tour",
            Context::Overlay => "Over the panes: keys, output, answers",
            Context::Entry => "Typing a command, a value, a search",
        }
    }
}

/// One row of the table.
#[derive(Clone, Copy, Debug)]
pub struct Binding {
    /// Where it holds.
    pub context: Context,
    /// Its name in the configuration file.
    pub name: &'static str,
    /// Its keys, as in the configuration file.
    pub keys: &'static [&'static str],
    /// What it does.
    pub action: Do,
    /// The same in words.
    pub help: &'static str,
    /// A word for the line of hints; rows that follow each other with the same word share it. Empty: not there.
    pub hint: &'static str,
}

const fn row(
    context: Context,
    name: &'static str,
    keys: &'static [&'static str],
    action: Do,
    help: &'static str,
    hint: &'static str,
) -> Binding {
    Binding { context, name, keys, action, help, hint }
}

use Context::{Entry, Everywhere, Overlay as Over, Tour};
const STRUCTURE: Context = Context::Pane(Pane::Structure);
const PARAMETERS: Context = Context::Pane(Pane::Parameters);
const PAIRS: Context = Context::Pane(Pane::Pairs);
const PIVOTS: Context = Context::Pane(Pane::Pivots);
const QUANTITIES: Context = Context::Pane(Pane::Quantities);
const MAP: Context = Context::Pane(Pane::Map);

/// All keys.
#[rustfmt::skip]
pub const BINDINGS: &[Binding] = &[
    row(Everywhere, "help", &["?", "f1"], Do::Help, "show the keys", "help"),
    row(Everywhere, "leave", &["q"], Do::Leave, "leave: back to where it was started, shell or command line", "quit"),
    row(Everywhere, "next-pane", &["tab"], Do::NextPane, "next pane", "pane"),
    row(Everywhere, "step-back", &["left"], Do::StepBack, "one pivot back: every pane shows it", "step"),
    row(Everywhere, "step-on", &["right"], Do::StepOn, "one pivot on", "step"),
    row(Everywhere, "up", &["up"], Do::Up, "select the row above; in Pivots one pivot back, in Plots the plot before, in Loading the loading before", "select"),
    row(Everywhere, "down", &["down"], Do::Down, "select the row below", "select"),
    row(Everywhere, "more", &["+", "="], Do::Vary(10), "selected parameter one step up, solved at once", "vary"),
    row(Everywhere, "less", &["-", "_"], Do::Vary(-10), "one step down", "vary"),
    row(Everywhere, "command", &[":"], Do::Command, "type any command of the REPL; Tab completes", "command"),
    row(Everywhere, "search", &["/"], Do::Search, "go to a row that contains a text", "search"),
    row(Everywhere, "maximize", &["z"], Do::Maximize, "give the pane the whole screen, or take it back", "large"),
    row(Everywhere, "find-next", &["n"], Do::FindNext, "the next row that contains it", ""),
    row(Everywhere, "find-previous", &["N"], Do::FindPrevious, "the one before", ""),
    row(Everywhere, "copy-value", &["y"], Do::CopyValue, "copy what is under the cursor (OSC 52: over SSH, too)", ""),
    row(Everywhere, "copy-command", &["Y"], Do::CopyCommand, "copy the command that sets or shows it", ""),
    row(Everywhere, "output", &["O"], Do::Output, "show again what was last printed", ""),
    row(Everywhere, "exit", &["Q"], Do::Exit, "end the program", ""),
    row(Everywhere, "to-repl", &["R"], Do::ToRepl, "go on at the command line, same session", ""),
    row(Everywhere, "previous-pane", &["shift-tab"], Do::PreviousPane, "pane before", ""),
    row(Everywhere, "structure", &["1"], Do::Focus(Pane::Structure), "go to Structure", ""),
    row(Everywhere, "parameters", &["2"], Do::Focus(Pane::Parameters), "go to Parameters", ""),
    row(Everywhere, "pairs", &["3"], Do::Focus(Pane::Pairs), "go to Pairs", ""),
    row(Everywhere, "pivots", &["4"], Do::Focus(Pane::Pivots), "go to Pivots", ""),
    row(Everywhere, "plots", &["5"], Do::Focus(Pane::Plot), "go to Plots", ""),
    row(Everywhere, "answer", &["6"], Do::Focus(Pane::Answer), "go to Answer", ""),
    row(Everywhere, "quantities", &["7"], Do::Focus(Pane::Quantities), "go to Quantities", ""),
    row(Everywhere, "loading", &["8"], Do::Focus(Pane::Loading), "go to Loading", ""),
    row(Everywhere, "map", &["9"], Do::Focus(Pane::Map), "go to Map", ""),
    row(Everywhere, "page-up", &["pageup"], Do::PageUp, "ten rows up", ""),
    row(Everywhere, "page-down", &["pagedown"], Do::PageDown, "ten rows down", ""),
    row(Everywhere, "step-first", &["home"], Do::StepFirst, "first pivot: the entry of p", ""),
    row(Everywhere, "step-last", &["end"], Do::StepLast, "end of the run: the answer, or the ray", ""),
    row(Everywhere, "play", &["space"], Do::Play, "run through the pivots, or pause", ""),
    row(Everywhere, "coarse-more", &["]"], Do::Vary(100), "ten steps up", ""),
    row(Everywhere, "coarse-less", &["["], Do::Vary(-100), "ten steps down", ""),
    row(Everywhere, "fine-more", &["."], Do::Vary(1), "a tenth of a step up", ""),
    row(Everywhere, "fine-less", &[","], Do::Vary(-1), "a tenth of a step down", ""),
    row(Everywhere, "value", &["v"], Do::TypeValue, "type the value: 120, +10%, += 5", ""),
    row(Everywhere, "reset", &["r"], Do::Reset, "parameter back to the value of the file", ""),
    row(Everywhere, "undo", &["u"], Do::Undo, "take back the last change", ""),
    row(Everywhere, "redo", &["U", "ctrl-y"], Do::Redo, "do it again", ""),
    row(Everywhere, "next-plot", &["p"], Do::NextPlot, "next plot: slip, force, pressure, opening, p, M Q N", ""),
    row(Everywhere, "previous-plot", &["P"], Do::PreviousPlot, "plot before", ""),
    row(Everywhere, "answers", &["a"], Do::Answers, "all answers side by side, up to 10 pairs", ""),
    row(Everywhere, "mode", &["m"], Do::Mode, "let the mode of a ray move, or stop it", ""),
    row(Everywhere, "before", &["b"], Do::Before, "show or hide the answer before the last change", ""),
    row(Everywhere, "explain", &["e"], Do::Explain, "show or hide the line that explains each pane", ""),
    row(Everywhere, "stop", &["esc", "ctrl-c"], Do::Stop, "stop what is computed or played", ""),
    row(Everywhere, "mouse", &["M"], Do::Mouse, "leave the mouse to the terminal (to copy text), or take it", ""),
    row(Everywhere, "redraw", &["ctrl-l"], Do::Redraw, "draw everything anew", ""),
    row(Everywhere, "suspend", &["ctrl-z"], Do::Suspend, "stop the program until `fg`", ""),

    row(STRUCTURE, "zoom-in", &["i"], Do::Look(ZoomIn), "enlarge", "zoom"),
    row(STRUCTURE, "zoom-out", &["o"], Do::Look(ZoomOut), "shrink", "zoom"),
    row(STRUCTURE, "fit", &["f"], Do::Look(Fit), "show all of it", ""),
    row(STRUCTURE, "pan-left", &["h"], Do::Look(Pan(-1, 0)), "look further left", ""),
    row(STRUCTURE, "pan-right", &["l"], Do::Look(Pan(1, 0)), "look further right", ""),
    row(STRUCTURE, "pan-up", &["k"], Do::Look(Pan(0, 1)), "look further up", ""),
    row(STRUCTURE, "pan-down", &["j"], Do::Look(Pan(0, -1)), "look further down", ""),
    row(STRUCTURE, "deform-more", &["d"], Do::Look(DeformMore), "displacements larger", "scale"),
    row(STRUCTURE, "deform-less", &["D"], Do::Look(DeformLess), "displacements smaller", "scale"),
    row(STRUCTURE, "deform-auto", &["A"], Do::Look(DeformAuto), "displacements at the automatic scale", ""),
    row(STRUCTURE, "loads", &["L"], Do::Look(Loads), "show or hide the loads", "loads"),
    row(STRUCTURE, "turn-right", &["t"], Do::Look(Turn(15, 0)), "in space: turn it, the viewer walks to the right", ""),
    row(STRUCTURE, "turn-left", &["T"], Do::Look(Turn(-15, 0)), "the viewer walks to the left", ""),
    row(STRUCTURE, "turn-up", &["w"], Do::Look(Turn(0, 15)), "the viewer rises", ""),
    row(STRUCTURE, "turn-down", &["W"], Do::Look(Turn(0, -15)), "the viewer sinks", ""),
    row(STRUCTURE, "next-view", &["V"], Do::Look(NextView), "the next view: ISO, XY, XZ, YZ", ""),

    row(STRUCTURE, "why-here", &["enter"], Do::Why, "why the selected pair is in its state", "why"),

    row(PARAMETERS, "type-value", &["enter"], Do::TypeValue, "type the value", "type"),

    row(PAIRS, "why", &["enter"], Do::Why, "why the pair is in its state", "why"),
    row(PAIRS, "sort", &["s"], Do::Sort, "sort by the next key", "sort"),
    row(PAIRS, "sort-reverse", &["S"], Do::SortReverse, "turn the order round", ""),

    row(PIVOTS, "ties", &["enter"], Do::Ties, "what was tied at the pivot, and what decided", "ties"),

    row(QUANTITIES, "ask", &["enter"], Do::Ask, "ask for one more quantity: `show …`", "ask"),
    row(QUANTITIES, "forget", &["x", "delete"], Do::Forget, "ask no longer for the selected one", "forget"),

    row(MAP, "map-left", &["left", "h"], Do::Across(-1), "cursor to the left: every pane shows the answer there", "move"),
    row(MAP, "map-right", &["right", "l"], Do::Across(1), "cursor to the right; up and down as everywhere", "move"),
    row(MAP, "map-set", &["enter"], Do::SetHere, "set both parameters to the place of the cursor", "set"),
    row(MAP, "map-region", &["space"], Do::NextRegion, "cursor into the next region", "region"),
    row(MAP, "map-home", &["home"], Do::CursorHome, "cursor back to the present values", ""),

    row(Tour, "tour-next", &["enter"], Do::TourNext, "next step of the tour", ""),
    row(Tour, "tour-back", &["backspace"], Do::TourBack, "step before", ""),
    row(Tour, "tour-end", &["esc"], Do::TourEnd, "end the tour", ""),

    row(Over, "close", &["esc", "enter", "q", "ctrl-c"], Do::Close, "close", "close"),
    row(Over, "over-up", &["up", "k"], Do::Up, "a line up", "scroll"),
    row(Over, "over-down", &["down", "j"], Do::Down, "a line down", "scroll"),
    row(Over, "over-page-up", &["pageup", "b"], Do::PageUp, "a page up", ""),
    row(Over, "over-page-down", &["pagedown", "space"], Do::PageDown, "a page down", ""),
    row(Over, "over-top", &["home", "g"], Do::Top, "the top", ""),
    row(Over, "over-bottom", &["end", "G"], Do::Bottom, "the end", ""),
    row(Over, "over-search", &["/"], Do::Search, "go to a line that contains a text", "search"),
    row(Over, "over-find-next", &["n"], Do::FindNext, "the next line that contains it", ""),
    row(Over, "over-find-previous", &["N"], Do::FindPrevious, "the one before", ""),
    row(Over, "over-copy-value", &["y"], Do::CopyValue, "copy the text", "copy"),
    row(Over, "over-copy-command", &["Y"], Do::CopyCommand, "copy the command", ""),
    row(Over, "over-command", &[":"], Do::Command, "type another command", "command"),
    row(Over, "over-help", &["?", "f1"], Do::Help, "show the keys", ""),
    row(Over, "over-redraw", &["ctrl-l"], Do::Redraw, "draw everything anew", ""),
    row(Over, "over-suspend", &["ctrl-z"], Do::Suspend, "stop the program until `fg`", ""),

    row(Entry, "accept", &["enter"], Do::Accept, "run it, take it", ""),
    row(Entry, "cancel", &["esc", "ctrl-c"], Do::Cancel, "drop it", ""),
    row(Entry, "complete", &["tab"], Do::Complete, "complete the word, then the next way to", ""),
    row(Entry, "history-back", &["up"], Do::HistoryBack, "line typed before", ""),
    row(Entry, "history-on", &["down"], Do::HistoryOn, "line typed after", ""),
    row(Entry, "cursor-left", &["left"], Do::Edit(Edit::Left), "cursor left", ""),
    row(Entry, "cursor-right", &["right"], Do::Edit(Edit::Right), "cursor right", ""),
    row(Entry, "cursor-home", &["home", "ctrl-a"], Do::Edit(Edit::Home), "cursor to the start", ""),
    row(Entry, "cursor-end", &["end", "ctrl-e"], Do::Edit(Edit::End), "cursor to the end", ""),
    row(Entry, "backspace", &["backspace", "ctrl-h"], Do::Edit(Edit::Backspace), "delete before the cursor", ""),
    row(Entry, "delete", &["delete", "ctrl-d"], Do::Edit(Edit::Delete), "delete at the cursor", ""),
    row(Entry, "delete-to-start", &["ctrl-u"], Do::Edit(Edit::DeleteToStart), "delete to the start", ""),
    row(Entry, "delete-word", &["ctrl-w"], Do::Edit(Edit::DeleteWord), "delete the word before the cursor", ""),
    row(Entry, "entry-redraw", &["ctrl-l"], Do::Redraw, "draw everything anew", ""),
    row(Entry, "entry-suspend", &["ctrl-z"], Do::Suspend, "stop the program until `fg`", ""),
];
