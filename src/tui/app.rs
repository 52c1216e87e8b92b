//! The state of the screen. Nothing here draws, waits or computes.

use std::collections::VecDeque;
use std::rc::Rc;
use std::sync::Arc;
use std::time::Duration;

use indexmap::IndexMap;
use ratatui::text::Line;

use crate::model::parameter::Parameter;
use crate::model::quantity::Quantity;
use crate::model::structure::Dimension;
use crate::session::commands::screen::Tour;
use crate::session::results::PairState;
use crate::session::{AllAnswers, Gauge};
use crate::view::projection::Viewpoint;
use crate::view::style::Role;

use super::action::{Job, Leave, Loading};
use super::entry::Entry;
use super::kept::The;
use super::keymap::Keymap;
use super::pane::{Pane, Plot, SortKey};
use super::pictures::{Order, Pictures};
use super::shown::{Moment, Shown};
use super::theme::Look;
use super::viewport::Viewport;

/// What is typed.
#[derive(Clone, Debug, Default, PartialEq)]
pub enum Input {
    /// Nothing: keys are commands.
    #[default]
    None,
    /// A command after `:`.
    Command(Entry),
    /// A part of a row to go to, after `/`.
    Search {
        /// The text.
        entry: Entry,
        /// The row it began at.
        from: usize,
    },
    /// A value of this parameter.
    Value {
        /// The parameter.
        name: String,
        /// The text.
        entry: Entry,
    },
}

/// What lies over the panes.
#[derive(Clone, Debug, Default, PartialEq)]
pub enum Overlay {
    /// Nothing.
    #[default]
    None,
    /// The keys.
    Help {
        /// First line shown.
        scroll: usize,
    },
    /// Output of a command.
    Output {
        /// The command.
        title: String,
        /// Its output.
        lines: Rc<Vec<Line<'static>>>,
        /// First line shown.
        scroll: usize,
    },
    /// All answers side by side.
    Answers {
        /// The answers.
        answers: AllAnswers,
        /// First line shown.
        scroll: usize,
    },
}

/// A line at the bottom, until the next key.
#[derive(Clone, Debug, PartialEq)]
pub struct Message {
    /// What it says.
    pub text: String,
    /// Good or bad.
    pub role: Role,
}

/// Time between two pivots while they run.
const PLAY: Duration = Duration::from_millis(700);
/// Time between two pictures of a moving mode.
const MOVE: Duration = Duration::from_millis(120);
/// Pictures of one period of the mode.
pub const PERIOD: u32 = 24;

