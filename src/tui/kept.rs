//! What is kept of a picture: it is made anew only when what it shows has changed.

use std::cell::RefCell;
use std::rc::Rc;
use std::sync::{Arc, Weak};

/// The last picture, and what it was made of.
pub struct Kept<K, V>(RefCell<Option<(K, Rc<V>)>>);

impl<K, V> Default for Kept<K, V> {
    fn default() -> Self {
        Kept(RefCell::new(None))
    }
}

impl<K: PartialEq, V> Kept<K, V> {
    /// The picture of `key`, made now unless the last one was of it.
    pub fn of(&self, key: K, make: impl FnOnce() -> V) -> Rc<V> {
        if let Some((kept, picture)) = &*self.0.borrow()
            && *kept == key
        {
            return Rc::clone(picture);
        }
        let picture = Rc::new(make());
        *self.0.borrow_mut() = Some((key, Rc::clone(&picture)));
        picture
    }

    /// Forgets it.
    pub fn clear(&self) {
        *self.0.borrow_mut() = None;
    }
}

/// The one shared value meant, not one that is equal: comparing it costs nothing, and keeps nothing alive.
pub struct The<T>(Weak<T>);

impl<T> The<T> {
    /// This one.
    pub fn one(value: &Arc<T>) -> Self {
        The(Arc::downgrade(value))
    }
}

impl<T> PartialEq for The<T> {
    fn eq(&self, other: &Self) -> bool {
        // The allocation of a dead value stays reserved by the weak pointer: no other value can stand there.
        self.0.ptr_eq(&other.0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_picture_is_made_once_for_what_it_shows() {
        let kept = Kept::default();
        let value = Arc::new(1);
        let mut made = 0;
        for key in [The::one(&value), The::one(&value), The::one(&Arc::new(1)), The::one(&value)] {
            kept.of(key, || made += 1);
        }
        assert_eq!(made, 3);
        kept.clear();
        kept.of(The::one(&value), || made += 1);
        assert_eq!(made, 4);
    }
}
