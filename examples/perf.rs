use std::ops::ControlFlow;
use std::time::Instant;
use stickslip::contact::complementarity::contact_lcp;
use stickslip::lcp::driver::run;
use stickslip::lcp::lemke::SchemeEngine;
use stickslip::lcp::vertex::{Basis, vertex};
use stickslip::solve::numbers::{contact_numbers, factors};
use stickslip::solve::prepare;
use stickslip::watch::Quiet;
fn main() {
    let arg = |k: usize| std::env::args().nth(k).unwrap();
    let nx: usize = arg(1).parse().unwrap();
    let ny: usize = arg(2).parse().unwrap();
    let f: f64 = arg(3).parse().unwrap();
    let t: f64 = arg(4).parse().unwrap();
    let reps: usize = arg(5).parse().unwrap();
    let text = format!(
        r#"{{"format":"stickslip/1","title":"perf","parameters":{{"f":{f},"T":{t}}},
    "materials":{{"m":{{"E":1e5,"nu":0.3}}}},
    "plates":[{{"id":"lower","origin":[0,0],"size":[8,4],"divisions":[{nx},{ny}],"thickness":0.1,"material":"m","plane":"strain"}},
    {{"id":"upper","origin":[0,4],"size":[8,4],"divisions":[{nx},{ny}],"thickness":0.1,"material":"m","plane":"strain"}}],
    "supports":[{{"at":"lower.bottom","fixed":["x","y"]}}],
    "springs":[{{"at":"upper.left","direction":[1,0],"stiffness":10.0}}],
    "contacts":[{{"id":"joint","edge":"upper.bottom","against":"lower.top","friction":"f"}}],
    "loads":{{"weight":{{"items":[{{"traction":{{"edge":"upper.top","value":[0,-100]}}}}]}},"pull":{{"factor":"T","items":[{{"traction":{{"edge":"upper.left","value":[1,0.7]}}}}]}}}}}}"#
    );
    let scenario = stickslip::model::load::load_text("perf", &text, None).unwrap();
    let prepared = prepare(&scenario, &Quiet).unwrap();
    let values = scenario.parameter_values();
    let system = prepared.system().unwrap();
    let numbers = contact_numbers(system, &factors(&prepared, &values), &values);
    let mut best = [f64::MAX; 3];
    for _ in 0..reps {
        let start = Instant::now();
        let contact = contact_lcp(system, &numbers, scenario.rules.covering).unwrap();
        best[0] = best[0].min(start.elapsed().as_secs_f64());
        let start = Instant::now();
        let mut engine = SchemeEngine::new(
            contact.lcp.clone(),
            contact.tie_rule(scenario.rules.tie_break),
        );
        let result = run(&mut engine, 1_000_000, &mut |_| ControlFlow::Continue(()));
        best[1] = best[1].min(start.elapsed().as_secs_f64());
        let start = Instant::now();
        let v = vertex(&contact.lcp, &Basis::after(&result.pivots));
        best[2] = best[2].min(start.elapsed().as_secs_f64());
        assert!(v.is_some());
        if best[2] == f64::MAX {
            println!("{:?}", result.outcome);
        }
        print!("{} ({}) ", result.pivots.len(), engine.refreshes());
    }
    println!(
        "lcp {:.2} ms, engine {:.2} ms, vertex {:.2} ms",
        best[0] * 1e3,
        best[1] * 1e3,
        best[2] * 1e3
    );
}
