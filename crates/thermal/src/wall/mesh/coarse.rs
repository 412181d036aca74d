//! A wall of a few nodes, lumped from the resolved mesh.
use super::{Column, Facing, Link, Mesh, Section};
use crate::wall::geometry::{Geometry, Layer};
use crate::wall::material::Material;
use alloc::vec::Vec;

impl Link {
    /// Shape factor of both halves in series in one material, m.
    pub(crate) fn series_m(&self) -> f64 {
        (self.shape_a_m.recip() + self.shape_b_m.recip()).recip()
    }
}

impl Mesh {
    /// All columns of the resolved mesh, the layers of each as one cell of their mixture.
    pub(crate) fn of_mixture(geometry: &Geometry) -> Self {
        let parts: Vec<(&Material, f64)> =
            geometry.layers.iter().map(|layer| (&layer.material, layer.thickness_m)).collect();
        let mixture = Material::mixture(&parts);
        let layer = Layer { material: mixture, thickness_m: geometry.thickness_m(), cells: 1 };
        Self::resolved(&Geometry { layers: vec![layer], lumped: false, ..geometry.clone() })
    }

    /// A wall of a few nodes, each a stretch of the contour over the full thickness, and the node of every column
    /// of the resolved mesh. Stretches have about equal outer areas; capacities, areas and shape factors add, the layers
    /// become one mixture, and between two nodes the half cells of the columns from middle to middle lie in series.
    /// There are never more nodes than columns.
    pub(crate) fn coarse(geometry: &Geometry, nodes: usize) -> (Self, Vec<usize>) {
        let fine = Self::of_mixture(geometry);
        let node_of = stretches_of_equal_area(&fine.columns, nodes);
        let count = node_of.last().map_or(0, |last| last + 1);
        let range =
            |node: usize| node_of.partition_point(|&n| n < node)..node_of.partition_point(|&n| n <= node);
        let sum = |node: usize, value: &dyn Fn(&Column) -> f64| {
            fine.columns[range(node)].iter().map(value).sum::<f64>()
        };
        let columns = (0..count)
            .map(|node| Column {
                section: if count == 1 {
                    Section::Cylinder
                } else {
                    fine.columns[middle_of(&range(node))].section
                },
                facing: Facing::Side,
                inner_area_m2: sum(node, &|c| c.inner_area_m2),
                outer_area_m2: sum(node, &|c| c.outer_area_m2),
                inner_height_m: {
                    let columns = &fine.columns[range(node)];
                    (columns[0].inner_height_m.0, columns[columns.len() - 1].inner_height_m.1)
                },
                inner_shape_m: sum(node, &|c| c.inner_shape_m),
                outer_shape_m: sum(node, &|c| c.outer_shape_m),
            })
            .collect();
        let links = (1..count)
            .map(|node| {
                let (below, above) = (range(node - 1), range(node));
                // Link j of the one-layer mesh joins the columns j and j + 1.
                let border = &fine.links[above.start - 1];
                let half = |links: core::ops::Range<usize>, at_border_m: f64| {
                    let inside: f64 = fine.links[links].iter().map(|link| link.series_m().recip()).sum();
                    (inside + at_border_m.recip()).recip()
                };
                Link {
                    a: node - 1,
                    b: node,
                    shape_a_m: half(middle_of(&below)..below.end - 1, border.shape_a_m),
                    shape_b_m: half(above.start..middle_of(&above), border.shape_b_m),
                }
            })
            .collect();
        let mesh = Mesh {
            radial: 1,
            columns,
            volume_m3: (0..count).map(|node| fine.volume_m3[range(node)].iter().sum()).collect(),
            material: vec![0; count],
            materials: fine.materials.clone(),
            links,
        };
        (mesh, node_of)
    }
}

fn middle_of(range: &core::ops::Range<usize>) -> usize {
    (range.start + range.end - 1) / 2
}

/// Node of each column when contiguous stretches shall have about equal outer areas and none is empty.
fn stretches_of_equal_area(columns: &[Column], nodes: usize) -> Vec<usize> {
    let nodes = nodes.clamp(1, columns.len());
    let total: f64 = columns.iter().map(|c| c.outer_area_m2).sum();
    let (mut below, mut node_of) = (0.0, Vec::with_capacity(columns.len()));
    for (j, column) in columns.iter().enumerate() {
        let wanted = ((below + 0.5 * column.outer_area_m2) / total * nodes as f64) as usize;
        let previous: Option<usize> = node_of.last().copied();
        let least = previous.unwrap_or(0).max((j + nodes).saturating_sub(columns.len()));
        node_of.push(wanted.clamp(least, previous.map_or(0, |node| node + 1).min(nodes - 1)));
        below += column.outer_area_m2;
    }
    node_of
}
