//! Pictures as SVG, for reports: the same scenes and charts as in characters. Colours can be told apart by the
//! colour-blind (Okabe and Ito), and nothing is said by colour alone.

pub mod chart;
pub mod face_map;
pub mod forces;
pub mod map;
pub mod structure;

use std::fmt::Write;

use crate::text::printable::xml as escaped;

/// Width of every figure, in px.
pub const WIDTH: f64 = 760.0;
/// Left and right of everything.
const MARGIN: f64 = 24.0;
/// Size of plain letters.
const SMALL: f64 = 12.0;
/// Width of a letter against its size, on average; a bit more than most fonts have.
const LETTER: f64 = 0.58;

const BLACK: &str = "#1a1a1a";
const GREY: &str = "#767676";
const FAINT: &str = "#c8c8c8";
const FACE: &str = "#eef0f2";
/// Of curves, one after the other.
const COLOURS: [&str; 6] = ["#0072b2", "#d55e00", "#009e73", "#cc79a7", "#e69f00", "#56b4e9"];

/// Of a text that may stand over lines: they end before its letters.
const HALO: &str = "paint-order=\"stroke\" stroke=\"#ffffff\" stroke-width=\"3\" stroke-linejoin=\"round\"";

/// What stands over a figure.
#[derive(Clone, Debug, Default)]
pub struct Caption {
    /// What is shown, in bold.
    pub title: String,
    /// Of what, with which parameters.
    pub about: String,
}

/// Where a text has its anchor.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Anchor {
    Start,
    Middle,
    End,
}

impl Anchor {
    fn word(self) -> &'static str {
        match self {
            Anchor::Start => "start",
            Anchor::Middle => "middle",
            Anchor::End => "end",
        }
    }
}

/// A drawing that grows downwards; coordinates in px from the left upper corner.
#[derive(Clone, Debug)]
struct Drawing {
    body: String,
    title: String,
    /// Where the next thing goes.
    y: f64,
    /// Boxes of the texts written: left, top, right, bottom.
    taken: Vec<[f64; 4]>,
}

/// A coordinate with two digits after the decimal point.
fn px(value: f64) -> String {
    // far outside of any figure; keeps what is not finite out of the file
    let value = if value.is_finite() { value.clamp(-1e5, 1e5) } else { 0.0 };
    let text = format!("{value:.2}");
    let text = text.trim_end_matches('0').trim_end_matches('.');
    if text == "-0" { "0".to_owned() } else { text.to_owned() }
}

fn points(points: &[(f64, f64)]) -> String {
    let words: Vec<String> = points.iter().map(|(x, y)| format!("{},{}", px(*x), px(*y))).collect();
    words.join(" ")
}

fn width_of(text: &str, size: f64) -> f64 {
    unicode_width::UnicodeWidthStr::width(text) as f64 * size * LETTER
}

impl Drawing {
    /// With its caption.
    fn new(caption: &Caption) -> Drawing {
        let mut drawing = Drawing { body: String::new(), title: caption.title.clone(), y: MARGIN, taken: Vec::new() };
        drawing.paragraph(&caption.title, 15.0, "font-weight=\"bold\"", BLACK);
        drawing.paragraph(&caption.about, SMALL, "", GREY);
        drawing.y += 6.0;
        drawing
    }

    /// Lines of text over the whole width, broken at blanks.
    fn paragraph(&mut self, text: &str, size: f64, attributes: &str, colour: &str) {
        let room = WIDTH - 2.0 * MARGIN;
        let mut line = String::new();
        let mut lines = Vec::new();
        for word in text.split(' ').filter(|word| !word.is_empty()) {
            if !line.is_empty() && width_of(&line, size) + width_of(word, size) + size * LETTER > room {
                lines.push(std::mem::take(&mut line));
            }
            if !line.is_empty() {
                line.push(' ');
            }
            line.push_str(word);
        }
        lines.extend(Some(line).filter(|line| !line.is_empty()));
        for line in lines {
            self.y += size;
            let y = self.y;
            self.text((MARGIN, y), &line, size, Anchor::Start, colour, attributes);
            self.y += 0.4 * size;
        }
    }

    fn put(&mut self, element: &str) {
        self.body.push_str(element);
        self.body.push('\n');
    }

    /// A text with its base line at y.
    fn text(&mut self, at: (f64, f64), text: &str, size: f64, anchor: Anchor, colour: &str, attributes: &str) {
        self.taken.push(text_box(at, text, size, anchor));
        let blank = if attributes.is_empty() { "" } else { " " };
        let element = format!(
            "<text x=\"{}\" y=\"{}\" font-size=\"{}\" text-anchor=\"{}\" fill=\"{colour}\"{blank}{attributes}>{}</text>",
            px(at.0),
            px(at.1),
            px(size),
            anchor.word(),
            escaped(text)
        );
        self.put(&element);
    }

    /// A text where nothing else is written within the figure; whether there was room.
    fn text_if_free(&mut self, at: (f64, f64), text: &str, anchor: Anchor, colour: &str) -> bool {
        let own = text_box(at, text, SMALL, anchor);
        let inside = own[0] >= 2.0 && own[2] <= WIDTH - 2.0;
        let free = inside && !self.taken.iter().any(|other| overlap(&own, other));
        if free {
            self.text(at, text, SMALL, anchor, colour, HALO);
        }
        free
    }

    /// Keeps a place free of texts.
    fn take(&mut self, at: (f64, f64), radius: f64) {
        self.taken.push([at.0 - radius, at.1 - radius, at.0 + radius, at.1 + radius]);
    }

