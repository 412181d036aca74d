//! Discharges: three runs of a hydrogen cylinder, a small vessel, an air tank, two tanks of plastics.
use cylwatch_thermal::fluid::Fluid;
use cylwatch_thermal::vessel::InsideFilm;

use super::thermometer::{fit as fit_sheath, sheathed};
use super::{absolute, case, curve, fit, fitted, middle, rms, run, score};

/// Byrnes et al. 1964, hydrogen of 2000 psi in 14, 30 and 480 s. Fitted: the coefficient, to the pressure.
///
/// Run 8 misses 4 K, and its wall by 6.5 K: [`the_gas_of_run_8_took_more_heat_than_its_wall_thermometer_gave`]. Run 7 misses 2.5 bar:
/// [`a_valve_that_opens_within_a_second_explains_the_pressure`].
#[test]
fn a_hydrogen_cylinder_lets_down_within_4_k_in_14_and_30_seconds_and_5_k_in_480() {
    for (name, gas_k, pressure_bar, wall_k) in
        [("run7", 3.6, 3.2, 3.1), ("run8", 5.0, 1.3, 6.7), ("run9", 4.0, 2.5, 0.8)]
    {
        let points = |what: &str| curve("byrnes_1964", &format!("{name}_{what}"));
        let (_, best) = fitted("byrnes_1964", name, &points("pressure"));
        let t = &best.run.time_s;
        let gas = rms("gas", t, &best.run.gas_mean_k, &points("gas"));
        let wall = rms("wall", t, &best.run.wall_inner_mean_k, &points("wall"));
        assert!(gas <= gas_k && wall <= wall_k && best.pressure.1 <= pressure_bar, "{name}");
    }
}

/// Runs 7 and 9 let gas out slower in their first seconds than later, at higher pressure. With the opening as a second constant,
/// **fitted to the pressure as well**, both bars are met, in temperatures that nothing was fitted to.
#[test]
fn a_valve_that_opens_within_a_second_explains_the_pressure() {
    for (name, pressure_bar, gas_k) in [("run7", 1.2, 2.6), ("run9", 1.2, 2.6)] {
        let points = |what: &str| curve("byrnes_1964", &format!("{name}_{what}"));
        let (vessel, scenario) = case("byrnes_1964", name);
        let best = (0..=12)
            .map(|i| 0.1 * f64::from(i))
            .map(|start_s| {
                let mut scenario = scenario.clone();
                scenario.flows[0].start_s = start_s;
                (start_s, fit(&vessel, &scenario, &points("pressure")))
            })
            .min_by(|a, b| a.1.pressure.1.total_cmp(&b.1.pressure.1))
            .unwrap();
        println!("{name}: open from {:.1} s, pressure {:.2} bar", best.0, best.1.pressure.1);
        let gas = rms("gas", &best.1.run.time_s, &best.1.run.gas_mean_k, &points("gas"));
        assert!(best.1.pressure.1 <= pressure_bar && gas <= gas_k, "{name}");
    }
}

/// From the measured pressure and gas temperature alone, without films or orifice: `Q = m_1 u_1 - m_0 u_0 - int h dm`. The 57 kg of
/// steel would have cooled by 17 K for it, the thermometer of the wall shows 10 K; perlite gives next to nothing in 8 min.
#[test]
fn the_gas_of_run_8_took_more_heat_than_its_wall_thermometer_gave() {
    let fluid = Fluid::named("hydrogen").unwrap();
    let (vessel, scenario) = case("byrnes_1964", "run8");
    let (pressure, gas) = (curve("byrnes_1964", "run8_pressure"), curve("byrnes_1964", "run8_gas"));
    let states: Vec<_> = pressure
        .iter()
        .zip(&gas)
        .map(|(&(_, bar), &(_, k))| {
            let rho = fluid.density_from_pressure_temperature(bar * 1e5, k).unwrap();
            (rho * vessel.volume.volume_m3, fluid.state(rho, k))
        })
        .collect();
    let (first, last) = (&states[0], &states[states.len() - 1]);
    let left: f64 = states
        .windows(2)
        .map(|w| (w[0].0 - w[1].0) * 0.5 * (w[0].1.enthalpy_j_kg + w[1].1.enthalpy_j_kg))
        .sum();
    let heat_j = last.0 * last.1.internal_energy_j_kg - first.0 * first.1.internal_energy_j_kg + left;
    let simulated = run(&vessel, &scenario);
    let lost_k = simulated.wall_mean_k[0] - simulated.wall_mean_k[simulated.time_s.len() - 1];
    let given_j: f64 =
        simulated.heat_to_gas_w.windows(2).map(|w| 0.5 * (w[0] + w[1]) * scenario.sample_time_s).sum();
    let wall = curve("byrnes_1964", "run8_wall");
    let measured_k = wall[0].1 - wall[wall.len() - 1].1;
    let needed_k = heat_j / (given_j / lost_k);
    println!("run 8: {:.0} kJ, of the wall {needed_k:.1} K, measured {measured_k:.1} K", heat_j / 1e3);
    assert!(needed_k > 1.5 * measured_k);
}

