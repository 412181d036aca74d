//! Finite-volume mesh of the wall: numbers only, no temperature in it.
//!
//! The contour is cut into axial columns from the bottom's centre to the neck, each column into radial
//! cells from the inside to the outside. Cell `(j, k)` has index `j * radial + k`. Between two cells heat
//! flows through two half cells in series; the half cell between a node and a face has the shape factor
//! `g = A_mean / d` (m), so that its conductance is `k g`. Shape factors are exact for radial conduction in
//! cylindrical shells (logarithmic mean area) and spherical ones (geometric mean); spheroid domes take the
//! geometric mean of their own areas, flat ends their own area. Nodes lie at the middle radius.
//!
//! Areas and volumes of domes come from the parametrisation `r = (a + s t) cos(phi)`, `z = (b + s t) sin(phi)`
//! with semi-axes `a, b`, thickness `t`, depth in the wall `s` in `[0, 1]`, by Gauss-Legendre quadrature; hemispheres are exact.
mod coarse;

use crate::real::powi;
use alloc::vec::Vec;
use core::f64::consts::PI;

use super::geometry::{End, EndShape, Geometry};
use super::material::Material;

/// Height of the valve above the middle, as a fraction of the inner height.
pub(crate) const TOP: f64 = 0.5;

/// What a column belongs to.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Section {
    /// Closing end at z = 0.
    Bottom,
    /// Cylindrical shell.
    Cylinder,
    /// Closing end at the valve's side.
    Shoulder,
    /// Tube that carries the valve.
    Neck,
}

/// How the inner face of a column lies when the vessel stands.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Facing {
    /// A wall beside the gas.
    Side,
    /// A flat floor under the gas.
    Floor,
    /// A flat ceiling above the gas.
    Ceiling,
}

/// One axial column of the wall.
#[derive(Clone, Debug, PartialEq)]
pub struct Column {
    /// What it belongs to.
    pub section: Section,
    /// How its inner face lies.
    pub(crate) facing: Facing,
    /// Area facing the gas, m².
    pub inner_area_m2: f64,
    /// Area facing the surroundings, m².
    pub outer_area_m2: f64,
    /// Lowest and highest point of the inner face above the inner bottom, m.
    pub inner_height_m: (f64, f64),
    /// Shape factor between the innermost node and the inner face, m.
    pub inner_shape_m: f64,
    /// Shape factor between the outermost node and the outer face, m.
    pub outer_shape_m: f64,
}

/// Two half cells in series between the nodes of two cells.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Link {
    /// One cell.
    pub a: usize,
    /// The other cell.
    pub b: usize,
    /// Shape factor of the half on the side of `a`, m.
    pub shape_a_m: f64,
    /// Shape factor of the half on the side of `b`, m.
    pub shape_b_m: f64,
}

/// The mesh. Shapes: `volume_m3` and `material` have `columns.len() * radial` entries.
#[derive(Clone, Debug, PartialEq)]
pub struct Mesh {
    /// Number of radial cells in each column.
    pub radial: usize,
    /// Columns from the bottom up.
    pub columns: Vec<Column>,
    /// Volume of each cell, m³.
    pub volume_m3: Vec<f64>,
    /// Material of each cell as an index into [`Mesh::materials`].
    pub material: Vec<usize>,
    /// Materials of the layers, from the inside to the outside.
    pub materials: Vec<Material>,
    /// Connections inside the wall.
    pub links: Vec<Link>,
}

/// A stretch of contour before it becomes a [`Column`]: everything as a function of the depth `s` in the wall.
struct Stretch {
    section: Section,
    facing: Facing,
    shape: StretchShape,
    thickness_m: f64,
    inner_height_m: (f64, f64),
}

enum StretchShape {
    /// Shell of inner radius and length.
    Shell { radius_m: f64, length_m: f64 },
    /// Spheroid zone between two parameter angles.
    Zone { radius_m: f64, depth_m: f64, phi: (f64, f64) },
    /// Ring of a disc between two radii on the inside; `rim`: the outermost ring, which reaches to the outer radius.
    Ring { radii_m: (f64, f64), rim: bool },
}

/// Nodes and weights of the eight-point Gauss-Legendre rule on [-1, 1] (Abramowitz and Stegun, table 25.4).
const GAUSS_8: [(f64, f64); 4] = [
    (0.183_434_642_495_649_8, 0.362_683_783_378_362),
    (0.525_532_409_916_329, 0.313_706_645_877_887_3),
    (0.796_666_477_413_626_7, 0.222_381_034_453_374_48),
    (0.960_289_856_497_536_3, 0.101_228_536_290_376_26),
];

