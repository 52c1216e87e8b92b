//! How far a working scheme holds.

use std::io::{self, Write};

use super::style::Style;
use crate::explain::margin::{Margin, Turn};
use crate::text::number::short;

fn turn_words(turn: &Turn) -> String {
    format!("{}: pair {} {}", short(turn.at), turn.pair, turn.what)
}

/// Writes, for each load factor and friction parameter, the next turn of any pair and of this one.
pub fn write(out: &mut dyn Write, id: &str, margins: &[Margin], style: &Style) -> io::Result<()> {
    for margin in margins {
        let how = if margin.exact { "" } else { " (by search)" };
        writeln!(out, "{}", style.text(&format!("{} = {}{how}", margin.parameter, short(margin.present))))?;
        let rows = [
            ("  up, first       ", &margin.up, &margin.own_up),
            ("  down, first     ", &margin.down, &margin.own_down),
        ];
        for (label, first, own) in rows {
            let text = match first {
                Some(turn) => turn_words(turn),
                None if margin.exact => "nothing turns".to_owned(),
                None => "nothing turns in the range searched".to_owned(),
            };
            for line in style.hanging(label, &style.text(&text)) {
                writeln!(out, "{line}")?;
            }
            let same = |a: &Turn, b: &Turn| a.pair == b.pair && a.what == b.what;
            if let Some(own) = own
                && first.as_ref().is_none_or(|first| !same(first, own))
            {
                let text = format!("{} (if no other pair turned before)", turn_words(own));
                let label = format!("    pair {id} itself ");
                for line in style.hanging(&style.text(&label), &style.text(&text)) {
                    writeln!(out, "{line}")?;
                }
            }
        }
    }
    Ok(())
}
