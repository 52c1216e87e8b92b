//! What everyone needs of texts: which characters a terminal may get, a hash that never changes, files read with care.

pub mod file;
pub mod hash;
pub mod printable;
pub mod words;
