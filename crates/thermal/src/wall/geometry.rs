//! The vessel's contour: an axisymmetric stack of bottom, cylinder, shoulder and neck, and the layers of
//! its wall. Lengths in metres, measured on the inner contour unless a name says otherwise.
//!
//! Domes are half spheroids of inner semi-axes (radius, depth), of constant thickness `t` in the sense that
//! the outer contour is the spheroid (radius + t, depth + t). A flat end is a disc that reaches to the
//! outer radius. The neck is a short tube on the shoulder's opening.
use super::material::Material;

/// How the gas axis lies in the field of gravity.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Orientation {
    /// Valve at the top.
    Vertical,
    /// Axis horizontal.
    Horizontal,
}

/// Shape of a closing end.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum EndShape {
    /// A flat disc.
    Flat,
    /// A half spheroid of the given inner depth, m; a hemisphere when the depth is the inner radius.
    Dome {
        /// Inner depth of the dome, m.
        depth_m: f64,
    },
}

/// The bottom or the shoulder.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct End {
    /// Shape of the inner contour.
    pub shape: EndShape,
    /// Wall thickness, m; the layers keep their proportions.
    pub thickness_m: f64,
    /// Number of axial cells along its meridian, at least 1.
    pub cells: usize,
}

/// The tube above the shoulder that carries the valve.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Neck {
    /// Inner diameter, m.
    pub inner_diameter_m: f64,
    /// Wall thickness, m; the layers keep their proportions.
    pub thickness_m: f64,
    /// Length, m.
    pub length_m: f64,
    /// Number of axial cells, at least 1.
    pub cells: usize,
}

/// One layer of the cylindrical wall, counted from the inside.
#[derive(Clone, Debug, PartialEq)]
pub struct Layer {
    /// What it is made of.
    pub material: Material,
    /// Thickness on the cylinder, m.
    pub thickness_m: f64,
    /// Number of radial cells, at least 1.
    pub cells: usize,
}

/// Validated contour and wall of a vessel; build it with [`crate::vessel::VesselSpec::build`].
#[derive(Clone, Debug, PartialEq)]
pub struct Geometry {
    /// How the axis lies.
    pub orientation: Orientation,
    /// Inner diameter of the cylinder, m.
    pub inner_diameter_m: f64,
    /// Inner length of the cylinder without the ends, m.
    pub cylinder_length_m: f64,
    /// Number of axial cells of the cylinder, at least 1.
    pub cylinder_cells: usize,
    /// Closing end at z = 0.
    pub bottom: End,
    /// Closing end at the valve's side.
    pub shoulder: End,
    /// Neck, if modelled.
    pub neck: Option<Neck>,
    /// Wall layers from the inside to the outside; at least one.
    pub layers: Vec<Layer>,
    /// True: the whole wall is one single cell, whatever the counts say.
    pub lumped: bool,
}

impl Geometry {
    /// Wall thickness of the cylinder, m.
    pub fn thickness_m(&self) -> f64 {
        self.layers.iter().map(|layer| layer.thickness_m).sum()
    }
}
