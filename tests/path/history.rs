//! Random frames on three to eight supports under random histories with reversals.
//!
//! Every way is checked from R and RF alone, segment by segment: everything is affine in between, so that the laws at
//! its ends and the motion between them are the whole law of slip in rates. Its stages end where small steps lead, each
//! solved on its own by a search over the states of the pairs that shares nothing with the program.

use nalgebra::{DMatrix, DVector};
use rand::{Rng, SeedableRng};
use rand_chacha::ChaCha8Rng;
use stickslip::answer::record::{PairState, Verdict};
use stickslip::model::load::load_text;
use stickslip::path::stages::{History, HistoryEnd, Moment, StageResult, follow};
use stickslip::solve::problem::contact_problem;
use stickslip::solve::{Prepared, prepare};
use stickslip::watch::Quiet;

/// One pair as the tests see it: rows of R, f, what else the bound has, gap, whether it may open.
struct Pair {
    normal: usize,
    tangential: Option<usize>,
    friction: f64,
    constant: f64,
    gap: f64,
    opens: bool,
}

struct Data {
    r: DMatrix<f64>,
    cases: Vec<DVector<f64>>,
    pairs: Vec<Pair>,
}

impl Data {
    fn of(prepared: &Prepared, values: &stickslip::model::parameter::ParameterValues) -> Data {
        let system = prepared.system().expect("pairs");
        let problem = contact_problem(system, &vec![0.0; system.loads.len()], values);
        let pairs = system.pairs.iter().enumerate().map(|(i, pair)| Pair {
            normal: i,
            tangential: pair.plane_tangential(),
            friction: problem.laws[i].friction(),
            constant: problem.laws[i].fixed_bound(),
            gap: problem.laws[i].gap(),
            opens: !pair.law.is_bilateral(),
        });
        Data {
            r: system.stiffness.clone(),
            cases: system.loads.iter().map(|load| load.vector.clone()).collect(),
            pairs: pairs.collect(),
        }
    }

    fn displacements(&self, pairs: &[PairState]) -> DVector<f64> {
        let mut z = DVector::zeros(self.r.nrows());
        for (pair, state) in self.pairs.iter().zip(pairs) {
            z[pair.normal] = state.z_n;
            if let Some(joint) = pair.tangential {
                z[joint] = state.z_t;
            }
        }
        z
    }

    /// Σ |terms| of the load.
    fn sizes(&self, factors: &[f64]) -> DVector<f64> {
        let mut sizes = DVector::zeros(self.r.nrows());
        for (case, factor) in self.cases.iter().zip(factors) {
            sizes += factor.abs() * case.map(f64::abs);
        }
        for pair in &self.pairs {
            sizes += pair.gap.abs() * self.r.column(pair.normal).map(f64::abs);
        }
        sizes
    }

    fn load(&self, factors: &[f64]) -> DVector<f64> {
        let mut load = DVector::zeros(self.r.nrows());
        for (case, factor) in self.cases.iter().zip(factors) {
            load += *factor * case;
        }
        for pair in &self.pairs {
            load -= pair.gap * self.r.column(pair.normal);
        }
        load
    }
}

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

