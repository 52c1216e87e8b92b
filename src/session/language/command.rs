//! The only grammar of the program: every command of the REPL, of scripts and of the full screen's `:` line.
//!
//! To add a command: a variant here (its doc comment is the help, `after_help` the example), its name in
//! [`GROUPS`](crate::session::language::help::GROUPS), and its arm in `apply`. Completion, hints and help follow from the grammar: the `value_name` of an
//! argument says what may stand there (see [`crate::session::language::complete`]).

// The comments of variants are help texts: `z[NAME]` in them is no link.
#![allow(rustdoc::broken_intra_doc_links)]

use std::path::PathBuf;

use clap::{CommandFactory, FromArgMatches, Parser, Subcommand, ValueEnum};
use thiserror::Error;

use crate::path::grid::Shard;

use super::export::Export;
use crate::session::language::tokens::{self, OpenQuote};

/// One command with its arguments.
#[derive(Clone, Debug, PartialEq, Subcommand)]
pub enum Command {
    /// Load a scenario, from a file or an embedded one by its name, and solve it
    #[command(after_help = "Example:\n  load beam-ray\n  load my/structure.json")]
    Load {
        /// File, or name of an embedded scenario
        #[arg(value_name = "SCENARIO")]
        scenario: String,
    },
    /// Write a scenario to begin with, load it and solve it; without KIND, list the kinds
    ///
    /// The kinds are portal, continuous-beam, pipeline, block, block-stack, wall, arch, dam, footing, retaining-wall and
    /// press-fit. Their dimensions are parameters, or counts of parts: NAME=VALUE chooses any of them, the others stay as
    /// `new` lists them. The file has comments, which `save` keeps, and is KIND.json if none is named; one that is there
    /// already stays as it is.
    #[command(after_help = "Example:\n  new\n  new wall courses=5 bricks=4 f=0.5 wall-5.json")]
    New {
        /// What to begin with
        #[arg(value_name = "KIND")]
        kind: Option<String>,
        /// Values of its parameters and counts, and the file
        #[arg(value_name = "NAME=VALUE FILE")]
        words: Vec<String>,
    },
    /// List the embedded scenarios
    #[command(after_help = "Example:\n  scenarios")]
    Scenarios,
    /// Write the scenario with the present values and rules to a file
    ///
    /// The text of the file that was loaded is kept, with its order, layout and units; only values that changed are
    /// written anew. Without FILE it goes back to the file it came from. The file is replaced whole or not at all, and
    /// is the one that `diff` and `reset` compare with from here on.
    #[command(after_help = "Example:\n  set F2 150; save beam-150.json")]
    Save {
        /// File to write
        #[arg(value_name = "FILE")]
        file: Option<PathBuf>,
    },
    /// Show the parameters, their values and ranges
    #[command(after_help = "Example:\n  params")]
    Params,
    /// Change a parameter or a rule, and solve again
    ///
    /// VALUE is a number; `110%` of the present value; `+10%` or `-10%` more or less than it; or `+= 10`, `-= 10`,
    /// `*= 2`, `/= 2`. A value outside min … max is accepted: the range is the slider's.
    ///
    /// Rules: `set covering cohesive|ones|weight`, `set tie-break lexicographic|natural|first-row|random:SEED`,
    /// `set engine scheme|tableau|exact`; they hold for `solve`, not for the rate problems of `stages`. `set auto off` stops solving after each change until `solve` or
    /// `set auto on`.
    #[command(after_help = "Example:\n  set F2 120\n  set F2 += 10\n  set f 110%\n  set covering weight")]
    Set {
        /// Parameter, or auto, covering, tie-break, engine; then the value
        #[arg(value_name = "SETTING", required = true, trailing_var_arg = true, allow_hyphen_values = true)]
        words: Vec<String>,
    },
    /// Put a parameter, or everything, back to the value of the file
    #[command(after_help = "Example:\n  reset F2\n  reset")]
    Reset {
        /// Parameter; without it all of them and the rules
        #[arg(value_name = "PARAMETER")]
        name: Option<String>,
    },
    /// Take back the last change
    #[command(after_help = "Example:\n  set F2 500; undo")]
    Undo,
    /// Do again what was undone
    #[command(after_help = "Example:\n  undo; redo")]
    Redo,
    /// Show what differs from the file
    #[command(after_help = "Example:\n  set F2 150; diff")]
    Diff,

