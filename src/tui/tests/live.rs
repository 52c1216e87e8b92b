//! What a slider shows at once and what follows.

use super::*;
use crate::session::results::{Answer, Start};

/// Two plates of 8 × 1 on one another with 160 pairs: from 150 on an answer is followed from the last one.
const PLATES: &str = r#"{"format":"stickslip/1","title":"Two plates","parameters":{"f":{"value":0.4,"step":0.01},"T":60},
"materials":{"m":{"E":1e5,"nu":0.3}},
"plates":[
{"id":"lower","origin":[0,0],"size":[8,1],"divisions":[159,1],"thickness":0.1,"material":"m","plane":"strain"},
{"id":"upper","origin":[0,1],"size":[8,1],"divisions":[159,1],"thickness":0.1,"material":"m","plane":"strain"}],
"supports":[{"at":"lower.bottom","fixed":["x","y"]}],
"springs":[{"at":"upper.left","direction":[1,0],"stiffness":10}],
"contacts":[{"id":"joint","edge":"upper.bottom","against":"lower.top","friction":"f"}],
"loads":{"weight":{"items":[{"traction":{"edge":"upper.top","value":[0,-100]}}]},
"pull":{"factor":"T","items":[{"traction":{"edge":"upper.left","value":[1,0.2]}}]}}}"#;

fn plates() -> Rig {
    Rig::of(load_text("plates", PLATES, None).unwrap(), 140, 45)
}

fn answer(rig: &Rig) -> &Answer {
    rig.session.answer().unwrap()
}

/// The answer under the present values, solved from nothing.
fn cold(rig: &Rig) -> Answer {
    let (prepared, scenario) = (rig.session.prepared().unwrap(), rig.session.shared_scenario());
    prepared.case(&scenario, rig.session.values()).solve().unwrap().answer
}

fn near(a: &[f64], b: &[f64]) {
    let size = a.iter().fold(0.0, |size: f64, value| size.max(value.abs()));
    assert!(size > 0.0 && a.len() == b.len());
    for (a, b) in a.iter().zip(b) {
        assert!((a - b).abs() <= 1e-9 * size, "{a} instead of {b}, beside {size}");
    }
}

fn pairs(answer: &Answer) -> Vec<f64> {
    answer.pairs.iter().flat_map(|pair| [pair.x_n, pair.x_t]).collect()
}

fn displacements(answer: &Answer) -> Vec<f64> {
    answer.displacements.iter().flatten().flat_map(|u| [u.ux, u.uy]).collect()
}

/// The Answer pane.
fn written(rig: &Rig) -> String {
    crate::tui::panes::answer::lines(&rig.state, 120).iter().map(|line| format!("{line}\n")).collect()
}

/// One step of the friction: what comes back of it, and what is asked for next.
fn slide(rig: &mut Rig) -> Vec<Effect> {
    rig.state.parameter = 0;
    let [Effect::Run(job)] = &update(&mut rig.state, Action::Do(Do::Vary(10)))[..] else { panic!("one job") };
    let done = rig.perform(job.clone());
    update(&mut rig.state, Action::Done(Box::new(done)))
}

#[test]
fn states_come_first_and_the_rest_follows() {
    let mut rig = plates();
    let before = rig.state.shown.motion.u.clone();
    let effects = slide(&mut rig);
    // the states of the new friction, checked over the joints, beside the displacements of the old one
    let first = answer(&rig).clone();
    assert!(matches!(first.start, Start::Warm { .. }) && first.is_answer());
    assert!(first.check.passed && first.check.joints_only && first.check.equilibrium.is_none());
    assert!(first.displacements.is_none() && first.reactions.is_none());
    near(&pairs(&cold(&rig)), &pairs(&first));
    assert!(rig.state.shown.is_behind() && rig.state.shown.motion.u == before);
    assert!(rig.screen().contains("displacements follow"), "{}", rig.screen());
    assert!(written(&rig).contains("joints passed, equilibrium follows: min w"), "{}", written(&rig));
    // then displacements and equilibrium, and only then the pivots
    assert_eq!(effects, [Effect::Run(Job::Motion)]);
    let moment = Arc::clone(&rig.state.shown.moment);
    let done = rig.perform(Job::Motion);
    let effects = update(&mut rig.state, Action::Done(Box::new(done)));
    assert_eq!(effects, [Effect::Run(Job::Pivots)]);
    assert!(Arc::ptr_eq(&moment, &rig.state.shown.moment), "the same states: their pictures are kept");
    let whole = answer(&rig).clone();
    assert_eq!(whole.pairs, first.pairs);
    assert!(whole.check.passed && !whole.check.joints_only && whole.check.equilibrium.is_some());
    near(&displacements(&cold(&rig)), &displacements(&whole));
    assert!(rig.state.shown.motion.before == before, "the answer before, for comparison");
    assert!(rig.screen().contains("displacements ×"), "{}", rig.screen());
    assert!(written(&rig).contains(" passed: min w"), "{}", written(&rig));
}