/// The laws in rates along a history, from R and RF: the first breach.
fn breach(data: &Data, history: &History) -> Option<String> {
    let mut before: Option<(DVector<f64>, Vec<f64>)> = None;
    for (index, stage) in history.stages.iter().enumerate() {
        for (k, ends) in stage.moments.windows(2).enumerate() {
            let z = [data.displacements(&ends[0].pairs), data.displacements(&ends[1].pairs)];
            let force = [0, 1].map(|end| &data.r * &z[end] + data.load(&ends[end].factors));
            // Rounding goes with the terms that a force sums.
            let tiny = [0, 1].map(|end| {
                let terms = data.r.map(f64::abs) * z[end].map(f64::abs) + data.sizes(&ends[end].factors);
                1e-11 * terms
            });
            let short = 1e-9 * z[0].amax().max(z[1].amax());
            let place = |what: &str, pair: usize| {
                let [a, b] = [&ends[0], &ends[1]];
                Some(format!(
                    "stage {index}, segment {k} of {}, pair {pair}: {what}; {} {:?} to {} {:?}, tolerance {short}",
                    stage.moments.len() - 1,
                    a.t,
                    a.pairs.get(pair),
                    b.t,
                    b.pairs.get(pair)
                ))
            };
            if let Some((old, factors)) = &before
                && ((old - &z[0]).amax() > short || *factors != ends[0].factors)
            {
                return place("the way has a hole", 0);
            }
            for (i, pair) in data.pairs.iter().enumerate() {
                for end in 0..2 {
                    let shown = &ends[end].pairs[i];
                    let (x_n, noise) = (force[end][pair.normal], tiny[end][pair.normal]);
                    if pair.opens && (x_n < -noise || z[end][pair.normal] < 0.0) {
                        return place(&format!("x_n {x_n:e} (noise {noise:e}) or z_n below 0"), i);
                    }
                    if pair.opens && z[end][pair.normal].max(z[1 - end][pair.normal]) > short && x_n.abs() > noise {
                        return place(&format!("open with x_n {x_n:e} (noise {noise:e})"), i);
                    }
                    if (shown.x_n - x_n).abs() > noise {
                        return place(&format!("x_n is not that of R, {x_n:e} (noise {noise:e})"), i);
                    }
                    let Some(joint) = pair.tangential else { continue };
                    let (x_t, noise) = (force[end][joint], tiny[end][joint] + pair.friction * noise);
                    let bound = pair.friction * x_n.max(0.0) + pair.constant;
                    if x_t.abs() > bound + noise {
                        return place(&format!("{x_t} beyond the bound {bound}"), i);
                    }
                    let slip = z[1][joint] - z[0][joint];
                    if slip.abs() > short && (x_t + slip.signum() * bound).abs() > noise {
                        return place("slips away from its limit", i);
                    }
                    if (shown.x_t - x_t).abs() > noise {
                        return place("x_t is not that of R", i);
                    }
                }
            }
            before = Some((z[1].clone(), ends[1].factors.clone()));
        }
    }
    None
}

#[derive(Clone, Copy, PartialEq, Debug)]
struct Scheme {
    open: bool,
    /// −1, 0, 1.
    slip: i8,
}

impl Data {
    /// z and λ with every pair in its scheme, the slips of those that stick as they were.
    fn in_scheme(&self, load: &DVector<f64>, old: &DVector<f64>, schemes: &[Scheme]) -> Option<[DVector<f64>; 2]> {
        let n = self.r.nrows();
        let (mut matrix, mut right) = (DMatrix::zeros(n, n), DVector::zeros(n));
        for (pair, scheme) in self.pairs.iter().zip(schemes) {
            if scheme.open {
                matrix.row_mut(pair.normal).copy_from(&self.r.row(pair.normal));
                right[pair.normal] = -load[pair.normal];
            } else {
                matrix[(pair.normal, pair.normal)] = 1.0;
            }
            let Some(joint) = pair.tangential else { continue };
            if scheme.slip == 0 {
                matrix[(joint, joint)] = 1.0;
                right[joint] = old[joint];
            } else {
                let (sign, f) = (f64::from(scheme.slip), if scheme.open { 0.0 } else { pair.friction });
                let row = self.r.row(joint) * sign + self.r.row(pair.normal) * f;
                matrix.row_mut(joint).copy_from(&row);
                right[joint] = -(sign * load[joint] + f * load[pair.normal] + pair.constant);
            }
        }
        let z = matrix.lu().solve(&right)?;
        let force = &self.r * &z + load;
        Some([z, force])
    }

