use stickslip::solve::prepare;
use stickslip::watch::Quiet;
fn main() {
    let nx: usize = std::env::args().nth(1).unwrap().parse().unwrap();
    let ny: usize = std::env::args().nth(2).unwrap().parse().unwrap();
    let f: f64 = std::env::args().nth(3).unwrap().parse().unwrap();
    let t: f64 = std::env::args().nth(4).unwrap().parse().unwrap();
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
    let start = std::time::Instant::now();
    let scenario = stickslip::model::load::load_text("perf", &text, None).unwrap();
    let prepared = prepare(&scenario, &Quiet).unwrap();
    println!("prepare {:?}", start.elapsed());
    for _ in 0..5 {
        let start = std::time::Instant::now();
        let solved = prepared
            .solve(
                &scenario,
                &scenario.parameter_values(),
                scenario.rules,
                &Quiet,
            )
            .unwrap();
        let a = &solved.answer;
        let count =
            |s: stickslip::answer::record::State| a.pairs.iter().filter(|p| p.state == s).count();
        use stickslip::answer::record::State::*;
        println!(
            "{:?} pivots {} open {} stick {} + {} - {} lemke {:.2} ms total {:?} check {:?}",
            a.outcome,
            a.pivots.len(),
            count(Open),
            count(Stick),
            count(SlipPlus),
            count(SlipMinus),
            a.timings.lemke * 1e3,
            start.elapsed(),
            a.check
        );
    }
}
