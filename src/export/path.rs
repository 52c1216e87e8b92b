//! A followed path as CSV: one row for every place and pair.

use std::io::{self, Write};

use super::csv::quoted;
use crate::path::record::PathRecord;

/// Writes the path in full precision.
pub fn csv(out: &mut dyn Write, path: &PathRecord) -> io::Result<()> {
    write!(out, "stage,value")?;
    for case in &path.cases {
        write!(out, ",{}", quoted(&format!("factor {case}")))?;
    }
    writeln!(out, ",pair,state,x_n,x_t,z_n,z_t,change")?;
    for place in &path.places {
        for pair in &place.pairs {
            let stage = place.stage.map_or(String::new(), |stage| stage.to_string());
            write!(out, "{stage},{}", place.value)?;
            for factor in &place.factors {
                write!(out, ",{factor}")?;
            }
            writeln!(
                out,
                ",{},{},{},{},{},{},{}",
                quoted(&pair.id),
                pair.state.word(),
                pair.x_n,
                pair.x_t,
                pair.z_n,
                pair.z_t,
                quoted(&place.change)
            )?;
        }
    }
    Ok(())
}
