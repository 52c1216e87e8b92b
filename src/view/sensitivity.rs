//! Tables of derivatives: what one more unit of a parameter does to the pairs.

use std::io::{self, Write};

use super::style::{Role, Style};
use super::table::{Cell, Column, Row, Table};
use crate::answer::rounding::largest;
use crate::path::sensitivity::Sensitivity;

/// Writes the derivatives with respect to each parameter.
pub fn write(out: &mut dyn Write, sensitivity: &Sensitivity, style: &Style) -> io::Result<()> {
    for (k, rate) in sensitivity.parameters.iter().enumerate() {
        if k > 0 {
            writeln!(out)?;
        }
        let title = format!("per unit of {}", rate.parameter);
        writeln!(out, "{}", style.paint(Role::Title, &style.fit(&title, style.width)))?;
        let forces = largest(rate.pairs.iter().flat_map(|pair| [pair.x_n, pair.x_t]));
        let lengths = largest(rate.pairs.iter().flat_map(|pair| [pair.z_n, pair.z_t]));
        if forces == 0.0 && lengths == 0.0 {
            writeln!(out, "nothing: the pairs do not depend on it here")?;
            continue;
        }
        let in_space = rate.pairs.iter().any(|pair| pair.space.is_some());
        let along: &[[&str; 2]] = if in_space { &[["dx_t1", "dx_t2"], ["dz_t1", "dz_t2"]] } else { &[] };
        let [friction, slip] = match along {
            [friction, slip] => [friction.to_vec(), slip.to_vec()],
            _ => [vec!["dx_τ"], vec!["dz_τ"]],
        };
        let mut columns = vec![Column::words("pair"), Column::numbers("dx_n", None).of(1)];
        columns.extend(friction.into_iter().map(|head| Column::numbers(head, None).of(1)));
        columns.push(Column::numbers("dz_n", None).of(2).droppable(1));
        columns.extend(slip.into_iter().map(|head| Column::numbers(head, None).of(2)));
        let mut table = Table::new(columns);
        for pair in &rate.pairs {
            let mut cells = vec![Cell::from(pair.pair.as_str())];
            match pair.space {
                None => cells.extend([pair.x_n, pair.x_t, pair.z_n, pair.z_t].map(Cell::number)),
                Some([[x1, x2], [z1, z2]]) => {
                    cells.extend([pair.x_n, x1, x2, pair.z_n, z1, z2].map(Cell::number));
                }
            }
            table.rows.push(Row::new(cells));
        }
        table.write(out, style)?;
    }
    if !sensitivity.on_limit.is_empty() {
        let text = format!(
            "exactly on a limit: {}; there these derivatives hold to one side only",
            sensitivity.on_limit.join(", ")
        );
        style.paragraph(out, Role::Warning, &text)?;
    }
    Ok(())
}