fn integrate(from: f64, to: f64, f: impl Fn(f64) -> f64) -> f64 {
    let (middle, half) = (0.5 * (from + to), 0.5 * (to - from));
    half * GAUSS_8.iter().map(|&(x, w)| w * (f(middle - half * x) + f(middle + half * x))).sum::<f64>()
}

impl Stretch {
    /// Area of the surface at depth `s`, m².
    fn area_m2(&self, s: f64) -> f64 {
        let t = s * self.thickness_m;
        match self.shape {
            StretchShape::Shell { radius_m, length_m } => 2.0 * PI * (radius_m + t) * length_m,
            StretchShape::Zone { radius_m, depth_m, phi } => {
                let (a, b) = (radius_m + t, depth_m + t);
                integrate(phi.0, phi.1, |phi| {
                    2.0 * PI
                        * a
                        * libm::cos(phi)
                        * libm::sqrt(powi(a * libm::sin(phi), 2) + powi(b * libm::cos(phi), 2))
                })
            }
            StretchShape::Ring { radii_m: (r0, r1), rim } => {
                PI * (powi(r1 + if rim { t } else { 0.0 }, 2) - r0 * r0)
            }
        }
    }

    /// Area that faces the surroundings, m²: a disc's rim belongs to its outermost ring.
    fn outer_area_m2(&self) -> f64 {
        match self.shape {
            StretchShape::Ring { radii_m: (_, r1), rim: true } => {
                self.area_m2(1.0) + 2.0 * PI * (r1 + self.thickness_m) * self.thickness_m
            }
            _ => self.area_m2(1.0),
        }
    }

    /// Volume between two depths, m³.
    fn volume_m3(&self, s0: f64, s1: f64) -> f64 {
        let t = self.thickness_m;
        match self.shape {
            StretchShape::Shell { radius_m, length_m } => {
                PI * (powi(radius_m + s1 * t, 2) - powi(radius_m + s0 * t, 2)) * length_m
            }
            StretchShape::Zone { radius_m, depth_m, phi } => integrate(s0, s1, |s| {
                integrate(phi.0, phi.1, |phi| {
                    let (a, b) = (radius_m + s * t, depth_m + s * t);
                    2.0 * PI
                        * a
                        * libm::cos(phi)
                        * t
                        * (b * powi(libm::cos(phi), 2) + a * powi(libm::sin(phi), 2))
                })
            }),
            // A flat end is a disc of the full outer radius at every depth.
            StretchShape::Ring { .. } => self.area_m2(1.0) * (s1 - s0) * t,
        }
    }

    /// Length of the meridian at depth `s`, m.
    fn length_m(&self, s: f64) -> f64 {
        let t = s * self.thickness_m;
        match self.shape {
            StretchShape::Shell { length_m, .. } => length_m,
            StretchShape::Zone { radius_m, depth_m, phi } => {
                integrate(phi.0.min(phi.1), phi.0.max(phi.1), |phi| {
                    libm::sqrt(
                        powi((radius_m + t) * libm::sin(phi), 2) + powi((depth_m + t) * libm::cos(phi), 2),
                    )
                })
            }
            StretchShape::Ring { radii_m: (r0, r1), .. } => r1 - r0,
        }
    }

    /// Shape factor of radial conduction between two depths, m.
    fn radial_shape_m(&self, s0: f64, s1: f64) -> f64 {
        let distance = (s1 - s0).abs() * self.thickness_m;
        let (a0, a1) = (self.area_m2(s0), self.area_m2(s1));
        match self.shape {
            StretchShape::Shell { length_m, radius_m } => {
                let (r0, r1) = (radius_m + s0 * self.thickness_m, radius_m + s1 * self.thickness_m);
                2.0 * PI * length_m / libm::log(r1 / r0).abs()
            }
            _ => libm::sqrt(a0 * a1) / distance,
        }
    }

    /// Shape factor of conduction along the meridian over half the stretch, between two depths, m:
    /// the volume between the depths divided by the length gives the mean cross-section.
    fn axial_half_shape_m(&self, s0: f64, s1: f64) -> f64 {
        let length = self.length_m(0.5 * (s0 + s1));
        self.volume_m3(s0, s1) / length / (0.5 * length)
    }
}

impl Mesh {
    /// The mesh of a vessel's wall.
    pub fn new(geometry: &Geometry) -> Self {
        if geometry.lumped { Self::lumped(geometry) } else { Self::resolved(geometry) }
    }

    /// Number of cells.
    pub fn cells(&self) -> usize {
        self.volume_m3.len()
    }

