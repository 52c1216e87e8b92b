//! `check`.

use std::io::{self, Write};
use std::path::Path;

use clap::Args;
use serde_json::{Value, json};

use super::ending::Failure;
use super::input::{Form, named};
use crate::export::{json as json_export, mesh as mesh_export};
use crate::model::mesh;
use crate::model::problem::Problems;
use crate::session::{CommandError, diagnose, load};
use crate::signals::{Signals, TerminalWatch};
use crate::view;
use crate::view::style::Style;

/// Find every problem in scenario files, solving nothing; list what a mesh file holds
///
/// Also names the parts that only contact holds, with their motions: where those are not wanted, a support is missing.
/// Warns of what is allowed and hardly meant: a stiffness or weight that no material of that name has under the named
/// units, sections and parameters in other units, normals that point down under what stands on the ground, parameters,
/// materials and sections that nothing uses, loads on nothing, contacts that no load case presses while every joint is
/// held. Warnings leave the exit status as it is. Of large structures the motions of the parts are looked at first;
/// where they do not tell whether the loads press every contact, or whether a part moves in itself, the numbers are
/// asked, for 10 s at most. Of a mesh (.msh, .inp): nodes, elements, groups with lengths and areas, the boundary by
/// direction, and the worst element. Quality is the least sine of a corner's angle (of triangles by that of 60°): 1 is
/// best, 0 degenerate.
#[derive(Args, Debug)]
pub struct Check {
    /// Files, embedded scenarios or meshes; `-` reads a scenario from stdin
    #[arg(required = true, value_name = "SCENARIO")]
    scenarios: Vec<String>,
    /// For people, or one JSON object with what was found
    #[arg(long, value_enum, default_value_t = Form::Text)]
    format: Form,
}

impl Check {
    pub(super) fn run(&self, style: &Style, out: &mut dyn Write) -> Result<u8, Failure> {
        let signals = Signals::install()?;
        let watch = TerminalWatch::new(&signals);
        let mut checked = Vec::new();
        let mut wrong = Vec::new();
        for name in &self.scenarios {
            if mesh::is_mesh_name(Path::new(name)) {
                match load::mesh(name, &watch) {
                    Ok((mesh, overview)) if self.format == Form::Json => {
                        checked.push(mesh_export::overview(name, &mesh, &overview));
                    }
                    Ok((mesh, overview)) => view::mesh::write(out, name, &mesh, &overview, style)?,
                    Err(error) if error.is_interrupted() => return Err(error.into()),
                    Err(error) => tell_problem(name, error, style, &mut wrong)?,
                }
                continue;
            }
            let looked = named(name, &watch).and_then(|scenario| diagnose(scenario, &watch));
            watch.clear();
            match looked {
                Ok(of) if self.format == Form::Json => {
                    let warnings: Vec<Value> = of.warnings.iter().map(|of| json_export::problem(name, of)).collect();
                    checked.push(json!({
                        "scenario": name, "title": of.title, "notes": of.notes, "loose": of.loose, "warnings": warnings,
                    }));
                }
                Ok(of) => {
                    writeln!(out, "{}", style.text(&format!("{name}: no problems found ({})", of.title)))?;
                    for note in of.notes {
                        for line in style.hanging("note: ", &style.text(&note)) {
                            writeln!(out, "{line}")?;
                        }
                    }
                    view::status::write_loose(out, &of.loose, style)?;
                    view::warnings::write(out, name, &of.warnings, style)?;
                }
                Err(error) if error.is_interrupted() => return Err(error.into()),
                Err(error) => tell_problem(name, error, style, &mut wrong)?,
            }
        }
        if self.format == Form::Json {
            let mut report = json!({ "checked": checked });
            if let (false, Value::Object(report), Value::Object(error)) =
                (wrong.is_empty(), &mut report, json_export::problems(&wrong))
            {
                report.extend(error);
            }
            writeln!(out, "{}", json_export::pretty(&report)?)?;
        }
        out.flush()?;
        if wrong.is_empty() { Ok(0) } else { Err(Failure::Told(2)) }
    }
}

/// What is wrong with a checked file: on stderr, and for JSON at the end.
fn tell_problem(name: &str, error: CommandError, style: &Style, wrong: &mut Vec<Problems>) -> io::Result<()> {
    for line in error.to_string().lines() {
        writeln!(io::stderr(), "{}", style.text(line))?;
    }
    wrong.push(match error {
        CommandError::Scenario(problems) => problems,
        error => Problems::of_file(name, error.to_string(), ""),
    });
    Ok(())
}
