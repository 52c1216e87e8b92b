//! Regions: parts of neighbouring panels that touch and have one scheme.

use super::panel::Panel;
use crate::model::groups::Groups;

/// Parts of neighbouring panels that have less than this share of the range in common do not touch.
const TOUCHING: f64 = 1e-9;
/// A region of no more than this share of the plane is rounding of the place where others meet.
const NO_AREA: f64 = 1e-12;

/// The region of each part of each panel, numbered from the left below; `ranges` in the order of the axes.
pub fn regions(panels: &[Panel], ranges: [[f64; 2]; 2], along: usize) -> Vec<Vec<usize>> {
    let whole: f64 = ranges.iter().map(|[low, high]| high - low).product();
    merged(panels, connected(panels, ranges[along]), NO_AREA * whole)
}

/// Those that touch and have one scheme.
fn connected(panels: &[Panel], range: [f64; 2]) -> Vec<Vec<usize>> {
    let mut count = 0;
    let start = |panel: &Panel| {
        count += panel.areas.len();
        count - panel.areas.len()
    };
    let starts: Vec<usize> = panels.iter().map(start).collect();
    let mut groups = Groups::new(count);
    for (k, two) in panels.windows(2).enumerate() {
        let (below, above) = (&two[0].lines[two[0].lines.len() - 1], &two[1].lines[0]);
        for (i, a) in below.parts.iter().enumerate() {
            for (j, b) in above.parts.iter().enumerate().filter(|(_, b)| b.scheme == a.scheme) {
                if a.to.min(b.to) - a.from.max(b.from) > TOUCHING * (range[1] - range[0]) {
                    groups.join(starts[k] + i, starts[k + 1] + j);
                }
            }
        }
    }
    let mut numbers = groups.numbers(0..count).into_iter();
    panels.iter().map(|panel| numbers.by_ref().take(panel.areas.len()).collect()).collect()
}

/// The same without those of at most this area: each of their parts goes to what lies nearest.
fn merged(panels: &[Panel], regions: Vec<Vec<usize>>, least: f64) -> Vec<Vec<usize>> {
    let count = regions.iter().flatten().max().map_or(0, |last| last + 1);
    let mut areas = vec![0.0; count];
    for (panel, regions) in panels.iter().zip(&regions) {
        regions.iter().zip(&panel.areas).for_each(|(region, area)| areas[*region] += area);
    }
    if areas.iter().all(|area| *area > least || areas.len() == 1) {
        return regions;
    }
    let nearest = |panel: usize, part: usize| -> Option<usize> {
        let part = &panels[panel].lines[0].parts[part];
        let middle = 0.5 * (part.from + part.to);
        let off = |other: usize, part: usize| {
            let part = &panels[other].lines[0].parts[part];
            (part.from - middle).max(middle - part.to)
        };
        let mut others: Vec<usize> = (0..panels.len()).collect();
        others.sort_by_key(|other| other.abs_diff(panel));
        others.into_iter().find_map(|other| {
            let large = (0..regions[other].len()).filter(|part| areas[regions[other][*part]] > least);
            large.min_by(|a, b| off(other, *a).total_cmp(&off(other, *b))).map(|part| regions[other][part])
        })
    };
    let mut numbers = vec![None; count];
    let mut next = 0..;
    let number = |(panel, part): (usize, usize)| {
        let region = regions[panel][part];
        let region = if areas[region] > least { region } else { nearest(panel, part).unwrap_or(region) };
        *numbers[region].get_or_insert_with(|| next.next().unwrap_or_default())
    };
    let places = (0..panels.len()).flat_map(|panel| (0..regions[panel].len()).map(move |part| (panel, part)));
    let mut found = places.collect::<Vec<_>>().into_iter().map(number).collect::<Vec<_>>().into_iter();
    regions.iter().map(|parts| found.by_ref().take(parts.len()).collect()).collect()
}