    /// Solve with the present values
    ///
    /// Needed only after `set auto off`, or to solve the same once more.
    #[command(after_help = "Example:\n  set auto off; set f 0.3; set F2 90; solve")]
    Solve,
    /// Say what the answer is, under which rules it was found, and its check
    #[command(after_help = "Example:\n  status")]
    Status,
    /// Show state, forces and slip of the contact pairs, at the pivot chosen by `step`
    #[command(
        after_help = "Example:\n  pairs\n  pairs c1 c3\n  pairs joint[0]..joint[4] sort z_t\n  pairs c* sort reserve top 3"
    )]
    Pairs {
        /// Pairs, ranges A..B or patterns with `*`; then `sort KEY` and `top N`
        #[arg(value_name = "PAIRS")]
        words: Vec<String>,
    },
    /// Show the displacements of the nodes, at the pivot chosen by `step`
    #[command(after_help = "Example:\n  displacements\n  displacements s1 s3..s5\n  displacements s* sort ux top 3")]
    Displacements {
        /// Nodes, ranges A..B or patterns with `*`; then `sort u|ux|uy|rz` and `top N`
        #[arg(value_name = "NODES")]
        words: Vec<String>,
    },
    /// Show N, Q, M at the ends of the elements of the bars
    #[command(after_help = "Example:\n  members\n  members AB\n  members b1..b3 sort M top 2")]
    Members {
        /// Bars, ranges A..B or patterns with `*`; then `sort N|Q|M` and `top N`
        #[arg(value_name = "BARS")]
        words: Vec<String>,
    },
    /// Show the forces of supports and springs on the structure
    ///
    /// One row for each node that is held or sprung, the sum of both where it is both; then the totals. Forces of contact
    /// stand under the pairs.
    #[command(after_help = "Example:\n  reactions")]
    Reactions,
    /// Show quantities of the answer: forces, slips, displacements, stresses, limits
    ///
    /// Commas may separate several. Without a quantity the probes of the scenario are shown. The same words stand in
    /// `expect`, in probes, in `envelope`, `sweep --columns`, `trace … of` and `plot path`.
    #[command(after_help = "Example:\n  show x_n c1, z_t c6\n  show sum x_n *, count stick")]
    Show {
        /// The quantities
        #[arg(value_name = "QUANTITY", allow_negative_numbers = true)]
        words: Vec<String>,
    },
    /// Show the answer on one screen: resultants, extremes, reactions, safety of each load case
    #[command(after_help = "Example:\n  summary")]
    Summary,
    /// Solve the load combinations of the scenario
    ///
    /// Each multiplies the factors of the load cases it names; cases it does not name count 0. With NAME its answer is
    /// the one that the other commands show, until the next change or `solve`.
    #[command(after_help = "Example:\n  combine\n  combine ULS1")]
    Combine {
        /// The combination; all of them if none is named
        #[arg(value_name = "COMBINATION")]
        name: Option<String>,
    },
    /// Show the least and the largest value of quantities, over load combinations or ranges of parameters
    ///
    /// With the combination, or the place, that governs. Where an exact path leads over a single parameter (loads,
    /// friction) the place is exact; otherwise it is that of a grid of answers, refined around its extremes, and said to
    /// be so. A range left out is that of the slider.
    #[command(
        after_help = "Example:\n  envelope\n  envelope x_n c1, max u over combinations\n  envelope x_t c1 over f 0..1\n  envelope max u over F 50..150 F2 0..200"
    )]
    Envelope {
        /// The quantities, the probes if none is named; then `over combinations` or `over PARAMETER A..B …`
        #[arg(value_name = "QUANTITY", trailing_var_arg = true, allow_hyphen_values = true)]
        words: Vec<String>,
    },
    /// Show the numbers of the fresh check of the answer; `check exact` proves or refutes it
    ///
    /// `check exact` solves the final working scheme in exact arithmetic from the f64 data and tells every sign.
    #[command(after_help = "Example:\n  check\n  check exact")]
    Check {
        /// In exact arithmetic
        #[arg(value_name = "EXACT")]
        how: Option<CheckHow>,
    },

    /// List the pivots, each with its sentence
    #[command(after_help = "Example:\n  pivots\n  pivots 2..4")]
    Pivots {
        /// One pivot, or FROM..TO; either end may be left out
        #[arg(value_name = "RANGE")]
        range: Option<String>,
    },
    /// Move along the pivots: `pairs` and `plot` then show the structure at that pivot
    #[command(after_help = "Example:\n  step first; step; step 2; step back 1; step to 4; step last")]
    Step {
        /// N, back N, to K, first or last; one pivot on if left out
        #[arg(value_name = "STEP")]
        words: Vec<String>,
    },
    /// Say why a pair is in its state, and which pivots brought it there; of a bare LCP, why a variable has its value
    #[command(after_help = "Example:\n  why c6; load murty6; why z[1]; why w[2]")]
    Why {
        /// The pair; of a bare LCP z[NAME] or w[NAME]
        #[arg(value_name = "PAIR")]
        pair: String,
    },

    /// List the pivots with tied rows, what chose among them, and the vertices with basics at zero
    #[command(after_help = "Example:\n  load cycling; ties")]
    Ties,
    /// Print the dictionary of a small problem at the pivot chosen by `step`
    #[command(after_help = "Example:\n  load klarbring; set f 0.5; step first; tableau")]
    Tableau,

    /// Run every covering, tie-break and engine on the present values, and say which find the same answer
    #[command(after_help = "Example:\n  load greco; set f 2; compare")]
    Compare,
    /// List every answer; with a number, show that one
    ///
    /// Goes through all working schemes in exact arithmetic, cutting what cannot be completed. Where answers lie side by
    /// side it tells the corners of the continuum and the directions in which it has no end. Ctrl-C shows what was found
    /// so far. `enumerate 2` makes the second answer the one that `pairs`, `plot` and the others show; `solve` goes back
    /// to Lemke's.
    #[command(after_help = "Example:\n  load klarbring; enumerate; enumerate 2; pairs")]
    Enumerate {
        /// Number of the answer to show
        #[arg(value_name = "ANSWER")]
        answer: Option<usize>,
    },
    /// Find the friction above which more than one answer is possible
    ///
    /// Exact up to 8 pairs; beyond, a search among drawn working schemes, reported as such.
    #[command(after_help = "Example:\n  load klarbring; critical f")]
    Critical {
        /// The friction parameter
        #[arg(value_name = "PARAMETER")]
        friction: String,
    },
    /// Show the ray: its class, its motion and what it means
    #[command(after_help = "Example:\n  load beam-ray; ray")]
    Ray,

    /// Follow the answer over a load or a friction coefficient: every breakpoint, exactly
    ///
    /// NAME is a load case, a parameter in which the loads are linear, or a friction parameter. A load is followed from its present factor
    /// upwards (from 0 where there is no answer now) to the target, a turning point or its limit; friction up to the
    /// target, or else to the end of the slider. `plot path` and `export path` show the way afterwards.
    #[command(
        after_help = "Example:\n  trace pull\n  trace F2 to 400\n  trace f to 1\n  trace pull --through\n  trace pull to 260 of x_t c6, max z_t"
    )]
    Trace {
        /// What to follow
        #[arg(value_name = "TRACED")]
        name: String,
        /// `to` and the value to reach; `of` and quantities to show on the way
        #[arg(value_name = "to VALUE", num_args = 0.., allow_negative_numbers = true)]
        to: Vec<String>,
        /// Follow the path through turning points, where the load has to fall
        #[arg(long)]
        through: bool,
    },
    /// Find the limit of a load: its factor, the safety, how the structure collapses
    ///
    /// A load whose present value is negative grows downwards.
    #[command(after_help = "Example:\n  limit pull\n  limit F2")]
    Limit {
        /// Load case, or a parameter in which the loads are linear
        #[arg(value_name = "LOAD")]
        name: String,
    },
    /// Find the values of a parameter or load at which a quantity is as wanted
    ///
    /// `find NAME [A..B] where QUANTITY < | = | > VALUE` (or `QUANTITY WORD`) tells every interval and place in the range,
    /// which is that of the slider if it is left out. Where an exact path leads over NAME (loads, friction) they are
    /// exact and in order; elsewhere (geometry, stiffness) they are brackets between answers of their own.
    /// `find least|most NAME [A..B] where outcome answer` brackets the first value with an answer between a checked answer
    /// and a proved collapse; with another condition it is the first or the last place at which that holds.
    #[command(
        after_help = "Example:\n  find F2 0..400 where z_t c3 > 0\n  find f 0..1 where x_t c1 = -50\n  find F2 where state c3 = slip+\n  find most F2 where outcome answer"
    )]
    Find {
        /// `least` or `most`, the parameter or load case, the range, `where` and the condition
        #[arg(value_name = "FOUND", required = true, trailing_var_arg = true, allow_hyphen_values = true)]
        words: Vec<String>,
    },
    /// Cut the plane of two parameters into its regions of equal working scheme
    ///
    /// `map P [A..B] Q [C..D] [of QUANTITY]`: parameters or load cases, horizontal and vertical; the ranges are those of
    /// the sliders where they are left out. One of the two is followed on its exact path while the other stands still;
    /// where the order of the schemes changes is found to the last digits. Each region gets its area, and at a place inside
    /// its states, or the collapse with its motion and what is proved of it, and the quantity. In small problems other
    /// answers are looked for there; their regions are hatched. `export map FILE.svg|.json` writes the last map.
    #[command(after_help = "Example:\n  map f 0..1 F2 0..400\n  map f 0..1 F2 0..400 of z_t c6")]
    Map {
        /// The two parameters or load cases with their ranges, `of` and a quantity
        #[arg(value_name = "MAPPED", required = true, trailing_var_arg = true, allow_hyphen_values = true)]
        words: Vec<String>,
    },
    /// Show what one more unit of a parameter does to forces and slips
    #[command(after_help = "Example:\n  sensitivity\n  sensitivity f")]
    Sensitivity {
        /// Parameter; all of them if none is named
        #[arg(value_name = "NAME")]
        parameter: Option<String>,
    },
    /// Follow the load history of the scenario, with memory
    ///
    /// Each stage is followed event by event from where the one before ended; slips stay. With STAGE the way through
    /// that stage and the pairs at its end are shown. `plot path` draws the loops. Until the next change or `solve`,
    /// `expect` and the tables `pairs`, `displacements`, `members`, `reactions` and `check` mean the end of the history.
    ///
    /// The rate problems between two events are always solved under the default rules: `set covering`, `set tie-break`
    /// and `set engine` do not reach them.
    #[command(after_help = "Example:\n  stages\n  stages 2\n  stages; plot path slip c6")]
    Stages {
        /// Number of a stage
        #[arg(value_name = "STAGE")]
        stage: Option<usize>,
    },
    /// Solve at every point of a grid of up to three parameters
    ///
    /// A range is A..B, with the number of points N after it (11 if left out). With `--out` the rows go to a .csv or
    /// .json file as they come; Ctrl-C keeps what is done and `--resume` goes on from there.
    #[command(after_help = "Example:\n  sweep f 0..1 21\n  sweep f 0..1 F2 0..400 41 --out beam.csv")]
    Sweep {
        /// PARAMETER A..B [N], up to three times
        #[arg(value_name = "SWEPT", required = true, allow_negative_numbers = true)]
        words: Vec<String>,
        /// File for the rows: .csv, or .json for one object a line
        #[arg(long, value_name = "FILE")]
        out: Option<PathBuf>,
        /// Continue the file
        #[arg(long, requires = "out")]
        resume: bool,
        /// Only part K of N
        #[arg(long, value_name = "K/N")]
        shard: Option<Shard>,
        /// Quantities with columns of their own, separated by commas: "x_n c1, max u"
        #[arg(long, value_name = "QUANTITIES")]
        columns: Option<String>,
    },

    /// Draw a picture of the present state, or of the last path
    ///
    /// `plot path [slip|force|gap|pressure] [PAIRS]`, or `plot path QUANTITY`, draws what the last `trace` or `stages`
    /// followed. A history is drawn over the load that goes to and fro most, or with `over CASE` at the end over another one.
    #[command(
        after_help = "Example:\n  plot slip\n  plot force\n  plot structure\n  trace F2; plot path force c6 c5\n  \
                            stages; plot path slip c6 over pull"
    )]
    Plot {
        /// What to draw
        #[arg(value_name = "PICTURE")]
        picture: Picture,
        /// Pivots to draw on one axis: numbers, `first`, `last`, separated by commas
        #[arg(long, value_name = "PIVOTS", value_delimiter = ',')]
        at: Vec<String>,
        /// Columns of the picture
        #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(20..=1000))]
        width: Option<u16>,
        /// Lines of the picture
        #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(5..=500))]
        height: Option<u16>,
        /// Bar, for moment, shear and axial (all of them without one); quantity, pairs and `over CASE`, for path
        #[arg(value_name = "OF")]
        of: Vec<String>,
    },

    /// Go to the full screen, with this session; `q` there comes back
    ///
    /// Only at the prompt of a terminal: in a script and on a pipe it is refused, as a command that fails.
    #[command(after_help = "Example:\n  tui")]
    Tui,

    /// Run the commands of a script
    #[command(after_help = "Example:\n  source scenarios/scripts/beam.stick")]
    Source {
        /// The script
        #[arg(value_name = "FILE")]
        file: PathBuf,
    },
    /// Write what is typed from now on to a script, with the answers as comments
    ///
    /// The script begins with the present scenario and values, so that `replay` and `source` bring the same answers.
    #[command(after_help = "Example:\n  record session.stick; set F2 150; pairs; record off")]
    Record {
        /// The script to write, or `off`
        #[arg(value_name = "FILE")]
        file: PathBuf,
    },
    /// Test the answer: the script fails where it is not as expected
    ///
    /// Forms, with OP one of = != < <= > >= and `± TOLERANCE` (or `+- TOLERANCE`) after `=`:
    ///   expect QUANTITY OP NUMBER               (`help show` lists the quantities)
    ///   expect outcome answer|trivial|normal|ray|pivot-limit|breakdown|check-failed
    ///   expect state PAIR open|stick|slip+|slip-|closed
    ///   expect x_n|x_t|z_n|z_t|bound|reserve_plus|reserve_minus PAIR OP NUMBER
    ///   expect ux|uy|rz NODE OP NUMBER
    ///   expect p OP NUMBER
    ///   expect pivots OP NUMBER
    ///   expect unknowns|free|lcp OP NUMBER      (sizes, as `status` shows them)
    ///   expect ray mechanism|artefact|fault|no-equilibrium
    ///   expect verdict certified|proved|undecided
    ///   expect stage S …                        (after `stages`: at the end of stage S)
    ///   expect error "part of the message"      (after a command that fails)
    /// NUMBER and TOLERANCE may be formulas of the parameters: `2*f*F`, `q*L^2/8`; a tolerance also `1%`.
    /// States, forces and p are those at the pivot chosen by `step`.
    #[command(
        verbatim_doc_comment,
        after_help = "Example:\n  expect outcome normal\n  expect x_n c1 = 100 ± 1e-6\n  expect x_t c6 = -f*F ± 1%\n  expect pivots <= 20"
    )]
    Expect {
        /// What is expected
        #[arg(value_name = "EXPECTATION", required = true, trailing_var_arg = true, allow_hyphen_values = true)]
        words: Vec<String>,
    },
    /// Write tables, pictures, a report, the mesh with its results, or the LCP, to a file
    ///
    /// Tables go to .csv or .json: `export WHAT [OF] FILE`, where OF are the quantities of `quantities` and `envelope`, or
    /// the words that `sensitivity`, `critical`, `find`, `limit` and `check` take. A table is what the command shows, at
    /// the pivot chosen by `step`, after `stages` at the end of the history.
    ///
    /// `export report FILE.html` is one file with its figures, `FILE.md` has them beside it as FILE-structure.svg and so
    /// on. It bears no date, so that the same answer gives the same file; `export report date FILE` adds it.
    ///
    /// `export vtu FILE.vtu` is the state shown for ParaView: the nodes with displacement, rotation and stress, the
    /// elements with stress or N, Q, M, and a vertex for each pair with its state (0 open, 1 stick, 2 slip+, 3 slip-,
    /// 4 closed) and the vectors of force, friction and slip. `export vtu FILE.pvd` is a series, of the moments of the
    /// history after `stages`, else of the pivots: FILE-0000.vtu, FILE-0001.vtu … stand beside it.
    ///
    /// Pictures go to .svg: `slip`, `force`, `gap` and `pressure` of the state shown or at pivots that are named; `moment`,
    /// `shear` and `axial` of all bars on the structure, or of the bar that is named; `path` as `plot path` draws it, with
    /// the same words.
    ///
    /// `export lcp` writes M, q and the covering d, in the units of the scenario: to .json as a scenario of this program,
    /// or M to FILE.mtx, q to FILE.q.mtx and d to FILE.d.mtx in Matrix Market format; a scenario reads M back with
    /// `"M": { "file": "FILE.mtx" }`.
    ///
    /// `export stiffness` writes K of the elements to FILE.mtx, F of each load case to FILE.CASE.mtx, and to FILE.json the
    /// scenario that reads them back as a superelement: with the dofs of the rows, and supports, ties, springs and contacts
    /// beside it at the present values.
    ///
    /// A file that is there is replaced, whole or not at all; never the scenario itself.
    #[command(
        after_help = "Example:\n  export pairs pairs.csv\n  export envelope x_n c1, max u envelope.csv\n  export vtu beam.vtu\n  export structure beam.svg\n  export report beam.html\n  export path force c6 c5 path.svg\n  export result answer.json\n  export lcp beam-lcp.json\n  export find F2 0..400 where z_t c3 > 0 places.csv\n  export stiffness k.mtx"
    )]
    Export {
        /// What to write
        #[arg(value_name = "WHAT")]
        what: Export,
        /// Its ending says the format; of what stands before it
        #[arg(value_name = "OF FILE", required = true, trailing_var_arg = true, allow_hyphen_values = true)]
        words: Vec<String>,
    },
    /// Turn an LCP of Siconos (FILE.dat: dense, sparse or in blocks) into a scenario
    ///
    /// Writes FILE.json beside it, which `load` opens; a file that is there already stays as it is.
    #[command(after_help = "Example:\n  import lcp_mmc.dat; load lcp_mmc.json")]
    Import {
        /// The file
        #[arg(value_name = "FILE")]
        file: PathBuf,
    },
    /// Print the words that follow
    #[command(after_help = "Example:\n  echo now with less friction")]
    Echo {
        /// Any words
        #[arg(value_name = "WORDS", trailing_var_arg = true, allow_hyphen_values = true)]
        words: Vec<String>,
    },
    /// Bring back the changes of a session in this directory that ended without `quit`
    ///
    /// Values and rules are as they were after its last change, `undo` goes back through them; nothing is run again and
    /// no file is written.
    #[command(after_help = "Example:\n  restore\n  restore discard")]
    Restore {
        /// Forget those changes instead
        #[arg(value_name = "DISCARD")]
        discard: Option<Discard>,
    },

    /// Show all commands, or what one of them does
    #[command(visible_alias = "?", after_help = "Example:\n  help set")]
    Help {
        /// The command
        #[arg(value_name = "COMMAND")]
        command: Option<String>,
    },
    /// Take the guided tour: six steps in the full screen, from sticking to the ray
    #[command(after_help = "Example:\n  tour")]
    Tour,
    /// List the commands given so far
    #[command(after_help = "Example:\n  history")]
    History,
    /// Leave
    #[command(visible_alias = "exit", after_help = "Example:\n  quit")]
    Quit,
}

