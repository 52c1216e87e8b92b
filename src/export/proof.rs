//! A proof as `stickslip-proof/1`, and the system it is about as a scenario (docs/proofs.md).

use nalgebra::DMatrix;
use num_rational::BigRational;
use serde_json::{Map, Value, json};

use super::lcp::of_source;
use crate::contact::law::PairLaw;
use crate::lcp::exact::dyadic::rational;
use crate::model::units::Units;
use crate::solve::prove::forms::Forms;
use crate::solve::prove::system::{ProvedContact, ProvedSystem};
use crate::solve::prove::tree::{Sum, Tree};
use crate::solve::prove::{Claim, Proof};
use crate::text::hash::Hash;

/// The system as a `stickslip/1` scenario: it loads and solves as it is.
pub fn system(system: &ProvedSystem, title: &str, units: &Units) -> Value {
    let (key, source) = match system {
        ProvedSystem::Contact(contact) => ("contact_system", of_contact(contact)),
        ProvedSystem::Plain { matrix, q, names } => {
            ("lcp", json!({"names": names, "M": rows(matrix), "q": q.as_slice()}))
        }
    };
    of_source(key, source, title, units)
}

fn rows(matrix: &DMatrix<f64>) -> Value {
    matrix.row_iter().map(|row| row.iter().copied().collect::<Value>()).collect()
}

fn of_contact(contact: &ProvedContact) -> Value {
    let laws = || contact.laws.iter();
    let fixed = |law: &PairLaw, bilateral: bool| if law.is_bilateral() == bilateral { law.fixed_bound() } else { 0.0 };
    let mut value = json!({
        "pairs": contact.ids,
        "law": laws().map(|law| law.kind().word()).collect::<Vec<_>>(),
        "friction": laws().map(PairLaw::friction).collect::<Vec<_>>(),
        "cohesion": laws().map(|law| fixed(law, false)).collect::<Vec<_>>(),
        "bound": laws().map(|law| fixed(law, true)).collect::<Vec<_>>(),
        "gap": laws().map(PairLaw::gap).collect::<Vec<_>>(),
        "stiffness": rows(&contact.stiffness),
        "loads": {"all": {"factor": 1.0, "vector": contact.load.as_slice()}},
    });
    if contact.tangents > 1 {
        value["tangents"] = contact.tangents.into();
    }
    if !contact.kernel.is_empty() {
        value["kernel"] = contact.kernel.iter().map(|motion| json!(motion.as_slice())).collect();
    }
    value
}

/// The proof; `system` is the text of its system, by whose hash it names it.
pub fn proof(proof: &Proof, system: &str) -> Value {
    let forms = &proof.forms;
    let mut value = json!({"format": "stickslip-proof/1", "system": Hash::of(system).long()});
    let mut put = |key: &str, entry: Value| value[key] = entry;
    if let Some(polygon) = proof.polygon() {
        let direction =
            |facet| polygon.direction(facet).iter().map(|part| fraction(&rational(*part))).collect::<Value>();
        put("directions", (0..polygon.half()).map(direction).collect());
    }
    match &proof.claim {
        Claim::Answer(z) => {
            let values = forms.values(z);
            let words = forms.scheme(&values).unwrap_or_default();
            let scheme = forms.groups.iter().zip(words).map(|(group, word)| (group.name.clone(), Value::from(word)));
            put("claim", "answer".into());
            put("scheme", Value::Object(scheme.collect()));
            put("values", named(forms, &values));
        }
        Claim::Answers(all) => {
            put("claim", "answers".into());
            put("answers", all.answers.iter().map(|z| named(forms, &forms.values(z))).collect());
            put("tree", tree(forms, &all.tree));
        }
        Claim::Collapse(found) => {
            put("claim", "collapse".into());
            put("motion", named(forms, &found.motion));
            if let ProvedSystem::Contact(contact) = &proof.system
                && contact.tangents > 1
            {
                let slips = contact.ids.iter().zip(&found.slips);
                put("slips", Value::Object(slips.map(|(id, slip)| (id.clone(), fraction(slip))).collect()));
            }
            put("amounts", found.amounts.iter().map(fraction).collect());
            put("work", fraction(&found.work));
            put("bound", fraction(&found.bound));
        }
    }
    value
}

fn fraction(value: &BigRational) -> Value {
    value.to_string().into()
}

/// The first variables with these values.
fn named(forms: &Forms, values: &[BigRational]) -> Value {
    Value::Object(forms.names.iter().zip(values).map(|(name, value)| (name.clone(), fraction(value))).collect())
}

fn tree(forms: &Forms, node: &Tree) -> Value {
    let sum = |sum: &Sum| -> Map<String, Value> {
        sum.iter().map(|(variable, factor)| (forms.names[*variable].clone(), fraction(factor))).collect()
    };
    match node {
        Tree::Split { group, below } => {
            let group = &forms.groups[*group];
            let branches = group.branches.iter().zip(below);
            let branches: Map<_, _> =
                branches.map(|(branch, child)| (branch.name.clone(), tree(forms, child))).collect();
            json!({"of": group.name, "branches": branches})
        }
        Tree::Cut(factors) => json!({"cut": sum(factors)}),
        Tree::Answer { answer, tight } => json!({"answer": answer + 1, "tight": sum(tight)}),
        Tree::Set { answers } => json!({"set": answers.iter().map(|answer| answer + 1).collect::<Vec<_>>()}),
    }
}