#[test]
fn an_answer_overtaken_by_the_next_step_is_completed_for_comparison() {
    let mut rig = plates();
    for value in [0.41, 0.42] {
        rig.perform(Job::Set { name: "f".into(), value });
    }
    assert!(rig.session.previous_answer().unwrap().displacements.is_none());
    rig.perform(Job::Motion);
    let previous = rig.session.previous_answer().unwrap();
    assert!(previous.displacements.is_some() && previous.check.equilibrium.is_some());
    assert!(answer(&rig).displacements.is_some());
}

#[test]
fn a_command_finds_the_answer_whole() {
    for line in ["displacements", "show max u", "reactions", "status", "check", "step first"] {
        let mut rig = plates();
        slide(&mut rig);
        let done = rig.perform(Job::Line { text: line.to_owned(), shows: true });
        assert_eq!(done.error, None, "{line}");
        assert!(answer(&rig).check.equilibrium.is_some() && answer(&rig).displacements.is_some(), "{line}");
        assert!(!done.output.contains("equilibrium follows"), "{line}: {}", done.output);
    }
    for job in [Job::Quantities(Vec::new()), Job::Pivots] {
        let mut rig = plates();
        slide(&mut rig);
        rig.perform(job);
        assert!(answer(&rig).check.equilibrium.is_some());
    }
}

/// Somebody who wants everything to stop.
struct Stops;

impl crate::watch::Watch for Stops {
    fn progress(&self, _: &str, _: f64) {}
    fn stop(&self) -> bool {
        true
    }
}

#[test]
fn the_next_step_does_not_wait_for_displacements() {
    let mut rig = plates();
    assert_eq!(slide(&mut rig), [Effect::Run(Job::Motion)]);
    assert!(!rig.state.awaits(), "the states are drawn before");
    assert_eq!(update(&mut rig.state, Action::Do(Do::Vary(10))), [Effect::Stop]);
    let done = perform(&mut rig.session, &rig.state.shown, Job::Motion, rig.state.look.report(76), &Stops);
    assert!(done.interrupted && !rig.session.solved().unwrap().is_whole());
    let effects = update(&mut rig.state, Action::Done(Box::new(done)));
    assert!(matches!(effects[..], [Effect::Run(Job::Set { .. })]) && rig.state.message.is_none());
    let Effect::Run(job) = effects[0].clone() else { unreachable!() };
    let done = rig.perform(job);
    assert_eq!(update(&mut rig.state, Action::Done(Box::new(done))), [Effect::Run(Job::Motion)]);
}

#[test]
fn the_next_pivot_does_not_wait_for_the_picture_of_the_last() {
    let mut rig = plates();
    let back = |rig: &mut Rig| update(&mut rig.state, Action::Do(Do::StepBack));
    let [Effect::Run(step)] = &back(&mut rig)[..] else { panic!("one job") };
    let done = rig.perform(step.clone());
    assert_eq!(update(&mut rig.state, Action::Done(Box::new(done))), [Effect::Run(Job::Motion)]);
    let at = rig.state.shown.position;
    assert_eq!(back(&mut rig), [Effect::Stop]);
    let done = perform(&mut rig.session, &rig.state.shown, Job::Motion, rig.state.look.report(76), &Stops);
    assert!(done.shown.is_behind() && done.error.is_none());
    let effects = update(&mut rig.state, Action::Done(Box::new(done)));
    assert!(rig.state.shown.is_behind() && rig.state.shown.position == at);
    let [Effect::Run(step @ Job::Step(_))] = &effects[..] else { panic!("{effects:?}") };
    let done = rig.perform(step.clone());
    assert_eq!(update(&mut rig.state, Action::Done(Box::new(done))), [Effect::Run(Job::Motion)]);
    let done = rig.perform(Job::Motion);
    update(&mut rig.state, Action::Done(Box::new(done)));
    assert!(!rig.state.shown.is_behind() && rig.state.shown.motion.u.is_some());
}

/// However often its picture is drawn, a structure is walked over once; one whose places change is another.
#[test]
fn what_pictures_share_is_gathered_once() {
    let mut rig = plates();
    let shared = |rig: &Rig| Arc::clone(rig.state.shown.skeleton().unwrap());
    let first = shared(&rig);
    rig.screen();
    slide(&mut rig);
    rig.press(&["1", "i", "d", "down", "L", "4", "left"]);
    rig.command("set T 70");
    rig.screen();
    assert!(Arc::ptr_eq(&first, &shared(&rig)));
    let mut rig = Rig::new("dam", 140, 45);
    let (before, width) = (shared(&rig), shared(&rig).side(0));
    rig.command("set B 27");
    assert!(!Arc::ptr_eq(&before, &shared(&rig)));
    assert_eq!([width, shared(&rig).side(0)], [24.0, 27.0]);
}