impl Command {
    /// Whether it looks at the pivots or the final scheme of the run, which a warm start does not have.
    pub(in crate::session) fn needs_pivots(&self) -> bool {
        match self {
            Command::Check { how } => how.is_some(),
            Command::Show { words } => words.iter().any(|word| word == "pivots"),
            Command::Plot { picture, at, .. } => {
                matches!(picture, Picture::P | Picture::Path | Picture::Mode) || !at.is_empty()
            }
            Command::Pivots { .. }
            | Command::Step { .. }
            | Command::Why { .. }
            | Command::Ties
            | Command::Tableau
            | Command::Compare
            | Command::Enumerate { .. }
            | Command::Ray
            | Command::Trace { .. }
            | Command::Limit { .. }
            | Command::Sensitivity { .. }
            | Command::Export { .. }
            | Command::Expect { .. } => true,
            _ => false,
        }
    }
}

/// What `plot` draws.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum Picture {
    /// Slip z_τ along the contact zone
    Slip,
    /// Friction force x_τ within its bound ±(f x_n + c)
    Force,
    /// Distance open z_n
    Gap,
    /// Compressive force x_n
    Pressure,
    /// p over the pivots
    P,
    /// The structure with the states of its pairs, and its deformed shape
    Structure,
    /// The collapse mode of a ray
    Mode,
    /// Bending moment along a bar, or along all bars where they lie
    Moment,
    /// Shear force likewise
    Shear,
    /// Normal force likewise
    Axial,
    /// Slip or force over the load, friction or history that was followed last
    Path,
}

