//! What `new` writes: every kind for several sets of values, its answer against closed forms and small computations of
//! their own that stand here.

use std::f64::consts::PI;
use std::path::Path;

use nalgebra::{DMatrix, DVector};
use serde_json::Value;
use stickslip::model::template::{self, find};
use stickslip::session::{Format, Output, Session, diagnose};
use stickslip::view::style::Style;
use stickslip::watch::Quiet;

/// A scenario of a kind, solved.
pub struct Begun(Session);

impl Begun {
    pub fn of(kind: &str, given: &str) -> Begun {
        let pairs = given.split_whitespace().map(|word| word.split_once('=').expect("NAME=VALUE"));
        let given: Vec<(String, String)> = pairs.map(|(name, value)| (name.to_owned(), value.to_owned())).collect();
        let scenario = find(kind).unwrap().scenario(&given, Path::new("begun.json"));
        Begun(Session::new(scenario.unwrap_or_else(|error| panic!("{error}")), &Quiet).unwrap())
    }

    pub fn report(&mut self, command: &str) -> Value {
        let mut out = Vec::new();
        let mut io = Output::new(&mut out, Style::default(), Format::JsonLines, &Quiet);
        self.0.execute(command, &mut io).unwrap_or_else(|error| panic!("{command}: {error}"));
        serde_json::from_slice::<Value>(&out).unwrap()["report"].clone()
    }

    pub fn get(&mut self, quantity: &str) -> f64 {
        let report = self.report(&format!("show {quantity}"));
        report[0]["value"].as_f64().unwrap_or_else(|| panic!("{quantity}: {report}"))
    }

    pub fn state(&mut self, pair: &str) -> String {
        self.report(&format!("show state {pair}"))[0]["value"].as_str().unwrap().to_owned()
    }

    pub fn parameter(&self, name: &str) -> f64 {
        self.0.values()[name]
    }

    /// `relative` is of the expected value, or of `scale` where that is larger.
    pub fn expect(&mut self, quantity: &str, expected: f64, scale: f64, relative: f64) {
        let found = self.get(quantity);
        let tolerance = relative * expected.abs().max(scale);
        assert!((found - expected).abs() <= tolerance, "{quantity} = {found}, expected {expected} ± {tolerance}");
    }
}

/// Rounding of sums over a structure: equilibrium holds to that, whatever the mesh.
pub const ROUNDING: f64 = 1e-9;

#[test]
fn every_kind_is_solved_as_it_stands_and_nothing_about_it_is_odd() {
    for template in template::ALL {
        let scenario = template.default_scenario().unwrap();
        let diagnosis = diagnose(scenario, &Quiet).unwrap();
        assert!(
            diagnosis.warnings.is_empty() && diagnosis.notes.is_empty(),
            "{}: {:?}",
            template.kind,
            diagnosis.warnings
        );
        let session = Session::new(template.default_scenario().unwrap(), &Quiet).unwrap();
        let answer = session.answer().unwrap();
        assert!(answer.ray.is_none() && answer.check.passed, "{}", template.kind);
    }
}

#[test]
fn what_new_writes_is_loaded_and_solved_and_never_over_something() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("my wall.json");
    let command = format!("new wall courses=3 f=0.5 \"{}\"", path.display());
    let mut session = Begun(Session::new(find("block").unwrap().default_scenario().unwrap(), &Quiet).unwrap());
    let report = session.report(&command);
    assert_eq!(report["notes"][0], format!("wrote {}", path.display()));
    assert_eq!(session.0.scenario().path.as_deref(), Some(&*path));
    assert_eq!(session.0.scenario().text, std::fs::read_to_string(&path).unwrap());
    assert!(session.parameter("f") == 0.5 && session.0.answer().is_some());
    // comments stay through `save`
    session.report("set f 0.45");
    session.report("save");
    let text = std::fs::read_to_string(&path).unwrap();
    assert!(text.contains("// Courses of bricks") && text.contains("0.45"));
    // what is there stays, and a command that fails leaves neither a change nor a file
    let depths = session.0.undo_depths();
    let other = folder.path().join("other.json").display().to_string();
    for refused in
        [command.as_str(), &format!("new wall f=x {other}"), &format!("new wal {other}"), "new wall a.json b.json"]
    {
        let mut out = Vec::new();
        let mut io = Output::text(&mut out, Style::default(), &Quiet);
        assert!(session.0.execute(refused, &mut io).is_err(), "{refused}");
    }
    assert_eq!((session.0.undo_depths(), std::fs::read_to_string(&path).unwrap()), (depths, text));
    assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 1);
    // the list
    let kinds = session.report("new");
    let kinds = kinds.as_array().unwrap();
    assert_eq!(kinds.len(), template::ALL.len());
    let spans = &kinds[1]["names"][0];
    assert_eq!((&spans["name"], &spans["value"], &spans["count"]), (&"spans".into(), &3.0.into(), &true.into()));
    session.report("undo");
    session.report("undo");
    assert_eq!(session.0.scenario().title, "Block on a rough plane");
}

