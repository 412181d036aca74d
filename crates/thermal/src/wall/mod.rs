//! The wall: contour, mesh, materials, conduction.
pub(crate) mod conduction;
pub mod geometry;
#[cfg(feature = "files")]
pub(crate) mod library;
pub mod material;
pub mod mesh;
