use stickslip::solve::prepare;
use stickslip::watch::Quiet;
fn main() {
    for name in std::env::args().skip(1) {
        let scenario = match stickslip::model::embedded::load(&name) {
            Ok(s) => s,
            Err(other) => {
                println!("{other}");
                continue;
            }
        };
        let prepared = match prepare(&scenario, &Quiet) {
            Ok(p) => p,
            Err(e) => {
                println!("{name}: {e}");
                continue;
            }
        };
        match prepared.solve(
            &scenario,
            &scenario.parameter_values(),
            scenario.rules,
            &Quiet,
        ) {
            Err(e) => println!("{name}: {e}"),
            Ok(solved) => {
                let a = &solved.answer;
                println!(
                    "== {name}: {:?} p {} pivots {} size {:?} check {:?} failure {:?}",
                    a.outcome,
                    a.p,
                    a.pivots.len(),
                    a.size,
                    a.check,
                    a.failure
                );
                if let Some(ray) = &a.ray {
                    println!("   {:?} {} | {}", ray.class, ray.mode, ray.explanation);
                }
                for p in a.pivots.iter().take(40) {
                    println!(
                        "   {} {} -> {} p {} {:?}: {}",
                        p.step, p.entering, p.leaving, p.p, p.ties, p.sentence
                    );
                }
                for p in &a.pairs {
                    println!(
                        "   {} {:?} {:?} xn {:.6} xt {:.6} zn {:.6e} zt {:.6e}",
                        p.id, p.state, p.held, p.x_n, p.x_t, p.z_n, p.z_t
                    );
                }
                println!("   {:?}", a.timings);
            }
        }
    }
}
