//! `export` of pictures and reports: well-formed, with nothing over its texts, and with a legend of what is shown.

use std::fs;
use std::path::Path;

use stickslip::model::embedded;
use stickslip::session::{CommandError, Session};
use stickslip::watch::Quiet;

use super::export::{SCENARIO, open, run};
use super::lines;

/// A block on its face beside a post on a node, which slips by (3 − 0.1 · 10)/10: the figure has the cells of the face and
/// the curve over the post.
#[test]
fn figures_show_faces_and_the_pairs_beside_them() {
    let mut session = lines::read(include_str!("../common/block-and-post.json"));
    let folder = tempfile::tempdir().expect("a folder");
    let file = folder.path().join("slip.svg");
    run(&mut session, &format!("export slip {}", file.display())).expect("written");
    let figure = fs::read_to_string(&file).expect("there");
    tags(&figure);
    assert_eq!(figure.matches("<title>base[").count(), 4, "{figure}");
    assert!(figure.contains(">Slip |z_τ|</text>") && figure.contains(">foot</text>"), "{figure}");
}

/// An element of XML: its name, its attributes, the text up to the next tag.
struct Tag<'a> {
    name: &'a str,
    attributes: Vec<(&'a str, &'a str)>,
    text: &'a str,
}

/// The opening tags of a text, which is refused where it is not well-formed.
fn tags(text: &str) -> Vec<Tag<'_>> {
    let mut open: Vec<&str> = Vec::new();
    let mut tags = Vec::new();
    for piece in text.split('<').skip(1) {
        let (inside, after) = piece.split_once('>').unwrap_or_else(|| panic!("<{piece} is not closed"));
        assert!(!after.contains('>'), "a bare > in {after}");
        assert!(after.split('&').skip(1).all(|entity| entity.contains(';')), "a bare & in {after}");
        if inside.starts_with(['?', '!']) {
            continue;
        }
        if let Some(name) = inside.strip_prefix('/') {
            assert_eq!(open.pop(), Some(name));
            continue;
        }
        let (inside, empty) = inside.strip_suffix('/').map_or((inside, false), |inside| (inside, true));
        let (name, mut rest) = inside.split_once(' ').unwrap_or((inside, ""));
        let mut attributes = Vec::new();
        while let Some((key, after)) = rest.split_once("=\"") {
            let (value, after) = after.split_once('"').expect("a closed value");
            attributes.push((key.trim(), value));
            rest = after;
        }
        assert!(rest.trim().is_empty(), "{rest:?} in <{inside}>");
        if !empty {
            open.push(name);
        }
        tags.push(Tag { name, attributes, text: after });
    }
    assert!(open.is_empty(), "{open:?} stay open");
    tags
}

/// No number of a picture is out of it, and no two of its texts lie over each other.
fn check_picture(name: &str, text: &str) {
    let tags = tags(text);
    let attribute = |tag: &Tag<'_>, key: &str| {
        let value = tag.attributes.iter().find(|(known, _)| *known == key).map(|(_, value)| *value);
        value.unwrap_or_else(|| panic!("{name}: no {key} in <{}>", tag.name)).to_owned()
    };
    let number = |tag: &Tag<'_>, key: &str| -> f64 { attribute(tag, key).parse().expect("a number") };
    let (width, height) = (number(&tags[0], "width"), number(&tags[0], "height"));
    let mut boxes: Vec<([f64; 4], String)> = Vec::new();
    for tag in tags.iter().filter(|tag| tag.name == "text") {
        let (x, y, size) = (number(tag, "x"), number(tag, "y"), number(tag, "font-size"));
        // letters are about half as wide as high
        let wide = 0.5 * size * tag.text.chars().count() as f64;
        let left = match attribute(tag, "text-anchor").as_str() {
            "start" => x,
            "middle" => x - 0.5 * wide,
            _ => x - wide,
        };
        let own = [left, y - 0.75 * size, left + wide, y];
        assert!(own[0] >= 0.0 && own[2] <= width && own[1] >= 0.0 && own[3] <= height, "{name}: {} is cut", tag.text);
        for (other, said) in &boxes {
            let apart = own[0] >= other[2] || other[0] >= own[2] || own[1] >= other[3] || other[1] >= own[3];
            assert!(apart, "{name}: {} lies over {said}", tag.text);
        }
        boxes.push((own, tag.text.to_owned()));
    }
    assert!(boxes.len() > 1, "{name}: no texts");
    assert!(!text.contains("NaN") && !text.contains("inf"), "{name}");
    // What is not a number would be drawn to the corner.
    assert!(!text.contains(" 0,0") && !text.contains("\"0,0"), "{name}: a point in the corner");
}

