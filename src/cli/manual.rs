//! `completions`, `man`: what an installation takes from the grammar of the program.

use std::fs;
use std::io::{self, Write};
use std::path::{Path, PathBuf};

use clap::{Args, Command, ValueEnum};

use super::ending::Failure;
use crate::session::CommandError;

/// Print the completions of a shell
#[derive(Args, Debug)]
#[command(after_help = "Example:\n  stickslip completions zsh > ~/.zfunc/_stickslip")]
pub struct Completions {
    /// The shell
    #[arg(value_enum)]
    shell: Shell,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum Shell {
    Bash,
    Elvish,
    Fish,
    Nushell,
    Powershell,
    Zsh,
}

impl Completions {
    pub(super) fn run(&self, mut grammar: Command, out: &mut dyn Write) -> Result<u8, Failure> {
        let mut script = Vec::new();
        let (grammar, to) = (&mut grammar, &mut script);
        match self.shell {
            Shell::Bash => clap_complete::generate(clap_complete::Shell::Bash, grammar, NAME, to),
            Shell::Elvish => clap_complete::generate(clap_complete::Shell::Elvish, grammar, NAME, to),
            Shell::Fish => clap_complete::generate(clap_complete::Shell::Fish, grammar, NAME, to),
            Shell::Nushell => clap_complete::generate(clap_complete_nushell::Nushell, grammar, NAME, to),
            Shell::Powershell => clap_complete::generate(clap_complete::Shell::PowerShell, grammar, NAME, to),
            Shell::Zsh => clap_complete::generate(clap_complete::Shell::Zsh, grammar, NAME, to),
        }
        out.write_all(&script)?;
        Ok(0)
    }
}

const NAME: &str = "stickslip";

/// Print the manual page, or write those of all commands into a folder
#[derive(Args, Debug)]
#[command(after_help = "Examples:\n  stickslip man | man -l -\n  stickslip man ~/.local/share/man/man1")]
pub struct Manual {
    /// Where stickslip.1, stickslip-solve.1 and so on are written; made if need be
    #[arg(value_name = "FOLDER")]
    folder: Option<PathBuf>,
}

impl Manual {
    pub(super) fn run(&self, grammar: Command, out: &mut dyn Write) -> Result<u8, Failure> {
        // `help` of clap would be a page of its own beside every page
        let grammar = grammar.disable_help_subcommand(true);
        let Some(folder) = &self.folder else {
            let mut page = Vec::new();
            clap_mangen::Man::new(grammar).render(&mut page)?;
            out.write_all(&page)?;
            return Ok(0);
        };
        write(&grammar, folder).map_err(|source| CommandError::File {
            doing: "write the manual pages to",
            path: folder.clone(),
            source,
        })?;
        Ok(0)
    }
}

fn write(grammar: &Command, folder: &Path) -> io::Result<()> {
    fs::create_dir_all(folder)?;
    clap_mangen::generate_to(grammar.clone(), folder)
}