/// The word of `check exact`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum CheckHow {
    /// In exact arithmetic
    Exact,
}

/// The word of `restore discard`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum Discard {
    /// Forget the changes
    Discard,
}

/// Clap's view of one line.
#[derive(Parser)]
#[command(
    name = "",
    no_binary_name = true,
    disable_help_subcommand = true,
    disable_version_flag = true,
    disable_help_flag = true,
    help_template = "{about-with-newline}\nUsage: {usage}\n\n{all-args}{after-help}\n"
)]
struct Line {
    #[command(subcommand)]
    command: Command,
}

/// A command that does not belong to the language.
#[derive(Clone, Debug, PartialEq, Eq, Error)]
pub enum GrammarError {
    /// Quotation not closed.
    #[error(transparent)]
    Quote(#[from] OpenQuote),
    /// No such command.
    #[error("unknown command `{word}`{}: `help` lists all commands", suggestion(.near))]
    Unknown {
        /// The word.
        word: String,
        /// Commands that look like it.
        near: Vec<String>,
    },
    /// A prefix of several commands.
    #[error("`{word}` may be {}: write one more letter", .candidates.join(", "))]
    Ambiguous {
        /// The word.
        word: String,
        /// What it may mean.
        candidates: Vec<String>,
    },
    /// The arguments are wrong; the text is clap's, in one paragraph.
    #[error("{0}")]
    Arguments(String),
}

fn suggestion(near: &[String]) -> String {
    match near {
        [] => String::new(),
        near => format!(" (did you mean `{}`?)", near.join("` or `")),
    }
}

/// Words among `known` that look like `word`, best first, at most three.
pub fn near<'a>(word: &str, known: impl IntoIterator<Item = &'a str>) -> Vec<String> {
    let wanted = word.to_lowercase();
    let mut scored: Vec<(f64, &str)> = known
        .into_iter()
        .map(|name| (strsim::jaro_winkler(&wanted, &name.to_lowercase()), name))
        .filter(|(score, _)| *score > 0.8)
        .collect();
    scored.sort_by(|a, b| b.0.total_cmp(&a.0).then(a.1.cmp(b.1)));
    scored.into_iter().take(3).map(|(_, name)| name.to_owned()).collect()
}

