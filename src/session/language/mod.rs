//! The language of the session: lines split into `tokens`, the grammar in `command`, what may be set, selected and
//! expected, and the help and the completion that are made from the same tables.

pub mod command;
pub mod complete;
pub mod expect;
pub mod export;
pub mod help;
pub(in crate::session) mod selection;
pub mod setting;
pub mod tokens;
