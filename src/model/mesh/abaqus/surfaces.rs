//! Surfaces: sides of elements, nodes, or other surfaces put together.

use std::collections::{HashMap, HashSet};

use super::cards::{Cards, Keyword, whole};
use super::sets::{Sets, bare};
use super::{MeshProblem, Place};
use crate::model::mesh::raw::{RawMembers, RawMesh};
use crate::model::words::quoted;

/// What a surface is made of.
#[derive(Clone, Copy, PartialEq)]
enum Of {
    Elements,
    Nodes,
    Surfaces,
}

/// A surface as it is read.
pub struct Surface {
    pub name: String,
    pub place: Place,
    of: Of,
    /// A set, a number or a surface, the face, and where it stands.
    items: Vec<(String, Option<String>, Place)>,
}

impl Surface {
    /// From its keyword; `None` where it has nothing to do with the mesh: what it is instead.
    pub fn begin(keyword: &Keyword, cards: &Cards<'_>) -> Result<Result<Surface, String>, MeshProblem> {
        let place = keyword.place;
        let Some(name) = keyword.value("NAME") else {
            return Err(cards.problem(place, "*SURFACE without NAME=", "add NAME=…"));
        };
        let word = |key: &str| keyword.value(key).map(str::to_ascii_uppercase);
        let of = match (word("TYPE").as_deref(), word("COMBINE").as_deref()) {
            (_, Some("UNION")) => Of::Surfaces,
            (_, Some(other)) => {
                return Err(cards.problem(
                    place,
                    format!("the surface \"{name}\" is a {} of others, which is not read", quoted(other)),
                    "surfaces are combined by COMBINE=UNION: write out the faces",
                ));
            }
            (None | Some("ELEMENT"), None) => Of::Elements,
            (Some("NODE"), None) => Of::Nodes,
            (Some(other), None) => return Ok(Err(format!("*SURFACE, TYPE={}", quoted(other).trim_matches('"')))),
        };
        Ok(Ok(Surface { name: name.to_owned(), place, of, items: Vec::new() }))
    }

    /// Reads a data line.
    pub fn read(&mut self, fields: &[String], place: Place) {
        let mut fields = fields.iter().filter(|field| !field.is_empty());
        if self.of == Of::Surfaces {
            self.items.extend(fields.map(|name| (name.clone(), None, place)));
        } else if let Some(of) = fields.next() {
            let face = fields.next().map(|face| face.to_ascii_uppercase());
            self.items.push((of.clone(), face, place));
        }
    }
}

/// What the items of surfaces are found in: elements by number, sets with the numbers of their members.
pub struct Found<'a> {
    pub mesh: &'a RawMesh,
    pub cards: &'a Cards<'a>,
    pub element_of: &'a HashMap<u64, u32>,
    pub element_sets: (&'a Sets, &'a [Vec<u64>]),
    pub node_sets: (&'a Sets, &'a [Vec<u64>]),
}

impl Found<'_> {
    /// The members of every surface.
    pub fn members(&self, surfaces: &[Surface]) -> Result<Vec<RawMembers>, MeshProblem> {
        let mut done: Vec<RawMembers> = Vec::with_capacity(surfaces.len());
        for surface in surfaces {
            done.push(match surface.of {
                Of::Nodes => RawMembers::NodeSet(self.nodes(surface)?),
                Of::Elements => RawMembers::Sides(self.sides(surface)?),
                Of::Surfaces => self.union(surface, surfaces, &done)?,
            });
        }
        Ok(done)
    }

    fn unknown(&self, surface: &Surface, what: &str, of: &str, place: Place) -> MeshProblem {
        self.cards.problem(
            place,
            format!("the surface \"{}\" names the {what} {}, which is not there", surface.name, quoted(of)),
            "define it, or correct the name",
        )
    }

    /// The sides of surfaces that stand before it, each once.
    fn union(&self, surface: &Surface, surfaces: &[Surface], done: &[RawMembers]) -> Result<RawMembers, MeshProblem> {
        let (mut sides, mut seen) = (Vec::new(), HashSet::new());
        for (name, _, place) in &surface.items {
            let named =
                |other: &Surface| other.name.eq_ignore_ascii_case(name) || other.name.eq_ignore_ascii_case(bare(name));
            match surfaces.iter().position(named).and_then(|index| done.get(index)) {
                Some(RawMembers::Sides(of)) => sides.extend(of.iter().copied().filter(|side| seen.insert(*side))),
                Some(_) => {
                    return Err(self.cards.problem(
                        *place,
                        format!("the surface \"{}\" names {}, which consists of nodes", surface.name, quoted(name)),
                        "put surfaces of element sides together",
                    ));
                }
                None => return Err(self.unknown(surface, "surface", name, *place)),
            }
        }
        Ok(RawMembers::Sides(sides))
    }

    fn nodes(&self, surface: &Surface) -> Result<Vec<u64>, MeshProblem> {
        let (sets, members) = self.node_sets;
        let mut tags = Vec::new();
        for (of, _, place) in &surface.items {
            match (sets.find(of), whole(bare(of))) {
                (None, Some(tag)) if self.mesh.node(tag).is_some() => tags.push(tag),
                (Some(set), _) => tags.extend(&members[set]),
                _ => return Err(self.unknown(surface, "node or node set", of, *place)),
            }
        }
        Ok(tags)
    }

    fn sides(&self, surface: &Surface) -> Result<Vec<(u32, Option<u8>)>, MeshProblem> {
        let (sets, members) = self.element_sets;
        let mut sides = Vec::new();
        for (of, face, place) in &surface.items {
            let tags = match (sets.find(of), whole(bare(of))) {
                (None, Some(tag)) if self.element_of.contains_key(&tag) => vec![tag],
                (Some(set), _) => members[set].clone(),
                _ => return Err(self.unknown(surface, "element or element set", of, *place)),
            };
            for tag in tags {
                let index = self.element_of[&tag];
                sides.push((index, self.side(surface, index, face.as_deref(), *place)?));
            }
        }
        Ok(sides)
    }

    /// The corner at which a side of an area begins, or the number of a face of a solid, from 0; `None` for all sides
    /// on the boundary.
    fn side(&self, surface: &Surface, index: u32, face: Option<&str>, place: Place) -> Result<Option<u8>, MeshProblem> {
        let (tag, shape, _) = self.mesh.element(index);
        if shape.dimension() == 1 {
            return Err(self.cards.problem(
                place,
                format!("the surface \"{}\" names element {tag}, which is {}", surface.name, shape.words()),
                "a surface is made of sides of areas or solids",
            ));
        }
        let Some(face) = face else { return Ok(None) };
        let count = if shape.is_solid() { shape.faces().len() } else { shape.corners() };
        let side = face.strip_prefix('S').and_then(whole).filter(|k| (1..=count as u64).contains(k));
        let side = side.ok_or_else(|| {
            self.cards.problem(
                place,
                format!(
                    "the surface \"{}\" names the face {} of element {tag}, which is {}",
                    surface.name,
                    quoted(face),
                    shape.words()
                ),
                match shape.is_solid() {
                    true => format!("its faces are S1 to S{count}"),
                    false => format!("its faces are S1 to S{count}: from each corner to the next"),
                },
            )
        })?;
        Ok(Some(side as u8 - 1))
    }
}
