use super::*;
use crate::wall::geometry::{Layer, Neck, Orientation};
use approx::assert_relative_eq;

fn steel() -> Material {
    Material {
        name: "steel".into(),
        density_kg_m3: 7850.0,
        heat_capacity_j_kg_k: 470.0,
        heat_capacity_slope_per_k: 0.0,
        conductivity_w_m_k: 45.0,
        conductivity_slope_per_k: 0.0,
        source: "test".into(),
    }
}

fn domed(depth_m: f64, opening_m: Option<f64>) -> Geometry {
    let end = End { shape: EndShape::Dome { depth_m }, thickness_m: 0.006, cells: 3 };
    Geometry {
        orientation: Orientation::Vertical,
        inner_diameter_m: 0.2,
        cylinder_length_m: 0.5,
        cylinder_cells: 4,
        bottom: end,
        shoulder: End { cells: 2, ..end },
        neck: opening_m.map(|d| Neck { inner_diameter_m: d, thickness_m: 0.01, length_m: 0.03, cells: 1 }),
        layers: vec![Layer { material: steel(), thickness_m: 0.006, cells: 3 }],
        lumped: false,
    }
}

fn flat() -> Geometry {
    let end = End { shape: EndShape::Flat, thickness_m: 0.0067, cells: 2 };
    Geometry {
        inner_diameter_m: 0.1907,
        cylinder_length_m: 0.7,
        bottom: end,
        shoulder: end,
        layers: vec![Layer { material: steel(), thickness_m: 0.0067, cells: 2 }],
        ..domed(0.1, None)
    }
}

fn sum(mesh: &Mesh, section: Section, value: fn(&Column) -> f64) -> f64 {
    mesh.columns.iter().filter(|c| c.section == section).map(value).sum()
}

#[test]
fn hemispheres_have_the_areas_and_volumes_of_spheres() {
    let mesh = Mesh::new(&domed(0.1, None));
    let (r, t) = (0.1_f64, 0.006_f64);
    assert_relative_eq!(
        sum(&mesh, Section::Bottom, |c| c.inner_area_m2),
        2.0 * PI * r * r,
        max_relative = 1e-10
    );
    assert_relative_eq!(
        sum(&mesh, Section::Bottom, |c| c.outer_area_m2),
        2.0 * PI * (r + t).powi(2),
        max_relative = 1e-10
    );
    let volume: f64 = mesh.volume_m3[..9].iter().sum();
    assert_relative_eq!(volume, 2.0 / 3.0 * PI * ((r + t).powi(3) - r.powi(3)), max_relative = 1e-10);
}

/// Half the surface of an oblate spheroid: pi a² (1 + (1 - e²)/e artanh e).
#[test]
fn ellipsoidal_dome_has_the_area_of_half_an_oblate_spheroid() {
    let mesh = Mesh::new(&domed(0.05, None));
    let (a, b) = (0.1_f64, 0.05_f64);
    let e = (1.0 - b * b / (a * a)).sqrt();
    let area = PI * a * a * (1.0 + (1.0 - e * e) / e * e.atanh());
    assert_relative_eq!(sum(&mesh, Section::Shoulder, |c| c.inner_area_m2), area, max_relative = 1e-7);
}

#[test]
fn flat_ended_bottle_has_the_volume_and_area_between_two_cylinders() {
    let mesh = Mesh::new(&flat());
    let (d, length, t) = (0.1907_f64, 0.7_f64, 0.0067_f64);
    let (outer_d, outer_length) = (d + 2.0 * t, length + 2.0 * t);
    let solid = 0.25 * PI * (outer_d * outer_d * outer_length - d * d * length);
    assert_relative_eq!(mesh.volume_m3.iter().sum::<f64>(), solid, max_relative = 1e-12);
    let outer: f64 = mesh.columns.iter().map(|c| c.outer_area_m2).sum();
    assert_relative_eq!(outer, PI * outer_d * (outer_length + 0.5 * outer_d), max_relative = 1e-12);
    let inner: f64 = mesh.columns.iter().map(|c| c.inner_area_m2).sum();
    assert_relative_eq!(inner, PI * d * (length + 0.5 * d), max_relative = 1e-12);
    assert_relative_eq!(mesh.mass_kg(), 26.28, max_relative = 1e-3);
}

#[test]
fn radial_resistances_of_a_shell_add_up_to_the_logarithm() {
    let mesh = Mesh::new(&domed(0.1, None));
    let column = 4;
    let mut resistance = 1.0 / mesh.columns[column].inner_shape_m + 1.0 / mesh.columns[column].outer_shape_m;
    for link in &mesh.links {
        if link.a / mesh.radial == column && link.b / mesh.radial == column {
            resistance += 1.0 / link.shape_a_m + 1.0 / link.shape_b_m;
        }
    }
    let length = 0.5 / 4.0;
    assert_relative_eq!(resistance, (0.106_f64 / 0.1).ln() / (2.0 * PI * length), max_relative = 1e-12);
}

