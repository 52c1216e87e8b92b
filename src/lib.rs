//! stickslip: what a structure with frictional contact really does.

pub mod answer;
pub mod contact;
pub mod export;
pub mod lcp;
pub mod model;
pub mod view;
