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
    let is_in_space = path.places.iter().flat_map(|place| &place.pairs).any(|pair| pair.space.is_some());
    let joints = if is_in_space { "x_n,x_t1,x_t2,z_n,z_t1,z_t2" } else { "x_n,x_t,z_n,z_t" };
    writeln!(out, ",pair,state,{joints},change")?;
    for place in &path.places {
        for pair in &place.pairs {
            let stage = place.stage.map_or(String::new(), |stage| stage.to_string());
            write!(out, "{stage},{}", place.value)?;
            for factor in &place.factors {
                write!(out, ",{factor}")?;
            }
            write!(out, ",{},{}", quoted(&pair.id), pair.state.word())?;
            let forces = std::iter::once(pair.x_n).chain(pair.friction());
            for number in forces.chain([pair.z_n]).chain(pair.slip()) {
                write!(out, ",{number}")?;
            }
            writeln!(out, ",{}", quoted(&place.change))?;
        }
    }
    Ok(())
}
