//! How the output looks, from the options and from what the terminal can do.

use std::ffi::OsString;
use std::io::IsTerminal;

use clap::{Args, ValueEnum};

use crate::signals::{DUMB, is_dumb, terminal_width};
use crate::view::style::Style;

/// How the output looks.
#[derive(Args, Clone, Debug)]
pub struct Look {
    /// Colours: never on a pipe or with NO_COLOR, unless `always`
    #[arg(long, global = true, value_enum, default_value_t = Color::Auto, value_name = "WHEN")]
    color: Color,
    /// Plain ASCII only
    #[arg(long, global = true)]
    ascii: bool,
    /// Columns of the output; otherwise those of the terminal, or 80
    #[arg(long, global = true, value_name = "N", value_parser = clap::value_parser!(u16).range(20..=1000))]
    width: Option<u16>,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum Color {
    Auto,
    Always,
    Never,
}

impl Look {
    /// The style for a stream.
    pub fn style(&self, stream: &impl IsTerminal) -> Style {
        let terminal = stream.is_terminal();
        let color = match self.color {
            Color::Always => true,
            Color::Never => false,
            Color::Auto => terminal && variable("NO_COLOR").is_none() && !is_dumb(),
        };
        let width = match self.width {
            Some(width) => usize::from(width),
            None if terminal => terminal_width(),
            None => 80,
        };
        Style { width, color, ascii: self.why_ascii().is_some() }
    }

    /// Why only ASCII is written.
    pub(super) fn why_ascii(&self) -> Option<String> {
        if self.ascii { Some("--ascii".to_owned()) } else { why_ascii(&variable) }
    }

    /// Why a stream without colours has none.
    pub(super) fn why_no_color(&self, terminal: bool) -> String {
        match self.color {
            Color::Never => "--color never",
            _ if !terminal => "stdout is not a terminal",
            _ if is_dumb() => DUMB,
            _ => "NO_COLOR is set",
        }
        .to_owned()
    }
}

/// The text of a variable of the environment that is set to something.
pub(super) fn variable(name: &str) -> Option<String> {
    std::env::var_os(name).filter(|value| !value.is_empty()).map(|value| value.to_string_lossy().into_owned())
}

/// Why Unicode would come out wrong: the locale, as far as one is named, is not UTF-8, or it is the console of Linux,
/// whose font lacks most of what is drawn.
fn why_ascii(variable: &dyn Fn(&str) -> Option<String>) -> Option<String> {
    // the first that is set decides, as POSIX says
    let locale = ["LC_ALL", "LC_CTYPE", "LANG"].into_iter().find_map(|name| Some((name, variable(name)?)));
    let is_utf8 = |locale: &str| {
        let locale = locale.to_ascii_lowercase();
        locale.contains("utf-8") || locale.contains("utf8")
    };
    match locale {
        Some((name, locale)) if !is_utf8(&locale) => Some(format!("{name}={locale} is not UTF-8")),
        _ if variable("TERM").as_deref() == Some("linux") => Some("TERM=linux: its font lacks them".to_owned()),
        _ => None,
    }
}

/// Whether help and errors of usage are written in ASCII; there may be no [`Look`] to ask.
pub(super) fn is_ascii(arguments: &[OsString]) -> bool {
    arguments.iter().any(|word| word == "--ascii") || why_ascii(&variable).is_some()
}

#[cfg(test)]
mod tests {
    use super::why_ascii;

    #[test]
    fn the_locale_decides_in_the_order_of_posix() {
        for (set, ascii) in [
            (&[][..], false),
            (&[("LANG", "C")], true),
            (&[("LANG", "POSIX")], true),
            (&[("LANG", "de_DE")], true),
            (&[("LANG", "de_DE.ISO-8859-1")], true),
            (&[("LANG", "C.UTF-8")], false),
            (&[("LANG", "en_US.utf8")], false),
            (&[("LANG", "de_DE.UTF-8@euro")], false),
            (&[("LANG", "C"), ("LC_CTYPE", "C.UTF-8")], false),
            (&[("LANG", "C.UTF-8"), ("LC_ALL", "C")], true),
            (&[("LANG", "C.UTF-8"), ("LC_CTYPE", "C"), ("LC_ALL", "C.UTF-8")], false),
            (&[("LANG", "C.UTF-8"), ("TERM", "linux")], true),
            (&[("TERM", "xterm-256color")], false),
        ] {
            let variable =
                |name: &str| set.iter().find(|(known, _)| *known == name).map(|(_, value)| (*value).to_owned());
            assert_eq!(why_ascii(&variable).is_some(), ascii, "{set:?}");
        }
    }
}