#[test]
fn lumped_wall_keeps_mass_and_areas() {
    for geometry in [flat(), domed(0.07, Some(0.03))] {
        let fine = Mesh::new(&geometry);
        let lumped = Mesh::new(&Geometry { lumped: true, ..geometry });
        assert_eq!(lumped.cells(), 1);
        assert_relative_eq!(lumped.mass_kg(), fine.mass_kg(), max_relative = 1e-9);
        for value in [(|c: &Column| c.inner_area_m2) as fn(&Column) -> f64, |c| c.outer_area_m2] {
            let total: f64 = fine.columns.iter().map(value).sum();
            assert_relative_eq!(value(&lumped.columns[0]), total, max_relative = 1e-12);
        }
    }
}

#[test]
fn columns_follow_each_other_from_the_bottom_to_the_neck() {
    let geometry = domed(0.07, Some(0.03));
    let mesh = Mesh::new(&geometry);
    assert_eq!(mesh.columns.len(), 3 + 4 + 2 + 1);
    assert_relative_eq!(mesh.columns[0].inner_height_m.0, 0.0, epsilon = 1e-12);
    for pair in mesh.columns.windows(2) {
        assert_relative_eq!(pair[0].inner_height_m.1, pair[1].inner_height_m.0, epsilon = 1e-12);
    }
    let top = mesh.columns.last().unwrap().inner_height_m.1;
    assert_relative_eq!(top, geometry.inner_height_m(), max_relative = 1e-12);
    assert_eq!(mesh.columns[mesh.column_of("shoulder").unwrap()].section, Section::Shoulder);
    assert_eq!(mesh.columns[mesh.column_of("middle").unwrap()].section, Section::Cylinder);
    assert_eq!(mesh.column_of("nowhere"), None);
}

/// Contour volume against a fine sum of discs.
#[test]
fn contour_volume_is_the_sum_of_its_discs() {
    let geometry = domed(0.07, Some(0.03));
    let n = 200_000;
    let (a, b, l) = (0.1_f64, 0.07_f64, 0.5_f64);
    let height = geometry.inner_height_m();
    let dz = height / n as f64;
    let volume: f64 = (0..n)
        .map(|i| {
            let z = (i as f64 + 0.5) * dz;
            let r = if z < b {
                a * (1.0 - ((b - z) / b).powi(2)).sqrt()
            } else if z < b + l {
                a
            } else {
                (a * (1.0 - ((z - b - l) / b).powi(2)).max(0.0).sqrt()).max(0.015)
            };
            PI * r * r * dz
        })
        .sum();
    assert_relative_eq!(geometry.contour_volume_m3(), volume, max_relative = 1e-5);
}

#[test]
fn a_coarse_wall_keeps_mass_areas_and_contact_to_the_air() {
    for name in ["nitrogen-20l", "haque-i1"] {
        let geometry = crate::vessel::presets::load(name).unwrap().geometry;
        let fine = Mesh::new(&geometry);
        let sum = |mesh: &Mesh, value: fn(&Column) -> f64| mesh.columns.iter().map(value).sum::<f64>();
        for nodes in [1, 2, 3, 5, fine.columns.len(), 400] {
            let (coarse, node_of) = Mesh::coarse(&geometry, nodes);
            assert_eq!(coarse.columns.len(), nodes.min(fine.columns.len()));
            assert_eq!(node_of.len(), fine.columns.len());
            assert!(node_of.windows(2).all(|pair| pair[1] == pair[0] || pair[1] == pair[0] + 1));
            assert_relative_eq!(coarse.mass_kg(), fine.mass_kg(), max_relative = 1e-9);
            for value in [|c: &Column| c.inner_area_m2, |c: &Column| c.outer_area_m2] {
                assert_relative_eq!(sum(&coarse, value), sum(&fine, value), max_relative = 1e-9);
            }
        }
    }
}

/// Along a bar the conductance between two nodes is that of the stretch from middle to middle.
#[test]
fn coarse_nodes_of_a_tube_conduct_like_the_tube_between_their_middles() {
    let mut geometry = crate::vessel::presets::load("nitrogen-20l").unwrap().geometry;
    geometry.cylinder_cells = 400;
    let (coarse, node_of) = Mesh::coarse(&geometry, 8);
    let fine = Mesh::coarse(&geometry, usize::MAX).0;
    let middle = |node: usize| {
        let of = |j: usize| fine.columns[j].inner_height_m;
        let columns: Vec<usize> = (0..node_of.len()).filter(|&j| node_of[j] == node).collect();
        0.5 * (of(columns[0]).0 + of(columns[columns.len() - 1]).1)
    };
    // Nodes 3 and 4 lie in the shell.
    let (inner, outer) =
        (0.5 * geometry.inner_diameter_m, 0.5 * geometry.inner_diameter_m + geometry.thickness_m());
    let section_m2 = std::f64::consts::PI * (outer * outer - inner * inner);
    let expected = section_m2 / (middle(4) - middle(3));
    assert_relative_eq!(coarse.links[3].series_m(), expected, max_relative = 0.01);
}
