//! Values that are shared, not copied, between a session and those that look at it.

use std::sync::Arc;

/// Whether both are the one value meant, not equal ones, or neither is there.
pub fn is_same<T>(a: &Option<Arc<T>>, b: &Option<Arc<T>>) -> bool {
    match (a, b) {
        (Some(a), Some(b)) => Arc::ptr_eq(a, b),
        (None, None) => true,
        _ => false,
    }
}
