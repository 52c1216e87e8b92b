//! What every module needs to handle text: which characters a terminal may get, numbers as they are read, a hash that
//! never changes, files read with care.

pub mod file;
pub mod hash;
pub mod number;
pub mod printable;
pub mod words;
