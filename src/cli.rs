//! The program as the shell sees it: arguments, streams, exit statuses.

mod look;
mod order;

use std::ffi::OsString;
use std::io::{self, IsTerminal, Write};
use std::path::{Path, PathBuf};

use clap::{Args, CommandFactory, Parser, Subcommand, ValueEnum};
use serde_json::{Value, json};

use crate::export::{json as json_export, mesh as mesh_export};
use crate::model::embedded;
use crate::model::mesh;
use crate::model::problem::Problems;
use crate::model::rules::{Covering, Engine, TieBreak};
use crate::model::scenario::Scenario;
use crate::model::schema;
use crate::session::commands::{import, new, script, sweep};
use crate::session::{Answer, exit_status, load};
use crate::session::{CommandError, Format, History, Output, Session, diagnose};
use crate::signals::{self, Signals, TerminalWatch, is_dumb};
use crate::text::printable::{self, Printable};
use crate::view;
use crate::view::style::{Role, Style};
use look::Look;

/// Structures with frictional contact, solved by Lemke's algorithm and explained pivot by pivot
#[derive(Debug, Parser)]
#[command(
    name = "stickslip",
    version,
    args_conflicts_with_subcommands = true,
    after_help = "Exit status: 0 an answer, or the command did its job; 1 an `expect` failed; 2 bad usage or input;\n\
                  3 no answer: a mechanism or no equilibrium; 4 no answer: an artefact or fault, a failed check or a \
                  limit; 130 interrupted."
)]
struct Cli {
    #[command(subcommand)]
    command: Option<Command>,
    /// Scenario to open: a file, or an embedded one by name (`stickslip scenarios`)
    #[arg(default_value = embedded::DEFAULT)]
    scenario: String,
    #[command(flatten)]
    look: Look,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum Form {
    Text,
    Json,
}

#[derive(Debug, Subcommand)]
enum Command {
    /// Solve a scenario and print the answer
    Solve(Solve),
    /// Run a script of REPL commands; `-` reads it from stdin
    Replay(Replay),
    /// Solve at every point of a grid, on all cores
    ///
    /// Rows come in the order of the grid (the last parameter runs fastest) and are the same bytes whatever the number
    /// of threads or shards. Ctrl-C keeps the rows that are done; --resume goes on from there.
    #[command(after_help = "Examples:\n  stickslip sweep beam --vary f=0:1:0.05 --out beam.csv\n  \
                      stickslip sweep beam --vary f=0:1:0.05 --vary F2=0:400:10 --shard $K/$N --out part-$K.csv --resume\n  \
                      stickslip merge part-*.csv > beam.csv")]
    Sweep(SweepArguments),
    /// Join the shards of a sweep into what one run would have written, checking that none is missing
    #[command(after_help = "Example:\n  stickslip merge part-*.csv --out beam.csv")]
    Merge {
        /// The files of all shards, in any order
        #[arg(required = true, value_name = "FILE")]
        files: Vec<PathBuf>,
        /// File to write; otherwise stdout
        #[arg(long, value_name = "FILE")]
        out: Option<PathBuf>,
    },
    /// Find every problem in scenario files, solving nothing; list what a mesh file holds
    ///
    /// Also names the parts that only contact holds, with their motions: where those are not wanted, a support is missing.
    /// Warns of what is allowed and hardly meant: a stiffness or weight that no material of that name has under the named
    /// units, sections and parameters in other units, normals that point down under what stands on the ground, parameters, materials and
    /// sections that nothing uses, loads on nothing, contacts that no load case presses while every joint is held.
    /// Warnings leave the exit status as it is.
    /// Of a mesh (.msh, .inp): nodes, elements, groups with lengths and areas, the boundary by direction, and the
    /// worst element. Quality is the least sine of a corner's angle (of triangles by that of 60°):
    /// 1 is best, 0 degenerate.
    Check {
        /// Files, embedded scenarios or meshes; `-` reads a scenario from stdin
        #[arg(required = true, value_name = "SCENARIO")]
        scenarios: Vec<String>,
        /// For people, or one JSON object with what was found
        #[arg(long, value_enum, default_value_t = Form::Text)]
        format: Form,
    },
    /// Write a scenario to begin with; without KIND, list the kinds
    ///
    /// The kinds are portal, continuous-beam, pipeline, block, block-stack, wall, arch, dam, footing, retaining-wall and
    /// press-fit. Their dimensions are parameters, or counts of parts: NAME=VALUE chooses any of them, the others stay as
    /// `stickslip new` lists them. The file has comments and is KIND.json if none is named; one that is there already stays
    /// as it is.
    #[command(after_help = "Examples:\n  stickslip new\n  stickslip new wall courses=5 bricks=4 f=0.5 wall-5.json")]
    New {
        /// What to begin with
        #[arg(value_name = "KIND")]
        kind: Option<String>,
        /// Values of its parameters and counts, and the file
        #[arg(value_name = "NAME=VALUE|FILE")]
        words: Vec<String>,
    },
    /// Turn an LCP of Siconos (FILE.dat) into a scenario
    ///
    /// Reads dense, sparse and block matrices and writes FILE.json beside the file; one that is there already stays as it is.
    #[command(after_help = "Example:\n  stickslip import lcp_mmc.dat")]
    Import {
        /// The file
        #[arg(value_name = "FILE")]
        file: PathBuf,
    },
    /// Show a scenario in the full screen: vary it and watch
    Tui {
        /// A file, or an embedded scenario
        #[arg(default_value = embedded::DEFAULT)]
        scenario: String,
    },
    /// Answer the requests of another program: JSON lines on stdin and stdout
    ///
    /// One line is one request, {"id": …, "command": "…"}; its answer comes at once, on one line: {"id": …, "ok": true,
    /// "report": …}, the report of `replay --format json`, or {"id": …, "ok": false, "error": "…", "status": N}, with the
    /// exit status that the error would have had. A request of several commands is answered by a list of reports. Whatever
    /// cannot be understood is answered by an error, with the id null where none can be read. SIGINT stops a long command,
    /// `quit` or the end of the input ends the program.
    #[command(after_help = "Example:\n  echo '{\"id\": 1, \"command\": \"set f 0.4; pairs\"}' | stickslip serve beam")]
    Serve {
        /// The first scenario: a file, or an embedded one
        #[arg(default_value = embedded::DEFAULT)]
        scenario: String,
    },
    /// List the embedded scenarios
    Scenarios,
    /// Print the JSON Schema of the scenario format
    #[command(after_help = "Example:\n  stickslip schema > stickslip.schema.json")]
    Schema,
    /// Print the completions of a shell
    Completions {
        /// The shell
        shell: clap_complete::Shell,
    },
}

/// What is solved with other values and rules than those of the file.
#[derive(Args, Debug)]
struct Settings {
    /// Change a parameter, as the REPL's `set` does: `--set f=0.3`, `--set F2=110%`
    #[arg(long = "set", value_name = "NAME=VALUE")]
    values: Vec<String>,
    /// Covering vector: cohesive, ones or weight (like the next two not for the rate problems of load histories)
    #[arg(long)]
    covering: Option<Covering>,
    /// Tie-break: lexicographic, natural, first-row or random:SEED
    #[arg(long)]
    tie_break: Option<TieBreak>,
    /// Engine: scheme, tableau or exact
    #[arg(long)]
    engine: Option<Engine>,
}

impl Settings {
    fn has_rules(&self) -> bool {
        self.covering.is_some() || self.tie_break.is_some() || self.engine.is_some()
    }