    /// Index of the cell in a column at a radial position, both from 0.
    pub fn cell(&self, column: usize, radial: usize) -> usize {
        column * self.radial + radial
    }

    /// Index of the cell of a column that touches the gas.
    pub fn inner_cell(&self, column: usize) -> usize {
        self.cell(column, 0)
    }

    /// Index of the cell of a column that touches the surroundings.
    pub fn outer_cell(&self, column: usize) -> usize {
        self.cell(column, self.radial - 1)
    }

    /// Mass of the wall, kg.
    pub fn mass_kg(&self) -> f64 {
        self.volume_m3.iter().zip(&self.material).map(|(v, &m)| v * self.materials[m].density_kg_m3).sum()
    }

    /// Heat capacity of the wall at the reference temperature, J/K.
    pub fn capacity_j_k(&self) -> f64 {
        let of_volume = |m: usize| self.materials[m].density_kg_m3 * self.materials[m].heat_capacity_j_kg_k;
        self.volume_m3.iter().zip(&self.material).map(|(v, &m)| v * of_volume(m)).sum()
    }

    /// Column that stands for a place name: `bottom`, `middle`, `shoulder`, `neck`.
    ///
    /// `bottom` is the lowest column, `middle` the cylinder's column at half its height, `shoulder` the middle
    /// of the upper end, `neck` the topmost column.
    pub fn column_of(&self, place: &str) -> Option<usize> {
        let last = self.columns.len() - 1;
        let within = |section: Section| {
            let first = self.columns.iter().position(|c| c.section == section)?;
            let count = self.columns.iter().filter(|c| c.section == section).count();
            Some(first + count / 2)
        };
        match place {
            "bottom" => Some(0),
            "middle" => Some(within(Section::Cylinder).unwrap_or(last / 2)),
            "shoulder" => Some(within(Section::Shoulder).unwrap_or(last)),
            "neck" => Some(last),
            _ => None,
        }
    }

    /// Height of the middle of each column above that of the vessel, as a fraction of the inner height.
    pub(crate) fn above_middle(&self) -> Vec<f64> {
        let top_m = self.inner_height_m();
        let middle =
            |column: &Column| 0.5 * (column.inner_height_m.0 + column.inner_height_m.1) / top_m - 0.5;
        self.columns.iter().map(middle).collect()
    }

    /// Projected area of each column in the sun, m²: its outer area over pi, times the part of its height that is lit, from
    /// one fraction of the height to another.
    pub(crate) fn lit_area_m2(&self, fractions: (f64, f64)) -> Vec<f64> {
        let top_m = self.inner_height_m();
        let (from, to) = (fractions.0 * top_m, fractions.1 * top_m);
        self.columns
            .iter()
            .map(|column| {
                let (low, high) = column.inner_height_m;
                let lit = if high > low {
                    ((high.min(to) - low.max(from)) / (high - low)).max(0.0)
                } else {
                    f64::from(u8::from(from <= low && low <= to))
                };
                lit * column.outer_area_m2 / core::f64::consts::PI
            })
            .collect()
    }

    fn inner_height_m(&self) -> f64 {
        self.columns.iter().map(|column| column.inner_height_m.1).fold(0.0, f64::max)
    }

    fn resolved(geometry: &Geometry) -> Self {
        let stretches = stretches(geometry);
        let materials: Vec<Material> = geometry.layers.iter().map(|layer| layer.material.clone()).collect();
        // Depths of the faces and the layer of each radial cell, the same in every column.
        let mut faces = vec![0.0];
        let mut layer_of = Vec::new();
        let total = geometry.thickness_m();
        for (index, layer) in geometry.layers.iter().enumerate() {
            let start = *faces.last().expect("faces start with 0");
            for cell in 1..=layer.cells {
                faces.push(start + layer.thickness_m / total * cell as f64 / layer.cells as f64);
                layer_of.push(index);
            }
        }
        let radial = layer_of.len();
        let middle = |k: usize| 0.5 * (faces[k] + faces[k + 1]);
        let mut mesh = Mesh {
            radial,
            columns: Vec::new(),
            volume_m3: Vec::new(),
            material: Vec::new(),
            materials,
            links: Vec::new(),
        };
        for (j, stretch) in stretches.iter().enumerate() {
            for k in 0..radial {
                mesh.volume_m3.push(stretch.volume_m3(faces[k], faces[k + 1]));
                mesh.material.push(layer_of[k]);
                if k > 0 {
                    mesh.links.push(Link {
                        a: j * radial + k - 1,
                        b: j * radial + k,
                        shape_a_m: stretch.radial_shape_m(middle(k - 1), faces[k]),
                        shape_b_m: stretch.radial_shape_m(faces[k], middle(k)),
                    });
                }
                if j > 0 {
                    mesh.links.push(Link {
                        a: (j - 1) * radial + k,
                        b: j * radial + k,
                        shape_a_m: stretches[j - 1].axial_half_shape_m(faces[k], faces[k + 1]),
                        shape_b_m: stretch.axial_half_shape_m(faces[k], faces[k + 1]),
                    });
                }
            }
            mesh.columns.push(Column {
                section: stretch.section,
                facing: stretch.facing,
                inner_area_m2: stretch.area_m2(0.0),
                outer_area_m2: stretch.outer_area_m2(),
                inner_height_m: stretch.inner_height_m,
                inner_shape_m: stretch.radial_shape_m(0.0, middle(0)),
                outer_shape_m: stretch.radial_shape_m(middle(radial - 1), 1.0),
            });
        }
        mesh
    }

