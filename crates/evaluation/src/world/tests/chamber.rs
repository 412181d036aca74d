//! Cylinders in a chamber against the laws and the balances that are stated for them.
use cylwatch_thermal::units::ZERO_CELSIUS_K;

use crate::world::chamber::{Chamber, ChamberRequest, ChamberRun};
use crate::world::statistics::{Law, assert_law, assert_share, mean};
use crate::world::{SteadyLeak, VesselKind};

/// Coarse in space: what is claimed here does not depend on the mesh.
fn coarse(chamber: Chamber, seed: u64, sample_s: f64) -> ChamberRequest {
    let fine = ChamberRequest::new(chamber, seed, sample_s);
    ChamberRequest { wall_cells: 3, gas_cells: 4, relative_tolerance: 1e-5, ..fine }
}

fn run(request: &ChamberRequest) -> ChamberRun {
    request.run().unwrap()
}

fn bodies(run: &ChamberRun) -> Vec<Vec<f64>> {
    let of = &run.trajectory;
    let surfaces = ["shoulder", "valve", "middle", "bottom"].map(|place| of.surface_k(place).unwrap());
    [of.gas_mean_k.clone(), of.wall_mean_k.clone()].into_iter().chain(surfaces).collect()
}

#[test]
fn cylinders_and_sensors_fill_their_stated_ranges_evenly() {
    let drawn: Vec<_> = (0..500).map(|seed| coarse(Chamber::TUNNEL, seed, 60.0).drawn().unwrap()).collect();
    let of = |what: &str, value: &dyn Fn(usize) -> f64, (low, high): (f64, f64)| {
        let values: Vec<f64> = (0..drawn.len()).map(value).collect();
        assert_law(what, &values, Law::Uniform(low, high));
    };
    of("outside film", &|k| drawn[k].0.outside_film, (0.75, 1.3));
    of("inside film", &|k| drawn[k].0.inside_film, (0.75, 1.3));
    of("wall capacity", &|k| drawn[k].0.wall_capacity, (0.8, 1.25));
    of("valve capacity", &|k| drawn[k].0.valve_capacity, (0.75, 1.3));
    of("valve contact", &|k| drawn[k].0.valve_contact, (0.7, 1.3));
    of("emissivity", &|k| drawn[k].0.emissivity, (0.6, 0.95));
    of("thermal expansion", &|k| drawn[k].0.thermal_expansion, (0.9, 1.1));
    of("pressure expansion", &|k| drawn[k].0.pressure_expansion, (0.9, 1.1));
    of("film slope", &|k| drawn[k].0.film_slope, (-0.3, 0.3));
    of("shoulder's offset", &|k| drawn[k].1.shoulder.offset_k, (-0.3, 0.3));
    of("valve's coupling", &|k| drawn[k].1.valve.air_coupling, (0.05, 0.15));
    of("transmitter's offset", &|k| drawn[k].1.pressure.offset_pa.abs(), (0.25e5, 0.625e5));
    of("its coefficient", &|k| drawn[k].1.pressure.coefficient_pa_k.abs(), (0.0125e5, 0.0375e5));
    let high = drawn.iter().filter(|(_, sensors)| sensors.pressure.offset_pa > 0.0).count();
    assert_share("offsets above zero", high, drawn.len(), 0.5);
}

#[test]
fn a_seed_gives_one_cylinder_and_another_seed_another() {
    let of = |seed| run(&coarse(Chamber::SCENARIOS[0], seed, 60.0));
    let (first, again, other) = (of(1), of(1), of(2));
    assert_eq!(first.log.values, again.log.values);
    assert_eq!(bodies(&first), bodies(&again));
    assert!(first.log.values.iter().zip(&other.log.values).all(|(a, b)| a != b));
}

