//! Text of a scenario → checked [`Scenario`], collecting every problem on the way.

mod bars;
mod bricks;
mod builder;
mod contact_system;
mod contacts;
mod declared;
mod edges;
mod elements;
mod face_sides;
mod findings;
mod foundations;
mod law;
mod lcp;
mod loads;
mod matrix_file;
mod matrix_market;
mod measured;
mod mesh_elements;
mod mesh_names;
mod meshes;
mod name_table;
mod names;
mod numbers;
mod parameters;
mod plates;
mod polygon;
mod reader;
mod rigid;
mod sides;
mod single_elements;
mod spot;
mod springs;
mod stages;
mod structure;
mod superelement;
mod supports;
#[cfg(test)]
mod tests;
mod ties;

use std::cell::RefCell;
use std::path::PathBuf;
use std::sync::Arc;

use super::dimension::Dimension;
use super::locate::{Document, position};
use super::mesh::MeshFiles;
use super::parameter::ParameterValues;
use super::problem::{Problem, Problems};
use super::rules::{Covering, Engine, Rules, TieBreak, UnknownChoice};
use super::scenario::{FORMAT, Places, Scenario, Source};
use super::units::Units;
use super::uses::Uses;
use super::words::{self, quoted};
use reader::{Cursor, Entry, Fields, Reading};

/// Keys of any scenario.
const COMMON: [&str; 12] = [
    "$schema",
    "format",
    "dimension",
    "title",
    "description",
    "units",
    "parameters",
    "stages",
    "combinations",
    "probes",
    "measured",
    "solver",
];

/// Keys of `solver`.
const SOLVER: [&str; 5] = ["covering", "tie_break", "engine", "facets", "cone"];

/// Keys of the other two sources.
const OTHER_SOURCES: [&str; 2] = ["contact_system", "lcp"];

/// What a text is read for.
#[derive(Clone, Default)]
pub struct Under<'a> {
    /// Values of the parameters; without them those of the file.
    pub values: Option<&'a ParameterValues>,
    /// The parameter along which the numbers of [`Region::Amount`](crate::model::uses::Region::Amount) are read as
    /// rates, in place of their values.
    pub along: Option<&'a str>,
    /// Mesh files that were read already.
    pub meshes: MeshFiles,
}

/// Checks the text of a scenario.
pub fn scenario(name: &str, text: &str, path: Option<PathBuf>, mut under: Under<'_>) -> Result<Scenario, Problems> {
    let document = Document::parse(text).map_err(|error| {
        let (line, column) = position(text, error.offset);
        Problems {
            file: name.to_string(),
            problems: vec![Problem {
                line,
                column,
                path: String::new(),
                message: error.message,
                help: error.help.to_string(),
            }],
            more: 0,
        }
    })?;
    let meshes = RefCell::new(std::mem::take(&mut under.meshes));
    let reading = Reading { path: path.clone(), meshes, ..Reading::default() };
    let decoded = read(Cursor::root(&document, &reading), name, text, path, &under);
    let parameters = reading.parameters.into_inner().unwrap_or_default();
    match (reading.findings.into_problems(name, &document), decoded) {
        (None, Some(mut scenario)) => {
            let places = reading.uses.into_inner();
            let places = places.into_iter().map(|((name, region), offset)| (name, region, document.path_at(offset)));
            scenario.uses = Uses::new(places, parameters.formulas());
            scenario.meshes = reading.meshes.into_inner();
            Ok(scenario)
        }
        (Some(problems), _) => Err(problems),
        // Whatever is missing was reported; this is said in case that rule is ever broken.
        (None, None) => Err(Problems::of_file(
            name,
            "the scenario could not be read, and no reason was recorded",
            "please report this as a fault of the program",
        )),
    }
}