/// Everything the screen knows.
pub struct State {
    /// The session.
    pub shown: Arc<Shown>,
    /// Colours and characters.
    pub look: Look,
    /// The keys.
    pub keys: Arc<Keymap>,
    /// Columns and rows of the terminal.
    pub size: (u16, u16),
    /// Where `q` goes.
    pub home: Leave,
    /// The pane that has the focus.
    pub focus: Pane,
    /// The pane shown where there is room for one of several.
    pub tab: Pane,
    /// Likewise on a large screen, where only Answer, Quantities and Loading share a place.
    pub side: Pane,
    /// Whether the focused pane has the whole screen.
    pub maximized: bool,
    /// The selected parameter.
    pub parameter: usize,
    /// The selected pair, in the order of the file.
    pub pair: usize,
    /// The plot.
    pub plot: Plot,
    /// First line of the answer pane.
    pub answer_scroll: usize,
    /// Order of the pairs.
    pub sort: SortKey,
    /// Largest first.
    pub descending: bool,
    /// The part of the structure in view.
    pub view: Viewport,
    /// From where a structure in space is seen; `None` is as the session says.
    pub turned: Option<Viewpoint>,
    /// Scale of the displacements; `None` is automatic.
    pub magnification: Option<f64>,
    /// Whether the loads are shown.
    pub loads: bool,
    /// Whether the answer before is shown too.
    pub ghost: bool,
    /// Whether each pane explains itself.
    pub explains: bool,
    /// Whether the mode of the ray moves.
    pub moving: bool,
    /// Its picture, 0 … PERIOD − 1.
    pub phase: u32,
    /// Whether the pivots run.
    pub playing: bool,
    /// Values asked for and not answered yet.
    pub wanted: IndexMap<String, f64>,
    /// The pivot asked for and not shown yet.
    pub wanted_step: Option<usize>,
    /// The loading asked for and not shown yet.
    pub wanted_loading: Option<Loading>,
    /// The combination that is to be shown again after every change.
    pub combination: Option<String>,
    /// Quantities that are shown besides the probes.
    pub asked: Vec<Quantity>,
    /// Probes and quantities with their values.
    pub gauges: Vec<Gauge>,
    /// The state they belong to.
    pub gauges_at: Option<The<Moment>>,
    /// The selected quantity.
    pub quantity: usize,
    /// The pane in the place that Plots and Map share on a large screen.
    pub lower: Pane,
    /// The place of the cursor in the map, once it was moved.
    pub map_at: Option<[f64; 2]>,
    /// What is shown again when the cursor of the map is left: the session, while an answer beside it is shown.
    pub below: Option<Arc<Shown>>,
    /// The job at work.
    pub running: Option<Job>,
    /// Jobs that wait for it.
    pub waiting: VecDeque<Job>,
    /// How far it is.
    pub progress: Option<(String, f64)>,
    /// The collapse whose remedies were sought last.
    pub remedies_sought: Option<The<Moment>>,
    /// A line at the bottom.
    pub message: Option<Message>,
    /// What is wrong with the file that is watched: the panes show what it was before.
    pub trouble: Option<String>,
    /// What is typed.
    pub input: Input,
    /// Lines typed before.
    pub history: Vec<String>,
    /// What lies over the panes.
    pub overlay: Overlay,
    /// What was last printed in several lines, to be shown again.
    pub output: Option<(String, Rc<Vec<Line<'static>>>)>,
    /// What was searched for last.
    pub sought: String,
    /// The line of the overlay that was found.
    pub found: Option<usize>,
    /// The tour, and its step.
    pub tour: Option<(Tour, usize)>,
    /// Whether the mouse is taken.
    pub mouse: bool,
    /// The parameter whose slider the mouse holds.
    pub held: Option<usize>,
    /// What was drawn and is kept.
    pub pictures: Pictures,
}

impl State {
    /// A screen on this session.
    pub fn new(shown: Arc<Shown>, look: Look, keys: Arc<Keymap>, size: (u16, u16), home: Leave) -> Self {
        let mut state = State {
            shown,
            look,
            keys,
            size,
            home,
            focus: Pane::Parameters,
            tab: Pane::Structure,
            side: Pane::Answer,
            maximized: false,
            parameter: 0,
            pair: 0,
            plot: Plot::Slip,
            answer_scroll: 0,
            sort: SortKey::File,
            descending: false,
            view: Viewport::default(),
            turned: None,
            magnification: None,
            loads: true,
            ghost: true,
            explains: true,
            moving: false,
            phase: PERIOD / 4,
            playing: false,
            wanted: IndexMap::new(),
            wanted_step: None,
            wanted_loading: None,
            combination: None,
            asked: Vec::new(),
            gauges: Vec::new(),
            gauges_at: None,
            quantity: 0,
            lower: Pane::Plot,
            map_at: None,
            below: None,
            running: None,
            waiting: VecDeque::new(),
            progress: None,
            remedies_sought: None,
            message: None,
            trouble: None,
            input: Input::None,
            history: Vec::new(),
            overlay: Overlay::None,
            output: None,
            sought: String::new(),
            found: None,
            tour: None,
            mouse: true,
            held: None,
            pictures: Pictures::default(),
        };
        state.new_scenario();
        state
    }

    /// Forgets what belongs to another scenario.
    pub fn new_scenario(&mut self) {
        self.parameter = 0;
        self.pair = 0;
        self.answer_scroll = 0;
        self.view = Viewport::default();
        self.turned = None;
        self.magnification = None;
        self.moving = false;
        self.phase = PERIOD / 4;
        self.playing = false;
        self.wanted.clear();
        self.wanted_loading = None;
        self.combination = None;
        self.asked.clear();
        self.gauges.clear();
        self.gauges_at = None;
        self.quantity = 0;
        self.lower = Pane::Plot;
        self.map_at = None;
        self.below = None;
        self.sort = SortKey::File;
        self.descending = false;
        self.held = None;
        if self.shown.values.is_empty() && self.focus == Pane::Parameters {
            self.focus = Pane::Pivots;
        }
        self.plot = self.plots()[0];
    }

    /// The same scenario in another version: what was looked at stays as far as it is there. Pairs and parameters are
    /// brought within their numbers by what follows every job.
    pub fn reloaded(&mut self) {
        self.moving = false;
        self.playing = false;
        self.wanted.clear();
        self.held = None;
    }

    /// How long until the next [`super::action::Action::Tick`]; `None` while nothing moves.
    pub fn tick(&self) -> Option<Duration> {
        if self.playing {
            Some(PLAY)
        } else if self.moving && self.shown.at_ray() {
            Some(MOVE)
        } else {
            None
        }
    }

    /// Whether what is at work belongs to the frame of the last key, if it comes at once. What follows the states of a
    /// slider does not: they are drawn first.
    pub fn awaits(&self) -> bool {
        match &self.running {
            _ if self.progress.is_some() => false,
            Some(Job::Motion) => self.shown.is_whole(),
            Some(Job::Pivots) | None => false,
            Some(_) => true,
        }
    }