    /// One cell for the whole wall: capacities and areas add, the layers become one mixture.
    fn lumped(geometry: &Geometry) -> Self {
        Self::coarse(geometry, 1).0
    }
}

fn stretches(geometry: &Geometry) -> Vec<Stretch> {
    let radius = 0.5 * geometry.inner_diameter_m;
    let mut out = Vec::new();
    let mut height = 0.0;
    push_end(&mut out, &geometry.bottom, radius, 0.0, Section::Bottom, &mut height);
    let dz = geometry.cylinder_length_m / geometry.cylinder_cells as f64;
    for cell in 0..geometry.cylinder_cells {
        let z = height + dz * cell as f64;
        out.push(Stretch {
            section: Section::Cylinder,
            facing: Facing::Side,
            shape: StretchShape::Shell { radius_m: radius, length_m: dz },
            thickness_m: geometry.thickness_m(),
            inner_height_m: (z, z + dz),
        });
    }
    height += geometry.cylinder_length_m;
    let opening = geometry.neck.map_or(0.0, |neck| 0.5 * neck.inner_diameter_m);
    push_end(&mut out, &geometry.shoulder, radius, opening, Section::Shoulder, &mut height);
    if let Some(neck) = geometry.neck {
        let dz = neck.length_m / neck.cells as f64;
        for cell in 0..neck.cells {
            let z = height + dz * cell as f64;
            out.push(Stretch {
                section: Section::Neck,
                facing: Facing::Side,
                shape: StretchShape::Shell { radius_m: opening, length_m: dz },
                thickness_m: neck.thickness_m,
                inner_height_m: (z, z + dz),
            });
        }
    }
    out
}

/// Columns of an end in the order from the bottom up; `height` is the inner height reached so far, m.
fn push_end(
    out: &mut Vec<Stretch>,
    end: &End,
    radius: f64,
    opening: f64,
    section: Section,
    height: &mut f64,
) {
    let bottom = section == Section::Bottom;
    let n = end.cells as f64;
    // A bottom starts at the axis, a shoulder at the cylinder.
    let ordered = |cell: usize| if bottom { end.cells - 1 - cell } else { cell };
    match end.shape {
        EndShape::Flat => {
            let width = (radius - opening) / n;
            for cell in 0..end.cells {
                let from_rim = ordered(cell);
                let outer = radius - width * from_rim as f64;
                out.push(Stretch {
                    section,
                    facing: if bottom { Facing::Floor } else { Facing::Ceiling },
                    shape: StretchShape::Ring { radii_m: (outer - width, outer), rim: from_rim == 0 },
                    thickness_m: end.thickness_m,
                    inner_height_m: (*height, *height),
                });
            }
        }
        EndShape::Dome { depth_m } => {
            let phi_end = libm::acos(opening / radius);
            let z = |phi: f64| depth_m * libm::sin(phi);
            for cell in 0..end.cells {
                let from_equator = ordered(cell) as f64;
                let phi = (phi_end * from_equator / n, phi_end * (from_equator + 1.0) / n);
                let inner_height_m = if bottom {
                    (depth_m - z(phi.1), depth_m - z(phi.0))
                } else {
                    (*height + z(phi.0), *height + z(phi.1))
                };
                out.push(Stretch {
                    section,
                    facing: Facing::Side,
                    shape: StretchShape::Zone { radius_m: radius, depth_m, phi },
                    thickness_m: end.thickness_m,
                    inner_height_m,
                });
            }
            *height += if bottom { depth_m } else { z(phi_end) };
        }
    }
}

#[cfg(test)]
mod tests;