    /// The words after a `set`, setting by setting.
    fn words(&self) -> Vec<Vec<String>> {
        let rule = |name: &str, choice: Option<String>| choice.map(|choice| vec![name.to_owned(), choice]);
        self.values
            .iter()
            .map(|setting| vec![setting.clone()])
            .chain(rule("covering", self.covering.map(|c| c.to_string())))
            .chain(rule("tie-break", self.tie_break.map(|t| t.to_string())))
            .chain(rule("engine", self.engine.map(|e| e.to_string())))
            .collect()
    }
}

#[derive(Args, Debug)]
struct Solve {
    /// A file, or an embedded scenario; `-` reads one from stdin
    #[arg(default_value = embedded::DEFAULT)]
    scenario: String,
    #[command(flatten)]
    settings: Settings,
    /// For people, or the JSON of the whole result
    #[arg(long, value_enum, default_value_t = Form::Text)]
    format: Form,
    /// Show how long it took
    #[arg(long)]
    timings: bool,
    /// Solve a scenario with stages in one step, all load cases with their factors, instead of following its history
    #[arg(long)]
    at_once: bool,
}

#[derive(Args, Debug)]
struct Replay {
    /// The script
    script: PathBuf,
    /// Text, or one JSON object per command
    #[arg(long, value_enum, default_value_t = Form::Text)]
    format: Form,
    /// Go on after a command that fails
    #[arg(long)]
    keep_going: bool,
    /// Say each command before its result
    #[arg(long)]
    echo: bool,
}

#[derive(Args, Debug)]
struct SweepArguments {
    /// A file, or an embedded scenario; `-` reads one from stdin
    #[arg(default_value = embedded::DEFAULT)]
    scenario: String,
    /// A parameter and its values: NAME=FROM:TO:STEP (TO included), NAME=FROM..TO/COUNT or NAME=VALUE; up to three
    #[arg(long = "vary", value_name = "NAME=RANGE", required = true)]
    axes: Vec<String>,
    #[command(flatten)]
    settings: Settings,
    /// Only part K of N, for batch systems
    #[arg(long, value_name = "K/N")]
    shard: Option<sweep::Shard>,
    /// File to write; otherwise stdout
    #[arg(long, value_name = "FILE")]
    out: Option<PathBuf>,
    /// Continue the file if it is there
    #[arg(long, requires = "out")]
    resume: bool,
    /// CSV, or JSON lines; otherwise by the ending of FILE, or CSV
    #[arg(long, value_enum)]
    format: Option<Rows>,
    /// Quantities with columns of their own, separated by commas: "x_n c1, max u"
    #[arg(long, value_name = "QUANTITIES")]
    columns: Option<String>,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum Rows {
    Csv,
    Json,
}

/// What ends the program early.
enum Failure {
    /// A command that failed.
    Command(CommandError),
    /// A message for stderr and a status.
    Status(u8, String),
    /// What is wrong was told already.
    Told(u8),
}

impl From<io::Error> for Failure {
    fn from(error: io::Error) -> Self {
        Failure::Command(CommandError::Output(error))
    }
}

impl From<CommandError> for Failure {
    fn from(error: CommandError) -> Self {
        Failure::Command(error)
    }
}

/// What comes after the arguments: `main` switches to the next face.
pub enum Next {
    /// The program is done.
    Exit(u8),
    /// The command line that stays.
    Repl(Box<Start>),
    /// The full screen.
    Tui(Box<Start>),
    /// JSON lines.
    Serve(Box<Start>),
}

/// What the REPL, the full screen and `serve` start from.
pub struct Start {
    /// The scenario, loaded and solved.
    pub session: Session,
    /// Style of stdout.
    pub style: Style,
    /// The handlers, installed.
    pub signals: Signals,
    /// Style of stderr.
    pub errors: Style,
}

/// The exit status of a face; tells on stderr, in the style `errors`, why it could not go on.
pub fn finish(ended: io::Result<u8>, errors: &Style) -> u8 {
    status(ended.map_err(Failure::from), false, errors)
}

/// Runs what the arguments of the process ask for, up to the REPL.
pub fn main() -> Next {
    if let Err(error) = signals::survive_limits() {
        return Next::Exit(finish(Err(error), &Style::default()));
    }
    let arguments = order::command_first(&Cli::command(), std::env::args_os().collect());
    let cli = match Cli::try_parse_from(&arguments) {
        Ok(cli) => cli,
        Err(error) => return Next::Exit(usage(&error, &arguments)),
    };
    let errors = cli.look.style(&io::stderr());
    let failed = |failure| Next::Exit(status(Err(failure), false, &errors));
    match &cli.command {
        None => start(&cli, &cli.scenario, errors).map_or_else(failed, |start| Next::Repl(Box::new(start))),
        Some(Command::Tui { scenario }) => {
            start_screen(&cli, scenario, errors).map_or_else(failed, |start| Next::Tui(Box::new(start)))
        }
        Some(Command::Serve { scenario }) => {
            start(&cli, scenario, errors).map_or_else(failed, |start| Next::Serve(Box::new(start)))
        }
        Some(_) => {
            let json = asks_for_json(&arguments);
            Next::Exit(status(run(cli), json, &errors))
        }
    }
}

/// Whether the arguments ask for JSON; needed where they cannot be read as a whole.
fn asks_for_json(arguments: &[OsString]) -> bool {
    let pair = |pair: &[OsString]| pair[0] == "--format" && pair[1] == "json";
    arguments.iter().any(|word| word == "--format=json") || arguments.windows(2).any(pair)
}

/// Help and version go to stdout and are no error.
fn usage(error: &clap::Error, arguments: &[OsString]) -> u8 {
    let status = u8::try_from(error.exit_code()).unwrap_or(2);
    // the message quotes the arguments: it is made again from what of them may be shown
    let clean = arguments.iter().map(|word| printable::line(&word.to_string_lossy()));
    let shown = Cli::try_parse_from(clean).err().filter(|shown| shown.kind() == error.kind());
    if status != 0 && asks_for_json(arguments) {
        let text = shown.as_ref().unwrap_or(error).render().to_string();
        let message = text.lines().next().unwrap_or_default().trim_start_matches("error: ");
        tell_json(&json_export::problems(&[Problems::of_file("", message, "")]));
    }
    let printed = match shown {
        Some(shown) => shown.print(),
        None => io::stderr().write_all(printable::text(&error.render().to_string(), false).as_bytes()),
    };
    match printed {
        Err(error) if error.kind() != io::ErrorKind::BrokenPipe => 2,
        _ => status,
    }
}

fn start_screen(cli: &Cli, scenario: &str, errors: Style) -> Result<Start, Failure> {
    if !io::stdin().is_terminal() || !io::stdout().is_terminal() || is_dumb() {
        return Err(Failure::Status(
            2,
            "the full screen needs a terminal that understands cursor codes; `stickslip solve` and `stickslip replay` \
             work without"
                .to_owned(),
        ));
    }
    start(cli, scenario, errors)
}

fn start(cli: &Cli, scenario: &str, errors: Style) -> Result<Start, Failure> {
    let style = cli.look.style(&io::stdout());
    let signals = Signals::install()?;
    let watch = TerminalWatch::new(&signals);
    let scenario = load::scenario(scenario, &watch)?;
    let session = Session::new(scenario, &watch);
    watch.clear();
    Ok(Start { session: session?, style, signals, errors })
}

/// The exit status of a result; a failure is told on stderr, and with `json` on stdout as well.
fn status(result: Result<u8, Failure>, json: bool, errors: &Style) -> u8 {
    let failure = match result {
        Ok(status) | Err(Failure::Told(status)) => return status,
        Err(Failure::Command(error)) if error.is_broken_pipe() => return 0,
        Err(failure) => failure,
    };
    let (status, message) = match &failure {
        // a shell run leaves no session behind
        Failure::Command(error) if error.is_interrupted() => (error.status(), "interrupted".to_owned()),
        Failure::Command(error) => (error.status(), error.to_string()),
        Failure::Status(status, message) => (*status, message.clone()),
        Failure::Told(status) => (*status, String::new()),
    };
    if json && status == 2 && !matches!(&failure, Failure::Command(error) if error.is_output()) {
        tell_json(&match &failure {
            Failure::Command(CommandError::Scenario(problems)) => {
                json_export::no_result(std::slice::from_ref(problems))
            }
            _ => json_export::no_result(&[Problems::of_file("", message.as_str(), "")]),
        });
    }
    tell(errors, &message);
    status
}

/// What is wrong with the input, for a program that reads stdout; if nobody does, so be it.
fn tell_json(error: &Value) {
    let _ = json_export::pretty(error).and_then(|text| writeln!(io::stdout(), "{text}"));
}

/// An error on stderr; if nobody can read it, so be it.
fn tell(style: &Style, message: &str) {
    let lines: Vec<String> = message.lines().map(|line| style.text(line)).collect();
    let _ = writeln!(io::stderr(), "{} {}", style.paint(Role::Bad, "error:"), lines.join("\n"));
}

fn run(cli: Cli) -> Result<u8, Failure> {
    let style = cli.look.style(&io::stdout());
    let mut out = Printable::new(io::stdout(), style.color);
    match cli.command {
        None | Some(Command::Tui { .. } | Command::Serve { .. }) => Ok(0), // `main` starts those
        Some(Command::Solve(arguments)) => solve(&arguments, &style, &mut out),
        Some(Command::Replay(arguments)) => replay(&arguments, style, &mut out),
        Some(Command::Sweep(arguments)) => sweep(&arguments, &style, &mut out),
        Some(Command::Merge { files, out: to }) => merge(&files, to.as_deref(), &style, &mut out),
        Some(Command::Check { scenarios, format }) => check(&scenarios, format, &style, &mut out),
        Some(Command::New { kind, words }) => begin(kind.as_deref(), &words, &style, &mut out),
        Some(Command::Import { file }) => {
            let watch = TerminalWatch::new(&Signals::install()?);
            let (written, rows) = import::import(&file, &watch)?;
            writeln!(out, "wrote {}: an LCP of {rows} rows", written.display())?;
            Ok(0)
        }
        Some(Command::Scenarios) => {
            crate::session::write_scenarios(&mut out, &style)?;
            Ok(0)
        }
        Some(Command::Schema) => {
            out.write_all(schema::SCHEMA.as_bytes())?;
            Ok(0)
        }
        Some(Command::Completions { shell }) => {
            let mut script = Vec::new();
            clap_complete::generate(shell, &mut Cli::command(), "stickslip", &mut script);
            out.write_all(&script)?;
            Ok(0)
        }
    }
}

/// `new`: the kinds, or a scenario of one of them and what to type next.
fn begin(kind: Option<&str>, words: &[String], style: &Style, out: &mut dyn Write) -> Result<u8, Failure> {
    let Some(kind) = kind else {
        view::templates::write(out, &new::kinds()?, style)?;
        return Ok(0);
    };
    let watch = TerminalWatch::new(&Signals::install()?);
    let (path, scenario) = new::write(kind, words, &watch)?;
    let file = new::typed(&path);
    let open = format!("  stickslip {file}");
    let wide = open.chars().count() + 4;
    let lines = [
        format!("wrote {}: {}", path.display(), scenario.title),
        format!("{open:<wide$}  opens it at the prompt, solved"),
        format!("  stickslip tui {file}  shows it in the full screen, to vary it"),
    ];
    for line in lines {
        writeln!(out, "{}", style.text(&line))?;
    }
    Ok(0)
}

/// A scenario named on the command line.
fn named(word: &str, watch: &TerminalWatch) -> Result<Scenario, CommandError> {
    let scenario = if word == "-" { load::stdin(watch) } else { load::scenario(word, watch) };
    watch.clear();
    scenario
}

fn solve(arguments: &Solve, style: &Style, out: &mut dyn Write) -> Result<u8, Failure> {
    let signals = Signals::install()?;
    let watch = TerminalWatch::new(&signals);
    let scenario = named(&arguments.scenario, &watch)?;
    let session = Session::with_settings(scenario, &arguments.settings.words(), &watch);
    watch.clear();
    let mut session = session?;
    if !arguments.at_once && !session.scenario().stages.is_empty() {
        let history = session.follow_stages(&watch);
        watch.clear();
        return write_history(&session, &*history?, arguments, style, out);
    }
    let Some(answer) = session.answer() else {
        return Err(Failure::Status(4, "no answer".to_owned()));
    };
    match arguments.format {
        Form::Json => {
            let result = session.result(arguments.timings).unwrap_or_default();
            writeln!(out, "{}", json_export::pretty(&result)?)?;
        }
        Form::Text => write_answer(&session, answer, arguments.timings, style, out)?,
    }
    out.flush()?;
    Ok(exit_status(answer))
}

/// The end of a load history, and its stages.
fn write_history(
    session: &Session,
    history: &History,
    arguments: &Solve,
    style: &Style,
    out: &mut dyn Write,
) -> Result<u8, Failure> {
    let scenario = session.scenario();
    let nothing = || Failure::Status(4, "no answer".to_owned());
    let answer = history.answer().ok_or_else(nothing)?;
    if arguments.format == Form::Json {
        let result = session.result(arguments.timings).ok_or_else(nothing)?;
        writeln!(out, "{}", json_export::pretty(&result)?)?;
    } else {
        let note = "the load history was followed, this is its end (`--at-once`: all load cases at once)";
        view::stages::write_line(out, note, style)?;
        if arguments.settings.has_rules() {
            let note = "the covering, the tie-break and the engine chosen do not reach its rate problems: they are solved \
                        under the default rules";
            view::stages::write_line(out, note, style)?;
        }
        view::status::write(out, answer, scenario, session.values(), style)?;
        writeln!(out)?;
        view::stages::write(out, history, &scenario.units, style)?;
        writeln!(out)?;
        view::pairs::write(out, &answer.pairs, &scenario.units, style)?;
        if let Some(ray) = &answer.ray {
            writeln!(out)?;
            view::ray::write(out, ray, &scenario.units, style)?;
        }
        if arguments.timings {
            write_timings(answer, out)?;
        }
    }
    out.flush()?;
    Ok(exit_status(answer))
}

fn write_timings(answer: &Answer, out: &mut dyn Write) -> io::Result<()> {
    let t = &answer.timings;
    writeln!(
        out,
        "\nfactor {:.6} s, condense {:.6} s, lemke {:.6} s, total {:.6} s",
        t.factor, t.condense, t.lemke, t.total
    )
}

fn sweep(arguments: &SweepArguments, style: &Style, out: &mut dyn Write) -> Result<u8, Failure> {
    let signals = Signals::install()?;
    let watch = TerminalWatch::new(&signals);
    let scenario = named(&arguments.scenario, &watch)?;
    let session = Session::with_settings(scenario, &arguments.settings.words(), &watch);
    watch.clear();
    let session = session?;
    let request = sweep::SweepRequest {
        axes: &arguments.axes,
        shard: arguments.shard,
        format: arguments.format.map(|rows| match rows {
            Rows::Csv => sweep::Format::Csv,
            Rows::Json => sweep::Format::Json,
        }),
        out: arguments.out.as_deref(),
        resume: arguments.resume,
        columns: arguments.columns.as_deref(),
    };
    let done = session.sweep_into(&request, out, &watch);
    watch.clear();
    let done = done?;
    if let Some(path) = &arguments.out {
        writeln!(out, "{}", style.text(&sweep::done_sentence(&done, path)))?;
    }
    Ok(if done.is_complete() { 0 } else { 130 })
}

fn merge(files: &[PathBuf], to: Option<&Path>, style: &Style, out: &mut dyn Write) -> Result<u8, Failure> {
    let watch = TerminalWatch::new(&Signals::install()?);
    let rows = sweep::merge(files, to, out, &watch)?;
    if let Some(path) = to {
        writeln!(out, "{}", style.text(&format!("{rows} rows written to {}", path.display())))?;
    }
    Ok(0)
}

/// Status, pivots, pairs, ray: what one wants to see of an answer at once.
fn write_answer(
    session: &Session,
    answer: &Answer,
    timings: bool,
    style: &Style,
    out: &mut dyn Write,
) -> Result<(), Failure> {
    let scenario = session.scenario();
    let units = &scenario.units;
    view::status::write(out, answer, scenario, session.values(), style)?;
    if !answer.pivots.is_empty() {
        writeln!(out)?;
        view::pivots::write(out, answer, None, None, units, style)?;
    }
    writeln!(out)?;
    if answer.solution.is_some() || !answer.pairs.is_empty() {
        session.write_pairs(out, style)?;
    }
    if let Some(ray) = &answer.ray {
        writeln!(out)?;
        view::ray::write(out, ray, units, style)?;
    }
    if timings {
        write_timings(answer, out)?;
    }
    Ok(())
}

fn replay(arguments: &Replay, style: Style, out: &mut dyn Write) -> Result<u8, Failure> {
    let signals = Signals::install()?;
    let watch = TerminalWatch::new(&signals);
    let stdin = arguments.script == Path::new("-");
    let name = if stdin { "stdin".to_owned() } else { arguments.script.display().to_string() };
    let text = load::script((!stdin).then_some(arguments.script.as_path()), &watch)?;
    let mut session = Session::new(load::scenario(embedded::DEFAULT, &watch)?, &watch)?;
    let format = match arguments.format {
        Form::Text => Format::Text,
        Form::Json => Format::JsonLines,
    };
    let errors = Style { color: style.color && io::stderr().is_terminal(), ..style };
    let mut io = Output::new(out, style, format, &watch);
    io.echo = arguments.echo;
    let ended = script::run(&mut session, &name, &text, arguments.keep_going, &mut io, &mut |error| {
        watch.clear();
        tell(&errors, &error.to_string());
    });
    watch.clear();
    Ok(ended?.status)
}

/// What is wrong with a checked file: on stderr, and for JSON at the end.
fn tell_problem(name: &str, error: CommandError, style: &Style, wrong: &mut Vec<Problems>) -> io::Result<()> {
    for line in error.to_string().lines() {
        writeln!(io::stderr(), "{}", style.text(line))?;
    }
    wrong.push(match error {
        CommandError::Scenario(problems) => problems,
        error => Problems::of_file(name, error.to_string(), ""),
    });
    Ok(())
}

fn check(names: &[String], format: Form, style: &Style, out: &mut dyn Write) -> Result<u8, Failure> {
    let signals = Signals::install()?;
    let watch = TerminalWatch::new(&signals);
    let mut checked = Vec::new();
    let mut wrong = Vec::new();
    for name in names {
        if mesh::is_mesh_name(Path::new(name)) {
            match load::mesh(name, &watch) {
                Ok((mesh, overview)) if format == Form::Json => {
                    checked.push(mesh_export::overview(name, &mesh, &overview));
                }
                Ok((mesh, overview)) => view::mesh::write(out, name, &mesh, &overview, style)?,
                Err(error) if error.is_interrupted() => return Err(error.into()),
                Err(error) => tell_problem(name, error, style, &mut wrong)?,
            }
            continue;
        }
        let looked = named(name, &watch).and_then(|scenario| diagnose(scenario, &watch));
        watch.clear();
        match looked {
            Ok(of) if format == Form::Json => {
                let warnings: Vec<Value> = of.warnings.iter().map(|of| json_export::problem(name, of)).collect();
                checked.push(json!({
                    "scenario": name, "title": of.title, "notes": of.notes, "loose": of.loose, "warnings": warnings,
                }));
            }
            Ok(of) => {
                writeln!(out, "{}", style.text(&format!("{name}: no problems found ({})", of.title)))?;
                for note in of.notes {
                    for line in style.hanging("note: ", &style.text(&note)) {
                        writeln!(out, "{line}")?;
                    }
                }
                view::status::write_loose(out, &of.loose, style)?;
                view::warnings::write(out, name, &of.warnings, style)?;
            }
            Err(error) if error.is_interrupted() => return Err(error.into()),
            Err(error) => tell_problem(name, error, style, &mut wrong)?,
        }
    }
    if format == Form::Json {
        let mut report = json!({ "checked": checked });
        if let (false, Value::Object(report), Value::Object(error)) =
            (wrong.is_empty(), &mut report, json_export::problems(&wrong))
        {
            report.extend(error);
        }
        writeln!(out, "{}", json_export::pretty(&report)?)?;
    }
    out.flush()?;
    if wrong.is_empty() { Ok(0) } else { Err(Failure::Told(2)) }
}
