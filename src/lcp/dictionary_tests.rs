//! Dictionaries after random pivots, whatever steps wait in them, compared with the same built afresh from the data.

use std::sync::Arc;

use nalgebra::{DMatrix, DVector};
use rand::{Rng, SeedableRng};
use rand_chacha::ChaCha8Rng;

use super::{Dictionary, Place, Slot};
use crate::lcp::mirrored::{Mirror, MirroredLcp};
use crate::lcp::problem::Scale;

/// Contact of `pairs` pairs with a well-conditioned matrix, a third of the pairs frictionless.
fn contact(rng: &mut ChaCha8Rng, pairs: usize) -> MirroredLcp {
    let rubbing = pairs - pairs / 3;
    let size = pairs + rubbing;
    let root = DMatrix::from_fn(size, size, |_, _| rng.random_range(-1.0..1.0) / (size as f64).sqrt());
    let base = &root * root.transpose() + DMatrix::identity(size, size);
    let mirrors = (0..size).map(|i| {
        (i >= pairs).then(|| Mirror {
            whole: size + i - pairs,
            normal: Some(i - pairs),
            friction: rng.random_range(0.1..0.8),
            constant: rng.random_range(0.0..1.0),
            covering: 0.0,
        })
    });
    let mirrors: Vec<_> = mirrors.collect();
    let mut lcp = MirroredLcp {
        base: Arc::new(base),
        q: DVector::from_fn(size, |_, _| rng.random_range(-1.0..1.0)),
        covering: DVector::zeros(size),
        whole: (0..size).collect(),
        mirrors,
        scale: Scale { row: vec![1.0; size], column: vec![1.0; size], load: None },
        full_size: size + rubbing,
    };
    load(rng, &mut lcp);
    lcp
}

/// Another covering vector, or load increment.
fn load(rng: &mut ChaCha8Rng, lcp: &mut MirroredLcp) {
    lcp.covering = DVector::from_fn(lcp.size(), |_, _| rng.random_range(-1.0..1.0));
    for mirror in lcp.mirrors.iter_mut().flatten() {
        mirror.covering = rng.random_range(-1.0..1.0);
    }
}

/// One random step of the kinds that Lemke's algorithm and paths make: a pivot in column c, the mirror of a basic or of
/// the entering reserve in its place, or another load increment while p is nonbasic.
fn step(rng: &mut ChaCha8Rng, lcp: &mut MirroredLcp, dictionary: &mut Dictionary, last: &mut usize) {
    // Mostly near the last column, as contact changes; p comes and goes.
    let width = dictionary.column.len();
    let c = match (rng.random_range(0..8), dictionary.place(Slot::P)) {
        (0, Place::Column(c)) => c,
        (1, _) => rng.random_range(0..width),
        _ => (*last + rng.random_range(0..9)) % width,
    };
    *last = c;
    if rng.random_range(0..16) == 0 && dictionary.place(Slot::P) == Place::Column(c) {
        if rng.random_range(0..2) == 0 {
            dictionary.rescale(3.0);
            lcp.covering *= 3.0;
            lcp.mirrors.iter_mut().flatten().for_each(|mirror| mirror.covering *= 3.0);
        } else {
            load(rng, lcp);
            dictionary.reload(lcp);
        }
        return;
    }
    let mut column = Vec::new();
    dictionary.fetch_column(c, &mut column);
    if let Slot::W(i) = dictionary.column[c]
        && rng.random_range(0..3) == 0
        && matches!(dictionary.place(Slot::Z(i)), Place::Column(_))
        && dictionary.hidden_rate(lcp, i, c, &column).abs() > 0.3
    {
        dictionary.pivot_hidden(lcp, i, c, &column, 0.1);
        return;
    }
    let largest = column.iter().fold(0.0, |a: f64, b| a.max(b.abs()));
    let rows: Vec<usize> = (0..column.len()).filter(|&r| column[r].abs() > 0.5 * largest).collect();
    let r = rows[rng.random_range(0..rows.len())];
    if let Slot::W(i) = dictionary.row[r]
        && lcp.mirrors[i].is_some()
        && matches!(dictionary.place(Slot::Z(i)), Place::Column(z) if z != c)
        && dictionary.hidden_rate(lcp, i, c, &column).abs() > 0.5 * largest
    {
        column[r] = dictionary.hidden_rate(lcp, i, c, &column);
        dictionary.turn(lcp, i);
    }
    dictionary.pivot(r, c, &column, 0.1);
}

#[test]
fn waiting_steps_change_no_entry() {
    let mut rng = ChaCha8Rng::seed_from_u64(11);
    let (mut compared, mut with_p) = (0, 0);
    for pairs in [4, 30, 90] {
        let mut lcp = contact(&mut rng, pairs);
        let mut dictionary = Dictionary::new(&lcp);
        let mut last = 0;
        for done in 1..=400 {
            step(&mut rng, &mut lcp, &mut dictionary, &mut last);
            if done % 20 != 0 {
                continue;
            }
            let mut fresh = dictionary.clone();
            if !fresh.rebuild(&lcp) {
                continue;
            }
            compared += 1;
            with_p += usize::from(matches!(dictionary.place(Slot::P), Place::Row(_)));
            let width = dictionary.column.len();
            let (mut mine, mut expected) = (Vec::new(), Vec::new());
            let mut columns = Vec::new();
            for c in 0..width {
                fresh.fetch_column(c, &mut expected);
                columns.push(expected.clone());
            }
            let largest = columns.iter().flatten().fold(1.0, |a: f64, b| a.max(b.abs()));
            let close = |value: f64, expected: f64, what: &str| {
                let error = (value - expected).abs();
                assert!(error <= 1e-9 * largest, "{pairs} pairs, step {done}, {what}: {value} for {expected}");
            };
            // What reads without taking steps over comes first.
            let terms: Vec<(usize, f64)> = (0..width).step_by(5).map(|c| (c, 0.1)).collect();
            for (r, value) in dictionary.combined_columns(&terms).into_iter().enumerate() {
                close(value, terms.iter().map(|&(c, factor)| factor * columns[c][r]).sum(), "combination");
            }
            let (r, c) = (rng.random_range(0..dictionary.row.len()), rng.random_range(0..width));
            close(dictionary.reader(c).entry(r), columns[c][r], "entry");
            // All columns of a copy, so that blocks stay behind in the dictionary itself.
            let mut copy = dictionary.clone();
            for (c, expected) in columns.iter().enumerate() {
                copy.fetch_column(c, &mut mine);
                for (value, expected) in mine.iter().zip(expected) {
                    close(*value, *expected, "column");
                }
            }
        }
    }
    assert!(compared > 50 && with_p > 10, "{compared} compared, {with_p} with p basic");
}