    /// The schemes that would mend what is broken in this state; empty: it is the answer.
    fn mended(&self, old: &DVector<f64>, [z, force]: &[DVector<f64>; 2], schemes: &[Scheme]) -> Vec<(usize, Scheme)> {
        let (tiny, short) = (1e-9 * force.amax().max(1e-6), 1e-9 * z.amax().max(old.amax()).max(1e-9));
        let mut mends = Vec::new();
        for (i, (pair, scheme)) in self.pairs.iter().zip(schemes).enumerate() {
            let mut next = *scheme;
            if pair.opens && scheme.open && z[pair.normal] < -short {
                next.open = false;
            }
            if pair.opens && !scheme.open && force[pair.normal] < -tiny {
                next.open = true;
            }
            if let Some(joint) = pair.tangential {
                let f = if scheme.open { 0.0 } else { pair.friction };
                let bound = f * force[pair.normal] + pair.constant;
                let nothing_holds = scheme.open && pair.constant == 0.0;
                let slip = z[joint] - old[joint];
                if scheme.slip != 0 && f64::from(scheme.slip) * slip < -short && !nothing_holds {
                    next.slip = 0;
                } else if scheme.slip == 0 && force[joint].abs() > bound + tiny {
                    next.slip = if force[joint] > 0.0 { -1 } else { 1 };
                }
            }
            if next != *scheme {
                mends.push((i, next));
            }
        }
        mends
    }

    /// The state after a small step, from the schemes of the step before.
    fn step(&self, load: &DVector<f64>, old: &DVector<f64>, schemes: &mut [Scheme]) -> Option<[DVector<f64>; 2]> {
        let mut random = ChaCha8Rng::seed_from_u64(1);
        for round in 0..400 {
            let state = self.in_scheme(load, old, schemes)?;
            let mends = self.mended(old, &state, schemes);
            if mends.is_empty() {
                return Some(state);
            }
            // All at once, then one after the other by lot.
            let one = random.random_range(0..mends.len());
            for &(i, next) in if round < 20 { &mends[..] } else { &mends[one..=one] } {
                schemes[i] = next;
            }
        }
        None
    }

    /// Every state that a step leads to, by every scheme of every pair; `None` where there are too many to go through.
    fn search(&self, load: &DVector<f64>, old: &DVector<f64>) -> Option<Vec<[DVector<f64>; 2]>> {
        let choices: Vec<Vec<Scheme>> = self
            .pairs
            .iter()
            .map(|pair| {
                let slips: &[i8] = if pair.tangential.is_some() { &[0, 1, -1] } else { &[0] };
                let opens: &[bool] = if pair.opens { &[false, true] } else { &[false] };
                opens.iter().flat_map(|&open| slips.iter().map(move |&slip| Scheme { open, slip })).collect()
            })
            .collect();
        let count: usize = choices.iter().map(Vec::len).product();
        let scheme = |mut number: usize| {
            let pick = |choices: &Vec<Scheme>| {
                let chosen = choices[number % choices.len()];
                number /= choices.len();
                chosen
            };
            choices.iter().map(pick).collect::<Vec<_>>()
        };
        let answers = (0..count).map(scheme).filter_map(|schemes| {
            let state = self.in_scheme(load, old, &schemes)?;
            self.mended(old, &state, &schemes).is_empty().then_some(state)
        });
        (count <= 8_000).then(|| answers.collect())
    }