#[test]
fn every_picture_is_drawn_and_nothing_lies_over_its_texts() {
    let folder = tempfile::tempdir().expect("a folder");
    let file = folder.path().join("x.svg");
    let mut drawn = std::collections::BTreeMap::new();
    for (name, _) in embedded::list() {
        let mut session = Session::new(embedded::load(name).expect("embedded"), &Quiet).expect("solved");
        let _ = run(&mut session, "trace pull");
        for what in [
            "structure",
            "mode",
            "slip",
            "slip first last",
            "force",
            "gap",
            "pressure",
            "p",
            "moment",
            "shear",
            "axial",
            "path",
            "path force",
        ] {
            match run(&mut session, &format!("export {what} '{}'", file.display())) {
                Ok(()) => {
                    check_picture(&format!("{name} {what}"), &fs::read_to_string(&file).expect("a file"));
                    *drawn.entry(what).or_insert(0) += 1;
                }
                Err(error) => assert!(matches!(error, CommandError::Refused(_)), "{name} {what}: {error}"),
            }
        }
    }
    assert_eq!(drawn.len(), 13, "{drawn:?}");
}

/// The states are shown by shapes and in words, the load and the scale by their signs.
#[test]
fn a_picture_of_the_structure_has_a_legend_of_what_it_shows() {
    let folder = tempfile::tempdir().expect("a folder");
    let file = folder.path().join("x.svg");
    let mut session = Session::new(embedded::load("beam").expect("embedded"), &Quiet).expect("solved");
    run(&mut session, &format!("export structure '{}'", file.display())).expect("drawn");
    let text = fs::read_to_string(&file).expect("a file");
    let texts: Vec<&str> = tags(&text).into_iter().filter(|tag| tag.name == "text").map(|tag| tag.text).collect();
    // at the end F = 100 and F2 = 250 add up
    let load = format!("weight + pull up to {:.2} kN", 100.0_f64.hypot(250.0));
    for word in ["stick", "slip+", &load, "undeformed", "5 m", "c1", "c6"] {
        assert!(texts.contains(&word), "{word} is missing in {texts:?}");
    }
    assert!(texts.iter().any(|text| text.contains("F2\u{a0}=\u{a0}250\u{a0}kN")), "{texts:?}");
    assert!(!texts.contains(&"open"));
    // 2 pairs stick and 4 slip, and each has one sign in the legend
    assert_eq!(text.matches("<circle").count(), 3);
    run(&mut session, &format!("load '{}'; export structure '{}'", hostile(folder.path()), file.display()))
        .expect("drawn");
    check_picture("hostile", &fs::read_to_string(&file).expect("a file"));
}

/// The scenario with a title that is markup, and with control characters.
fn hostile(folder: &Path) -> String {
    let file = folder.join("a&b<c>.json");
    let title = r#"Block <script>alert(\"1\")</script> & \u0007 \ud83d\ude00"#;
    fs::write(&file, SCENARIO.replace("Block with a post", title)).expect("a file");
    file.display().to_string()
}

