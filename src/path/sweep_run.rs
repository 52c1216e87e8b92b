//! Runs a sweep: blocks of points on all threads, their rows written in the order of the grid.

use std::io::Write;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::time::Instant;

use rayon::prelude::*;

use super::sweep::{Row, Sweep};
use crate::watch::{StopOnly, Watch};

/// Points that are solved before they are written.
const CHUNK: usize = 256;
/// Points whose equilibrium is looked at together.
const BLOCK: usize = 16;

/// What was done.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Done {
    /// Rows written now.
    pub written: usize,
    /// Rows that were there already.
    pub found: usize,
    /// Rows of the whole shard.
    pub total: usize,
    /// Rows with an answer among those written now.
    pub answers: usize,
}

impl Done {
    /// Whether nothing is missing.
    pub fn is_complete(&self) -> bool {
        self.found + self.written == self.total
    }
}

impl Sweep<'_> {
    /// Solves the points of the shard after the first `found` and writes their rows to `out`, flushed as they come.
    /// Stops after the rows that are ready when `watch` asks to.
    ///
    /// # Errors
    /// Where `out` cannot be written.
    pub fn run(&self, found: usize, out: &mut dyn Write, watch: &dyn Watch) -> std::io::Result<Done> {
        let points = self.shard.points(self.grid.len());
        let mut done = Done { written: 0, found, total: points.len(), answers: 0 };
        let hash = self.header().hash;
        let start = Instant::now();
        let mut next = points.start + found;
        let told = |ready: usize| {
            let words = progress(ready, points.len(), ready - found, start.elapsed().as_secs_f64());
            watch.progress(&words, ready as f64 / points.len() as f64);
        };
        while next < points.end && !watch.stop() {
            let end = (next + CHUNK).min(points.end);
            let stop_only = StopOnly(watch);
            let solved = AtomicUsize::new(done.found + done.written);
            let rows: Vec<Vec<Option<Row>>> = (next..end)
                .into_par_iter()
                .step_by(BLOCK)
                .map(|first| {
                    let block = first..(first + BLOCK).min(end);
                    if watch.stop() {
                        return vec![None];
                    }
                    let found = self.solve(block.clone(), &stop_only);
                    let ready = solved.fetch_add(block.len(), Ordering::Relaxed) + block.len();
                    told(ready);
                    block.zip(found).map(|(index, found)| self.row(index, found, &hash)).collect()
                })
                .collect();
            let rows: Vec<Option<Row>> = rows.into_iter().flatten().collect();
            for row in rows.iter().map_while(Option::as_ref) {
                out.write_all(row.line.as_bytes())?;
                done.written += 1;
                done.answers += usize::from(row.is_answer);
            }
            out.flush()?;
            if rows.iter().any(Option::is_none) {
                // Stopped: what comes after the gap would stand in the wrong place.
                break;
            }
            next = end;
        }
        Ok(done)
    }
}

fn progress(ready: usize, total: usize, written: usize, seconds: f64) -> String {
    let rate = if seconds > 0.0 { written as f64 / seconds } else { 0.0 };
    let left = if rate > 0.0 { (total - ready) as f64 / rate } else { 0.0 };
    let left = match left as u64 {
        0..=119 => format!("{left:.0} s"),
        120..=7199 => format!("{:.0} min", left / 60.0),
        _ => format!("{:.1} h", left / 3600.0),
    };
    format!("{ready} of {total}, {rate:.0}/s, {left} left")
}
