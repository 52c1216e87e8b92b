//! The result of a scenario with stages: `stickslip-result/1` of the end of its history, and every stage.

use serde_json::{Map, Value};

use super::json;
use crate::model::parameter::ParameterValues;
use crate::path::stages::{History, StageResult};

/// The result of a history. Its top-level keys describe the end of the last stage followed; `attempts` and `pivots` are
/// those of the last rate problem. Where a stage broke down there is no answer, and the stages are those before it. `None`
/// for a history without stages.
pub fn result(history: &History, scenario_name: &str, parameters: &ParameterValues, timings: bool) -> Option<Value> {
    let mut result = json::result(&*history.outcome()?, scenario_name, parameters, timings);
    if let Value::Object(map) = &mut result {
        let stages = history.stages.iter().map(|of| stage(of, &history.cases)).collect();
        map.insert("stages".to_owned(), Value::Array(stages));
    }
    Some(result)
}

/// The end of a stage; in a stage that ends in a limit the state at which that was met.
fn stage(stage: &StageResult, cases: &[String]) -> Value {
    let end = stage.moments.last();
    let mut map = Map::new();
    let mut put = |key: &str, value: Value| {
        map.insert(key.to_owned(), value);
    };
    let factors = end.map_or(&[][..], |end| &end.factors);
    put("factors", cases.iter().cloned().zip(factors.iter().map(json::value)).collect::<Map<_, _>>().into());
    put("done", json::value(&end.map_or(0.0, |end| end.t)));
    put("pairs", json::pairs(&stage.end));
    if stage.end.displacements.is_some() {
        put("displacements", json::displacements(&stage.end));
    }
    if stage.end.members.is_some() {
        put("members", json::members(&stage.end));
    }
    if stage.end.reactions.is_some() {
        put("reactions", json::reactions(&stage.end));
    }
    put("dissipated", json::value(&stage.dissipated));
    put("balance", json::value(&stage.energy.map(|energy| energy.residual)));
    if stage.estimated_error.is_some() {
        put("estimated_error", json::value(&stage.estimated_error));
    }
    if !stage.end.notes.is_empty() {
        put("notes", json::value(&stage.end.notes));
    }
    Value::Object(map)
}