/// Woodfield et al. 2007, hydrogen of 100 bar in 45 s from 0.94 L, two gas thermometers up to 20 K apart. Fitted: the coefficient, to the pressure.
///
/// Misses 4 K by its film: 0.7 of McAdams's law meets the middle to 5.2 K, and to 2.7 K with a thermocouple of 0.02 mm. The law is known to 30 %,
/// and in a vessel as small as this 30 % are 10 K.
#[test]
fn a_small_vessel_misses_4_k_by_the_uncertainty_of_its_film() {
    let pressure = absolute(&curve("woodfield_2007", "discharge_pressure"));
    let (high, low) =
        (curve("woodfield_2007", "discharge_gas_high"), curve("woodfield_2007", "discharge_gas_low"));
    let middle = middle(&high, &low);
    let (mut vessel, best) = fitted("woodfield_2007", "discharge", &pressure);
    let gas = rms("middle of two thermometers", &best.run.time_s, &best.run.gas_mean_k, &middle);
    assert!(best.pressure.1 <= 0.75 && gas <= 10.0);
    vessel.inside_film = InsideFilm::Rayleigh { factor: 0.13, exponent: 1.0 / 3.0, multiplier: 0.7 };
    let weaker = fit(&vessel, &case("woodfield_2007", "discharge").1, &pressure);
    let gas = rms("with 0.7 of the film", &weaker.run.time_s, &weaker.run.gas_mean_k, &middle);
    let (capacity, left) = fit_sheath(&vessel, &weaker.run, &middle);
    println!("  and a sheath of {capacity:.0} J/m2/K: {left:.2} K");
    assert!(gas <= 5.4 && left <= 2.9);
}

/// Thorncroft et al. 2007, air of 7.9 bar in 40 s from 16 L. Fitted: the coefficient, to the pressure.
///
/// Misses 4 K by its thermometer: in the first 3.6 s the air expands from 7.9 to 5.9 bar, adiabatically to 274 K, and it shows 286 K, though no
/// wall can give that much so fast.
#[test]
fn an_air_tank_misses_4_k_by_the_lag_of_its_thermometer() {
    let (vessel, best) =
        fitted("thorncroft_2007", "discharge", &curve("thorncroft_2007", "discharge_pressure"));
    let points = curve("thorncroft_2007", "discharge_gas");
    let gas = rms("gas", &best.run.time_s, &best.run.gas_mean_k, &points);
    let (capacity, left) = fit_sheath(&vessel, &best.run, &points);
    println!("  with a sheath of {capacity:.0} J/m2/K: {left:.2} K");
    assert!(best.pressure.1 <= 0.04 && gas <= 9.7 && left <= 6.0);
}

/// Helium of 700 bar from a type IV tank in 300 s (KIT). Fitted: the coefficient, to the pressure; walls as the publication has them.
///
/// Misses 4 K by its thermometer, as the publication says of it: the coldest reading comes 20 s after the model's. A sheath of 3 mm, the one constant
/// **fitted to this temperature**, leaves 4.8 K.
#[test]
fn a_helium_tank_misses_4_k_by_the_lag_of_its_thermometer() {
    let (vessel, best) = fitted("kit_helium", "discharge", &absolute(&curve("kit_helium", "pressure")));
    let points = curve("kit_helium", "gas");
    let gas = rms("gas", &best.run.time_s, &best.run.gas_mean_k, &points);
    let (capacity, left) = fit_sheath(&vessel, &best.run, &points);
    println!("  with a sheath of {capacity:.0} J/m2/K: {left:.2} K");
    assert!(best.pressure.1 <= 1.7 && gas <= 14.9 && left <= 4.9);
    assert!((2_000.0..5_000.0).contains(&capacity), "{capacity}");
    let coldest = |t: &[f64], x: &[f64]| t[x.iter().enumerate().min_by(|a, b| a.1.total_cmp(b.1)).unwrap().0];
    let reading = sheathed(&vessel, &best.run, capacity);
    let (gas_s, read_s) =
        (coldest(&best.run.time_s, &best.run.gas_mean_k), coldest(&best.run.time_s, &reading));
    println!("  coldest at {gas_s:.0} s, read at {read_s:.0} s, measured at 100 s");
    assert!(gas_s < 85.0 && (90.0..115.0).contains(&read_s));
}

/// Hydrogen of 700 bar from a lying type IV tank, 1.8 g/s (GasTeF): the flow is given, nothing is fitted; the tank's materials are the library's.
#[test]
fn a_plastics_tank_that_feeds_a_fuel_cell_is_within_4_k_on_its_axis() {
    let (vessel, scenario) = case("demiguel_2015", "discharge");
    let run = run(&vessel, &scenario);
    let points = |name: &str| curve("demiguel_2015", name);
    println!("demiguel_2015 discharge");
    let axis = rms("gas on the axis", &run.time_s, &run.gas_mean_k, &points("gas_middle"));
    let low = rms("gas at the bottom", &run.time_s, &run.gas_mean_k, &points("gas_low"));
    let high = rms("gas at the top", &run.time_s, &run.gas_mean_k, &points("gas_high"));
    let mean: Vec<f64> =
        run.wall_outer_k.iter().map(|cells| cells.iter().sum::<f64>() / cells.len() as f64).collect();
    let wall = score(&run.time_s, &mean, &points("wall_outer")).1;
    println!("  outer wall {wall:.2} K");
    assert!(axis <= 2.6 && low <= 3.4 && wall <= 1.5);
    // The layer under the top is 40 K warmer than the rest, and no mean.
    assert!(high > 20.0);
}
