//! The wall: contour, mesh, materials, conduction.
pub mod geometry;
pub mod material;
