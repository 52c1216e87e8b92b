//! The exact z of a working scheme all of whose signs hold.

use std::ops::ControlFlow;

use num_rational::BigRational;
use num_traits::{Signed, Zero};

use super::forms::{Branch, Forms};
use super::tree::impose;
use crate::lcp::exact::polyhedron::State;
use crate::lcp::exact::rational_solve::{RationalSolution, clear_denominators, solve};
use crate::watch::Watch;

/// Most groups of a scheme that is completed by a linear program where its equations alone do not decide.
const MOST_COMPLETED: usize = 30;
/// Rounds in which branches with a wrong sign are exchanged.
const ROUNDS: usize = 20;

/// z of an answer in the branches `scheme`, one per group. Where the numbers as stored are just beyond a limit of this
/// scheme, a branch whose sign fails is exchanged for the next one. `None`: no such answer was found, or it was
/// stopped.
pub fn answer_of(forms: &Forms, mut scheme: Vec<usize>, watch: &dyn Watch) -> Option<Vec<BigRational>> {
    for _ in 0..ROUNDS {
        let Some(z) = solution(forms, &scheme, watch) else {
            return if forms.groups.len() <= MOST_COMPLETED { completed(forms, &scheme, watch) } else { None };
        };
        let values = forms.values(&z);
        if forms.scheme(&values).is_some() {
            return Some(z);
        }
        let changed = exchange(forms, &mut scheme, &values);
        if !changed || watch.stop() {
            return None;
        }
    }
    None
}

/// The solution of the scheme's equations, where they are regular and as many as the unknowns that it leaves.
fn solution(forms: &Forms, scheme: &[usize], watch: &dyn Watch) -> Option<Vec<BigRational>> {
    let n = forms.unknowns;
    let mut zero = vec![false; forms.names.len()];
    forms.zero.iter().for_each(|&variable| zero[variable] = true);
    for branch in chosen(forms, scheme) {
        // Of an open pair in the plane x- follows from x_n and x+.
        branch.zero.iter().take(1 + forms.tangents.max(1)).for_each(|&variable| zero[variable] = true);
    }
    let unknown: Vec<usize> = (0..n).filter(|&variable| !zero[variable]).collect();
    // x_t of a frictionless pair may be identically 0.
    let says = |variable: &usize| !forms.forms[variable - n].iter().all(Zero::is_zero);
    let rows: Vec<usize> = (n..zero.len()).filter(|&variable| zero[variable]).filter(says).collect();
    if unknown.len() != rows.len() {
        return None;
    }
    let (mut matrix, mut right) = (Vec::new(), Vec::new());
    for &row in &rows {
        let form = &forms.forms[row - n];
        let picked: Vec<BigRational> = unknown.iter().chain([&n]).map(|&column| form[column].clone()).collect();
        let (mut whole, _) = clear_denominators(&picked);
        right.push(-whole.pop().unwrap_or_default());
        matrix.push(whole);
    }
    let mut progress = |share: f64| -> ControlFlow<()> {
        watch.progress("exact answer", share);
        watch.go_on()
    };
    let RationalSolution::Unique(found) = solve(&matrix, &right, &mut progress) else { return None };
    let mut z = vec![BigRational::zero(); n];
    for (&variable, numerator) in unknown.iter().zip(found.numerators) {
        z[variable] = BigRational::new(numerator, found.denominator.clone());
    }
    Some(z)
}

/// A point of the scheme with all signs kept, by a linear program.
fn completed(forms: &Forms, scheme: &[usize], watch: &dyn Watch) -> Option<Vec<BigRational>> {
    let mut go_on = || !watch.stop();
    let (mut polyhedron, (mut state, _)) = forms.start(&mut go_on);
    for branch in chosen(forms, scheme) {
        if state == State::Feasible {
            (state, _) = impose(&mut polyhedron, branch, &mut go_on);
        }
    }
    (state == State::Feasible).then(|| (0..forms.unknowns).map(|variable| polyhedron.value(variable)).collect())
}

fn chosen<'a>(forms: &'a Forms, scheme: &'a [usize]) -> impl Iterator<Item = &'a Branch> {
    forms.groups.iter().zip(scheme).map(|(group, &branch)| &group.branches[branch])
}

/// Gives every group with a wrong sign the branch in which what is negative is zero; whether any was changed.
fn exchange(forms: &Forms, scheme: &mut [usize], values: &[BigRational]) -> bool {
    let mut changed = false;
    for (group, now) in forms.groups.iter().zip(scheme) {
        let present = &group.branches[*now];
        let leaves = |branch: &Branch| {
            branch.zero.iter().any(|&variable| forms.signed[variable] && values[variable].is_negative())
        };
        let kept = |branch: &Branch| -> usize {
            branch.zero.iter().filter(|variable| present.zero.contains(variable)).count()
        };
        let is_wrong = !present.signs_hold(values) || leaves(present);
        let candidates = group
            .branches
            .iter()
            .enumerate()
            .filter(|(other, branch)| *other != *now && (leaves(branch) || is_wrong && branch.signs.is_empty()));
        if let Some((other, _)) = candidates.max_by_key(|(_, branch)| kept(branch)) {
            *now = other;
            changed = true;
        }
    }
    changed
}
