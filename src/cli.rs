//! The program as the shell sees it: arguments, streams, exit statuses. Each subcommand has its file.

mod check;
mod doctor;
mod ending;
mod faces;
mod input;
mod look;
mod manual;
mod new;
mod order;
mod prompt;
mod replay;
mod settings;
mod solve;
mod sweep;

use std::ffi::OsString;
use std::io::{self, Write};

use clap::{CommandFactory, Parser, Subcommand};

pub use ending::finish;
use ending::{Failure, asks_for_json, status, tell_json};
pub use faces::{Next, Start};
use faces::{Serve, Tui, start, start_screen};
use look::Look;

use crate::export::json as json_export;
use crate::model::embedded;
use crate::model::problem::Problems;
use crate::model::schema;
use crate::signals;
use crate::text::printable::{self, Printable};
use crate::view::style::Style;

/// Structures with frictional contact, solved by Lemke's algorithm and explained pivot by pivot
#[derive(Debug, Parser)]
#[command(
    name = "stickslip",
    version,
    args_conflicts_with_subcommands = true,
    after_help = "`stickslip help WORD` also knows the commands of the prompt and the quantities.\n\n\
                  Exit status: 0 an answer, or the command did its job; 1 an `expect` failed; 2 bad usage or input;\n\
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

#[derive(Debug, Subcommand)]
enum Command {
    Solve(solve::Solve),
    Replay(replay::Replay),
    Sweep(sweep::Sweep),
    Merge(sweep::Merge),
    Check(check::Check),
    New(new::New),
    Import(new::Import),
    Tui(Tui),
    Serve(Serve),
    /// List the embedded scenarios
    Scenarios,
    /// Print the JSON Schema of the scenario format
    #[command(after_help = "Example:\n  stickslip schema > stickslip.schema.json")]
    Schema,
    Doctor(doctor::Doctor),
    Completions(manual::Completions),
    #[command(name = "man")]
    Manual(manual::Manual),
}

/// Runs what the arguments of the process ask for, up to the REPL.
pub fn main() -> Next {
    if let Err(error) = signals::survive_limits() {
        return Next::Exit(finish(Err(error), &Style::default()));
    }
    let arguments = order::command_first(&Cli::command(), std::env::args_os().collect());
    if let Some((word, look)) = prompt::asked_help(&arguments) {
        let style = look.style(&io::stdout());
        let written = prompt::write_help(&word, &style, &mut Printable::new(io::stdout(), style.color));
        return Next::Exit(status(written, false, &look.style(&io::stderr())));
    }
    let cli = match Cli::try_parse_from(&arguments) {
        Ok(cli) => cli,
        Err(error) => return Next::Exit(usage(&error, &arguments)),
    };
    let errors = cli.look.style(&io::stderr());
    let failed = |failure| Next::Exit(status(Err(failure), false, &errors));
    match &cli.command {
        None => start(&cli.look, &cli.scenario, errors).map_or_else(failed, |start| Next::Repl(Box::new(start))),
        Some(Command::Tui(Tui { scenario })) => {
            start_screen(&cli.look, scenario, errors).map_or_else(failed, |start| Next::Tui(Box::new(start)))
        }
        Some(Command::Serve(Serve { scenario })) => {
            start(&cli.look, scenario, errors).map_or_else(failed, |start| Next::Serve(Box::new(start)))
        }
        Some(_) => {
            let json = asks_for_json(&arguments);
            Next::Exit(status(run(cli), json, &errors))
        }
    }
}

fn run(cli: Cli) -> Result<u8, Failure> {
    let style = &cli.look.style(&io::stdout());
    let out = &mut Printable::new(io::stdout(), style.color);
    let Some(command) = cli.command else { return Ok(0) };
    match command {
        Command::Tui(_) | Command::Serve(_) => return Ok(0), // `main` starts those
        Command::Solve(solve) => return solve.run(style, out),
        Command::Replay(replay) => return replay.run(style, out),
        Command::Sweep(sweep) => return sweep.run(style, out),
        Command::Merge(merge) => return merge.run(style, out),
        Command::Check(check) => return check.run(style, out),
        Command::New(new) => return new.run(style, out),
        Command::Import(import) => return import.run(style, out),
        Command::Scenarios => crate::session::write_scenarios(out, style)?,
        Command::Schema => out.write_all(schema::SCHEMA.as_bytes())?,
        Command::Doctor(doctor) => return doctor.run(&cli.look, style, out),
        Command::Completions(completions) => return completions.run(Cli::command(), out),
        Command::Manual(manual) => return manual.run(Cli::command(), out),
    }
    Ok(0)
}

/// Help and version go to stdout and are not errors.
fn usage(error: &clap::Error, arguments: &[OsString]) -> u8 {
    let status = u8::try_from(error.exit_code()).unwrap_or(2);
    // the message quotes the arguments: it is made again from their printable form
    let clean = arguments.iter().map(|word| printable::line(&word.to_string_lossy()));
    let shown = Cli::try_parse_from(clean).err().filter(|shown| shown.kind() == error.kind());
    let hint = (status != 0).then(|| prompt::hint(arguments)).flatten();
    if status != 0 && asks_for_json(arguments) {
        let text = hint.clone().unwrap_or_else(|| shown.as_ref().unwrap_or(error).render().to_string());
        let message = text.lines().next().unwrap_or_default().trim_start_matches("error: ");
        tell_json(&json_export::problems(&[Problems::of_file("", message, "")]));
    }
    let plain = Style { ascii: look::is_ascii(arguments), ..Style::default() };
    let printed = match shown {
        _ if let Some(hint) = hint => writeln!(io::stderr(), "error: {}", plain.text(&hint)),
        Some(shown) if plain.ascii => write_ascii(&shown, &plain),
        Some(shown) => shown.print(),
        None => io::stderr().write_all(printable::text(&error.render().to_string(), false).as_bytes()),
    };
    match printed {
        Err(error) if error.kind() != io::ErrorKind::BrokenPipe => 2,
        _ => status,
    }
}

/// Help, version or a usage error where only ASCII can be shown.
fn write_ascii(shown: &clap::Error, style: &Style) -> io::Result<()> {
    let text: String = shown.render().to_string().lines().map(|line| style.text(line) + "\n").collect();
    if shown.use_stderr() { io::stderr().write_all(text.as_bytes()) } else { io::stdout().write_all(text.as_bytes()) }
}