    fn line(&mut self, from: (f64, f64), to: (f64, f64), colour: &str, width: f64, attributes: &str) {
        let blank = if attributes.is_empty() { "" } else { " " };
        let element = format!(
            "<line x1=\"{}\" y1=\"{}\" x2=\"{}\" y2=\"{}\" stroke=\"{colour}\" stroke-width=\"{}\"{blank}{attributes}/>",
            px(from.0),
            px(from.1),
            px(to.0),
            px(to.1),
            px(width)
        );
        self.put(&element);
    }

    /// Open lines of one look.
    fn lines(&mut self, lines: &[Vec<(f64, f64)>], colour: &str, width: f64, attributes: &str) {
        let paths: Vec<String> =
            lines.iter().filter(|line| line.len() > 1).map(|line| format!("M{}", points(line))).collect();
        if !paths.is_empty() {
            let blank = if attributes.is_empty() { "" } else { " " };
            let element = format!(
                "<path d=\"{}\" fill=\"none\" stroke=\"{colour}\" stroke-width=\"{}\" stroke-linejoin=\"round\"{blank}{attributes}/>",
                paths.concat(),
                px(width)
            );
            self.put(&element);
        }
    }

    /// A closed shape.
    fn polygon(&mut self, corners: &[(f64, f64)], fill: &str, stroke: &str) {
        let element = format!(
            "<polygon points=\"{}\" fill=\"{fill}\" stroke=\"{stroke}\" stroke-width=\"1.5\" stroke-linejoin=\"round\"/>",
            points(corners)
        );
        self.put(&element);
    }

    fn circle(&mut self, at: (f64, f64), radius: f64, fill: &str, stroke: &str) {
        let element = format!(
            "<circle cx=\"{}\" cy=\"{}\" r=\"{}\" fill=\"{fill}\" stroke=\"{stroke}\" stroke-width=\"1.5\"/>",
            px(at.0),
            px(at.1),
            px(radius)
        );
        self.put(&element);
    }

    /// An arrow; `head` is long.
    fn arrow(&mut self, from: (f64, f64), to: (f64, f64), colour: &str) {
        let (dx, dy) = (to.0 - from.0, to.1 - from.1);
        let length = dx.hypot(dy).max(1e-9);
        let (c, s) = (dx / length, dy / length);
        let head = length.min(8.0);
        let base = (to.0 - head * c, to.1 - head * s);
        self.line(from, base, colour, 1.5, "");
        let wing = 0.45 * head;
        self.polygon(
            &[to, (base.0 - wing * s, base.1 + wing * c), (base.0 + wing * s, base.1 - wing * c)],
            colour,
            colour,
        );
    }

    /// Signs with their meaning, in as many lines as they need.
    fn legend(&mut self, entries: &[(Sign, String)]) {
        if entries.is_empty() {
            return;
        }
        self.y += 22.0;
        let mut x = MARGIN;
        for (sign, name) in entries {
            let width = 26.0 + width_of(name, SMALL) + 18.0;
            if x > MARGIN && x + width > WIDTH - MARGIN {
                x = MARGIN;
                self.y += 20.0;
            }
            let y = self.y;
            sign.draw(self, (x + 9.0, y - 4.0));
            self.text((x + 24.0, y), name, SMALL, Anchor::Start, BLACK, "");
            x += width;
        }
    }

    /// The whole file.
    fn finish(self) -> String {
        let height = self.y + MARGIN;
        let mut text = String::new();
        let _ = writeln!(
            text,
            "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{}\" height=\"{}\" viewBox=\"0 0 {} {}\" \
             font-family=\"Helvetica, Arial, 'DejaVu Sans', sans-serif\" role=\"img\">",
            px(WIDTH),
            px(height),
            px(WIDTH),
            px(height)
        );
        let _ = writeln!(text, "<title>{}</title>", escaped(&self.title));
        let _ = writeln!(text, "<rect width=\"100%\" height=\"100%\" fill=\"#ffffff\"/>");
        text.push_str(&self.body);
        text.push_str("</svg>\n");
        text
    }
}

fn text_box(at: (f64, f64), text: &str, size: f64, anchor: Anchor) -> [f64; 4] {
    let width = width_of(text, size);
    let left = match anchor {
        Anchor::Start => at.0,
        Anchor::Middle => at.0 - 0.5 * width,
        Anchor::End => at.0 - width,
    };
    [left - 2.0, at.1 - 0.85 * size, left + width + 2.0, at.1 + 0.25 * size]
}

fn overlap(a: &[f64; 4], b: &[f64; 4]) -> bool {
    a[0] < b[2] && b[0] < a[2] && a[1] < b[3] && b[1] < a[3]
}

/// A sign of a legend, drawn as in the figure.
#[derive(Clone, Debug, PartialEq)]
enum Sign {
    Pair(Option<crate::answer::record::State>),
    Support(usize),
    Load(super::plot::loads::LoadKind),
    Undeformed,
    Curve(usize, super::plot::chart::Line),
}

impl Sign {
    fn draw(&self, drawing: &mut Drawing, at: (f64, f64)) {
        match self {
            Sign::Pair(state) => {
                let right = if *state == Some(crate::answer::record::State::SlipMinus) { -1.0 } else { 1.0 };
                structure::pair(drawing, at, *state, Some((right, 0.0)), 5.5);
            }
            Sign::Support(held) => structure::support(drawing, at, *held, 6.0),
            Sign::Load(kind) => drawing.arrow((at.0 - 9.0, at.1), (at.0 + 9.0, at.1), structure::colour(*kind)),
            Sign::Undeformed => {
                drawing.line((at.0 - 9.0, at.1), (at.0 + 9.0, at.1), GREY, 1.0, "stroke-dasharray=\"4 3\"")
            }
            Sign::Curve(number, line) => chart::sample(drawing, at, *number, *line),
        }
    }
}