#[test]
fn portal() {
    // Kleinlogel's frame does not shorten and its feet do not bend: large areas and deep footings come close to it.
    let stiff = "A=100 d=50";
    for (l, h, b, q) in [(12.0_f64, 5.0, 0.4, 20.0), (20.0, 4.0, 0.6, 35.0), (8.0, 3.0, 0.2, 10.0)] {
        let k = h / l;
        let mut rocking = Begun::of("portal", &format!("L={l} h={h} b={b} q={q} W=0 f=1.5 {stiff}"));
        // the foot turns about its outer edge: it bears V b/2, less than the clamped moment
        let m = q * l / 2.0 * b / 2.0;
        assert!(m < q * l * l / (12.0 * (k + 2.0)));
        let thrust = q * l * l / (4.0 * h * (2.0 * k + 3.0)) + 3.0 * m * (k + 1.0) / (h * (2.0 * k + 3.0));
        rocking.expect("sum x_n *", q * l, 0.0, ROUNDING);
        rocking.expect("foot_moment", m, 0.0, ROUNDING);
        rocking.expect("thrust", thrust, 0.0, 1e-3);
        let mut clamped = Begun::of("portal", &format!("L={l} h={h} b={} q={q} W=0 f=3 {stiff}", l / 3.0));
        clamped.expect("count open *", 0.0, 0.0, 0.0);
        clamped.expect("thrust", q * l * l / (4.0 * h * (k + 2.0)), 0.0, 1e-3);
    }
    for (l, h, b, q) in [(12.0_f64, 5.0, 0.4, 20.0), (20.0, 4.0, 0.6, 35.0)] {
        let mut sliding = Begun::of("portal", &format!("L={l} h={h} b={b} q={q} W=1 f=0.1"));
        sliding.expect("limit wind", 0.1 * q * l, 0.0, 1e-6);
        let mut rough = Begun::of("portal", &format!("L={l} h={h} b={b} q={q} W=1 f=1.5"));
        rough.expect("limit wind", q * l * ((l + b) / 2.0 / h).min(1.5), 0.0, 1e-6);
    }
    // Here the path leads on beyond the limit only by rounding: runs of their own bracket it.
    for (h, f) in [(7.0_f64, 0.1_f64), (7.0, 0.2), (3.0, 1.5)] {
        let mut frame = Begun::of("portal", &format!("L=8 h={h} b=0.2 q=10 W=1 f={f}"));
        frame.expect("limit wind", 80.0 * f.min(8.2 / 2.0 / h), 0.0, 1e-6);
    }
    // pushed the other way: a turning point beyond the sliding limit f q L is none
    let mut pulled = Begun::of("portal", "L=12 h=8 b=0.51 f=0.508 q=10 W=-0.5");
    pulled.expect("limit W", -0.508 * 120.0, 0.0, 1e-6);
}