#[test]
fn cylinders_start_settled_and_reach_the_temperatures_of_their_chamber() {
    // How far bodies may still lag at the end, K: nothing but turbulence after steps of nine and more time constants; 20 min
    // behind ramps of 10 and -2.3 K/h.
    let [first, second, third, fourth] = Chamber::SCENARIOS;
    for (chamber, (least, most)) in [
        (first, (-0.2, 2.0)),
        (second, (-2.0, 0.2)),
        (third, (-10.0, -2.0)),
        (fourth, (0.3, 2.0)),
        (Chamber::TUNNEL, (-2.0, 0.2)),
    ] {
        let run = run(&coarse(chamber, 8, 120.0));
        let time_s = &run.trajectory.time_s;
        let change = time_s.partition_point(|&t_s| t_s < chamber.change_s());
        let (start_k, end_k) = (chamber.start_degc + ZERO_CELSIUS_K, chamber.end_degc + ZERO_CELSIUS_K);
        for body in bodies(&run) {
            // An outer surface differs from its wall by the film of the turbulent air alone.
            assert!((body[0] - start_k).abs() < 2e-3, "{chamber:?}: {} K at first", body[0]);
            // An hour of turbulence of 0.4 K and 2 min hardly moves a body of half an hour.
            let rest_k = body[..change].iter().map(|k| (k - start_k).abs()).fold(0.0, f64::max);
            assert!(rest_k < 0.6, "{chamber:?}: {rest_k} K before the change");
            let lag_k = body[body.len() - 1] - end_k;
            assert!(lag_k > least - 0.5 && lag_k < most + 0.5, "{chamber:?}: {lag_k} K from the end");
        }
        let end_s = time_s[time_s.len() - 1];
        assert!(end_s >= chamber.duration_s() && end_s < chamber.duration_s() + 120.0);
    }
}

#[test]
fn a_full_cylinder_has_the_mass_of_its_fill_and_the_pressure_of_its_temperature() {
    let run = run(&coarse(Chamber::SCENARIOS[0], 8, 600.0));
    let nominal = VesselKind::Nitrogen20.nominal().unwrap().vessel;
    // Filled to 200 bar and settled at 15 °C, in the volume that this cylinder then has.
    let rho = nominal.fluid.density_from_pressure_temperature(200e5, 288.15).unwrap();
    let mass_kg = rho * run.trajectory.vessel.volume.volume_m3(288.15, 200e5);
    approx::assert_relative_eq!(run.trajectory.mass_kg[0], mass_kg, max_relative = 1e-9);
    // Settled at 21 °C, six kelvin warmer: 6 K of 0.99 bar/K.
    let rise_bar = run.trajectory.pressure_pa[0] / 1e5 - 200.0;
    assert!((5.5..6.2).contains(&rise_bar), "{rise_bar} bar above the fill");
}

#[test]
fn a_tight_cylinder_keeps_its_mass_and_a_leaking_one_loses_rate_times_time() {
    let leak = SteadyLeak { rate_kg_s: 50e-3 / 3600.0, onset_s: 4321.0 };
    let of = |leak| {
        let request = coarse(Chamber::SCENARIOS[0], 4, 60.0);
        run(&ChamberRequest { leak, relative_tolerance: 1e-8, ..request }).trajectory
    };
    let (tight, leaking) = (of(None), of(Some(leak)));
    assert!(tight.mass_kg.iter().all(|&mass| (mass / tight.mass_kg[0] - 1.0).abs() < 1e-12));
    for (&t_s, &mass_kg) in leaking.time_s.iter().zip(&leaking.mass_kg) {
        let lost_kg = leak.rate_kg_s * (t_s - leak.onset_s).max(0.0);
        assert!((tight.mass_kg[0] - mass_kg - lost_kg).abs() < 1e-9, "{mass_kg} kg at {t_s} s");
    }
    // Both cylinders are the same until then; afterwards the gas expands and cools.
    let before = leaking.time_s.partition_point(|&t_s| t_s <= leak.onset_s);
    for k in 0..before {
        assert!((tight.gas_mean_k[k] - leaking.gas_mean_k[k]).abs() < 1e-5);
    }
    let half = tight.time_s.len() / 2;
    assert!(mean(&leaking.gas_mean_k[half..]) < mean(&tight.gas_mean_k[half..]));
    assert!(leaking.pressure_pa.last() < tight.pressure_pa.last());
}

#[test]
fn stacked_gas_is_warmer_above_and_its_mean_is_weighted_by_mass() {
    let chamber = Chamber::SCENARIOS[0];
    let run = run(&ChamberRequest::new(chamber, 8, 600.0)).trajectory;
    assert!(run.gas_cells_k.iter().all(|cells| cells.len() == 10));
    // While the wall cools the gas, cold gas sinks along it.
    let change = run.time_s.partition_point(|&t_s| t_s <= chamber.change_s() + 600.0);
    let cells = &run.gas_cells_k[change];
    assert!(cells.windows(2).all(|pair| pair[1] > pair[0]), "{cells:?}");
    // One pressure everywhere: the colder half is the denser one, so the mean by mass is below that by volume.
    let mean_k = run.gas_mean_k[change];
    assert!(cells[0] < mean_k && mean_k < mean(cells));
}
