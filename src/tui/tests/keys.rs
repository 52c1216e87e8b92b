//! The table of the keys.

use super::*;

#[test]
fn the_manual_names_every_key() {
    let manual = keymap::manual();
    for binding in BINDINGS {
        assert!(manual.contains(&format!("`{}`", binding.name)));
    }
    insta::assert_snapshot!("keys-of-the-manual", manual);
}
