//! The fuzz targets with changed seeds: a bounded run in seconds, the same each time. An input is handled well if
//! nothing panics or hangs and a failed command leaves no traces; `cargo fuzz` looks further.

#[path = "../../fuzz/targets/entry.rs"]
mod entry;

use std::fs;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::Path;
use std::time::{Duration, Instant};

use rand::{Rng, RngCore, SeedableRng};
use rand_chacha::ChaCha8Rng;

/// Pieces of the languages, put in at any place.
const PIECES: &[&str] = &[
    "0",
    "-1",
    "1e308",
    "1e-320",
    "NaN",
    "18446744073709551616",
    "0.1",
    "%",
    "±",
    "..",
    "[",
    "]",
    "{",
    "}",
    "\"",
    "'",
    ",",
    ":",
    ";",
    "#",
    "//",
    "/*",
    "\\",
    "\\u0000",
    "\u{202e}",
    "é",
    "null",
    "true",
    "f",
    "sqrt(",
    "^",
    "c1",
    "to",
    "sort",
    "set ",
    "load beam-ray",
    "\n",
    "\r\n",
    "\t",
    "--at",
    "\"contacts\": [",
    "%%MatrixMarket matrix array real general\n",
];

fn seeds(folders: &[&str]) -> Vec<Vec<u8>> {
    let mut files: Vec<_> = folders
        .iter()
        .flat_map(|folder| fs::read_dir(Path::new(env!("CARGO_MANIFEST_DIR")).join(folder)).expect("the seeds"))
        .map(|entry| entry.expect("an entry").path())
        .filter(|path| path.is_file() && fs::metadata(path).is_ok_and(|file| file.len() < 6000))
        .collect();
    files.sort();
    files.iter().map(|path| fs::read(path).expect("a seed")).collect()
}

fn changed(seed: &[u8], random: &mut ChaCha8Rng) -> Vec<u8> {
    let mut bytes = seed.to_vec();
    for _ in 0..random.random_range(1..5) {
        let at = random.random_range(0..=bytes.len());
        let end = (at + random.random_range(1..12)).min(bytes.len());
        match random.random_range(0..5) {
            0 if at < bytes.len() => bytes[at] = (random.next_u32() & 0xff) as u8,
            1 => drop(bytes.drain(at..end)),
            2 => bytes.truncate(at),
            3 => {
                let piece = bytes[at..end].to_vec();
                let to = random.random_range(0..=bytes.len());
                drop(bytes.splice(to..to, piece));
            }
            _ => {
                let piece = PIECES[random.random_range(0..PIECES.len())];
                drop(bytes.splice(at..at, piece.bytes()));
            }
        }
    }
    bytes
}

/// Every seed as it is, then `count` changed ones: how many of those are accepted.
fn run(target: fn(&[u8]) -> bool, folders: &[&str], count: usize) -> usize {
    let seeds = seeds(folders);
    assert!(!seeds.is_empty());
    let shown = |bytes: &[u8]| String::from_utf8_lossy(bytes).into_owned();
    for seed in &seeds {
        assert!(target(seed), "a seed is refused: {}", shown(seed));
    }
    let mut random = ChaCha8Rng::seed_from_u64(20_261_126);
    let mut accepted = 0;
    for number in 0..count {
        let bytes = changed(&seeds[number % seeds.len()], &mut random);
        let start = Instant::now();
        let found = catch_unwind(AssertUnwindSafe(|| target(&bytes)));
        assert!(found.is_ok(), "a panic at {:?}", shown(&bytes));
        assert!(start.elapsed() < Duration::from_secs(20), "{:?} took {:?}", shown(&bytes), start.elapsed());
        accepted += usize::from(found.is_ok_and(|accepted| accepted));
    }
    accepted
}

/// Some changed inputs pass (otherwise the changes are so coarse that nothing after the first check is reached), and
/// some do not.
fn some_pass(accepted: usize, count: usize) {
    assert!(accepted > 0 && accepted < count, "{accepted} of {count} were accepted");
}

#[test]
fn scenarios() {
    some_pass(run(entry::scenario, &["fuzz/seeds/scenario", "scenarios"], 600), 600);
}

#[test]
fn matrices() {
    some_pass(run(entry::matrix_market, &["fuzz/seeds/matrix_market"], 1500), 1500);
}

#[test]
fn lines() {
    some_pass(run(entry::line, &["fuzz/seeds/line"], 200), 200);
}

#[test]
fn scripts() {
    some_pass(run(entry::script, &["fuzz/seeds/script"], 150), 150);
}

#[test]
fn sweep_files() {
    // Grid and checksums leave hardly a byte of such a file free.
    let accepted = run(entry::sweep, &["fuzz/seeds/sweep"], 600);
    assert!(accepted < 6, "{accepted} altered files were accepted");
}
