//! The full screen: one session in panes, solved again as it is varied.
//!
//! event → [`action::Action`] → [`update::update`] (pure: state and action → state and effects) → [`draw::draw`].
//! Only [`runtime`] and [`terminal`] know threads, clocks and the terminal; the session lives on the thread of
//! [`worker`], so that the screen answers while it computes. The keys are one table, [`bindings::BINDINGS`].

pub mod action;
pub mod answers;
pub mod app;
pub mod bindings;
pub mod clipboard;
pub mod config;
pub mod draw;
pub mod entry;
pub mod frame;
pub mod help;
pub mod input;
pub mod kept;
pub mod key;
pub mod keymap;
pub mod layout;
pub mod listing;
pub mod overlay;
pub mod paint;
pub mod pane;
pub mod panes;
pub mod pictures;
pub mod prompt;
pub mod rewrap;
pub mod runtime;
pub mod sequence;
pub mod shown;
pub mod terminal;
pub mod theme;
pub mod tour;
pub mod update;
pub mod vary;
pub mod viewport;
pub mod worker;

#[cfg(test)]
mod tests;

pub use runtime::{Ended, Start, run};
