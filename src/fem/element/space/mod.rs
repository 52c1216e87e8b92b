//! Elements in space.

mod frame;
mod solid;

pub use frame::SpaceFrame;
pub use solid::Solid;
