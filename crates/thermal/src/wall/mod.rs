//! The wall: contour, mesh, materials, conduction.
pub mod conduction;
pub mod geometry;
pub mod material;
pub mod mesh;