/// Moments over the bearings of a beam by Clapeyron's equation, and its reactions; spans, load, EI, settlements.
fn three_moments(spans: &[f64], q: f64, ei: f64, s: &[f64]) -> (Vec<f64>, Vec<f64>) {
    let n = spans.len();
    let mut matrix = DMatrix::<f64>::identity(n + 1, n + 1);
    let mut right = DVector::<f64>::zeros(n + 1);
    for k in 1..n {
        let (a, b) = (spans[k - 1], spans[k]);
        matrix[(k, k - 1)] = a;
        matrix[(k, k)] = 2.0 * (a + b);
        matrix[(k, k + 1)] = b;
        right[k] = -q * (a.powi(3) + b.powi(3)) / 4.0 + 6.0 * ei * ((s[k] - s[k - 1]) / a + (s[k] - s[k + 1]) / b);
    }
    let m = matrix.lu().solve(&right).unwrap();
    let mut reactions = vec![0.0; n + 1];
    for (k, l) in spans.iter().enumerate() {
        let tilt = (m[k + 1] - m[k]) / l;
        reactions[k] += q * l / 2.0 + tilt;
        reactions[k + 1] += q * l / 2.0 - tilt;
    }
    (m.iter().copied().collect(), reactions)
}

#[test]
fn continuous_beam() {
    for (spans, settlements, q, inertia) in [
        (vec![10.0], vec![0.0, 0.01], 30.0, 0.004),
        (vec![10.0, 10.0, 10.0], vec![0.0, 0.02, 0.0, 0.0], 30.0, 0.004),
        (vec![8.0, 12.0], vec![0.0, 0.005, 0.01], 50.0, 0.002),
        (vec![9.0, 14.0, 11.0, 14.0, 8.0], vec![0.002, 0.0, 0.01, 0.0, 0.004, 0.0], 40.0, 0.003),
    ] {
        let mut given = format!("spans={} q={q} I={inertia}", spans.len());
        let mut add = |letter: char, values: &[f64]| {
            values.iter().enumerate().for_each(|(k, value)| given.push_str(&format!(" {letter}{}={value}", k + 1)));
        };
        add('L', &spans);
        add('s', &settlements);
        let mut beam = Begun::of("continuous-beam", &given);
        let (moments, reactions) = three_moments(&spans, q, 2.1e8 * inertia, &settlements);
        assert!(reactions.iter().all(|r| *r > 0.0), "all bearings carry: {reactions:?}");
        let total = q * spans.iter().sum::<f64>();
        for (k, reaction) in reactions.iter().enumerate() {
            beam.expect(&format!("R{}", k + 1), *reaction, total, ROUNDING);
        }
        for (k, moment) in moments.iter().enumerate().take(spans.len()).skip(1) {
            beam.expect(&format!("M{}", k + 1), *moment, total, ROUNDING);
        }
    }
    // the middle bearing sinks away: one beam over both spans, M = q a b/2 where it was
    let mut lifted = Begun::of("continuous-beam", "spans=2 L1=6 L2=9 s2=0.5");
    assert_eq!(lifted.state("c2"), "open");
    lifted.expect("M2", 30.0 * 6.0 * 9.0 / 2.0, 0.0, ROUNDING);
    lifted.expect("R1", 30.0 * 15.0 / 2.0, 0.0, ROUNDING);
}

