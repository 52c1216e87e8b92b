//! `cargo bench -p stickslip-benches`: Lemke by size, friction and ties; condensation; solving again; Coulomb's cone;
//! loading; a screen.
//!
//! `STICKSLIP_BENCH_LARGE=1` adds m = 1000. What the numbers mean and the tables: `benches/README.md`.

use std::hint::black_box;
use std::sync::Arc;
use std::time::{Duration, Instant};

use criterion::{BenchmarkId, Criterion, criterion_group, criterion_main};
use ratatui::Terminal;
use ratatui::backend::TestBackend;

use plates::block::Block;
use plates::{Plates, Pull, Ready};
use stickslip::contact::cone::ConeState;
use stickslip::contact::lcp::contact_lcp;
use stickslip::contact::written::ContactLcp;
use stickslip::model::embedded;
use stickslip::model::load::load_text;
use stickslip::model::rules::TieBreak;
use stickslip::session::Session;
use stickslip::solve::engines::run_scheme;
use stickslip::solve::prepare;
use stickslip::tui::action::Leave;
use stickslip::tui::app::State;
use stickslip::tui::draw::draw;
use stickslip::tui::keymap::Keymap;
use stickslip::tui::shown::Shown;
use stickslip::tui::theme::Look;
use stickslip::watch::Quiet;

fn is_large() -> bool {
    std::env::var_os("STICKSLIP_BENCH_LARGE").is_some()
}

/// The LCP of plates for the given friction.
fn lcp(ready: &Ready, friction: f64) -> ContactLcp {
    let problem = ready.problem(&ready.values(&[("f", friction)]));
    contact_lcp(&problem, ready.scenario.rules.covering).expect("cohesive covers all")
}

/// From R, RF and f to the vertex: what the yardsticks of `against.py` do from M and q.
fn lemke(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group("lemke");
    group.sample_size(10).measurement_time(Duration::from_secs(3));
    let sizes: &[usize] = if is_large() { &[50, 100, 300, 1000] } else { &[50, 100, 300] };
    for &pairs in sizes {
        let ready = Ready::new(&Plates::with_pairs(pairs, 0.4));
        for friction in [0.1, 0.4, 2.0] {
            let contact = lcp(&ready, friction);
            let rule = contact.tie_rule(TieBreak::Lexicographic);
            group.bench_function(BenchmarkId::new(format!("f={friction}"), pairs), |bench| {
                bench.iter(|| black_box(run_scheme(&contact.lcp, rule.clone(), &Quiet)));
            });
        }
        let symmetric = Plates { pull: Pull::Symmetric, ..Plates::with_pairs(pairs, 0.4) };
        let contact = lcp(&Ready::new(&symmetric), 0.4);
        for ties in [TieBreak::Lexicographic, TieBreak::Natural] {
            let rule = contact.tie_rule(ties);
            group.bench_function(BenchmarkId::new(format!("ties, {ties}"), pairs), |bench| {
                bench.iter(|| black_box(run_scheme(&contact.lcp, rule.clone(), &Quiet)));
            });
        }
    }
    group.finish();
}

/// Assembly, ordering, factorization, R and RF.
fn condensation(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group("condensation");
    group.sample_size(10).measurement_time(Duration::from_secs(5));
    for divisions in [[40, 20], [80, 40], [160, 80]] {
        let scenario = Plates { divisions, ..Plates::with_pairs(2, 0.4) }.scenario();
        let name = format!("{}x{}", divisions[0], divisions[1]);
        group.bench_function(name, |bench| {
            bench.iter(|| prepare(&scenario, &Quiet).expect("it stands"));
        });
    }
    group.finish();
}

/// A whole answer with its check: cold, after a change of the load, after a change of f by 2 %.
fn resolve(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group("solve again");
    group.sample_size(20).measurement_time(Duration::from_secs(3));
    for pairs in [100, 300] {
        let ready = Ready::new(&Plates::with_pairs(pairs, 0.4));
        let rules = ready.scenario.rules;
        let solve = |values: &_| ready.prepared.case(&ready.scenario, values).under(rules).solve().expect("an answer");
        group.bench_function(BenchmarkId::new("cold", pairs), |bench| {
            let values = ready.values(&[]);
            bench.iter(|| black_box(solve(&values)));
        });
        for (what, parameter, here, there) in [("load by 2 %", "T", 60.0, 61.2), ("f by 2 %", "f", 0.4, 0.408)] {
            let ends = [here, there].map(|value| ready.values(&[(parameter, value)]));
            group.bench_function(BenchmarkId::new(what, pairs), |bench| {
                // There and back again; each step starts from the answer before it.
                bench.iter_custom(|steps| {
                    let mut last = solve(&ends[0]);
                    let clock = Instant::now();
                    for step in 1..=steps {
                        let values = &ends[usize::from(step % 2 == 1)];
                        last = ready
                            .prepared
                            .case(&ready.scenario, values)
                            .under(rules)
                            .follow(&last)
                            .expect("the path gets there");
                    }
                    clock.elapsed()
                });
            });
        }
    }
    group.finish();
}

