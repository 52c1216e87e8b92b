//! Elements in space.

mod frame;
mod shape;
mod solid;

pub use frame::SpaceFrame;
pub use solid::Solid;