/// A riser (clamped at its top) and a run of frame elements over the supports that are closed, without friction:
/// reactions of the supports, then force and moment at the nozzle.
fn pipe_without_friction(
    a: f64,
    h: f64,
    ea: f64,
    ei: f64,
    w: f64,
    strain: f64,
    closed: &[bool],
) -> (Vec<f64>, [f64; 3]) {
    let nodes = closed.len() + 2;
    let place = |k: usize| if k == 0 { [0.0, h] } else { [(k - 1) as f64 * a, 0.0] };
    let mut stiffness = DMatrix::<f64>::zeros(3 * nodes, 3 * nodes);
    let mut load = DVector::<f64>::zeros(3 * nodes);
    for k in 0..nodes - 1 {
        let (from, to) = (place(k), place(k + 1));
        let (dx, dy) = (to[0] - from[0], to[1] - from[1]);
        let l = dx.hypot(dy);
        let (c, s) = (dx / l, dy / l);
        let turn = DMatrix::from_fn(6, 6, |i, j| match (i % 3, j % 3, i / 3 == j / 3) {
            (0, 0, true) | (1, 1, true) => c,
            (0, 1, true) => s,
            (1, 0, true) => -s,
            (2, 2, true) => 1.0,
            _ => 0.0,
        });
        let (x, b, m, r) = (ea / l, 12.0 * ei / l.powi(3), 6.0 * ei / l.powi(2), 2.0 * ei / l);
        #[rustfmt::skip]
        let local = DMatrix::from_row_slice(6, 6, &[
            x, 0.0, 0.0, -x, 0.0, 0.0,
            0.0, b, m, 0.0, -b, m,
            0.0, m, 2.0 * r, 0.0, -m, r,
            -x, 0.0, 0.0, x, 0.0, 0.0,
            0.0, -b, -m, 0.0, b, -m,
            0.0, m, r, 0.0, -m, 2.0 * r,
        ]);
        // weight in the axes of the bar, and the push of the heat
        let (along, across) = (-w * s, -w * c);
        let heat = ea * strain;
        let given = DVector::from_row_slice(&[
            along * l / 2.0 - heat,
            across * l / 2.0,
            across * l * l / 12.0,
            along * l / 2.0 + heat,
            across * l / 2.0,
            -across * l * l / 12.0,
        ]);
        let mut block = stiffness.view_mut((3 * k, 3 * k), (6, 6));
        block += turn.transpose() * local * &turn;
        let mut part = load.rows_mut(3 * k, 6);
        part += turn.transpose() * given;
    }
    let held = |dof: usize| dof < 3 || (dof >= 6 && dof % 3 == 1 && closed[dof / 3 - 2]);
    let free: Vec<usize> = (0..3 * nodes).filter(|&dof| !held(dof)).collect();
    let reduced = DMatrix::from_fn(free.len(), free.len(), |i, j| stiffness[(free[i], free[j])]);
    let right = DVector::from_fn(free.len(), |i, _| load[free[i]]);
    let solution = reduced.lu().solve(&right).unwrap();
    let mut u = DVector::<f64>::zeros(3 * nodes);
    free.iter().zip(solution.iter()).for_each(|(&dof, value)| u[dof] = *value);
    let forces = stiffness * u - load;
    let supports = (0..closed.len()).map(|k| forces[3 * (k + 2) + 1]).collect();
    (supports, [forces[0], forces[1], forces[2]])
}

#[test]
fn pipeline() {
    for (supports, a, h, d, t, w, heat) in [
        (6, 3.0, 4.0, 0.2191_f64, 0.01, 0.62, 180.0),
        (6, 3.0, 4.0, 0.2191, 0.01, 0.62, 0.0),
        (1, 2.0, 1.0, 0.1, 0.004, 0.2, 50.0),
        (12, 6.0, 7.0, 0.4, 0.012, 2.5, 300.0),
    ] {
        let given = format!("supports={supports} a={a} h={h} D={d} t={t} w={w} dT={heat}");
        let mut pipe = Begun::of("pipeline", &format!("{given} f=0"));
        let closed: Vec<bool> = (1..=supports).map(|k| pipe.state(&format!("c{k}")) != "open").collect();
        let area = PI / 4.0 * (d * d - (d - 2.0 * t).powi(2));
        let inertia = PI / 64.0 * (d.powi(4) - (d - 2.0 * t).powi(4));
        let (reactions, nozzle) = pipe_without_friction(a, h, 2e8 * area, 2e8 * inertia, w, 1.2e-5 * heat, &closed);
        let weight = w * (h + f64::from(supports as u32) * a);
        for (k, reaction) in reactions.iter().enumerate() {
            pipe.expect(&format!("x_n c{}", k + 1), *reaction, weight, 1e-8);
        }
        for (quantity, expected) in ["fx nozzle", "fy nozzle", "m nozzle"].into_iter().zip(nozzle) {
            pipe.expect(quantity, expected, weight * a, 1e-8);
        }
        // with friction: equilibrium of the whole
        let mut rough = Begun::of("pipeline", &format!("{given} f=0.3"));
        let lift = rough.get("fy nozzle");
        rough.expect("sum x_n *", weight - lift, weight, ROUNDING);
        let thrust = rough.get("fx nozzle");
        rough.expect("sum x_t *", -thrust, weight, ROUNDING);
        let turning: f64 = (1..=supports)
            .map(|k| {
                let (n, t) = (rough.get(&format!("x_n c{k}")), rough.get(&format!("x_t c{k}")));
                assert!(t.abs() <= 0.3 * n + ROUNDING * weight);
                n * f64::from(k as u32) * a + t * h
            })
            .sum();
        let run = f64::from(supports as u32) * a;
        rough.expect("m nozzle", w * run * run / 2.0 - turning, weight * run, ROUNDING);
    }
}

