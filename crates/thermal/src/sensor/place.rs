//! Places of sensors, and the cells of a model that stand for them.
use crate::wall::geometry::Geometry;
use crate::wall::mesh::{Facing, Mesh, TOP};
use serde::{Deserialize, Serialize};

/// Names of places that a surface sensor can sit at.
pub const PLACES: [&str; 5] = ["bottom", "middle", "shoulder", "neck", "valve"];

/// Where a surface sensor sits.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub enum SurfacePlace {
    /// Centre of the closed end.
    Bottom,
    /// Cylinder at half its height.
    Middle,
    /// Middle of the end at the valve's side.
    Shoulder,
    /// Neck, or the topmost wall cell.
    Neck,
    /// Valve body.
    Valve,
    /// A height on the side.
    Height {
        /// Distance from the outer bottom along the axis, m.
        height_m: f64,
    },
}

/// Where a sensor hangs in the gas.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub enum GasPlace {
    /// A gas cell of the model, 1 at the bottom, as in the columns `gas_1_degc`, `gas_2_degc`, ...
    Cell {
        /// Number from 1.
        number: usize,
    },
    /// A height.
    Height {
        /// Vertical distance from the outer bottom (lying: from the lowest line of the outside), m.
        height_m: f64,
    },
}

impl SurfacePlace {
    /// The place of a name in [`PLACES`].
    #[cfg(feature = "files")]
    pub(crate) fn named(name: &str) -> Option<Self> {
        match name {
            "bottom" => Some(Self::Bottom),
            "middle" => Some(Self::Middle),
            "shoulder" => Some(Self::Shoulder),
            "neck" => Some(Self::Neck),
            "valve" => Some(Self::Valve),
            _ => None,
        }
    }

    /// Its name; `height` for a height.
    pub fn as_str(&self) -> &'static str {
        match self {
            Self::Bottom => "bottom",
            Self::Middle => "middle",
            Self::Shoulder => "shoulder",
            Self::Neck => "neck",
            Self::Valve => "valve",
            Self::Height { .. } => "height",
        }
    }

    /// Column of the mesh that stands for the place; `None` for the valve, which is no wall, and for a height that
    /// the vessel does not reach.
    pub fn column(&self, geometry: &Geometry, mesh: &Mesh) -> Option<usize> {
        let Self::Height { height_m } = *self else { return mesh.column_of(self.as_str()) };
        if !(0.0..=geometry.outer_height_m()).contains(&height_m) {
            return None;
        }
        // Beside the plate of a flat end the nearest side column stands for it.
        let z = height_m - geometry.bottom.thickness_m;
        let distance = |&j: &usize| {
            let (low, high) = mesh.columns[j].inner_height_m;
            (low - z).max(z - high).max(0.0)
        };
        let sides = (0..mesh.columns.len()).filter(|&j| mesh.columns[j].facing == Facing::Side);
        sides.min_by(|a, b| distance(a).total_cmp(&distance(b)))
    }

    /// Height above the middle as a fraction of the inner height, as the film and the air of the surroundings change with it;
    /// `None` as for [`SurfacePlace::column`], but the valve is the top.
    pub fn above_middle(&self, geometry: &Geometry, mesh: &Mesh) -> Option<f64> {
        match self {
            Self::Valve => Some(TOP),
            place => Some(mesh.above_middle()[place.column(geometry, mesh)?]),
        }
    }
}
