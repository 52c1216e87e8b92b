use stickslip::model::rules::Rules;
use stickslip::solve::prepare;
use stickslip::watch::Quiet;
fn main() {
    for spec in std::env::args().skip(1) {
        let mut words = spec.split(',');
        let name = words.next().unwrap();
        let scenario = stickslip::model::embedded::load(name)
            .map_err(|e| e.to_string())
            .unwrap();
        let prepared = prepare(&scenario, &Quiet)
            .map_err(|e| e.to_string())
            .unwrap();
        let mut values = scenario.parameter_values();
        let mut rules: Rules = scenario.rules;
        for word in words {
            let (key, value) = word.split_once('=').unwrap();
            match key {
                "covering" => rules.covering = value.parse().unwrap(),
                "tie-break" => rules.tie_break = value.parse().unwrap(),
                "engine" => rules.engine = value.parse().unwrap(),
                _ => {
                    values.insert(key.to_owned(), value.parse().unwrap());
                }
            }
        }
        let start = std::time::Instant::now();
        match prepared.solve(&scenario, &values, rules, &Quiet) {
            Err(e) => println!("== {spec}: {e}"),
            Ok(s) => {
                let a = &s.answer;
                println!(
                    "== {spec}: {:?} {} pivots p {} ({:?}) {:?}",
                    a.outcome,
                    a.pivots.len(),
                    a.p,
                    start.elapsed(),
                    a.failure
                );
                for t in &a.attempts {
                    println!(
                        "   tried {} {} {} {:?}",
                        t.covering, t.tie_break, t.engine, t.outcome
                    );
                }
                for n in &a.notes {
                    println!("   note {n}");
                }
                if let Some(r) = &a.ray {
                    println!(
                        "   {:?} {:?}\n   {}\n   {}",
                        r.class, r.verdict, r.mode, r.explanation
                    );
                }
            }
        }
    }
}
