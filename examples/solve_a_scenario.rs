//! A structure from its file to its answer, in Rust.
//!
//! `cargo run --example solve_a_scenario [FILE]`; without a file the embedded `frame`.

use std::error::Error;

use stickslip::model::{embedded, load};
use stickslip::solve::prepare;
use stickslip::watch::Quiet;

fn main() -> Result<(), Box<dyn Error>> {
    // The file, read and checked: every problem in it is listed with its place.
    let scenario = match std::env::args().nth(1) {
        Some(file) => load::load_text(&file, &std::fs::read_to_string(&file)?, None)?,
        None => embedded::load("frame")?,
    };
    // R and RF: once, as long as no number of the geometry changes.
    let prepared = prepare(&scenario, &Quiet)?;
    // Everything else follows the values of the parameters.
    let values = scenario.parameter_values();
    let solved = prepared.case(&scenario, &values).solve()?;

    println!("{}: {:?} after {} pivots", scenario.title, solved.answer.outcome, solved.answer.pivot_count);
    for pivot in &solved.answer.pivots {
        println!("  {}", pivot.sentence);
    }
    for pair in &solved.answer.pairs {
        println!("  {:<8} {:<6} x_n {:>12.4}  x_t {:>12.4}", pair.id, pair.state.word(), pair.x_n, pair.x_t);
    }
    if let Some(ray) = &solved.answer.ray {
        println!("  {}", ray.explanation);
    }
    Ok(())
}
