//! The LCP of a scenario with every row written out, for other programs.

use crate::contact::force_form;
use crate::contact::full_lcp::full_lcp;
use crate::contact::problem::ContactProblem;
use crate::contact::rows::rows;
use crate::lcp::problem::Lcp;
use crate::lcp::variable::Variable;
use crate::model::parameter::ParameterValues;
use crate::model::rules::{Covering, Rules};
use crate::solve::engines::written_out;
use crate::solve::prepared::{Geometry, Prepared};
use crate::solve::problem::{contact_problem, factors};

impl Prepared {
    /// The LCP in the scenario's units (forces w, q; displacements z) and the names of its rows, with the covering
    /// and in space the friction polygon of these rules. The covering of a bare LCP is its own.
    pub fn written_lcp(&self, values: &ParameterValues, rules: Rules) -> (Lcp<f64>, Vec<String>) {
        match &*self.geometry {
            Geometry::Structure { system, .. } | Geometry::Contact { system, .. } => {
                let problem = contact_problem(system, &factors(self, values), values).under(rules);
                if system.force_form.is_some() {
                    return written_in_force_form(&problem, rules.covering);
                }
                let lcp = full_lcp(&problem, rules.covering);
                let names = rows(system, problem.polygon).iter().map(|row| row.name('x', system)).collect();
                (lcp, names)
            }
            Geometry::Plain { lcp, q, names, .. } => {
                let mut lcp = written_out(lcp);
                lcp.q = q.iter().map(|entry| entry.value(values)).collect();
                (lcp, names.clone())
            }
        }
    }
}

/// Where joints are in force form: forces and displacements have changed places in some rows, as their names say.
fn written_in_force_form(problem: &ContactProblem, covering: Covering) -> (Lcp<f64>, Vec<String>) {
    let system = &*problem.system;
    let contact = force_form::written_lcp(problem, covering);
    let mut lcp = written_out(&contact.lcp);
    let unit = |variable: Variable| contact.unit(variable);
    for (i, row) in lcp.matrix.iter_mut().enumerate() {
        row.iter_mut().enumerate().for_each(|(j, entry)| *entry *= unit(Variable::W(i)) / unit(Variable::Z(j)));
        lcp.q[i] *= unit(Variable::W(i));
        lcp.covering[i] *= unit(Variable::W(i)) / contact.force_unit;
    }
    let names = (0..contact.rows.len()).map(|row| contact.name(Variable::W(row), system)).collect();
    (lcp, names)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::contact::polygon::Polygon;
    use crate::contact::rows::RowKind;
    use crate::export::lcp::scenario;
    use crate::model::embedded;
    use crate::model::load::load_text;
    use crate::solve::prepare;
    use crate::watch::Quiet;

    #[test]
    fn the_exported_scenario_has_the_same_answer() {
        for name in ["beam", "frame-rotated", "gap", "plates-hinged", "murty6"] {
            let loaded = embedded::load(name).expect("embedded");
            let values = loaded.parameter_values();
            let prepared = prepare(&loaded, &Quiet).expect("prepared");
            let (lcp, names) = prepared.written_lcp(&values, loaded.rules);
            let text = scenario(&lcp, &names, name, &crate::model::units::Units::default()).to_string();
            let exported = load_text("exported", &text, None).expect("a scenario");
            let again = prepare(&exported, &Quiet).expect("prepared");
            let solved = again.case(&exported, &exported.parameter_values()).solve().expect("solved");
            let z = solved.answer.solution.expect("an lcp has one").z;
            let direct = prepared.case(&loaded, &values).solve().expect("solved");
            let expected: Vec<f64> = match (&direct.answer.solution, prepared.system()) {
                (Some(solution), _) => solution.z.clone(),
                (None, system) => rows(system.expect("contact"), Polygon::PLANE)
                    .iter()
                    .map(|row| {
                        let pair = &direct.answer.pairs[row.pair];
                        match row.couple {
                            RowKind::Normal => pair.z_n,
                            RowKind::PLUS => pair.z_t.max(0.0),
                            RowKind::Facet(_) => (-pair.z_t).max(0.0),
                        }
                    })
                    .collect(),
            };
            let largest = expected.iter().fold(0.0f64, |a, b| a.max(b.abs()));
            assert_eq!(z.len(), expected.len(), "{name}");
            for (found, expected) in z.iter().zip(&expected) {
                assert!((found - expected).abs() <= 1e-9 * largest, "{name}: {found} {expected}");
            }
        }
    }
}
