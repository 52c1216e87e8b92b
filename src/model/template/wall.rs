//! A wall in running bond, shaken.

use super::{Count, Template, lines};

pub const TEMPLATE: Template = Template {
    kind: "wall",
    counts: &[
        Count { name: "courses", default: 4, range: (1, 12), about: "number of courses" },
        Count { name: "bricks", default: 3, range: (1, 12), about: "number of bricks in a course" },
    ],
    needs: &[],
    text: |counts| text(counts[0], counts[1]),
};

/// A brick: its first half brick from the left, and how many of them it has.
struct Brick {
    course: usize,
    number: usize,
    start: usize,
    halves: usize,
}

/// The bricks of a course (from 1, at the bottom); every second course begins and ends with a half brick.
fn course(course: usize, bricks: usize) -> Vec<Brick> {
    let shifted = course.is_multiple_of(2);
    let count = if shifted { bricks + 1 } else { bricks };
    let brick = |k: usize| match shifted {
        false => (2 * k, 2),
        true if k == 0 => (0, 1),
        true => (2 * k - 1, if k == bricks { 1 } else { 2 }),
    };
    (0..count)
        .map(|k| {
            let (start, halves) = brick(k);
            Brick { course, number: k + 1, start, halves }
        })
        .collect()
}

/// The brick of a course over a half brick of its length, and its node at the left end of that half.
fn over(half: usize, bricks: &[Brick]) -> (&Brick, usize) {
    let at = bricks.partition_point(|brick| brick.start + brick.halves <= half);
    (&bricks[at], half - bricks[at].start)
}

fn text(courses: usize, bricks: usize) -> String {
    let wall: Vec<Vec<Brick>> = (1..=courses).map(|k| course(k, bricks)).collect();
    let id = |brick: &Brick| format!("b{}-{}", brick.course, brick.number);
    let plates = lines(wall.iter().flatten().map(|brick| {
        format!(
            r#"{{ "id": "{}", "origin": ["{}*l/2", "{}*h"], "size": ["{}*l/2", "h"], "divisions": [{}, 1], "thickness": "t", "material": "brick", "plane": "stress" }}"#,
            id(brick),
            brick.start,
            brick.course - 1,
            brick.halves,
            brick.halves
        )
    }));
    let ground = wall[0].iter().map(|brick| {
        format!(
            r#"{{ "id": "ground{}", "edge": "{}.bottom", "against": "ground", "friction": "f" }}"#,
            brick.number,
            id(brick)
        )
    });
    let mut contacts: Vec<String> = ground.collect();
    for (under, above) in wall.iter().zip(&wall[1..]) {
        for half in 0..2 * bricks {
            let ((low, l), (high, h)) = (over(half, under), over(half, above));
            for (end, side) in [(0, "l"), (1, "r")] {
                contacts.push(format!(
                    r#"{{ "id": "j{}-{}{side}", "node": "{}[{},0]", "against": "{}[{},1]", "normal": [0, 1], "friction": "f" }}"#,
                    low.course,
                    half + 1,
                    id(high),
                    h + end,
                    id(low),
                    l + end
                ));
            }
        }
    }
    TEXT.replace("COURSES", &courses.to_string())
        .replace("BRICKS", &bricks.to_string())
        .replace("// plates", &plates)
        .replace("// contacts", &lines(contacts))
}

const TEXT: &str = r#"{
  // Courses of bricks without mortar, each laid over the joints of the one below.
  "format": "stickslip/1",
  "title": "Dry wall in running bond",
  "description": "Bricks l long, h high and t thick lie on one another without mortar, each course half a brick aside; upright joints are open, as masons leave them. A horizontal acceleration g, as a part of gravity, pushes them: with little friction a course slides at g = f, with much a part of the wall overturns before, `limit quake`.",
  "units": { "length": "m", "force": "kN" },
  "parameters": {
    "l": { "value": 0.6, "min": 0.1, "max": 2, "step": 0.05, "unit": "m", "about": "length of a brick" },
    "h": { "value": 0.3, "min": 0.05, "max": 1, "step": 0.05, "unit": "m", "about": "height of a course" },
    "t": { "value": 0.3, "min": 0.05, "max": 1, "step": 0.05, "unit": "m", "about": "thickness of the wall" },
    "gamma": { "value": 20, "min": 1, "max": 80, "step": 1, "unit": "kN/m³", "about": "weight per volume" },
    "f": { "value": 0.65, "min": 0, "max": 1.5, "step": 0.05, "about": "friction between the courses and under them" },
    "g": { "value": 0.1, "min": -1, "max": 1, "step": 0.05, "about": "horizontal acceleration, as a part of gravity" },
    // shown, not set
    "W": { "formula": "COURSES*BRICKS*gamma*l*h*t", "unit": "kN", "about": "weight of the wall" }
  },
  // density: weight per volume, times an acceleration of 1
  "materials": { "brick": { "E": 1e7, "nu": 0.2, "density": "gamma" } },
  // b, the course from below, the place in it from the left
  "plates": [
    // plates
  ],
  // j, the joint over this course, the half brick from the left, its left or right end
  "contacts": [
    // contacts
  ],
  "loads": {
    "weight": { "items": [{ "gravity": { "acceleration": [0, -1] } }] },
    "quake": { "factor": "g", "items": [{ "gravity": { "acceleration": [1, 0] } }] }
  },
  "probes": {
    "base_normal": "sum x_n ground*",
    "base_shear": "sum x_t ground*",
    "open": "count open *",
    "sway": "max u"
  }
}
"#;
