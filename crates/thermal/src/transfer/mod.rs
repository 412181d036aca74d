//! Films: natural and forced convection inside and outside, radiation, sun.
pub mod inside;
pub mod outside;
mod surface;

#[cfg(feature = "simulate")]
pub(crate) use surface::SurfaceBalance;
#[cfg(feature = "simulate")]
pub(crate) use surface::{FilmSeries, LAST_STEP_K, solve_surface};
pub(crate) use surface::{HalfCell, solve_surface_from};
