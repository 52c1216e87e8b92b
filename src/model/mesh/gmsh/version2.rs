//! `$Nodes` and `$Elements` of version 2.2.

use super::super::raw::RawMesh;
use super::super::source::{Form, Item, Source};
use super::super::{MeshProblem, Place};
use super::{Kind, in_order, kind_of};

/// A number of a node or element.
fn tag(source: &mut Source<'_>, what: &str) -> Result<u64, MeshProblem> {
    let found = source.integer(what)?;
    u64::try_from(found).map_err(|_| {
        source.problem(format!("{what} is {found} in {}, expected one from 0", source.item), "save the mesh again")
    })
}

/// A count, which stands on a line of its own in every file.
fn count(source: &mut Source<'_>, what: &'static str, bytes_each: usize) -> Result<usize, MeshProblem> {
    source.item = Item::Section("the file");
    let line = source.text_line().unwrap_or("the end of the file");
    let count = line
        .parse::<u64>()
        .map_err(|_| source.line_problem(&format!("how many {what} follow"), line, "save the mesh again"))?;
    if source.form != Form::Text {
        source.end_text_line();
    }
    source.fits(count, &format!("the number of {what}"), bytes_each)
}

pub fn nodes(source: &mut Source<'_>, mesh: &mut RawMesh) -> Result<(), MeshProblem> {
    let each = if source.form == Form::Text { 8 } else { 28 };
    for _ in 0..count(source, "nodes", each)? {
        source.record(Item::Section("the nodes"));
        let tag = tag(source, "the number of a node")?;
        source.item = Item::One("node", tag);
        let position = [source.double("x")?, source.double("y")?, source.double("z")?];
        mesh.add_node(tag, position, source.place())?;
        source.end_of_record()?;
    }
    source.item = Item::Section("the nodes");
    Ok(())
}

pub fn elements(source: &mut Source<'_>, mesh: &mut RawMesh) -> Result<(), MeshProblem> {
    let mut left = count(source, "elements", if source.form == Form::Text { 6 } else { 8 })?;
    while left > 0 {
        source.record(Item::Section("the elements"));
        if source.form == Form::Text {
            let tag = tag(source, "the number of an element")?;
            source.item = Item::One("element", tag);
            let kind = source.integer("the type")?;
            let kind = kind_of(source, kind)?;
            let tags = source.integer("the number of tags")?;
            element(source, mesh, tag, &kind, tags)?;
            source.end_of_record()?;
            left -= 1;
            continue;
        }
        // A block of elements of one type.
        let kind = source.integer("the type of a block")?;
        let kind = kind_of(source, kind)?;
        let many = source.integer("the number of elements of a block")?;
        let tags = source.integer("the number of tags of a block")?;
        let many = usize::try_from(many).ok().filter(|many| (1..=left).contains(many)).ok_or_else(|| {
            source.problem(
                format!("a block is said to have {many} elements, where {left} are left"),
                "the file is damaged: save the mesh again",
            )
        })?;
        for _ in 0..many {
            source.item = Item::Section("the elements");
            let tag = tag(source, "the number of an element")?;
            source.item = Item::One("element", tag);
            element(source, mesh, tag, &kind, tags)?;
        }
        left -= many;
    }
    source.item = Item::Section("the elements");
    Ok(())
}

/// Tags and nodes of an element: the first tag is its physical group, 0 for none.
fn element(source: &mut Source<'_>, mesh: &mut RawMesh, tag_: u64, kind: &Kind, tags: i64) -> Result<(), MeshProblem> {
    let mut group = 0;
    if tags < 0 {
        return Err(source.problem(
            format!("{} is said to have {tags} tags, expected a number from 0", source.item),
            "the file is damaged: save the mesh again",
        ));
    }
    for k in 0..tags {
        let found = source.integer("a tag")?;
        if k == 0 {
            group = found.abs();
        }
    }
    let groups: &[i64] = if group == 0 { &[] } else { &[group] };
    let place: Place = source.place();
    match kind {
        Kind::Point => {
            let node = tag(source, "the number of its node")?;
            mesh.add_point(node, groups, place);
            Ok(())
        }
        Kind::Element(shape) => {
            let mut nodes = [0; 20];
            let nodes = &mut nodes[..shape.nodes()];
            for node in nodes.iter_mut() {
                *node = tag(source, "the number of a node")?;
            }
            in_order(*shape, nodes);
            mesh.add_element(tag_, *shape, nodes, place);
            mesh.put_in_groups(*shape, groups, place);
            Ok(())
        }
    }
}
