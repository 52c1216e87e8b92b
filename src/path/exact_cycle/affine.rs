//! All cycles of the same working schemes: affine in the slips of the pairs that stick where they begin.

use num_rational::BigRational;
use num_traits::{One, Signed, Zero};

use super::question::{Place, Question, Refused, SlipMap, Stretch, Way};
use crate::answer::record::State;
use crate::lcp::exact::dyadic::{nearest, rational};
use crate::lcp::exact::rational_solve::{RationalSolution, clear_denominators, product, solve};
use crate::lcp::exact::scalar::BigInt;
use crate::lcp::problem::NOISE;

/// Squarings of the map in search of a contraction: up to 2⁶ cycles.
const SQUARINGS: u32 = 6;

/// A wish of which the other equations leave no more than this share depends on them, but for the rounding of R.
const DEPENDENT: f64 = 1e-9;

/// A number that depends on the slips at the beginning: coefficients, the constant last.
type Affine = Vec<BigRational>;

/// All cycles of the given schemes.
pub(super) struct Family<'a> {
    /// Joints whose slips at the beginning are free to choose.
    slips: Vec<usize>,
    /// Those of the question, with short ones between where events coincide in f64.
    pub(super) stretches: Vec<Stretch<'a>>,
    /// z of the joints at the beginning and at the end of every stretch, and the share of the half there.
    places: Vec<(Vec<Affine>, Affine)>,
}

/// Equations for z of the joints and t, under one scheme.
struct Equations<'q, 'a> {
    question: &'q Question<'a>,
    half: usize,
    rows: Vec<Vec<BigRational>>,
    right: Vec<Affine>,
}

/// What becomes 0 where the scheme changes.
#[derive(Clone, Copy, PartialEq)]
enum Vanishing {
    Gap,
    Force,
    Reserve { plus: bool },
}

impl<'q, 'a> Equations<'q, 'a> {
    fn new(question: &'q Question<'a>, half: usize) -> Self {
        Equations { question, half, rows: Vec::new(), right: Vec::new() }
    }

    fn unit(&self, place: usize) -> Vec<BigRational> {
        let mut row = vec![BigRational::zero(); self.question.problem().system.joint_count() + 1];
        row[place] = BigRational::one();
        row
    }

    /// Joint (or t, the last) = value.
    fn fix(&mut self, place: usize, value: Affine) {
        self.rows.push(self.unit(place));
        self.right.push(value);
    }

    /// Σ factor·λ + constant = 0.
    fn vanish(&mut self, terms: &[(usize, BigRational)], constant: &BigRational, parameters: usize) {
        let question = self.question;
        let mut row = vec![BigRational::zero(); question.problem().system.joint_count() + 1];
        let mut right = vec![BigRational::zero(); parameters + 1];
        right[parameters] = -constant.clone();
        for (joint, factor) in terms.iter().filter(|(_, factor)| !factor.is_zero()) {
            let stiffness = &question.ends[0].stiffness[*joint];
            let (from, change) = question.constant(self.half, *joint);
            for (entry, r) in row.iter_mut().zip(stiffness.iter().chain([&change])) {
                if !r.is_zero() {
                    *entry += factor * r;
                }
            }
            right[parameters] -= factor * from;
        }
        self.rows.push(row);
        self.right.push(right);
    }

    fn vanishing(&mut self, pair: usize, what: Vanishing, parameters: usize) {
        let none = BigRational::zero();
        let law = &self.question.problem().laws[pair];
        match (what, self.question.problem().system.pairs[pair].plane_tangential()) {
            (Vanishing::Force, _) => self.vanish(&[(pair, BigRational::one())], &none, parameters),
            (Vanishing::Reserve { plus }, Some(joint)) => {
                let sign = if plus { BigRational::one() } else { -BigRational::one() };
                let terms = [(pair, rational(law.friction())), (joint, sign)];
                self.vanish(&terms, &rational(law.fixed_bound()), parameters);
            }
            (Vanishing::Gap | Vanishing::Reserve { .. }, _) => self.fix(pair, vec![none; parameters + 1]),
        }
    }

