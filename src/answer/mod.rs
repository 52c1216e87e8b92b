//! From a scenario and its parameter values to one checked answer.

pub mod record;