#[test]
fn moments_are_drawn_on_the_structure_and_along_a_bar() {
    let folder = tempfile::tempdir().expect("a folder");
    let (mut session, _) = open(folder.path());
    let file = folder.path().join("x.svg");
    for line in ["export axial", "export axial stay", "export moment post"] {
        run(&mut session, &format!("{line} '{}'", file.display())).expect("drawn");
        check_picture(line, &fs::read_to_string(&file).expect("a file"));
    }
    run(&mut session, &format!("export axial '{}'", file.display())).expect("drawn");
    let text = fs::read_to_string(&file).expect("a file");
    // the stay carries the 7 that hang on it
    assert!(tags(&text).iter().any(|tag| tag.name == "text" && tag.text == "-7"), "{text}");
    for (line, message) in [("export axial foo", "foo"), ("export axial post stay", "`stay` makes no sense")] {
        let error = run(&mut session, &format!("{line} '{}'", file.display())).expect_err(line).to_string();
        assert!(error.contains(message), "{error}");
    }
}

#[test]
fn a_report_holds_everything_and_is_the_same_each_time() {
    let folder = tempfile::tempdir().expect("a folder");
    let (mut session, _) = open(folder.path());
    let [html, again, markdown] = ["r.html", "again.html", "r.md"].map(|name| folder.path().join(name));
    for file in [&html, &again, &markdown] {
        run(&mut session, &format!("export report '{}'", file.display())).expect("written");
    }
    let text = fs::read_to_string(&html).expect("a file");
    assert_eq!(text, fs::read_to_string(&again).expect("a file"));
    let headings: Vec<&str> =
        tags_of_html(&text).into_iter().filter(|tag| tag.name == "h2").map(|tag| tag.text).collect();
    assert_eq!(
        headings,
        [
            "Parameters",
            "Materials",
            "Sections",
            "Nodes",
            "Bars",
            "Plates",
            "Supports",
            "Ties",
            "Contacts",
            "Loads",
            "Stages",
            "Answer",
            "Check",
            "Safety",
            "Figures",
            "Contact pairs",
            "Probes",
            "Resultants of the edge contacts",
            "Reactions",
            "Member forces",
            "Displacements",
            "Load history",
            "Load combinations"
        ]
    );
    assert_eq!(text.matches("<svg ").count(), text.matches("<figure>").count());
    assert!(text.contains(&format!("stickslip {}", env!("CARGO_PKG_VERSION"))) && text.contains("<td>ULS</td>"));
    // no file beside it, none from elsewhere
    assert!(!text.contains("src=") && !text.contains("href="), "{text}");
    let text = fs::read_to_string(&markdown).expect("a file");
    let figures: Vec<&str> = text.split("](<").skip(1).filter_map(|rest| rest.split(">)").next()).collect();
    assert!(figures.contains(&"r-structure.svg"), "{figures:?}");
    for figure in figures {
        check_picture(figure, &fs::read_to_string(folder.path().join(figure)).expect("a figure"));
    }
    // a date only where it is asked for
    run(&mut session, &format!("export report date '{}'", again.display())).expect("written");
    let dated = fs::read_to_string(&again).expect("a file");
    assert!(dated.contains(" · 2") && dated.len() > fs::read_to_string(&html).expect("a file").len());
    assert!(run(&mut session, &format!("export report today '{}'", again.display())).is_err());
    // the figures mean the history where the tables do
    run(&mut session, &format!("set H 49; stages; export report '{}'", html.display())).expect("written");
    assert!(
        fs::read_to_string(&html).expect("a file").contains("post.json · at the end of stage 2 of the load history")
    );
    run(&mut session, &format!("load '{}'; export report '{}'", hostile(folder.path()), html.display()))
        .expect("written");
    tags_of_html(&fs::read_to_string(&html).expect("a file"));
}

/// The tags of HTML whose void elements are closed for the purpose.
fn tags_of_html(text: &str) -> Vec<Tag<'_>> {
    let body = text.split_once("<body>").expect("a body").1.split_once("</body>").expect("its end").0;
    tags(body)
}

#[test]
fn every_embedded_scenario_has_a_report() {
    let folder = tempfile::tempdir().expect("a folder");
    let file = folder.path().join("r.html");
    for (name, _) in embedded::list() {
        let mut session = Session::new(embedded::load(name).expect("embedded"), &Quiet).expect("solved");
        run(&mut session, &format!("export report '{}'", file.display()))
            .unwrap_or_else(|error| panic!("{name}: {error}"));
        tags_of_html(&fs::read_to_string(&file).expect("a file"));
    }
}