/// "(did you mean …?)" with a blank before it, or nothing.
pub fn did_you_mean<'a>(word: &str, known: impl IntoIterator<Item = &'a str>) -> String {
    suggestion(&near(word, known))
}

/// The grammar as clap holds it: names, arguments, help.
pub fn grammar() -> clap::Command {
    let mut grammar = Line::command();
    // Without building, clap's `mut_subcommands` loses nothing we need; each command keeps its own `--help`.
    grammar = grammar.mut_subcommand("show", |command| {
        let example = command.get_after_help().map(ToString::to_string).unwrap_or_default();
        command.after_long_help(format!("{}\n\n{example}", crate::session::commands::quantities::help()))
    });
    grammar = grammar.mut_subcommands(|command| {
        command
            .help_template("{about-with-newline}\nUsage: {usage}\n\n{all-args}{after-help}\n")
            .disable_version_flag(true)
    });
    grammar
}

/// Commands that were not there in 0.1.
const SINCE_0_2: &[&str] = &["find", "show", "summary", "combine", "envelope", "import", "map", "new"];

/// The full name of a command: itself, an alias, or a prefix that only one command has.
///
/// # Errors
/// Unknown or ambiguous.
pub fn resolve(word: &str) -> Result<String, GrammarError> {
    let grammar = grammar();
    let mut candidates = Vec::new();
    for command in grammar.get_subcommands() {
        let name = command.get_name();
        if name == word || command.get_all_aliases().any(|alias| alias == word) {
            return Ok(name.to_owned());
        }
        if !word.is_empty() && name.starts_with(word) {
            candidates.push(name.to_owned());
        }
    }
    // A prefix that was unique in 0.1 keeps its meaning.
    let first: Vec<&String> = candidates.iter().filter(|name| !SINCE_0_2.contains(&name.as_str())).collect();
    if let ([one], true) = (&first[..], candidates.len() > 1) {
        return Ok((*one).clone());
    }
    match candidates.len() {
        1 => Ok(candidates.remove(0)),
        0 => Err(GrammarError::Unknown {
            word: word.to_owned(),
            near: near(word, grammar.get_subcommands().map(|c| c.get_name())),
        }),
        _ => Err(GrammarError::Ambiguous { word: word.to_owned(), candidates }),
    }
}