    /// z at the end of each stage by `steps` small steps a stage; `None` where a step has no answer.
    fn by_steps(&self, stages: &[Vec<f64>], steps: usize) -> Option<Vec<[DVector<f64>; 2]>> {
        let mut z: DVector<f64> = DVector::zeros(self.r.nrows());
        for pair in &self.pairs {
            z[pair.normal] = pair.gap.max(0.0);
        }
        let mut schemes: Vec<Scheme> = self.pairs.iter().map(|pair| Scheme { open: pair.gap > 0.0, slip: 0 }).collect();
        let mut from = vec![0.0; self.cases.len()];
        let mut ends = Vec::new();
        for target in stages {
            let mut state = None;
            for step in 1..=steps {
                let s = step as f64 / steps as f64;
                let factors: Vec<f64> = from.iter().zip(target).map(|(a, b)| a + s * (b - a)).collect();
                let load = self.load(&factors);
                let found = self.step(&load, &z, &mut schemes).or_else(|| {
                    let apart = |state: &[DVector<f64>; 2]| (&state[0] - &z).amax();
                    let states = self.search(&load, &z)?;
                    states.into_iter().min_by(|a, b| apart(a).total_cmp(&apart(b)))
                })?;
                z = found[0].clone();
                state = Some(found);
            }
            ends.push(state?);
            from.clone_from(target);
        }
        Some(ends)
    }
}

/// How far each stage's end is from where `steps` small steps a stage lead, relative to the largest force and
/// displacement; `None` where a small step has no answer.
fn apart(data: &Data, history: &History, steps: usize) -> Option<Vec<f64>> {
    let end = |stage: &StageResult| stage.moments.last().expect("an end").clone();
    let targets: Vec<Vec<f64>> = history.stages.iter().map(|stage| end(stage).factors).collect();
    let ends = data.by_steps(&targets, steps)?;
    let length = ends.iter().map(|[z, _]| z.amax()).fold(0.0, f64::max);
    let size = ends.iter().map(|[_, force]| force.amax()).fold(0.0, f64::max);
    let stages = history.stages.iter().zip(&ends);
    let differences = stages.map(|(stage, [z, force])| {
        let pairs = data.pairs.iter().zip(end(stage).pairs);
        pairs.fold(0.0, |worst: f64, (pair, shown)| {
            let normal =
                ((shown.z_n - z[pair.normal]) / length).abs().max(((shown.x_n - force[pair.normal]) / size).abs());
            let tangential = pair.tangential.map_or(0.0, |joint| {
                ((shown.x_t - force[joint]) / size).abs().max(((shown.z_t - z[joint]) / length).abs())
            });
            worst.max(normal).max(tangential)
        })
    });
    Some(differences.collect())
}

/// The largest distance of any stage end by `steps` small steps, and, where that is more than 4 / `steps`, by 4 and 16
/// times as many; `None` where a small step has no answer.
fn distances(data: &Data, history: &History, steps: usize) -> Option<Vec<f64>> {
    let distance = |steps: usize| Some(apart(data, history, steps)?.into_iter().fold(0.0, f64::max));
    let first = distance(steps)?;
    if first <= 4.0 / steps as f64 {
        return Some(vec![first]);
    }
    Some(vec![first, distance(4 * steps)?, distance(16 * steps)?])
}

/// A step that contains an event is right to the order of what one step moves: small steps lead to the same ends if
/// their distance falls with the step. How far they are apart at one number of steps is no measure, a frame that gives
/// way moves far in one step. Where in a step an event lies makes a factor of up to 4 of the 16 of the first order.
fn converges(distances: &[f64], steps: usize) -> bool {
    match distances {
        [first] => *first <= 4.0 / steps as f64,
        [first, .., last] => 4.0 * last <= *first,
        [] => false,
    }
}

/// Whether a state close to a moment, by less than `near`, is led to 1e-6 of the way to `target` further on: far beyond
/// what the search takes for rounding. `None` where there are too many schemes to go through.
fn goes_on(data: &Data, moment: &Moment, target: &[f64], near: f64) -> Option<bool> {
    let old = data.displacements(&moment.pairs);
    let factors: Vec<f64> = moment.factors.iter().zip(target).map(|(now, to)| now + 1e-6 * (to - now)).collect();
    let states = data.search(&data.load(&factors), &old)?;
    Some(states.iter().any(|[z, _]| (z - &old).amax() <= near))
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