fn read(root: Cursor<'_>, name: &str, text: &str, path: Option<PathBuf>, under: &Under<'_>) -> Option<Scenario> {
    let known: Vec<&'static str> = COMMON.into_iter().chain(structure::keys()).chain(OTHER_SOURCES).collect();
    let fields = root.fields(&known)?;
    format(&fields);
    let title = title(&fields);
    let description = match fields.optional("description") {
        Some(cursor) => cursor.string().map(str::to_string),
        None => None,
    };
    let units = fields.optional("units").and_then(units).unwrap_or_default();
    let _ = fields.optional("$schema").map(Cursor::string);
    if let Some(cursor) = fields.optional("parameters") {
        // Nothing has asked for them before.
        let _ = root.reading.parameters.set(parameters::read(cursor, under));
    }
    read_dimension(&fields);
    let solver = fields.optional("solver");
    let rules = solver.and_then(rules).unwrap_or_default();

    let mut places = Places::default();
    let mut notes = Vec::new();
    let source = match source_key(&fields)? {
        SourceKey::Structure => {
            let found = structure::read(&fields, path.as_deref())?;
            (places, notes) = (found.places, found.notes);
            Source::Structure(found.structure)
        }
        SourceKey::ContactSystem(cursor) => {
            let system = contact_system::read(cursor, path.as_deref())?;
            places.pairs = (0..system.pairs.len()).map(|pair| format!("contact_system.pairs[{pair}]").into()).collect();
            Source::ContactSystem(system)
        }
        SourceKey::Lcp(cursor) => {
            refuse_covering(solver);
            Source::Lcp(lcp::read(cursor, path.as_deref())?)
        }
    };
    let cases: Option<Vec<&str>> = match &source {
        Source::Structure(structure) => Some(structure.load_cases.iter().map(|case| case.name.as_str()).collect()),
        Source::ContactSystem(system) => Some(system.loads.iter().map(|load| load.name.as_str()).collect()),
        Source::Lcp(_) => None,
    };
    // One that could not be read is known all the same: what is wrong with it was said there.
    let cases = cases.map(|cases| named_besides(cases, &fields));
    if source.dimension() == Dimension::Plane {
        polygon::refuse_in_plane(solver, &SOLVER);
    }
    let stages = with_cases(&fields, "stages", cases.as_deref(), stages::read);
    let combinations = with_cases(&fields, "combinations", cases.as_deref(), stages::combinations);
    let mut scenario = Scenario {
        name: name.to_string(),
        path,
        text: text.to_string(),
        title: title?.to_string(),
        description,
        units,
        parameters: root.parameters().complete()?,
        source,
        stages: stages?,
        combinations: combinations?,
        probes: Vec::new(),
        measured: Vec::new(),
        rules,
        places,
        formulas: Arc::new(root.parameters().formulas().clone()),
        uses: Uses::default(),
        meshes: MeshFiles::default(),
        notes,
    };
    if root.problems_so_far() > 0 {
        // Quantities name pairs, nodes and bars, of which some could not be read.
        return Some(scenario);
    }
    scenario.probes = match fields.optional("probes") {
        Some(cursor) => measured::probes(cursor, &scenario)?,
        None => Vec::new(),
    };
    scenario.measured = match fields.optional("measured") {
        Some(cursor) => measured::measured(cursor, &scenario)?,
        None => Vec::new(),
    };
    Some(scenario)
}

/// The names of load cases with those besides that only the file has.
fn named_besides<'n>(mut cases: Vec<&'n str>, fields: &Fields<'n>) -> Vec<&'n str> {
    let of_system = fields.entry("contact_system").and_then(|entry| entry.value().get("loads"));
    let loads = fields.entry("loads").map(Entry::value).or(of_system);
    for name in loads.into_iter().flat_map(Cursor::names) {
        if !cases.contains(&name) {
            cases.push(name);
        }
    }
    cases
}

/// What a key says of the load cases; empty without the key. An lcp has none.
fn with_cases<'d, T>(
    fields: &Fields<'d>,
    key: &str,
    cases: Option<&[&str]>,
    read: impl Fn(Entry<'d>, &[&str]) -> Option<Vec<T>>,
) -> Option<Vec<T>> {
    match (fields.entry(key), cases) {
        (None, _) => Some(Vec::new()),
        (Some(entry), Some(cases)) => read(entry, cases),
        (Some(entry), None) => {
            entry.key_problem(format!("an lcp has no `{key}`: it has no load cases"), format!("remove `{key}`"));
            None
        }
    }
}

fn format(fields: &Fields<'_>) {
    let Some(cursor) = fields.required("format") else {
        return;
    };
    if let Some(word) = cursor.string()
        && word != FORMAT
    {
        cursor.problem(
            format!("unknown format {}, expected \"{FORMAT}\"", quoted(word)),
            format!("this version of the program reads \"{FORMAT}\" only"),
        );
    }
}

