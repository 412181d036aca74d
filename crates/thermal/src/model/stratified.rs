//! Stacked gas cells of common pressure.