/// A parameter inside the model moved: a load costs a solve with the kept factor, geometry a factorization.
fn renewed(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group("re-solve");
    group.sample_size(10).measurement_time(Duration::from_secs(5));
    for (divisions, name) in [([24, 8], "1 000 unknowns"), ([160, 80], "52 000 unknowns")] {
        let scenario = Plates { divisions, ..Plates::with_pairs(2, 0.4) }.inner_scenario();
        for (what, parameter, here, there) in [("load", "T", 60.0, 61.0), ("geometry", "b", 8.0, 8.1)] {
            group.bench_function(BenchmarkId::new(what, name), |bench| {
                let mut prepared = prepare(&scenario, &Quiet).expect("it stands");
                let mut turn = false;
                bench.iter(|| {
                    turn = !turn;
                    let mut values = scenario.parameter_values();
                    values.insert(parameter.to_owned(), if turn { there } else { here });
                    let (renewed, _) =
                        prepared.renewed(&scenario, &values, &Quiet).expect("it stands").expect("something moved");
                    prepared = renewed;
                    black_box(prepared.case(&scenario, &values).solve().expect("an answer"))
                });
            });
        }
    }
    group.finish();
}

/// Scenario text to checked model.
fn loading(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group("load");
    for name in ["beam", "plates-free"] {
        let text = embedded::text(name).expect("an embedded scenario");
        group.bench_function(name, |bench| {
            bench.iter(|| load_text(name, black_box(text), None).expect("sound"));
        });
    }
    let text = Plates { divisions: [160, 80], ..Plates::with_pairs(2, 0.4) }.text();
    group.sample_size(20);
    group.bench_function("plates 160x80", |bench| {
        bench.iter(|| load_text("plates", black_box(&text), None).expect("sound"));
    });
    group.finish();
}

/// Newton's method on Coulomb's cone, check included: from a polygon's distance of the answer, and from rest.
fn cone(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group("cone");
    group.sample_size(10).measurement_time(Duration::from_secs(5));
    for side in [10, 17, 31] {
        let block = Block::new(side);
        let answer = block.answer(&block.at_rest()).expect("an answer");
        let near = block.perturbed(&answer.z, 0.1);
        let count = |wanted: ConeState| answer.states.iter().filter(|state| **state == wanted).count();
        println!(
            "{} pairs: {} open, {} slip, {} stick; {} steps from near by, {} from rest",
            side * side,
            count(ConeState::Open),
            count(ConeState::Slip),
            count(ConeState::Stick),
            block.answer(&near).expect("an answer").steps,
            answer.steps
        );
        group.bench_function(BenchmarkId::new("near", side * side), |bench| {
            bench.iter(|| black_box(block.answer(&near)));
        });
        if side < 31 || is_large() {
            group.bench_function(BenchmarkId::new("from rest", side * side), |bench| {
                bench.iter(|| black_box(block.answer(&block.at_rest())));
            });
        }
    }
    group.finish();
}

/// One frame of the full screen, drawn from nothing.
fn frame(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group("frame");
    let pulled = Plates { divisions: [60, 30], ..Plates::with_pairs(2, 0.4) }.scenario();
    let named = |name| embedded::load(name).expect("an embedded scenario");
    for scenario in [named("beam"), named("plates-free"), pulled] {
        let name = scenario.title.clone();
        let session = Session::new(scenario, &Quiet).expect("it has an answer");
        let look = Look { color: true, ascii: false };
        let size = (120, 40);
        let mut state = State::new(Arc::new(Shown::of(&session)), look, Arc::new(Keymap::default()), size, Leave::Quit);
        let mut terminal = Terminal::new(TestBackend::new(size.0, size.1)).expect("in memory");
        group.bench_function(name, |bench| {
            bench.iter(|| {
                terminal.clear().expect("in memory");
                state.pictures.clear();
                terminal.draw(|frame| draw(&state, frame)).expect("in memory");
            });
        });
    }
    group.finish();
}

criterion_group! {
    name = benches;
    config = Criterion::default().warm_up_time(Duration::from_secs(1));
    targets = lemke, condensation, resolve, cone, renewed, loading, frame
}
criterion_main!(benches);