/// Whether points and vectors have two numbers or three.
fn read_dimension(fields: &Fields<'_>) {
    let Some(cursor) = fields.optional("dimension") else { return };
    if OTHER_SOURCES.into_iter().find_map(|key| fields.entry(key)).is_some_and(|other| other.name() == "lcp") {
        cursor.problem("`dimension` is that of a structure or of a contact system, and this is an lcp", "remove it");
        return;
    }
    // What is meant is clear: nothing that follows from the quotation marks is to be told as well.
    if let Some(word) =
        Some(cursor).filter(|at| at.is_string()).and_then(Cursor::string).filter(|word| ["2", "3"].contains(word))
    {
        cursor.problem(format!("expected a number, found \"{word}\""), format!("write {word}, a number"));
        if word == "3" {
            cursor.reading.dimension.set(Dimension::Space);
        }
        return;
    }
    match cursor.whole("dimension", 2) {
        Some(2) => {}
        Some(3) => cursor.reading.dimension.set(Dimension::Space),
        Some(_) => cursor.problem(
            format!("dimension must be 2 or 3, found {}", cursor.found()),
            "write 2 for a structure in the plane, 3 for one in space",
        ),
        None => {}
    }
}

fn title<'d>(fields: &Fields<'d>) -> Option<&'d str> {
    let cursor = fields.required("title")?;
    let title = cursor.string()?;
    if title.trim().is_empty() {
        cursor.problem("the title is empty", "say in a few words what this is");
        return None;
    }
    Some(title)
}

fn units(cursor: Cursor<'_>) -> Option<Units> {
    let fields = cursor.fields(&["length", "force"])?;
    let label = |key| fields.optional(key).and_then(Cursor::string).map(str::to_string);
    Some(Units { length: label("length"), force: label("force") })
}

fn rules(cursor: Cursor<'_>) -> Option<Rules> {
    let fields = cursor.fields(&SOLVER)?;
    Some(Rules {
        covering: rule::<Covering>(&fields, "covering"),
        tie_break: rule::<TieBreak>(&fields, "tie_break"),
        engine: rule::<Engine>(&fields, "engine"),
        facets: polygon::facets(&fields),
        cone: polygon::cone(&fields),
    })
}

fn rule<T: Default + std::str::FromStr<Err = UnknownChoice>>(fields: &Fields<'_>, key: &str) -> T {
    let Some(cursor) = fields.optional(key) else {
        return T::default();
    };
    let Some(word) = cursor.string() else {
        return T::default();
    };
    word.parse().unwrap_or_else(|error: UnknownChoice| {
        cursor.problem(format!("unknown {} {}", error.what, quoted(word)), format!("expected {}", error.expected));
        T::default()
    })
}

fn refuse_covering(solver: Option<Cursor<'_>>) {
    let Some(fields) = solver.filter(|cursor| cursor.is_object()).and_then(|cursor| cursor.fields(&SOLVER)) else {
        return;
    };
    fields.refuse(
        &["covering"],
        |_| "an lcp has no `solver.covering`: it has no contact pairs".into(),
        "remove it; the vector d itself can be given as `lcp.covering`",
    );
}

enum SourceKey<'d> {
    Structure,
    ContactSystem(Cursor<'d>),
    Lcp(Cursor<'d>),
}

/// Which of the three sources the file describes; a mixture and nothing at all are reported.
fn source_key<'d>(fields: &Fields<'d>) -> Option<SourceKey<'d>> {
    let structure = structure::keys().find_map(|key| fields.entry(key));
    let system = fields.entry("contact_system");
    let lcp = fields.entry("lcp");
    let mut present: Vec<Entry<'d>> = [structure, system, lcp].into_iter().flatten().collect();
    present.sort_by_key(|entry| entry.key_offset());
    if let [first, second, ..] = present[..] {
        second.key_problem(
            format!(
                "`{}` cannot stand beside `{}`: a scenario describes a structure, a contact system or an lcp, not a mixture",
                second.name(),
                first.name()
            ),
            "keep one of them; put the other into a file of its own",
        );
        return None;
    }
    match (structure, system, lcp) {
        (Some(_), _, _) => Some(SourceKey::Structure),
        (_, Some(system), _) => Some(SourceKey::ContactSystem(system.value())),
        (_, _, Some(lcp)) => Some(SourceKey::Lcp(lcp.value())),
        (None, None, None) => {
            fields.cursor().problem(
                "the scenario describes nothing: expected a structure (`nodes`, `bars`, `plates` …), a `superelement`, a `contact_system` or an `lcp`",
                "add one of them",
            );
            None
        }
    }
}
