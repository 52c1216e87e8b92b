//! Parse, run, exit status; nothing else.

use std::process::ExitCode;

use stickslip::cli::{self, Next};
use stickslip::repl;

fn main() -> ExitCode {
    ExitCode::from(match cli::main() {
        Next::Exit(status) => status,
        Next::Repl(mut start) => {
            let (style, signals) = (start.style, start.signals.clone());
            let ended = repl::run(&mut start.session, style, &signals);
            start.finish(ended.map(|ended| ended.status))
        }
    })
}
