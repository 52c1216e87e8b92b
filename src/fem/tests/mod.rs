//! Structures with known answers, against the whole way from K to R and back.

mod builder;
mod closed_forms;
mod ill_conditioned;
mod kernel;
mod large;
mod measured_loss;
mod ordering;
mod refusals;
mod rigid;
mod space;