#[test]
fn block() {
    for (b, h, t, gamma, f, push, mesh) in [
        (1.0_f64, 2.0, 1.0, 25.0, 0.4_f64, 10.0, "4 8"),
        (2.0, 1.0, 0.5, 80.0, 0.3, 20.0, "6 3"),
        (1.5, 3.0, 2.0, 20.0, 0.9, -30.0, "1 1"),
    ] {
        let (columns, rows) = mesh.split_once(' ').unwrap();
        let given = format!("b={b} h={h} t={t} gamma={gamma} f={f} H={push} columns={columns} rows={rows}");
        let mut block = Begun::of("block", &given);
        let weight = gamma * b * h * t;
        block.expect("normal", weight, 0.0, ROUNDING);
        block.expect("shear", -push, weight, ROUNDING);
        block.expect("eccentricity", push * h / weight, b, ROUNDING);
        let limit = (f * weight).min(weight * b / (2.0 * h)).copysign(push);
        block.expect("limit push", limit, 0.0, 1e-6);
    }
}

#[test]
fn block_stack() {
    for (n, b, h, f, p) in [
        (4, 0.6_f64, 0.4_f64, 0.6_f64, 0.0_f64),
        (1, 1.0, 0.5, 0.3, 10.0),
        (7, 0.5, 0.3, 0.2, 0.0),
        (3, 0.8, 0.2, 0.5, 25.0),
    ] {
        let mut stack = Begun::of("block-stack", &format!("blocks={n} b={b} h={h} f={f} P={p} g=0.02"));
        let weight = f64::from(n) * 24.0 * b * h * 0.6;
        stack.expect("normal", p + weight, 0.0, ROUNDING);
        stack.expect("shear", -0.02 * weight, weight, ROUNDING);
        stack.expect("eccentricity", 0.02 * weight * f64::from(n) * h / 2.0 / (p + weight), b, ROUNDING);
        // above the base the least of both: further up there is less weight beside P, and the arm is shorter
        let limit = (f * (p + weight) / weight).min((p + weight) * b / (f64::from(n) * h * weight));
        stack.expect("limit quake", limit, 0.0, 1e-6);
    }
}

#[test]
fn wall() {
    for (courses, bricks, l, h, f) in
        [(4, 3, 0.6, 0.3, 0.2), (1, 1, 0.5, 0.2, 0.3), (5, 2, 0.4, 0.2, 0.1), (2, 5, 0.3, 0.1, 0.25)]
    {
        let mut wall = Begun::of("wall", &format!("courses={courses} bricks={bricks} l={l} h={h} f={f} g=0.05"));
        let weight = f64::from(courses * bricks) * 20.0 * l * h * 0.3;
        wall.expect("base_normal", weight, 0.0, ROUNDING);
        wall.expect("base_shear", -0.05 * weight, 0.0, ROUNDING);
        wall.expect("limit quake", f, 0.0, 1e-6);
    }
    // rigid blocks, the end turns: see scenarios/scripts/wall.stick, half bricks as long as high
    Begun::of("wall", "l=0.6 h=0.3").expect("limit quake", 7.0 / 11.0, 0.0, 1e-6);
    // a single brick overturns at l/h
    Begun::of("wall", "courses=1 bricks=1 l=0.2 h=0.5 f=1.2").expect("limit quake", 0.4, 0.0, 1e-6);
}