    /// What the scheme of a pair demands; `before` is its slip where nothing moves it.
    fn scheme(
        &mut self,
        pair: usize,
        (state, held): (State, Option<State>),
        before: &dyn Fn(usize) -> Affine,
        n: usize,
    ) {
        let open = state == State::Open;
        self.vanishing(pair, if open { Vanishing::Force } else { Vanishing::Gap }, n);
        let Some(joint) = self.question.problem().system.pairs[pair].plane_tangential() else { return };
        match if open { held } else { Some(state) } {
            Some(State::SlipPlus) => self.vanishing(pair, Vanishing::Reserve { plus: true }, n),
            Some(State::SlipMinus) => self.vanishing(pair, Vanishing::Reserve { plus: false }, n),
            None => self.vanish(&[(joint, BigRational::one())], &BigRational::zero(), n),
            Some(_) => self.fix(joint, before(joint)),
        }
    }

    fn solution(&self) -> Result<Vec<Affine>, Refused> {
        let cleared: Vec<(Vec<BigInt>, BigInt)> = self.rows.iter().map(|row| clear_denominators(row)).collect();
        let matrix: Vec<Vec<BigInt>> = cleared.iter().map(|(row, _)| row.clone()).collect();
        let parameters = self.right.first().map_or(0, Vec::len);
        let mut found = vec![Vec::with_capacity(parameters); matrix.len()];
        for column in 0..parameters {
            self.question.go_on()?;
            let scaled = self.right.iter().zip(&cleared).map(|(right, (_, by))| &right[column] * by);
            let (right, by) = clear_denominators(&scaled.collect::<Vec<_>>());
            let watch = self.question.watch;
            let quotients = match solve(&matrix, &right, &mut |_| watch.go_on()) {
                RationalSolution::Unique(quotients) => quotients,
                RationalSolution::Interrupted => {
                    self.question.go_on()?;
                    return Err("it was stopped".to_owned());
                }
                _ => return Err("its schemes do not determine its states".to_owned()),
            };
            for (numbers, numerator) in found.iter_mut().zip(quotients.numerators) {
                numbers.push(BigRational::new(numerator, &quotients.denominator * &by));
            }
        }
        Ok(found)
    }
}

/// A pair and what becomes 0 of it.
type Event = (usize, Vanishing);

/// What becomes 0 where one scheme follows another. (A pair that stops slipping does so where another one has an event.)
fn events(here: &Way, next: &Way) -> Vec<Event> {
    let pairs = here.iter().zip(next).enumerate();
    let changed = pairs.filter(|(_, (a, b))| a != b).filter_map(|(pair, (&(a, held_a), &(b, held_b)))| {
        let slips = |state: State, held: Option<State>| if state == State::Open { held } else { Some(state) };
        let what = match (a == State::Open, b == State::Open) {
            (true, false) => Vanishing::Gap,
            (false, true) => Vanishing::Force,
            _ => match (slips(a, held_a)?, slips(b, held_b)?) {
                (State::Stick, State::SlipPlus) => Vanishing::Reserve { plus: true },
                (State::Stick, State::SlipMinus) => Vanishing::Reserve { plus: false },
                _ => return None,
            },
        };
        Some((pair, what))
    });
    changed.collect()
}

/// The joints of the pairs that stick where a cycle begins.
pub(super) fn slips(question: &Question<'_>) -> Vec<usize> {
    let pairs = question.problem().system.pairs.iter().zip(&question.reached);
    let stick = |&(state, held): &(State, Option<State>)| state == State::Stick || held == Some(State::Stick);
    pairs.filter(|(_, way)| stick(way)).filter_map(|(pair, _)| pair.plane_tangential()).collect()
}

/// Makes a family place by place.
struct Maker<'q, 'a> {
    question: &'q Question<'a>,
    family: Family<'a>,
    /// The slips by which coinciding events are put in order.
    chosen: &'q [BigRational],
}

