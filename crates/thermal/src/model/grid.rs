//! Where the gas cells are and which wall columns they touch.
//!
//! Stacked cells are horizontal slabs of equal height. Standing, a slab is cut out of the contour and touches
//! the columns whose heights it overlaps, the flat floor and ceiling at the ends. Lying, it is cut out of
//! the circle and touches every column with its share of the circumference (flat ends: of the disc).
use crate::sensor::GasPlace;
use crate::vessel::{GasResolution, Vessel};
use crate::wall::geometry::{Geometry, Orientation};
use crate::wall::mesh::{Facing, Mesh};

/// Slices per cell for volumes; the error of the midpoint rule is below 1e-5 of a cell.
const SLICES: usize = 400;

/// One gas cell.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct GasCell {
    /// Part of the vessel's volume.
    pub volume_fraction: f64,
    /// Height of the slab, m.
    pub height_m: f64,
    /// Area of the face to the next cell above, m²; 0 at the top.
    pub face_above_m2: f64,
    /// Wetted side area, m².
    pub side_m2: f64,
}

/// Contact of a wall column with a gas cell.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Contact {
    /// Gas cell.
    pub cell: usize,
    /// Area, m².
    pub area_m2: f64,
    /// How the wall lies; a floor or ceiling is a plate.
    pub facing: Facing,
}

/// The gas cells of a vessel.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct GasGrid {
    /// Cells from the bottom up.
    pub cells: Vec<GasCell>,
    /// Contacts of each wall column.
    pub contacts: Vec<Vec<Contact>>,
    /// Cell at the valve: what leaves comes from there, what enters goes there.
    pub outlet: usize,
}

impl GasGrid {
    /// The grid of a vessel's gas.
    pub(crate) fn new(vessel: &Vessel, mesh: &Mesh) -> Self {
        match vessel.gas {
            GasResolution::WellMixed => Self::single(mesh),
            GasResolution::Stratified(s) if s.cells < 2 => Self::single(mesh),
            GasResolution::Stratified(s) => Self::stacked(&vessel.geometry, mesh, s.cells),
        }
    }

    fn single(mesh: &Mesh) -> Self {
        let contacts: Vec<Vec<Contact>> = mesh
            .columns
            .iter()
            .map(|c| vec![Contact { cell: 0, area_m2: c.inner_area_m2, facing: Facing::Side }])
            .collect();
        let side_m2 = contacts.iter().flatten().map(|c| c.area_m2).sum();
        let cell = GasCell { volume_fraction: 1.0, height_m: 0.0, face_above_m2: 0.0, side_m2 };
        Self { cells: vec![cell], contacts, outlet: 0 }
    }

    fn stacked(geometry: &Geometry, mesh: &Mesh, count: usize) -> Self {
        let lying = geometry.orientation == Orientation::Horizontal;
        let height_m = geometry.gas_height_m() / count as f64;
        // Cross-section at a height, up to a factor.
        let section = |z: f64| {
            if lying {
                2.0 * (z * (geometry.inner_diameter_m - z)).max(0.0).sqrt() * geometry.inner_height_m()
            } else {
                std::f64::consts::PI * geometry.inner_radius_at_m(z).powi(2)
            }
        };
        let volume: Vec<f64> = (0..count)
            .map(|i| {
                let dz = height_m / SLICES as f64;
                (0..SLICES).map(|k| section(i as f64 * height_m + (k as f64 + 0.5) * dz) * dz).sum()
            })
            .collect();
        let total: f64 = volume.iter().sum();
        let contacts: Vec<Vec<Contact>> =
            mesh.columns.iter().map(|column| contacts_of(column, geometry, &volume, height_m)).collect();
        let cells = (0..count)
            .map(|i| GasCell {
                volume_fraction: volume[i] / total,
                height_m,
                face_above_m2: if i + 1 < count { section((i + 1) as f64 * height_m) } else { 0.0 },
                side_m2: contacts
                    .iter()
                    .flatten()
                    .filter(|c| c.cell == i && c.facing == Facing::Side)
                    .map(|c| c.area_m2)
                    .sum(),
            })
            .collect();
        Self { cells, contacts, outlet: if lying { count / 2 } else { count - 1 } }
    }
}

fn contacts_of(
    column: &crate::wall::mesh::Column,
    geometry: &Geometry,
    volume: &[f64],
    height_m: f64,
) -> Vec<Contact> {
    let count = volume.len();
    let area = column.inner_area_m2;
    let side = |cell: usize, share: f64| Contact { cell, area_m2: area * share, facing: Facing::Side };
    if geometry.orientation == Orientation::Horizontal {
        let radius = 0.5 * geometry.inner_diameter_m;
        let angle = |z: f64| (1.0 - z / radius).clamp(-1.0, 1.0).acos();
        let total: f64 = volume.iter().sum();
        return (0..count)
            .map(|i| {
                let arc =
                    (angle((i + 1) as f64 * height_m) - angle(i as f64 * height_m)) / std::f64::consts::PI;
                let disc = volume[i] / total;
                side(i, if column.facing == Facing::Side { arc } else { disc })
            })
            .collect();
    }
    match column.facing {
        Facing::Floor => vec![Contact { cell: 0, area_m2: area, facing: Facing::Floor }],
        Facing::Ceiling => vec![Contact { cell: count - 1, area_m2: area, facing: Facing::Ceiling }],
        Facing::Side => {
            let (low, high) = column.inner_height_m;
            (0..count)
                .filter_map(|i| {
                    let (z0, z1) = (i as f64 * height_m, (i + 1) as f64 * height_m);
                    let overlap = z1.min(high) - z0.max(low);
                    (overlap > 1e-9 * height_m).then(|| side(i, overlap / (high - low)))
                })
                .collect()
        }
    }
}

impl GasPlace {
    /// Gas cell that stands for the place, from 0; `None` for a number or height that the vessel does not have.
    pub fn cell(&self, vessel: &Vessel, mesh: &Mesh) -> Option<usize> {
        let grid = GasGrid::new(vessel, mesh);
        match *self {
            Self::Cell { number } => number.checked_sub(1).filter(|&cell| cell < grid.cells.len()),
            Self::Height { height_m } => {
                let geometry = &vessel.geometry;
                let (below_m, inner_m) = match geometry.orientation {
                    Orientation::Horizontal => (geometry.thickness_m(), geometry.inner_diameter_m),
                    Orientation::Vertical => (geometry.bottom.thickness_m, geometry.inner_height_m()),
                };
                let z = height_m - below_m;
                let count = grid.cells.len();
                (0.0..=inner_m).contains(&z).then(|| ((z / inner_m * count as f64) as usize).min(count - 1))
            }
        }
    }
}
