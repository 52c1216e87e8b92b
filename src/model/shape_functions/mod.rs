//! Shape functions and integration points of areas and solids, in the coordinates of their parent elements.

mod areas;
mod solids;

pub use areas::{AreaShape, MOST};
pub use solids::{MOST as MOST_OF_SOLID, SolidShape, TETRAHEDRON_SIDES, VolumePoint};
