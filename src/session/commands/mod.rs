//! What each command does: one file a group. `dispatch` hands a parsed command to its group.

pub(in crate::session) mod combinations;
pub(in crate::session) mod dispatch;
pub(in crate::session) mod exports;
pub(in crate::session) mod find;
pub mod import;
pub(in crate::session) mod map;
pub mod new;
pub mod paths;
pub(in crate::session) mod plots;
pub(in crate::session) mod quantities;
pub(in crate::session) mod questions;
pub(in crate::session) mod record;
pub(in crate::session) mod reports;
pub(in crate::session) mod restore;
pub mod save;
pub mod script;
pub(in crate::session) mod side;
pub(in crate::session) mod summary;
pub(in crate::session) mod why;
