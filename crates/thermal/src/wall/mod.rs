//! The wall: contour, mesh, materials, conduction.
pub mod conduction;
pub mod geometry;
#[cfg(feature = "files")]
pub mod library;
pub mod material;
pub mod mesh;
