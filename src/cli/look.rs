//! How the output looks, from the options and from what the terminal can do.

use std::io::IsTerminal;

use clap::{Args, ValueEnum};

use crate::signals::{is_dumb, terminal_width};
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
        Style { width, color, ascii: self.ascii || is_ascii_terminal(&variable) }
    }
}

/// The text of a variable of the environment that is set to something.
fn variable(name: &str) -> Option<String> {
    std::env::var_os(name).filter(|value| !value.is_empty()).map(|value| value.to_string_lossy().into_owned())
}

/// Whether Unicode would come out wrong: the locale, as far as one is named, is not UTF-8, or it is the console of
/// Linux, whose font lacks most of what is drawn.
fn is_ascii_terminal(variable: &dyn Fn(&str) -> Option<String>) -> bool {
    // the first that is set decides, as POSIX says
    let locale = ["LC_ALL", "LC_CTYPE", "LANG"].into_iter().find_map(variable);
    let is_utf8 = |locale: String| {
        let locale = locale.to_ascii_lowercase();
        locale.contains("utf-8") || locale.contains("utf8")
    };
    locale.is_some_and(|locale| !is_utf8(locale)) || variable("TERM").as_deref() == Some("linux")
}

#[cfg(test)]
mod tests {
    use super::is_ascii_terminal;

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
            assert_eq!(is_ascii_terminal(&variable), ascii, "{set:?}");
        }
    }
}
