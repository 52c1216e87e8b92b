//! Random frames on three to eight supports under random histories with reversals.
//!
//! Every way is checked from R and RF alone, segment by segment: everything is affine in between, so that the laws at
//! its ends and the motion between them are the whole law of slip in rates. Its stages end where small steps lead, each
//! solved on its own by a search over the states of the pairs that shares nothing with the program.

mod judge;
mod to_the_end;

use rand::{Rng, SeedableRng};
use rand_chacha::ChaCha8Rng;
use stickslip::answer::record::Verdict;
use stickslip::model::load::load_text;
use stickslip::path::stages::{HistoryEnd, follow};
use stickslip::solve::prepare;
use stickslip::watch::Quiet;

use self::judge::{Data, apart, breach, converges, distances, goes_on};

/// A pipe from a clamped end around a corner along `supports` supports, each with a law of its own.
fn frame(random: &mut ChaCha8Rng, supports: usize, clamped: bool, plain: bool) -> String {
    let mut nodes = String::from(r#""noz": [0, 4], "elb": [0, 0]"#);
    let mut bars = String::from(r#"{ "id": "riser", "nodes": ["noz", "elb"], "material": "st", "section": "p" }"#);
    let mut contacts = Vec::new();
    let mut last = "elb".to_owned();
    for i in 1..=supports {
        let y: f64 = random.random_range(-0.3..0.3);
        nodes += &format!(r#", "s{i}": [{}, {y}]"#, 3 * i);
        bars += &format!(r#", {{ "id": "p{i}", "nodes": ["{last}", "s{i}"], "material": "st", "section": "p" }}"#);
        last = format!("s{i}");
        let slope: f64 = random.random_range(-0.2..0.2);
        let friction: f64 = random.random_range(0.0..0.8);
        let law = match random.random_range(0..10) {
            0 if !plain => format!(r#""friction": {friction}, "cohesion": {}"#, random.random_range(0.0..2.0)),
            1 if !plain => format!(r#""friction": {friction}, "gap": {}"#, random.random_range(0.0..0.01)),
            2 if !plain => r#""law": "frictionless""#.to_owned(),
            3 if !plain => format!(r#""law": "bound", "bound": {}"#, random.random_range(0.0..2.0)),
            4 if !plain => r#""friction": 0"#.to_owned(),
            _ => format!(r#""friction": {friction}"#),
        };
        contacts
            .push(format!(r#"{{ "id": "c{i}", "node": "s{i}", "against": "ground", "normal": [{slope}, 1], {law} }}"#));
    }
    let weight: Vec<String> = (1..=supports)
        .map(|i| format!(r#"{{ "point": {{ "at": "s{i}", "force": [0, {}] }} }}"#, -random.random_range(0.5..3.0)))
        .collect();
    let mut case = |size: f64| {
        let items: Vec<String> = (0..random.random_range(1..4))
            .map(|_| {
                let at = random.random_range(0..=supports);
                let at = if at == 0 { "elb".to_owned() } else { format!("s{at}") };
                let force: [f64; 2] = [random.random_range(-size..size), random.random_range(-0.5 * size..0.5 * size)];
                format!(r#"{{ "point": {{ "at": "{at}", "force": [{}, {}] }} }}"#, force[0], force[1])
            })
            .collect();
        items.join(", ")
    };
    let (a, b) = (case(20.0), case(5.0));
    let supports_text = if clamped { r#""supports": [{ "at": "noz", "fixed": ["x", "y", "r"] }],"# } else { "" };
    let mut stages = vec![r#"{ "weight": 1 }"#.to_owned()];
    let mut sign = 1.0;
    for _ in 0..random.random_range(3..8) {
        let (a, b) = (sign * random.random_range(0.0..1.0), random.random_range(-1.0..1.0));
        sign = -sign;
        let weight = if random.random_bool(0.7) { 1.0 } else { random.random_range(0.3..1.5) };
        stages.push(format!(r#"{{ "weight": {weight}, "a": {a}, "b": {b} }}"#));
    }
    format!(
        r#"{{ "format": "stickslip/1", "title": "A random frame",
  "materials": {{ "st": {{ "E": 2e5, "nu": 0.3 }} }},
  "sections": {{ "p": {{ "area": 0.02, "inertia": {} }} }},
  "nodes": {{ {nodes} }}, "bars": [ {bars} ], {supports_text}
  "contacts": [ {} ],
  "loads": {{ "weight": {{ "items": [ {} ] }}, "a": {{ "items": [ {a} ] }}, "b": {{ "items": [ {b} ] }} }},
  "stages": [ {} ] }}"#,
        10f64.powf(random.random_range(-4.0..-2.0)),
        contacts.join(", "),
        weight.join(", "),
        stages.join(", "),
    )
}

/// What came of a number of random histories.
#[derive(Debug, Default)]
struct Tally {
    complete: usize,
    limits: usize,
    certified: usize,
    jumps: usize,
    compared: usize,
    events: usize,
}

fn try_histories(seeds: std::ops::Range<u64>, clamped: bool, steps: usize) -> Tally {
    let mut tally = Tally::default();
    for seed in seeds {
        let mut random = ChaCha8Rng::seed_from_u64(seed);
        let supports = random.random_range(3..=8);
        let text = frame(&mut random, supports, clamped, seed % 2 == 0);
        let scenario = load_text("random", &text, None).unwrap_or_else(|problems| panic!("{problems}\n{text}"));
        let prepared = prepare(&scenario, &Quiet).expect("sound");
        let values = scenario.parameter_values();
        let history =
            follow(prepared.case(&scenario, &values)).unwrap_or_else(|error| panic!("seed {seed}: {error}\n{text}"));
        let data = Data::of(&prepared, &values);
        tally.events += history.stages.iter().map(|stage| stage.moments.len() - 1).sum::<usize>();
        let own =
            |stage: usize, name: &String| scenario.stages[stage].multipliers.iter().find(|(case, _)| case == name);
        let value = |stage: usize, name| own(stage, name).map_or(0.0, |(_, to)| to.value(&values));
        let target = |stage| -> Vec<f64> { history.cases.iter().map(|name| value(stage, name)).collect() };
        let places = history.stages.iter().enumerate();
        let places = places.flat_map(|(k, stage)| stage.moments.windows(2).map(move |ends| (k, ends)));
        let jumps: Vec<_> = places.filter(|(_, ends)| ends[1].jump).collect();
        tally.jumps += jumps.len();
        for (count, (stage, ends)) in jumps.iter().enumerate() {
            let [from, to] = [0, 1].map(|end| data.displacements(&ends[end].pairs));
            let (moved, size) = ((&to - &from).amax(), from.amax().max(to.amax()));
            assert!(moved > 1e-6 * size, "seed {seed}: a jump that moves nothing, {moved:e} of {size:e}\n{text}");
            // Only the first: the state it leads to may lie 1e6 times as far away, and what is close to that is lost in
            // its size.
            if count == 0 {
                let on = goes_on(&data, &ends[0], &target(*stage), 0.1 * moved);
                assert_ne!(on, Some(true), "seed {seed}: a jump where a way leads on\n{text}");
            }
        }
        if !jumps.is_empty() {
            continue;
        }
        assert_eq!(breach(&data, &history), None, "seed {seed}\n{text}");
        for stage in &history.stages {
            let energy = stage.energy.expect("a structure");
            assert!(energy.residual <= 1e-10, "seed {seed}: {energy:?}");
            assert!(stage.dissipated >= -1e-12 * energy.work.abs().max(energy.stored.abs()), "seed {seed}: {stage:?}");
        }
        match &history.end {
            HistoryEnd::Complete => tally.complete += 1,
            HistoryEnd::Broken(error) => panic!("seed {seed}: {error}\n{text}"),
            HistoryEnd::Limit { stage, collapse, .. } => {
                tally.limits += 1;
                tally.certified += usize::from(collapse.verdict == Some(Verdict::Certified));
                let end = history.stages[*stage].moments.last().expect("an end");
                let near = 1e-3 * data.displacements(&end.pairs).amax();
                let on = goes_on(&data, end, &target(*stage), near);
                assert_ne!(on, Some(true), "seed {seed}: a limit where a way leads on\n{text}");
                continue;
            }
        }
        if steps == 0 {
            continue;
        }
        match distances(&data, &history, steps) {
            Some(distances) => {
                tally.compared += 1;
                assert!(converges(&distances, steps), "seed {seed}: {distances:?}\n{text}");
            }
            None => println!("seed {seed}: a small step has no answer"),
        }
    }
    println!("{tally:?}");
    tally
}

#[test]
fn random_histories_obey_the_laws_and_end_where_small_steps_lead() {
    let tally = try_histories(0..60, true, 100);
    assert!(tally.complete >= 55 && tally.compared >= 55, "{tally:?}");
    assert!(tally.events >= 600, "{tally:?}");
}

/// Without its clamp the pipe lies on sloping supports alone: most histories end in a limit, or jump where friction lets
/// go. Where the schemes are few enough to go through, no way leads on there.
#[test]
fn random_histories_of_loose_frames_end_where_no_way_leads_on() {
    let tally = try_histories(1000..1060, false, 0);
    assert!(tally.limits >= 30 && tally.certified >= 10, "{tally:?}");
}

#[test]
#[ignore = "many more of the same kinds: minutes"]
fn many_random_histories() {
    let (clamped, loose) = match std::env::var("STICKSLIP_SEEDS").ok().and_then(|given| given.parse::<u64>().ok()) {
        Some(count) => (10_000..10_000 + count, 20_000..20_000 + 2 * count),
        None => (10_000..11_000, 20_000..22_000),
    };
    let count = clamped.end - clamped.start;
    let clamped = try_histories(clamped, true, 60);
    assert!(clamped.complete as u64 >= count * 95 / 100, "{clamped:?}");
    let loose = try_histories(loose, false, 0);
    assert!(loose.limits as u64 >= count, "{loose:?}");
}

/// A pipe of EA = 1.32e6 kN from a nozzle around a corner along its supports; warm by 180 K · T, α = 1.2e-5.
fn hot_pipe(supports: usize, stages: &str) -> String {
    let mut nodes = String::from(r#""noz": [0, 4], "elb": [0, 0]"#);
    let mut bars = String::from(r#"{ "id": "riser", "nodes": ["noz", "elb"], "material": "st", "section": "p" }"#);
    let mut weight = String::from(r#"{ "line": { "bar": "riser", "value": [0, -0.62] } }"#);
    let mut contacts = Vec::new();
    let mut last = "elb".to_owned();
    for i in 1..=supports {
        nodes += &format!(r#", "s{i}": [{}, 0]"#, 3 * i);
        bars += &format!(r#", {{ "id": "p{i}", "nodes": ["{last}", "s{i}"], "material": "st", "section": "p" }}"#);
        weight += &format!(r#", {{ "line": {{ "bar": "p{i}", "value": [0, -0.62] }} }}"#);
        contacts.push(format!(
            r#"{{ "id": "c{i}", "node": "s{i}", "against": "ground", "normal": [0, 1], "friction": 0.3 }}"#
        ));
        last = format!("s{i}");
    }
    let heat = 1.32e6 * 1.2e-5 * 180.0;
    let point = |at: &str, x: f64, y: f64| format!(r#"{{ "point": {{ "at": "{at}", "force": [{x}, {y}] }} }}"#);
    let hot = [point("elb", -heat, -heat), point("noz", 0.0, heat), point(&last, heat, 0.0)].join(", ");
    format!(
        r#"{{ "format": "stickslip/1", "title": "Hot pipe", "parameters": {{ "T": {{ "value": 1.0 }} }},
  "materials": {{ "st": {{ "E": 2e8, "nu": 0.3 }} }}, "sections": {{ "p": {{ "area": 0.0066, "inertia": 3.67e-5 }} }},
  "nodes": {{ {nodes} }}, "bars": [ {bars} ], "supports": [ {{ "at": "noz", "fixed": ["x", "y", "r"] }} ],
  "contacts": [ {} ],
  "loads": {{ "weight": {{ "items": [ {weight} ] }}, "hot": {{ "factor": "T", "items": [ {hot} ] }} }},
  "stages": {stages} }}"#,
        contacts.join(", ")
    )
}

/// Restarts of eq. (8) at each reversal failed at 29 to 36 of 40 temperatures.
#[test]
fn hot_pipes_are_followed_at_every_temperature() {
    let stages = r#"[ { "weight": 1 }, { "weight": 1, "hot": 1 }, { "weight": 1 }, { "weight": 1, "hot": 1 } ]"#;
    for supports in 4..=6 {
        let scenario = load_text("pipe", &hot_pipe(supports, stages), None).expect("sound");
        let prepared = prepare(&scenario, &Quiet).expect("sound");
        let mut values = scenario.parameter_values();
        for step in 1..=40 {
            let warm = 0.025 * f64::from(step);
            values.insert("T".to_owned(), warm);
            let place = format!("{supports} supports, T = {warm}");
            let history = follow(prepared.case(&scenario, &values)).unwrap_or_else(|error| panic!("{place}: {error}"));
            assert_eq!(history.end, HistoryEnd::Complete, "{place}");
            let data = Data::of(&prepared, &values);
            assert_eq!(breach(&data, &history), None, "{place}");
            for stage in &history.stages {
                assert!(stage.energy.is_some_and(|energy| energy.residual <= 1e-12), "{place}: {:?}", stage.energy);
                assert!(stage.end.check.passed, "{place}: {:?}", stage.end.check);
            }
            if step % 13 == 1 {
                let apart = apart(&data, &history, 960).expect("every small step has an answer");
                assert!(apart.iter().all(|apart| *apart <= 1e-3), "{place}: {apart:?}");
            }
        }
    }
}
