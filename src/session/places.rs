//! Where the user's own files of this program stand, by the environment (XDG Base Directory Specification).

use std::path::PathBuf;

/// Why there is no state directory.
pub const NO_STATE: &str = "neither XDG_STATE_HOME nor HOME is set to an absolute path";

/// The state directory: `$XDG_STATE_HOME/stickslip` or `~/.local/state/stickslip`; `None` where neither variable is set
/// to an absolute path.
pub fn state() -> Option<PathBuf> {
    folder("XDG_STATE_HOME", ".local/state")
}

/// The file of the configuration: `$XDG_CONFIG_HOME/stickslip/config.json` or `~/.config/stickslip/config.json`; `None`
/// where neither variable is set to an absolute path.
pub fn configuration() -> Option<PathBuf> {
    folder("XDG_CONFIG_HOME", ".config").map(|folder| folder.join("config.json"))
}

fn folder(named: &str, under_home: &str) -> Option<PathBuf> {
    let absolute = |name: &str| std::env::var_os(name).map(PathBuf::from).filter(|path| path.is_absolute());
    let base = absolute(named).or_else(|| absolute("HOME").map(|home| home.join(under_home)))?;
    Some(base.join("stickslip"))
}
