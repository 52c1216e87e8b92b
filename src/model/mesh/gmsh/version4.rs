//! `$Entities`, `$Nodes` and `$Elements` of version 4.1.

use super::super::MeshProblem;
use super::super::raw::RawMesh;
use super::super::source::{Form, Item, Source};
use super::{Groups, Kind, dimension, in_order, kind_of};

/// Counts of a binary section begin after the line of its name.
fn begin(source: &mut Source<'_>, item: Item) {
    if source.form != Form::Text {
        source.end_text_line();
    }
    source.record(item);
}

pub fn entities(source: &mut Source<'_>, groups: &mut Groups) -> Result<(), MeshProblem> {
    const ITEM: Item = Item::Section("the entities");
    begin(source, ITEM);
    let mut counts = [0; 4];
    for (count, what) in counts.iter_mut().zip(["the points", "the curves", "the surfaces", "the volumes"]) {
        *count = source.count(what, 8)?;
    }
    source.end_of_record()?;
    for (dimension, count) in (0_u8..).zip(counts) {
        for _ in 0..count {
            source.record(ITEM);
            let number = source.integer("the number of an entity")?;
            source.item = Item::One("entity", number.unsigned_abs());
            for _ in 0..if dimension == 0 { 3 } else { 6 } {
                source.double("a coordinate")?;
            }
            let many = source.count("the number of groups", 2)?;
            let mut of = Vec::with_capacity(many);
            for _ in 0..many {
                of.push(source.integer("a group")?.abs());
            }
            if dimension > 0 {
                for _ in 0..source.count("the number of bounding entities", 2)? {
                    source.integer("a bounding entity")?;
                }
            }
            source.end_of_record()?;
            groups.of_entity.entry((dimension, number)).or_default().extend(of);
        }
    }
    source.item = ITEM;
    Ok(())
}

pub fn nodes(source: &mut Source<'_>, mesh: &mut RawMesh) -> Result<(), MeshProblem> {
    const ITEM: Item = Item::Section("the nodes");
    begin(source, ITEM);
    let blocks = source.count("the number of blocks", 8)?;
    let each = if source.form == Form::Text { 8 } else { 32 };
    let mut left = source.count("the number of nodes", each)?;
    source.size("the least number of a node")?;
    source.size("the largest number of a node")?;
    source.end_of_record()?;
    for _ in 0..blocks {
        source.record(ITEM);
        let of = source.integer("the dimension of a block")?;
        let of = dimension(source, of)?;
        source.integer("the entity of a block")?;
        let parameters = match source.integer("whether the nodes are parametric")? {
            0 => 0,
            _ => of,
        };
        let many = source.count("the number of nodes of a block", each)?;
        source.end_of_record()?;
        if many > left {
            return Err(source.problem(
                format!("a block is said to have {many} nodes, where {left} are left"),
                "the file is damaged: save the mesh again",
            ));
        }
        left -= many;
        let mut tags = Vec::with_capacity(many);
        for _ in 0..many {
            source.record(ITEM);
            tags.push(source.size("the number of a node")?);
            source.end_of_record()?;
        }
        for tag in tags {
            source.record(Item::One("node", tag));
            let position = [source.double("x")?, source.double("y")?, source.double("z")?];
            for _ in 0..parameters {
                source.double("a parametric coordinate")?;
            }
            mesh.add_node(tag, position, source.place())?;
            source.end_of_record()?;
        }
        source.item = ITEM;
    }
    all_there(source, left, "nodes")
}

pub fn elements(source: &mut Source<'_>, mesh: &mut RawMesh, groups: &Groups) -> Result<(), MeshProblem> {
    const ITEM: Item = Item::Section("the elements");
    begin(source, ITEM);
    let blocks = source.count("the number of blocks", 8)?;
    let each = if source.form == Form::Text { 4 } else { 16 };
    let mut left = source.count("the number of elements", each)?;
    source.size("the least number of an element")?;
    source.size("the largest number of an element")?;
    source.end_of_record()?;
    for _ in 0..blocks {
        source.record(ITEM);
        let of = source.integer("the dimension of a block")?;
        let of = dimension(source, of)?;
        let entity = source.integer("the entity of a block")?;
        let kind = source.integer("the type of a block")?;
        let head = source.place();
        let many = source.count("the number of elements of a block", each)?;
        source.end_of_record()?;
        if many > left {
            return Err(source.problem(
                format!("a block is said to have {many} elements, where {left} are left"),
                "the file is damaged: save the mesh again",
            ));
        }
        left -= many;
        let of_groups = groups.of_entity.get(&(of, entity)).map_or(&[][..], Vec::as_slice);
        for _ in 0..many {
            source.record(ITEM);
            let tag = source.size("the number of an element")?;
            source.item = Item::One("element", tag);
            let place = source.place();
            match kind_of(source, kind)? {
                Kind::Point => mesh.add_point(source.size("its node")?, of_groups, place),
                Kind::Element(shape) if shape.dimension() != of => {
                    return Err(MeshProblem {
                        line: head.line as usize,
                        ..source.problem(
                            format!("element {tag} is {} on an entity of dimension {of}", shape.words()),
                            "the file is damaged: save the mesh again",
                        )
                    });
                }
                Kind::Element(shape) => {
                    let mut nodes = [0; 20];
                    let nodes = &mut nodes[..shape.nodes()];
                    for node in nodes.iter_mut() {
                        *node = source.size("a node")?;
                    }
                    in_order(shape, nodes);
                    mesh.add_element(tag, shape, nodes, place);
                    mesh.put_in_groups(shape, of_groups, place);
                }
            }
            source.end_of_record()?;
        }
        source.item = ITEM;
    }
    all_there(source, left, "elements")
}

/// The counts of the blocks and the count of all must agree.
fn all_there(source: &Source<'_>, missing: usize, what: &str) -> Result<(), MeshProblem> {
    if missing == 0 {
        return Ok(());
    }
    Err(source.problem(
        format!("{missing} {what} fewer are in the blocks than are said to be in all of them"),
        "the file is damaged: save the mesh again",
    ))
}
