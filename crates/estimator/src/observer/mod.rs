//! The cylinder's observer.