/// Reads one command (no `;`, no comment); `None` for a blank one.
///
/// # Errors
/// [`GrammarError`], with what to write instead.
pub fn parse(text: &str) -> Result<Option<Command>, GrammarError> {
    let mut words = tokens::split(text)?;
    let Some(first) = words.first_mut() else {
        return Ok(None);
    };
    let name = resolve(first)?;
    first.clone_from(&name);
    // Commands whose words may begin with a sign would take it for one of them.
    if name != "echo" && matches!(&words[1..], [word] if word == "--help") {
        return Ok(Some(Command::Help { command: Some(name) }));
    }
    if name == "sweep" {
        // Its options may follow its ranges: a range from below zero would be taken for one of them.
        let below_zero = |word: &&mut String| word.starts_with('-') && !word.starts_with("--") && word.contains("..");
        words.iter_mut().filter(below_zero).for_each(|word| word.insert(0, ' '));
    }
    match grammar().try_get_matches_from(&words) {
        Ok(matches) => Line::from_arg_matches(&matches)
            .map(|line| Some(line.command))
            .map_err(|error| GrammarError::Arguments(one_paragraph(&error, &name))),
        Err(error) if error.kind() == clap::error::ErrorKind::DisplayHelp => {
            Ok(Some(Command::Help { command: Some(name) }))
        }
        Err(error) => Err(GrammarError::Arguments(one_paragraph(&error, &name))),
    }
}

