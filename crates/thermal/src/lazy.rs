//! Values that are made when they are first needed, on machines without an operating system, too.
use alloc::boxed::Box;
use core::ops::Deref;
use once_cell::race::OnceBox;

/// A value that is made when it is first looked at. Two threads that come at once both make it, and one of the two is kept.
pub(crate) struct Lazy<T> {
    made: OnceBox<T>,
    make: fn() -> T,
}

impl<T> Lazy<T> {
    /// A value that `make` makes.
    pub(crate) const fn new(make: fn() -> T) -> Self {
        Self { made: OnceBox::new(), make }
    }
}

impl<T> Deref for Lazy<T> {
    type Target = T;

    fn deref(&self) -> &T {
        self.made.get_or_init(|| Box::new((self.make)()))
    }
}