#[test]
fn dam() {
    // the last two are overflown: the water stands higher than the face
    for (z, h, b, crest, drain) in [
        (28.0, 30.0, 24.0, 4.0, 0.6),
        (45.0, 50.0, 40.0, 6.0, 0.3),
        (10.0, 20.0, 15.0, 3.0, 0.0),
        (24.0, 20.0, 30.0, 4.0, 0.4),
        (33.0, 30.0, 36.0, 5.0, 0.0),
    ] {
        let mut dam = Begun::of("dam", &format!("z={z} H={h} B={b} crest={crest} drain={drain} f=0.9"));
        let weight = 24.0 * h * (b + crest) / 2.0;
        let uplift = drain * 9.81 * z * b / 2.0;
        // pressure 9.81 (z - y) on strips of the face, and its moment about the base, by the midpoint rule; its error is
        // that of the moment, 9.81 H^3/12 of the square of the strips, beside 9.81 H^2 (z/2 - H/3)
        let strips: f64 = 20_000.0;
        let middle = |strip: i32| (f64::from(strip) + 0.5) * h / strips;
        let pressure = |y: f64| 9.81 * (z - y).max(0.0) * h / strips;
        let thrust: f64 = (0..20_000).map(middle).map(pressure).sum();
        let overturning: f64 = (0..20_000).map(middle).map(|y| y * pressure(y)).sum();
        // moments about the heel: rectangle and triangle of the section, triangles of uplift and water
        let moment = 24.0 * h * (crest * crest / 2.0 + (b - crest) / 2.0 * (crest + (b - crest) / 3.0))
            - uplift * b / 3.0
            + overturning;
        let e = moment / (weight - uplift) - b / 2.0;
        dam.expect("normal", weight - uplift, 0.0, ROUNDING);
        dam.expect("shear", -thrust, 0.0, 1e-8);
        dam.expect("eccentricity", e, b, 1e-8);
        // what the scenario says of itself
        for (name, expected) in [("weight", weight), ("uplift", uplift), ("thrust", thrust), ("e", e)] {
            let told = dam.parameter(name);
            assert!((told - expected).abs() <= 1e-8 * expected.abs().max(b), "{name} = {told}, not {expected}");
        }
        dam.expect("safety water", 0.9 * (weight - uplift) / thrust, 0.0, 1e-6);
    }
}

#[test]
fn footing() {
    let all = [(1.5_f64, 6.0, 900.0, 1e4), (0.5, 6.0, 600.0, 4e4), (3.0, 9.0, 1500.0, 2e4), (0.0, 7.0, 500.0, 1e4)];
    for (e, b, n, k) in all {
        // a depth of 300 m: rigid. The ground is a spring at each of 61 nodes, half as stiff at the ends.
        let mut footing = Begun::of("footing", &format!("e={e} B={b} N={n} k={k} d=300"));
        footing.expect("normal", n, 0.0, ROUNDING);
        footing.expect("eccentricity", e, 0.0, 1e-7);
        // the same springs under a rigid bar: settlement s and slope r from equilibrium with those that press
        let node = |i: usize| {
            let share = if i == 0 || i == 60 { 0.5 } else { 1.0 };
            (b * (i as f64 / 60.0 - 0.5), share * k * b / 60.0)
        };
        let (mut s, mut r) = (1.0, 0.0);
        for _ in 0..100 {
            let (mut k0, mut k1, mut k2) = (0.0, 0.0, 0.0);
            for (x, stiffness) in (0..=60).map(node).filter(|(x, _)| s + r * x > 0.0) {
                k0 += stiffness;
                k1 += stiffness * x;
                k2 += stiffness * x * x;
            }
            let determinant = k0 * k2 - k1 * k1;
            (s, r) = ((n * k2 - n * e * k1) / determinant, (n * e * k0 - n * k1) / determinant);
        }
        footing.expect("edge_settlement", -(s + r * b / 2.0), 0.0, 1e-5);
        // and those are near the continuous bed: a triangle beyond the kern, by the square of the mesh
        let edge = if e > b / 6.0 { 2.0 * n / (3.0 * (b / 2.0 - e)) } else { n / b * (1.0 + 6.0 * e / b) };
        footing.expect("edge_settlement", -edge / k, 0.0, 2e-3);
        // and so is what the ground presses with, force per length: the nodal forces dip at the last node, it does not
        let traction = footing.report("plot traction");
        let loaded = traction[0]["pairs"].as_array().unwrap().last().unwrap();
        assert_eq!(loaded["id"], "soil[60]");
        let pressed = loaded["normal"].as_f64().unwrap();
        assert!((pressed - edge).abs() <= 2e-3 * edge, "{pressed}, not {edge}");
        let told = footing.parameter("edge");
        assert!((told - edge).abs() <= 1e-12 * edge, "edge = {told}, not {edge}");
    }
}