/// Clap's message without its `error:`, its layout and its pointer to `--help`.
fn one_paragraph(error: &clap::Error, name: &str) -> String {
    let text = error.render().to_string();
    let mut parts = Vec::new();
    for line in text.lines() {
        let line = line.trim();
        if line.is_empty() || line.starts_with("For more information") {
            continue;
        }
        if line.starts_with("Usage:") {
            break;
        }
        parts.push(line.trim_start_matches("error: ").trim_start_matches("tip: "));
    }
    format!("{name}: {}; see `help {name}`", parts.join(" "))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn clap_accepts_the_grammar() {
        Line::command().debug_assert();
    }

    #[test]
    fn prefixes_and_typos() {
        assert_eq!(parse("piv").unwrap(), Some(Command::Pivots { range: None }));
        assert_eq!(parse("exit").unwrap(), Some(Command::Quit));
        assert_eq!(parse("com").unwrap(), Some(Command::Compare));
        assert_eq!(parse("comb").unwrap(), Some(Command::Combine { name: None }));
        assert_eq!(parse("en").unwrap(), Some(Command::Enumerate { answer: None }));
        let ambiguous = parse("p").unwrap_err().to_string();
        assert!(ambiguous.contains("pairs, pivots, plot") || ambiguous.contains("params"), "{ambiguous}");
        let typo = parse("piars").unwrap_err().to_string();
        assert!(typo.contains("did you mean `pairs`"), "{typo}");
    }

    #[test]
    fn signs_are_no_options() {
        let words = |text: &str| match parse(text).unwrap() {
            Some(Command::Set { words }) => words,
            other => panic!("{other:?}"),
        };
        assert_eq!(words("set F2 -10%"), ["F2", "-10%"]);
        assert_eq!(words("set F2 -= 10"), ["F2", "-=", "10"]);
        assert!(matches!(parse("echo --at -x"), Ok(Some(Command::Echo { words })) if words.len() == 2));
    }

    #[test]
    fn every_command_has_its_help() {
        for command in grammar().get_subcommands().map(clap::Command::get_name).filter(|name| *name != "echo") {
            let help = Command::Help { command: Some(command.to_owned()) };
            assert_eq!(parse(&format!("{command} --help")).unwrap(), Some(help));
        }
        assert!(matches!(parse("echo --help"), Ok(Some(Command::Echo { .. }))));
    }

    #[test]
    fn wrong_arguments_say_where_help_is() {
        let error = parse("plot sli").unwrap_err().to_string();
        assert!(error.contains("slip") && error.contains("help plot"), "{error}");
        assert!(parse("load").unwrap_err().to_string().contains("help load"));
    }
}