/// The cycles of the schemes that were followed.
pub(super) fn family<'a>(
    question: &Question<'a>,
    slips: &[usize],
    chosen: &[BigRational],
) -> Result<Family<'a>, Refused> {
    let family = Family { slips: slips.to_vec(), stretches: Vec::new(), places: Vec::new() };
    let mut maker = Maker { question, family, chosen };
    let mut equations = Equations::new(question, 0);
    let way = question.reached.iter().enumerate();
    way.for_each(|(pair, way)| equations.scheme(pair, *way, &|joint| maker.chosen(joint), slips.len()));
    equations.fix(question.problem().system.joint_count(), maker.constant(BigRational::zero()));
    maker.family.places.push(solved(&equations)?);
    let mut ended = None;
    for (k, stretch) in question.stretches.iter().enumerate() {
        if ended == Some(stretch.half) {
            continue;
        }
        let next = question.stretches.get(k + 1).filter(|next| next.half == stretch.half);
        let mut now = stretch.clone();
        let before = k.checked_sub(1).map(|before| &question.stretches[before]);
        if before.is_none_or(|before| before.half < stretch.half) {
            // Pairs that slip from the turn on come to their limits there, which in rationals may be a little later.
            let before = before.map_or(&question.reached, |before| &before.way);
            let late = events(before, &stretch.way);
            late.iter().for_each(|(pair, _)| now.way[*pair] = before[*pair]);
            maker.pass(&mut now, &stretch.way, late)?;
        }
        let goes_on = match next {
            None => maker.push(&now, None).map(|()| true)?,
            Some(next) => {
                let all = events(&stretch.way, &next.way);
                if all.is_empty() {
                    return Err("its schemes do not tell what happens between them".to_owned());
                }
                maker.pass(&mut now, &next.way, all)?
            }
        };
        ended = (!goes_on).then_some(stretch.half);
    }
    Ok(maker.family)
}

fn solved(equations: &Equations<'_, '_>) -> Result<(Vec<Affine>, Affine), Refused> {
    let mut found = equations.solution()?;
    let t = found.pop().ok_or("it has no joints")?;
    Ok((found, t))
}

impl<'a> Maker<'_, 'a> {
    fn constant(&self, value: BigRational) -> Affine {
        let mut all = vec![BigRational::zero(); self.family.slips.len() + 1];
        all[self.family.slips.len()] = value;
        all
    }

    /// The slip of a joint at the beginning: one of those that are free, or none.
    fn chosen(&self, joint: usize) -> Affine {
        let mut all = self.constant(BigRational::zero());
        if let Some(place) = self.family.slips.iter().position(|slip| *slip == joint) {
            all[place] = BigRational::one();
        }
        all
    }

    /// The end of a stretch: an event, or that of its half.
    fn end(&self, stretch: &Stretch<'_>, event: Option<Event>) -> Result<(Vec<Affine>, Affine), Refused> {
        let (n, question) = (self.family.slips.len(), self.question);
        let mut equations = Equations::new(question, stretch.half);
        let before = self.family.places.last().map_or(&[][..], |(z, _)| z);
        let way = stretch.way.iter().enumerate();
        way.for_each(|(pair, way)| equations.scheme(pair, *way, &|joint| before[joint].clone(), n));
        match event {
            None => equations.fix(question.problem().system.joint_count(), self.constant(BigRational::one())),
            Some((pair, what)) => equations.vanishing(pair, what, n),
        }
        solved(&equations)
    }

    fn push(&mut self, stretch: &Stretch<'a>, event: Option<Event>) -> Result<(), Refused> {
        let end = self.end(stretch, event)?;
        self.family.places.push(end);
        self.family.stretches.push(stretch.clone());
        Ok(())
    }

    /// Goes on through events that coincide in f64, in the order in which they come here, to the scheme after them.
    /// Whether the half goes on after them: an event at its end in f64 may lie beyond it.
    fn pass(&mut self, now: &mut Stretch<'a>, next: &Way, mut left: Vec<Event>) -> Result<bool, Refused> {
        while !left.is_empty() {
            let mut ends = Vec::new();
            for (place, event) in left.iter().enumerate() {
                // What does not change under this scheme does not come to its limit; it may stand there.
                let Ok(end) = self.end(now, Some(*event)) else { continue };
                ends.push((value(&end.1, self.chosen), place, end));
            }
            self.question.go_on()?;
            let first = ends.into_iter().min_by(|a, b| a.0.cmp(&b.0));
            let Some((t, place, end)) = first else { break };
            if t > BigRational::one() {
                self.push(now, None)?;
                return Ok(false);
            }
            self.family.places.push(end);
            self.family.stretches.push(now.clone());
            let (pair, _) = left.remove(place);
            now.way[pair] = next[pair];
        }
        now.way.clone_from(next);
        Ok(true)
    }
}

