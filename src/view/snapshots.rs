//! Reports as they look.
