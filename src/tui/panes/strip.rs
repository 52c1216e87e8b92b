//! The pairs of a contact system along a line: it has no structure to draw.

use ratatui::buffer::Buffer;
use ratatui::layout::Rect;

use super::legend::Legend;
use crate::session::results::{PairState, State as PairMotion};
use crate::tui::app::State;
use crate::tui::paint::put_text;
use crate::view::plot::canvas::{Canvas, Stroke};
use crate::view::plot::structure::pair_sign;
use crate::view::plot::ticks::range;
use crate::view::plot::zone::zone;
use crate::view::style::Role;

/// Where a pair moves along the line.
fn along(state: PairMotion) -> Option<(f64, f64)> {
    match state {
        PairMotion::SlipPlus => Some((1.0, 0.0)),
        PairMotion::SlipMinus => Some((-1.0, 0.0)),
        PairMotion::Open | PairMotion::Stick | PairMotion::Slip | PairMotion::Closed => None,
    }
}

/// The pairs of a contact system along a line.
pub fn draw(state: &State, area: Rect, buffer: &mut Buffer) {
    let look = state.look;
    let pairs: &[PairState] = state.shown.pairs();
    let text = "A contact system (R and RF are given): there is no structure, only its pairs.";
    put_text(look, text, look.role(Role::Muted), area, buffer);
    let rows = area.height.saturating_sub(1).max(1);
    let mut canvas = Canvas::new(usize::from(area.width), usize::from(rows));
    let zone = zone(pairs);
    let (first, last) = range(zone.abscissas.iter().copied());
    let mut legend = Legend::default();
    let (width, y) = (canvas.dots_x(), canvas.dots_y() / 2.0);
    if last > first {
        canvas.draw(Role::Muted, vec![Stroke::Line(vec![(4.0, y), (width - 4.0, y)])]);
    }
    for (pair, at) in pairs.iter().zip(&zone.abscissas) {
        let share = if last > first { (at - first) / (last - first) } else { 0.5 };
        let x = 4.0 + share * (width - 8.0);
        let sign = pair_sign(pair.state, along(pair.state), look.ascii);
        canvas.put(x, y, sign, Role::State(pair.state));
        canvas.label(x, y, &look.text(&pair.id), Role::Muted);
        legend.note(sign, Role::State(pair.state), pair.state.word());
    }
    let report = look.report(usize::from(area.width));
    let drawn = look.lines(&canvas.lines(&report).join("\n"));
    for (row, line) in drawn.iter().enumerate().skip(3) {
        if row < usize::from(rows) {
            buffer.set_line(area.x, area.y + row as u16, line, area.width);
        }
    }
    legend.sort();
    legend.draw(look, area, buffer);
}