/// An affine number under these slips.
fn value(affine: &Affine, slips: &[BigRational]) -> BigRational {
    let one = BigRational::one();
    let slips = slips.iter().chain([&one]);
    affine.iter().zip(slips).filter(|(a, _)| !a.is_zero()).map(|(a, slip)| a * slip).sum()
}

impl Family<'_> {
    /// Coefficients of the slips in z at the end less z at the beginning, joint by joint.
    fn change(&self) -> Vec<Affine> {
        let (first, last) = (&self.places[0].0, &self.places[self.places.len() - 1].0);
        last.iter().zip(first).map(|(last, first)| last.iter().zip(first).map(|(a, b)| a - b).collect()).collect()
    }

    /// Slips, near those of the followed cycle, with which forces and gaps come back.
    pub(super) fn closing(&self, question: &Question<'_>) -> Result<Vec<BigRational>, Refused> {
        let (change, n) = (self.change(), self.slips.len());
        let columns: Vec<_> = (0..=n)
            .map(|column| clear_denominators(&change.iter().map(|affine| affine[column].clone()).collect::<Vec<_>>()))
            .collect();
        let mut rows: Vec<Affine> = change[..question.problem().laws.len()].to_vec();
        for row in &question.ends[0].stiffness {
            question.go_on()?;
            let row = clear_denominators(row);
            rows.push(columns.iter().map(|column| product(&row, column)).collect());
        }
        let mut slips: Vec<BigRational> =
            self.slips.iter().map(|joint| rational(question.begin.state.z[*joint])).collect();
        let touching = self.touching(question);
        for (place, row) in reduced(rows, touching, n).ok_or("no slips close it in rationals")? {
            let others = row.iter().zip(&slips).enumerate().filter(|(column, _)| *column != place);
            slips[place] = -(others.map(|(_, (factor, slip))| factor * slip).sum::<BigRational>() + &row[n]);
        }
        Ok(slips)
    }

    /// Contact forces and reserves that are zero to rounding at a place where the pair goes on sticking: on the way it comes
    /// to its limit and not beyond, as it did before. Here that is so to the last digit, where slips are free for it.
    fn touching(&self, question: &Question<'_>) -> Vec<Affine> {
        let (problem, n) = (question.problem(), self.slips.len());
        let mut all = Vec::new();
        for (k, stretch) in self.stretches.iter().enumerate() {
            let next = self.stretches.get(k + 1).or(self.stretches.first());
            let Some(next) = next.filter(|next| !std::ptr::eq(next.end, stretch.end)) else { continue };
            for (pair, joints) in problem.system.pairs.iter().enumerate() {
                let rests = |stretch: &Stretch<'_>| stretch.way[pair] == (State::Stick, None);
                let Some(joint) = joints.plane_tangential().filter(|_| rests(stretch) && rests(next)) else {
                    continue;
                };
                let (law, state) = (&problem.laws[pair], &stretch.end.state);
                let [(normal, normal_terms), (own, own_terms)] =
                    [pair, joint].map(|joint| (state.force[joint], state.terms[joint]));
                let bound = law.friction() * normal + law.fixed_bound();
                let noise = NOISE * (law.friction() * normal_terms + law.fixed_bound() + own_terms);
                for sign in [1.0, -1.0].into_iter().filter(|sign| (bound + sign * own).abs() <= noise) {
                    let [normal, own] = [pair, joint].map(|joint| self.force(question, k + 1, joint));
                    let (friction, sign) = (rational(law.friction()), rational(sign));
                    let mut row: Affine = normal.iter().zip(&own).map(|(n, t)| &friction * n + &sign * t).collect();
                    row[n] += rational(law.fixed_bound());
                    all.push(row);
                }
            }
        }
        all
    }

    /// The half in which a place is shown.
    fn half_of(&self, place: usize) -> usize {
        place.checked_sub(1).map_or(0, |stretch| self.stretches[stretch].half)
    }

    /// λ of a joint at a place.
    fn force(&self, question: &Question<'_>, place: usize, joint: usize) -> Affine {
        let (z, t) = &self.places[place];
        let half = self.half_of(place);
        let (from, change) = question.constant(half, joint);
        let row = &question.ends[0].stiffness[joint];
        let n = self.slips.len();
        let column = |column: usize| {
            let own = row.iter().zip(z).filter(|(r, _)| !r.is_zero()).map(|(r, z)| r * &z[column]);
            own.sum::<BigRational>() + &change * &t[column]
        };
        let mut force: Affine = (0..=n).map(column).collect();
        force[n] += from;
        force
    }

    /// The states that the slips lead to.
    pub(super) fn places(&self, question: &Question<'_>, slips: &[BigRational]) -> Vec<Place> {
        let (slips, by) = clear_denominators(&slips.iter().cloned().chain([BigRational::one()]).collect::<Vec<_>>());
        let slips = (slips, by);
        let value = |affine: &Affine| product(&clear_denominators(affine), &slips);
        let rows: Vec<_> = question.ends[0].stiffness.iter().map(|row| clear_denominators(row)).collect();
        let places = self.places.iter().enumerate().map(|(k, (z, t))| {
            let half = self.half_of(k);
            let (t, z): (BigRational, Vec<BigRational>) = (value(t), z.iter().map(value).collect());
            let whole = clear_denominators(&z);
            let force = rows.iter().enumerate().map(|(joint, row)| {
                let (from, change) = question.constant(half, joint);
                product(row, &whole) + from + change * &t
            });
            Place { half, force: force.collect(), t, z }
        });
        places.collect()
    }

    /// What a cycle does to differences of slips.
    pub(super) fn map(&self, question: &Question<'_>) -> Result<SlipMap, Refused> {
        let n = self.slips.len();
        let end = &self.places[self.places.len() - 1].0;
        let mut map: Vec<Vec<BigRational>> = self.slips.iter().map(|joint| end[*joint][..n].to_vec()).collect();
        let one = |i: usize, j: usize| if i == j { BigRational::one() } else { BigRational::zero() };
        if map.iter().enumerate().all(|(i, row)| row.iter().enumerate().all(|(j, entry)| *entry == one(i, j))) {
            return Ok(SlipMap::Identical);
        }
        for squarings in 0..=SQUARINGS {
            let largest = map.iter().map(|row| row.iter().map(Signed::abs).sum::<BigRational>()).max();
            if let Some(share) = largest.filter(|largest| *largest < BigRational::one()) {
                let share = nearest(&share).next_up();
                return Ok(SlipMap::Contracting { share, cycles: 1 << squarings });
            }
            question.go_on()?;
            let rows: Vec<_> = map.iter().map(|row| clear_denominators(row)).collect();
            let column = |j: usize| clear_denominators(&map.iter().map(|row| row[j].clone()).collect::<Vec<_>>());
            let columns: Vec<_> = (0..n).map(column).collect();
            map = rows.iter().map(|row| columns.iter().map(|column| product(row, column)).collect()).collect();
        }
        Ok(SlipMap::Open)
    }
}

