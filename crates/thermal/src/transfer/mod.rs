//! Films: natural and forced convection inside and outside, radiation, sun.
pub mod inside;
pub mod outside;
mod surface;

#[cfg(feature = "simulate")]
pub(crate) use surface::SurfaceBalance;
pub(crate) use surface::{HalfCell, solve_surface, solve_surface_from};
