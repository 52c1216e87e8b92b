//! Results as CSV (RFC 4180): a head line of names, numbers in full precision, CRLF line ends.

use std::io::{self, Write};

use crate::answer::record::Answer;
use crate::model::quantity::Internal;

/// One field: text that is quoted where it must be, or a number.
#[derive(Clone, Copy)]
enum Field<'a> {
    Text(&'a str),
    Number(f64),
    Count(usize),
    Empty,
}

/// Writes the pairs.
pub fn pairs(out: &mut dyn Write, answer: &Answer) -> io::Result<()> {
    use Field::{Empty, Number, Text};
    let is_in_space = answer.pairs.iter().any(|pair| pair.space.is_some());
    head(
        out,
        match is_in_space {
            true => "id,law,state,held,x_n,x_t1,x_t2,z_n,z_t1,z_t2,direction,bound,reserve,x,y,z",
            false => "id,law,state,held,x_n,x_t,z_n,z_t,bound,reserve_plus,reserve_minus,x,y",
        },
    )?;
    let vector = |components: Vec<f64>| components.into_iter().map(Number).collect::<Vec<_>>();
    for pair in &answer.pairs {
        let held = pair.held.map_or(Empty, |held| Text(held.word()));
        let mut fields = vec![Text(&pair.id), Text(pair.law.word()), Text(pair.state.word()), held, Number(pair.x_n)];
        fields.extend(vector(pair.friction()));
        fields.push(Number(pair.z_n));
        fields.extend(vector(pair.slip()));
        fields.extend(match is_in_space {
            true => [pair.direction().map_or(Empty, Number), Number(pair.bound), Number(pair.reserve())],
            false => [Number(pair.bound), Number(pair.reserve_plus), Number(pair.reserve_minus)],
        });
        let place = |axis: usize| pair.position.map_or(Empty, |at| Number(at[axis]));
        fields.extend((0..if is_in_space { 3 } else { 2 }).map(place));
        row(out, &fields)?;
    }
    Ok(())
}

/// Writes the pivots; several tied rows stand in one field, separated by blanks.
pub fn pivots(out: &mut dyn Write, answer: &Answer) -> io::Result<()> {
    use Field::{Count, Empty, Number, Text};
    head(out, "step,entering,leaving,p,ties,pair,joint,from,to,sentence")?;
    for pivot in &answer.pivots {
        let ties = pivot.ties.join(" ");
        let turned = pivot.turned.as_ref();
        let joint = turned.map(|turned| match turned.joint {
            crate::answer::record::TurnedJoint::Normal => "normal",
            crate::answer::record::TurnedJoint::Tangential => "tangential",
        });
        row(
            out,
            &[
                Count(pivot.step),
                Text(&pivot.entering),
                Text(&pivot.leaving),
                Number(pivot.p),
                Text(&ties),
                turned.map_or(Empty, |turned| Text(&turned.pair)),
                joint.map_or(Empty, Text),
                turned.map_or(Empty, |turned| Text(&turned.from)),
                turned.map_or(Empty, |turned| Text(&turned.to)),
                Text(&pivot.sentence),
            ],
        )?;
    }
    Ok(())
}

/// Writes the nodal displacements; only the head line where there are none. A component that a node does not have is
/// empty.
pub fn displacements(out: &mut dyn Write, answer: &Answer) -> io::Result<()> {
    use Field::{Empty, Number, Text};
    let is_in_space = answer.displacements.iter().flatten().any(|node| node.space.is_some());
    head(out, if is_in_space { "node,ux,uy,uz,rx,ry,rz" } else { "node,ux,uy,rz" })?;
    for node in answer.displacements.iter().flatten() {
        let numbers = node.named().into_iter().map(|(_, number)| number.map_or(Empty, Number));
        row(out, &[vec![Text(&node.node)], numbers.collect()].concat())?;
    }
    Ok(())
}

/// Writes the member end forces; only the head line where there are none.
pub fn members(out: &mut dyn Write, answer: &Answer) -> io::Result<()> {
    use Field::{Count, Number, Text};
    let is_in_space = answer.members.iter().flatten().any(|member| member.start.space.is_some());
    let symbols = || Internal::of(is_in_space).iter().map(|which| which.symbol());
    let named = |end: &str| symbols().map(|symbol| format!(",{end}_{symbol}")).collect::<String>();
    head(out, &format!("bar,element{}{}", named("start"), named("end")))?;
    for member in answer.members.iter().flatten() {
        let ends = [member.start, member.end].into_iter().flat_map(|end| end.named());
        let forces = ends.map(|(_, force)| Number(force)).collect();
        row(out, &[vec![Text(&member.bar), Count(member.element)], forces].concat())?;
    }
    Ok(())
}

/// Writes the reactions; only the head line where there are none.
pub fn reactions(out: &mut dyn Write, answer: &Answer) -> io::Result<()> {
    use Field::{Number, Text};
    let is_in_space = answer.reactions.iter().flatten().any(|reaction| reaction.space.is_some());
    head(out, if is_in_space { "node,fx,fy,fz,mx,my,mz" } else { "node,fx,fy,m" })?;
    for reaction in answer.reactions.iter().flatten() {
        let numbers = reaction.named().into_iter().map(|(_, number)| Number(number)).collect();
        row(out, &[vec![Text(&reaction.node)], numbers].concat())?;
    }
    Ok(())
}

fn head(out: &mut dyn Write, names: &str) -> io::Result<()> {
    write!(out, "{names}\r\n")
}

fn row(out: &mut dyn Write, fields: &[Field<'_>]) -> io::Result<()> {
    for (place, field) in fields.iter().enumerate() {
        if place > 0 {
            out.write_all(b",")?;
        }
        match field {
            Field::Text(text) => out.write_all(quoted(text).as_bytes())?,
            // −0 is 0; what is not finite has no number in CSV and stays empty.
            Field::Number(number) if *number == 0.0 => out.write_all(b"0.0")?,
            Field::Number(number) if number.is_finite() => write!(out, "{number:?}")?,
            Field::Number(_) | Field::Empty => {}
            Field::Count(count) => write!(out, "{count}")?,
        }
    }
    out.write_all(b"\r\n")
}

/// A field in quotes if it holds a comma, a quote or a line end; quotes inside are doubled.
pub fn quoted(text: &str) -> std::borrow::Cow<'_, str> {
    if text.contains([',', '"', '\n', '\r']) {
        format!("\"{}\"", text.replace('"', "\"\"")).into()
    } else {
        text.into()
    }
}
