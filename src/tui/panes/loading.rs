//! Combinations of the loads and stages of their history, to be shown one by one.

use ratatui::buffer::Buffer;
use ratatui::layout::Rect;
use ratatui::text::{Line, Span};
use unicode_width::UnicodeWidthStr;

use crate::model::scenario::Stage;
use crate::text::number::short;
use crate::tui::action::Loading;
use crate::tui::app::State;
use crate::tui::listing::{GUTTER, Listing};
use crate::tui::paint::{inside, put_text};
use crate::tui::pane::Pane;
use crate::view::style::{Role, pad_right};

/// What a loading is called.
pub fn name(state: &State, loading: &Loading) -> String {
    match loading {
        Loading::Own => "factors of the loads as they are".to_owned(),
        Loading::Combination(name) => name.clone(),
        Loading::Stage(stage) => format!("stage {} of {}", stage + 1, state.shown.scenario.stages.len()),
    }
}

/// `1.35 weight + 1.5 pull`.
fn factors(state: &State, stage: &Stage) -> String {
    let one = |(case, factor): &(String, crate::model::parameter::Number)| {
        format!("{} {case}", short(factor.value(&state.shown.values)))
    };
    stage.multipliers.iter().map(one).collect::<Vec<_>>().join(" + ")
}

/// What is shown, where it is not the scenario's own.
pub fn note(state: &State) -> String {
    match state.loading() {
        Loading::Own => String::new(),
        loading => name(state, &loading),
    }
}

fn listing(state: &State, loadings: &[Loading], width: u16) -> Listing {
    let look = state.look;
    let width = usize::from(width.saturating_sub(GUTTER));
    let names: Vec<String> = loadings.iter().map(|loading| look.text(&name(state, loading))).collect();
    let column = names[1..].iter().map(|name| name.width()).max().unwrap_or(0).min(width / 2);
    let scenario = &state.shown.scenario;
    let rows = loadings.iter().zip(&names).map(|(loading, name)| {
        let text = match loading {
            Loading::Own => return Line::raw(look.fit(name, width)),
            Loading::Combination(wanted) => {
                let found = scenario.combinations.iter().find(|(name, _)| name == wanted);
                found.map_or(String::new(), |(_, combination)| factors(state, combination))
            }
            Loading::Stage(stage) => scenario.stages.get(*stage).map_or(String::new(), |stage| factors(state, stage)),
        };
        let room = width.saturating_sub(column + 2);
        Line::from(vec![
            Span::raw(format!("{}  ", pad_right(&look.fit(name, column), column))),
            Span::styled(look.fit(&text, room), look.role(Role::Muted)),
        ])
    });
    Listing::new(Vec::new(), rows.collect())
}

fn selected(state: &State, loadings: &[Loading]) -> usize {
    loadings.iter().position(|loading| *loading == state.loading()).unwrap_or_default()
}

/// The loading in a row of the screen.
pub fn at(state: &State, area: Rect, y: u16) -> Option<Loading> {
    let (inside, loadings) = (inside(area), state.loadings());
    let row = listing(state, &loadings, inside.width).row_at(selected(state, &loadings), inside, y)?;
    loadings.get(row).cloned()
}

/// Draws the pane.
pub fn draw(state: &State, area: Rect, buffer: &mut Buffer) {
    let loadings = state.loadings();
    if loadings.len() == 1 {
        let text = "neither `combinations` (sums of load cases) nor `stages` (a load history) in this scenario";
        put_text(state.look, text, state.look.role(Role::Muted), area, buffer);
        return;
    }
    let selected = (selected(state, &loadings), state.focus == Pane::Loading);
    listing(state, &loadings, area.width).draw(state.look, selected, |_| false, area, buffer);
}