#[test]
fn retaining_wall() {
    for (h, toe, heel, t, w, phi, p) in [
        (4.0, 0.8, 1.8, 0.4, 19.0, 30.0, 10.0),
        (6.0, 1.5, 3.0, 0.6, 18.0, 35.0, 5.0),
        (3.0, 0.5, 1.5, 0.3, 20.0, 28.0, 0.0),
    ] {
        let mut wall = Begun::of("retaining-wall", &format!("h={h} toe={toe} heel={heel} t={t} w={w} phi={phi} p={p}"));
        let ka = (1.0 - f64::to_radians(phi).sin()) / (1.0 + f64::to_radians(phi).sin());
        let push = ka * (w * h * h / 2.0 + p * h);
        let turning = ka * (w * h * h * h / 6.0 + p * h * h / 2.0);
        let (slab, stem, earth) = (25.0 * t * (toe + heel), 25.0 * t * h, (w * h + p) * heel);
        let total = slab + stem + earth;
        // about the foot of the stem, > 0 towards the heel; the earth pushes towards the toe
        let moment = slab * (heel - toe) / 2.0 + earth * heel / 2.0 - turning;
        wall.expect("normal", total, 0.0, ROUNDING);
        wall.expect("shear", push, 0.0, ROUNDING);
        wall.expect("stem_moment", turning, 0.0, ROUNDING);
        wall.expect("resultant ground e", moment / total - (heel - toe) / 2.0, toe + heel, 1e-8);
        wall.expect("safety earth", 0.5 * total / push, 0.0, 1e-6);
    }
}

#[test]
fn press_fit() {
    for (d, a, b, c, w) in
        [(0.01, 10.0, 20.0, 35.0, 1.0), (0.05, 40.0, 60.0, 90.0, 25.0), (0.004, 5.0, 8.0, 20.0, 10.0)]
    {
        let (a2, b2, c2) = (a * a, b * b, c * c);
        let p = 2.1e5 * d * (b2 - a2) * (c2 - b2) / (2.0 * b * b2 * (c2 - a2));
        // the growth of the outside: E u = 2 p b² c/(c² - b²)
        let growth = 2.0 * p * b2 * c / (2.1e5 * (c2 - b2));
        let errors = [1, 2].map(|fine| {
            let segments = 12 * fine;
            let mesh = format!("segments={segments} inner={} outer={}", 3 * fine, 4 * fine);
            let mut fit = Begun::of("press-fit", &format!("d={d} a={a} b={b} c={c} w={w} {mesh}"));
            fit.expect("count open *", 0.0, 0.0, 0.0);
            let segment = p * w * b * PI / 2.0 / f64::from(segments);
            assert!((fit.parameter("segment") / segment - 1.0).abs() < 1e-12);
            [fit.get("pair_force") / segment - 1.0, fit.get("widening") / growth - 1.0].map(f64::abs)
        });
        for (coarse, fine) in errors[0].iter().zip(errors[1]) {
            // of second order: a quarter
            assert!(fine < 4e-3 && (fine - coarse / 4.0).abs() < coarse / 10.0, "{errors:?}");
        }
    }
}
