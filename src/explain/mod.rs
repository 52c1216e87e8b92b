//! Why: pivots in sentences, rays by class, in the words of the structure.

pub mod all_schemes;
pub mod balance;
pub mod certificate;
mod exact_certificate;
mod exact_equations;
mod exact_motions;
pub mod kernel;
mod known_normals;
pub mod loose;
pub mod margin;
pub mod misfit;
pub mod mode;
pub mod motions;
pub mod pair_state;
pub mod plain_ray;
pub mod plain_why;
pub mod proof;
pub mod ray;
pub mod remedy;
pub mod rigid;
pub mod sentence;
mod sliding;
pub mod tableau;
pub mod ties;
pub mod unpressed;
pub mod vertex;
