//! The vessel's contour: an axisymmetric stack of bottom, cylinder, shoulder and neck, and the layers of
//! its wall. Lengths in metres, measured on the inner contour unless a name says otherwise.
//!
//! Domes are half spheroids of inner semi-axes (radius, depth), of constant thickness `t` in the sense that
//! the outer contour is the spheroid (radius + t, depth + t). A flat end is a disc that reaches to the
//! outer radius. The neck is a short tube on the shoulder's opening.
use super::material::Material;
use crate::real::powi;
use alloc::vec::Vec;
use serde::{Deserialize, Serialize};

/// How the gas axis lies in the field of gravity.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum Orientation {
    /// Valve at the top.
    Vertical,
    /// Axis horizontal.
    Horizontal,
}

/// Shape of a closing end.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
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
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct End {
    /// Shape of the inner contour.
    pub shape: EndShape,
    /// Wall thickness, m; the layers keep their proportions.
    pub thickness_m: f64,
    /// Number of axial cells along its meridian, at least 1.
    pub cells: usize,
}

/// The tube above the shoulder that carries the valve.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
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
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Layer {
    /// What it is made of.
    pub material: Material,
    /// Thickness on the cylinder, m.
    pub thickness_m: f64,
    /// Number of radial cells, at least 1.
    pub cells: usize,
}

/// Validated contour and wall of a vessel; build it with [`crate::vessel::VesselSpec::build`].
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
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

    /// The same contour with every cell divided into so many, along the wall and through it.
    pub fn refined(&self, by: usize) -> Self {
        let mut fine = self.clone();
        fine.cylinder_cells *= by;
        for end in [&mut fine.bottom, &mut fine.shoulder] {
            end.cells *= by;
        }
        fine.neck.iter_mut().for_each(|neck| neck.cells *= by);
        fine.layers.iter_mut().for_each(|layer| layer.cells *= by);
        fine
    }
}

impl Geometry {
    /// Height of the inner contour along the axis, m.
    pub fn inner_height_m(&self) -> f64 {
        let radius = 0.5 * self.inner_diameter_m;
        let bottom = match self.bottom.shape {
            EndShape::Flat => 0.0,
            EndShape::Dome { depth_m } => depth_m,
        };
        bottom
            + self.cylinder_length_m
            + self.shoulder_height_m(radius)
            + self.neck.map_or(0.0, |n| n.length_m)
    }

    /// Height of the gas as the vessel stands or lies, m.
    #[cfg(feature = "simulate")]
    pub(crate) fn gas_height_m(&self) -> f64 {
        match self.orientation {
            Orientation::Vertical => self.inner_height_m(),
            Orientation::Horizontal => self.inner_diameter_m,
        }
    }

    /// Height of the outer contour along the axis, without the valve, m.
    pub fn outer_height_m(&self) -> f64 {
        let top = if self.neck.is_some() { 0.0 } else { self.shoulder.thickness_m };
        self.bottom.thickness_m + self.inner_height_m() + top
    }

    /// Volume inside the contour, m³.
    pub fn contour_volume_m3(&self) -> f64 {
        let radius = 0.5 * self.inner_diameter_m;
        let area = core::f64::consts::PI * radius * radius;
        let bottom = match self.bottom.shape {
            EndShape::Flat => 0.0,
            EndShape::Dome { depth_m } => 2.0 / 3.0 * area * depth_m,
        };
        let shoulder = match self.shoulder.shape {
            EndShape::Flat => 0.0,
            EndShape::Dome { depth_m } => {
                // Zone of the spheroid up to the opening: pi a² (z - z³/(3 b²)).
                let z = self.shoulder_height_m(radius);
                area * (z - powi(z, 3) / (3.0 * depth_m * depth_m))
            }
        };
        let neck = self.neck.map_or(0.0, |neck| {
            0.25 * core::f64::consts::PI * powi(neck.inner_diameter_m, 2) * neck.length_m
        });
        bottom + area * self.cylinder_length_m + shoulder + neck
    }

    fn shoulder_height_m(&self, radius: f64) -> f64 {
        match self.shoulder.shape {
            EndShape::Flat => 0.0,
            EndShape::Dome { depth_m } => {
                let opening = self.neck.map_or(0.0, |neck| 0.5 * neck.inner_diameter_m) / radius;
                depth_m * libm::sqrt(1.0 - opening * opening)
            }
        }
    }
}

impl Geometry {
    /// Inner radius at a height above the inner bottom of the standing vessel, m.
    pub fn inner_radius_at_m(&self, height_m: f64) -> f64 {
        let radius = 0.5 * self.inner_diameter_m;
        let dome =
            |depth: f64, distance: f64| radius * libm::sqrt((1.0 - powi(distance / depth, 2)).max(0.0));
        let bottom = match self.bottom.shape {
            EndShape::Flat => 0.0,
            EndShape::Dome { depth_m } => depth_m,
        };
        let shoulder = bottom + self.cylinder_length_m;
        let opening = self.neck.map_or(0.0, |neck| 0.5 * neck.inner_diameter_m);
        match (self.bottom.shape, self.shoulder.shape) {
            (EndShape::Dome { depth_m }, _) if height_m < bottom => dome(depth_m, bottom - height_m),
            (_, EndShape::Dome { depth_m }) if height_m > shoulder => {
                dome(depth_m, height_m - shoulder).max(opening)
            }
            (_, EndShape::Flat) if height_m > shoulder => opening,
            _ => radius,
        }
    }
}
