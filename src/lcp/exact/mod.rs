//! The engines without rounding: integers, rationals, and f64 with a bound of every error. They judge the engine in
//! f64, stand in for it on small problems, and prove.

pub mod all_solutions;
pub mod ball_mod_p;
pub mod classes;
pub mod corners;
pub mod dyadic;
pub mod farkas;
pub mod lemke;
pub mod modular;
pub mod polyhedron;
pub mod rational_solve;
pub mod scalar;
pub mod tableau;
pub mod triangular;
