use super::grid::GasGrid;
use super::well_mixed::WellMixed;
use crate::vessel::{GasResolution, Stratification, presets};
use crate::wall::geometry::Orientation;
use crate::wall::mesh::{Facing, Mesh};
use approx::assert_relative_eq;

fn grid(vessel: &str, orientation: Orientation, cells: usize) -> (GasGrid, Mesh) {
    let mut vessel = presets::load(vessel).unwrap();
    vessel.geometry.orientation = orientation;
    vessel.gas = GasResolution::Stratified(Stratification {
        cells,
        exchange_length_diameters: 1.0,
        core_mixing: 0.05,
    });
    let mesh = Mesh::new(&vessel.geometry);
    (GasGrid::new(&vessel, &mesh), mesh)
}

#[test]
fn gas_cells_fill_the_vessel_and_touch_all_of_its_wall() {
    for name in ["nitrogen-20l", "haque-i1"] {
        for orientation in [Orientation::Vertical, Orientation::Horizontal] {
            let (grid, mesh) = grid(name, orientation, 17);
            assert_relative_eq!(
                grid.cells.iter().map(|c| c.volume_fraction).sum::<f64>(),
                1.0,
                epsilon = 1e-12
            );
            for (column, contacts) in mesh.columns.iter().zip(&grid.contacts) {
                let area: f64 = contacts.iter().map(|c| c.area_m2).sum();
                assert_relative_eq!(area, column.inner_area_m2, max_relative = 1e-9);
            }
            assert!(grid.cells.iter().all(|cell| cell.side_m2 > 0.0));
        }
    }
}

#[test]
fn lying_cylinder_has_no_floor_and_its_outlet_at_mid_height() {
    let (standing, _) = grid("haque-i1", Orientation::Vertical, 10);
    let (lying, _) = grid("haque-i1", Orientation::Horizontal, 10);
    let plates = |g: &GasGrid| g.contacts.iter().flatten().filter(|c| c.facing != Facing::Side).count();
    assert!(plates(&standing) >= 2 && plates(&lying) == 0);
    assert_eq!((standing.outlet, lying.outlet), (9, 5));
}

#[test]
fn slabs_of_a_lying_cylinder_have_the_volumes_of_circle_segments() {
    let (grid, _) = grid("haque-i1", Orientation::Horizontal, 4);
    // Segment of height R/2 in a circle: (acos(1/2) - sqrt(3)/4) / pi of its area.
    let segment = (0.5_f64.acos() - 3.0_f64.sqrt() / 4.0) / std::f64::consts::PI;
    assert_relative_eq!(grid.cells[0].volume_fraction, segment, max_relative = 1e-4);
    assert_relative_eq!(grid.cells[1].volume_fraction, 0.5 - segment, max_relative = 1e-4);
}

/// The last solution decides where Newton starts, and nothing else.
#[test]
fn the_state_of_the_gas_does_not_depend_on_what_was_asked_before() {
    let vessel = presets::load("nitrogen-20l").unwrap();
    let gas = || WellMixed::new(vessel.fluid.clone(), vessel.volume, 288.0);
    // Mass, kg, energy, J, and temperature of the wall, K.
    let asked = [
        (4.5, 8.5e5, 288.0),
        (4.5, 8.500001e5, 288.0),
        (4.49, 8.4e5, 287.0),
        (4.5, 8.5e5, 288.0),
        (0.5, 1.2e5, 300.0),
    ];
    let one = gas();
    for (mass_kg, energy_j, wall_k) in asked {
        let [warm, fresh] = [&one, &gas()].map(|gas| gas.node(mass_kg, energy_j, wall_k).unwrap());
        assert_relative_eq!(warm.state.temperature_k, fresh.state.temperature_k, max_relative = 1e-13);
        assert_relative_eq!(warm.state.pressure_pa, fresh.state.pressure_pa, max_relative = 1e-12);
        let energy = warm.state.internal_energy_j_kg * mass_kg;
        assert_relative_eq!(energy, energy_j, max_relative = 1e-12);
    }
}

/// A trial of the solver may ask for what is no gas: a mass and an energy between the phases, or a compressed liquid.
#[test]
fn a_trial_that_is_no_gas_does_not_lead_astray_what_follows() {
    let vessel = presets::load("nitrogen-20l").unwrap();
    let gas = || WellMixed::new(vessel.fluid.clone(), vessel.volume, 288.0);
    let right = gas().node(4.5, 8.5e5, 288.0).unwrap().state.temperature_k;
    for (mass_kg, energy_j) in [(4.5, -1.2e5), (4.4, -3e5), (12.0, -1.1e6), (14.5, -1.2e6), (1.0, -1e5)] {
        let one = gas();
        one.node(4.4, 8.4e5, 288.0).unwrap();
        let _ = one.node(mass_kg, energy_j, 288.0);
        let found = one.node(4.5, 8.5e5, 288.0).unwrap().state.temperature_k;
        assert_relative_eq!(found, right, max_relative = 1e-12);
    }
}
