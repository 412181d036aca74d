//! Films: natural and forced convection inside and outside, radiation, sun.