    /// The plots that make sense now; never empty.
    pub fn plots(&self) -> Vec<Plot> {
        let pairs = self.shown.pairs();
        let mut plots = match pairs.is_empty() {
            true => vec![Plot::P],
            // Where nothing rubs there are neither friction forces nor slips to look at.
            false if pairs.iter().all(|pair| !pair.law.has_tangential_joint()) => {
                vec![Plot::Pressure, Plot::Gap, Plot::P]
            }
            false => vec![Plot::Slip, Plot::Force, Plot::Pressure, Plot::Gap, Plot::P],
        };
        let members = self.shown.answer().and_then(|answer| answer.members.as_ref());
        if members.is_some_and(|members| !members.is_empty()) {
            plots.extend([Plot::Moment, Plot::Shear, Plot::Axial]);
            if self.shown.structure().is_some_and(|structure| structure.dimension == Dimension::Space) {
                plots.extend([Plot::MomentY, Plot::ShearZ, Plot::Torsion]);
            }
        }
        if self.shown.stage.is_some() && plots.len() > 1 {
            // the pivots of a stage's rate problems are not a way to its end
            plots.retain(|plot| *plot != Plot::P);
        }
        if self.shown.at_ray() {
            plots.insert(0, Plot::Ray);
        }
        plots
    }

    /// Name and description of the selected parameter.
    pub fn selected_parameter(&self) -> Option<(&str, &Parameter)> {
        let (name, parameter) = self.shown.scenario.parameters.get_index(self.parameter)?;
        Some((name, parameter))
    }

    /// The value of a parameter as asked for.
    pub fn value(&self, name: &str) -> f64 {
        self.wanted.get(name).or_else(|| self.shown.values.get(name)).copied().unwrap_or_default()
    }

    /// From where a structure in space is seen.
    pub fn viewpoint(&self) -> Viewpoint {
        self.turned.unwrap_or(self.shown.viewpoint)
    }

    /// The pivot shown or asked for.
    pub fn step(&self) -> Option<usize> {
        let last = self.shown.last_step()?;
        self.wanted_step.or(self.shown.step()).map(|step| step.min(last))
    }

    /// All loadings that can be shown: the scenario's own factors, its combinations, its stages. Only the first where
    /// it has neither.
    pub fn loadings(&self) -> Vec<Loading> {
        let scenario = &self.shown.scenario;
        let combinations = scenario.combinations.iter().map(|(name, _)| Loading::Combination(name.clone()));
        let stages = (0..scenario.stages.len()).map(Loading::Stage);
        [Loading::Own].into_iter().chain(combinations).chain(stages).collect()
    }

    /// The loading shown or asked for.
    pub fn loading(&self) -> Loading {
        if let Some(wanted) = &self.wanted_loading {
            return wanted.clone();
        }
        match (self.shown.stage, &self.shown.combination) {
            (Some(stage), _) => Loading::Stage(stage),
            (None, Some(name)) => Loading::Combination(name.clone()),
            (None, None) => Loading::Own,
        }
    }

    /// Whether a pane has something to say about this scenario that others do not.
    pub fn offers(&self, pane: Pane) -> bool {
        match pane {
            Pane::Quantities => !(self.shown.scenario.probes.is_empty() && self.asked.is_empty()),
            Pane::Loading => self.loadings().len() > 1,
            Pane::Map => self.shown.map.is_some(),
            _ => true,
        }
    }

    /// How many rows the pairs have: of a bare LCP those of z and w.
    pub fn pair_count(&self) -> usize {
        let moment = &self.shown.moment;
        moment.solution.as_ref().map_or(moment.pairs.len(), |solution| solution.z.len())
    }

    /// The pairs in the chosen order.
    pub fn order(&self) -> Rc<Order> {
        self.pictures.order.of((The::one(&self.shown.moment), self.sort, self.descending), || {
            let pairs = self.shown.pairs();
            let mut order: Vec<usize> = (0..pairs.len()).collect();
            let number = |pair: &PairState| match self.sort {
                SortKey::File => 0.0,
                SortKey::State => f64::from(pair.state as u8),
                SortKey::Slip => pair.z_t.abs(),
                SortKey::Pressure => pair.x_n,
                SortKey::Reserve => pair.reserve_plus.min(pair.reserve_minus),
                SortKey::Gap => pair.z_n,
            };
            order.sort_by(|a, b| number(&pairs[*a]).total_cmp(&number(&pairs[*b])).then(a.cmp(b)));
            if self.descending {
                order.reverse();
            }
            Order::new(order)
        })
    }

    /// Something to say until the next key.
    pub fn say(&mut self, role: Role, text: impl Into<String>) {
        self.message = Some(Message { text: text.into(), role });
    }
}