/// Rows solved for one unknown each, in reduced form (the constant is the last of `n` + 1 columns); `None` where they
/// contradict one another. Rows that are only `wished` are left out where they contradict those before.
fn reduced(rows: Vec<Affine>, wished: Vec<Affine>, n: usize) -> Option<Vec<(usize, Affine)>> {
    let mut done: Vec<(usize, Affine)> = Vec::new();
    let without = |row: Affine, place: usize, other: &Affine| -> Affine {
        if row[place].is_zero() {
            return row;
        }
        let factor = row[place].clone();
        row.into_iter().zip(other).map(|(a, b)| if b.is_zero() { a } else { a - &factor * b }).collect()
    };
    let demanded = rows.into_iter().map(|row| (row, true));
    for (row, demanded) in demanded.chain(wished.into_iter().map(|row| (row, false))) {
        let largest = |row: &Affine| row[..n].iter().map(Signed::abs).max().map_or(0.0, |most| nearest(&most));
        let before = largest(&row);
        let row = done.iter().fold(row, |row, (place, other)| without(row, *place, other));
        if !demanded && largest(&row) <= DEPENDENT * before {
            continue;
        }
        let Some(place) =
            (0..n).max_by(|a, b| row[*a].abs().cmp(&row[*b].abs())).filter(|place| !row[*place].is_zero())
        else {
            if row[n].is_zero() {
                continue;
            }
            return None;
        };
        let row: Affine = row.iter().map(|entry| entry / &row[place]).collect();
        done = done.into_iter().map(|(at, other)| (at, without(other, place, &row))).collect();
        done.push((place, row));
    }
    Some(done)
}
