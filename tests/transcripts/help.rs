//! `help ray`: every command it names is one for the problem that is loaded.

use super::lines::{embedded, told};

#[test]
fn the_steps_through_a_ray_are_commands_for_the_present_problem() {
    for (name, set, named) in [
        (
            "beam-ray",
            "",
            &["`why c6`", "`limit weight`, `limit pull`", "`find least f where outcome answer`", "`enumerate`"][..],
        ),
        ("beam", "", &["beam has no ray now, its outcome is normal", "`limit pull`"]),
        ("klarbring", "", &["`compare`"]),
        ("portal", "set f 0.05", &["portal ends in a ray, mechanism (certified)", "`limit dead`, `limit wind`"]),
        ("painleve", "", &["painleve ends in a ray, no-equilibrium (proved)", "`why z[1]`"]),
        ("cycling", "set tie-break first-row", &["its outcome is pivot-limit", "`ties`"]),
    ] {
        let mut session = embedded(name);
        told(&mut session, set).unwrap();
        let help = told(&mut session, "help ray").unwrap();
        let plain = help.split_whitespace().collect::<Vec<_>>().join(" ");
        for part in named {
            assert!(plain.contains(part), "{name}: no {part} in\n{help}");
        }
        let (_, guide) = plain.split_once("load beam-ray; ray").unwrap();
        let commands: Vec<&str> = guide.split('`').skip(1).step_by(2).collect();
        assert!(commands.len() >= 4, "{help}");
        for command in commands {
            if let Err(error) = told(&mut session, command) {
                // the limit of a load without which nothing stands
                let is_holding = command.starts_with("limit") && error.contains("there is no answer to start from");
                assert!(is_holding, "{name}: {command}: {error}");
            }
        }
    }
}
