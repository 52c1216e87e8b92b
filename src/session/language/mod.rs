//! The language of the session: lines split into `tokens` and read by the `grammar`, what may be set, selected and
//! expected, and the help and the completion that are made from the same table of commands.

pub mod candidates;
pub mod command;
pub mod complete;
pub mod error;
pub mod expect;
pub mod grammar;
pub mod help;
pub(in crate::session) mod quantities;
pub(in crate::session) mod range;
pub(in crate::session) mod selection;
pub mod setting;
pub mod tokens;
pub mod topics;
pub mod turn;
