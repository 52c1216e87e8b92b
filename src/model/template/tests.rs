use super::*;

fn words(given: &[(&str, &str)]) -> Vec<(String, String)> {
    given.iter().map(|(name, value)| ((*name).to_owned(), (*value).to_owned())).collect()
}

fn refusal(kind: &str, given: &[(&str, &str)]) -> String {
    match find(kind).and_then(|template| template.scenario(&words(given), Path::new("x.json"))) {
        Ok(_) => panic!("{kind} {given:?} was accepted"),
        Err(error) => error.to_string(),
    }
}

#[test]
fn every_template_loads_at_both_ends_of_its_counts() {
    for template in ALL {
        for at in [|count: &Count| count.default, |count: &Count| count.range.0, |count: &Count| count.range.1] {
            let counts: Vec<usize> = template.counts.iter().map(at).collect();
            let text = (template.text)(&counts);
            let scenario = load_text(template.kind, &text, None).unwrap_or_else(|problems| panic!("{problems}"));
            assert!(text.contains("  // ") && scenario.description.is_some(), "{}", template.kind);
            let mut names: Vec<String> = template.choices(&scenario).into_iter().map(|choice| choice.name).collect();
            names.extend(scenario.parameter_values().formulas().iter().map(|(name, _)| name.to_owned()));
            names.sort();
            let all = names.len();
            names.dedup();
            assert_eq!(names.len(), all, "{}: {names:?}", template.kind);
            for (name, parameter) in &scenario.parameters {
                assert!(parameter.about.is_some(), "{}: {name}", template.kind);
                let slider = parameter.min.is_some() && parameter.max.is_some() && parameter.step.is_some();
                assert!(slider || parameter.formula.is_some(), "{}: {name}", template.kind);
            }
            template.check_needs(&scenario.parameter_values()).unwrap();
        }
    }
}

#[test]
fn a_value_stands_in_the_text_and_its_slider_reaches_it() {
    let template = find("portal").unwrap();
    let scenario =
        template.scenario(&words(&[("L", "40"), ("q", "12.5"), ("W", "-7e1")]), Path::new("a.json")).unwrap();
    let plain = template.default_scenario().unwrap();
    let differing: Vec<(&str, &str)> = scenario.text.lines().zip(plain.text.lines()).filter(|(a, b)| a != b).collect();
    assert_eq!(scenario.text.lines().count(), plain.text.lines().count());
    assert_eq!(differing.len(), 3, "{differing:#?}");
    let of = |name: &str| (scenario.parameters[name].value, scenario.parameters[name].max.unwrap());
    assert_eq!(of("L"), (40.0, 40.0));
    assert_eq!(of("q"), (12.5, plain.parameters["q"].max.unwrap()));
    assert_eq!(of("W").0, -70.0);
    assert_eq!(scenario.name, "a.json");
}

#[test]
fn what_cannot_be_is_refused_with_what_can() {
    for (kind, given, said) in [
        ("portla", &[][..], &["`portla` is not a kind", "did you mean `portal`", "press-fit"][..]),
        ("portal", &[("hh", "3")], &["portal has no `hh`", "L, h, b, q"]),
        ("portal", &[("k", "3")], &["portal has no `k`", "L, h, b, q"]),
        ("portal", &[("L", "x")], &["`L` is the span", "a number greater than 0", "`x`"]),
        ("portal", &[("L", "")], &["a number greater than 0"]),
        ("portal", &[("L", "inf")], &["a number greater than 0"]),
        ("portal", &[("L", "nan")], &["a number greater than 0"]),
        ("portal", &[("L", "-3")], &["a number greater than 0", "`-3`"]),
        ("portal", &[("h", "0")], &["a number greater than 0", "`0`"]),
        ("portal", &[("f", "-0.1")], &["not negative"]),
        ("portal", &[("b", "20")], &["the footings would overlap: b = 20 must be less than L = 12"]),
        ("portal", &[("L", "10"), ("L", "11")], &["`L` is given twice"]),
        ("arch", &[("block", "9")], &["arch has no `block`", "did you mean `blocks`", "blocks, R, t"]),
        ("arch", &[("blocks", "0")], &["`blocks` is the number of blocks", "a whole number from 3 to 99", "`0`"]),
        ("arch", &[("blocks", "1000000000")], &["a whole number from 3 to 99"]),
        ("arch", &[("blocks", "-4")], &["a whole number"]),
        ("arch", &[("blocks", "3.5")], &["a whole number"]),
        ("arch", &[("blocks", "1e300")], &["a whole number"]),
        ("arch", &[("t", "9")], &["no opening"]),
        ("press-fit", &[("a", "25")], &["the inner ring would have no wall"]),
        ("footing", &[("e", "3")], &["beside the footing"]),
        ("continuous-beam", &[("L4", "3")], &["continuous-beam has no `L4`", "L1, L2, L3"]),
    ] {
        let error = refusal(kind, given);
        for part in said {
            assert!(error.contains(part), "{kind} {given:?}: {error}");
        }
    }
    let more = words(&[("spans", "4"), ("L4", "3")]);
    assert_eq!(find("continuous-beam").unwrap().scenario(&more, Path::new("x")).unwrap().parameters["L4"].value, 3.0);
}
