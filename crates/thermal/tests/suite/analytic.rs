//! Runs whose answer is known in closed form or from an independent program.
use approx::assert_relative_eq;
use cylwatch_thermal::ThermalError;
use cylwatch_thermal::flow::{Flow, FlowKind};
use cylwatch_thermal::fluid::{Equation, Fluid};
use cylwatch_thermal::scenario::{OutsideFilm, Series, Sun};
use cylwatch_thermal::simulate::{Method, SimulationSettings, simulate};
use cylwatch_thermal::trajectory::EventKind;
use cylwatch_thermal::vessel::Fill;

use crate::support::{closed_bottle, insulated, run, still};

/// Reference: HydDown 0.50 on the same bottle (project reference "peers", section 3): end pressure 219.71 bar,
/// 63 % of the gas's temperature rise after 3942 s.
#[test]
fn closed_bottle_after_an_ambient_step_agrees_with_hyddown() {
    let trajectory = run(&closed_bottle(), &still(308.15, 288.15, 8.0, 6.0), 1e-8);
    assert_relative_eq!(trajectory.mass_kg[0], 4.462, epsilon = 5e-4);
    assert_relative_eq!(*trajectory.pressure_pa.last().unwrap(), 219.71e5, epsilon = 0.05e5);
    let target = 288.15 + (1.0 - (-1.0_f64).exp()) * 20.0;
    let k = trajectory.gas_mean_k.iter().position(|&t| t >= target).unwrap();
    let (a, b) = (trajectory.gas_mean_k[k - 1], trajectory.gas_mean_k[k]);
    let t63 = trajectory.time_s[k - 1] + (target - a) / (b - a) * 60.0;
    println!("t63 = {t63:.0} s");
    assert_relative_eq!(t63, 3942.0, max_relative = 0.01);
}

/// Reference: CoolProp 8.0 (project facts): a tight cylinder of 200 bar at 15 °C reads 160.09 bar at -25 °C.
#[test]
fn tight_full_cylinder_at_minus_25_degc_reads_160_bar() {
    let trajectory = run(&closed_bottle(), &still(248.15, 248.15, 10.0, 1.0), 1e-8);
    for &p in &trajectory.pressure_pa {
        assert_relative_eq!(p, 160.09e5, epsilon = 0.02e5);
    }
}

#[test]
fn wall_without_gas_contact_cools_exponentially() {
    let vessel = insulated(Fluid::named("nitrogen").unwrap());
    let trajectory = run(&vessel, &still(253.15, 293.15, 12.0, 4.0), 1e-9);
    let (d, l) = (0.1907 + 2.0 * 0.0067_f64, 0.70 + 2.0 * 0.0067_f64);
    let area = std::f64::consts::PI * d * (l + 0.5 * d);
    let solid = 0.25 * std::f64::consts::PI * (d * d * l - 0.1907_f64.powi(2) * 0.70);
    let capacity = solid * 7850.0 * 470.0;
    // Half the wall is in series with the film: 0.0067/2/45 m²K/W over the mean area, 0.06 % of 1/12.
    for (t, wall) in trajectory.time_s.iter().zip(&trajectory.wall_mean_k) {
        let ideal = 253.15 + 40.0 * (-12.0 * area * t / capacity).exp();
        assert_relative_eq!(*wall, ideal, epsilon = 40.0 * 1e-3);
    }
}

/// Choked adiabatic blowdown of an ideal monatomic gas: `T/T_0 = (1 + (g-1)/2 B t)^-2` with
/// `B = Cd A / V sqrt(g R T_0) (2/(g+1))^((g+1)/(2(g-1)))`.
#[test]
fn adiabatic_blowdown_of_ideal_argon_follows_the_closed_form() {
    let fluid = Fluid::named("argon").unwrap().with_equation(Equation::IdealGas);
    let r = fluid.specific_gas_constant_j_kg_k();
    let vessel = insulated(fluid);
    let mut scenario = still(288.15, 288.15, 1e-9, 25.0 / 3600.0);
    scenario.sample_time_s = 1.0;
    scenario.initial.fill = Fill::Pressure { pressure_pa: 150e5 };
    scenario.flows.push(Flow::open(
        "nozzle",
        FlowKind::Orifice { diameter_m: 0.004, discharge_coefficient: 0.8, back_pressure_pa: 1e5 },
    ));
    let trajectory = run(&vessel, &scenario, 1e-9);
    let g: f64 = 5.0 / 3.0;
    let area = 0.25 * std::f64::consts::PI * 0.004_f64.powi(2) * 0.8;
    let b = area / vessel.volume.volume_m3
        * (g * r * 288.15).sqrt()
        * (2.0 / (g + 1.0)).powf((g + 1.0) / (2.0 * (g - 1.0)));
    for (t, gas) in trajectory.time_s.iter().zip(&trajectory.gas_mean_k) {
        let base = 1.0 + 0.5 * (g - 1.0) * b * t;
        assert_relative_eq!(*gas, 288.15 * base.powi(-2), max_relative = 1e-6);
    }
}

#[test]
fn pressure_limit_is_reported_when_the_cylinder_cools_through_it() {
    let mut scenario = still(248.15 - 10.0, 288.15, 20.0, 6.0);
    scenario.pressure_limits_pa.push(160e5);
    let trajectory = run(&closed_bottle(), &scenario, 1e-6);
    assert_eq!(trajectory.events.len(), 1);
    let event = &trajectory.events[0];
    assert_eq!(event.kind, EventKind::PressureLimit { limit_pa: 160e5, falling: true });
    assert_relative_eq!(event.pressure_pa, 160e5, epsilon = 1.0);
    assert_relative_eq!(event.gas_mean_k, 248.0, epsilon = 0.2);
}

#[test]
fn leak_stops_at_its_pressure_and_takes_what_it_should() {
    let mut scenario = still(288.15, 288.15, 20.0, 10.0);
    scenario.flows.push(Flow {
        name: "leak".into(),
        kind: FlowKind::Leak { mass_flow_kg_s: 1e-4 },
        start_s: 1800.0,
        stop_s: f64::INFINITY,
        opens_above_pa: None,
        closes_below_pa: Some(190e5),
        closes_above_pa: None,
    });
    let trajectory = run(&closed_bottle(), &scenario, 1e-8);
    let kinds: Vec<_> = trajectory.events.iter().map(|e| e.kind.clone()).collect();
    assert_eq!(
        kinds,
        [EventKind::FlowOpened { flow: "leak".into() }, EventKind::FlowClosed { flow: "leak".into() }]
    );
    assert_relative_eq!(trajectory.events[0].time_s, 1800.0, epsilon = 1e-9);
    assert_relative_eq!(trajectory.events[1].pressure_pa, 190e5, epsilon = 10.0);
    let lost = trajectory.mass_kg[0] - trajectory.mass_kg.last().unwrap();
    assert_relative_eq!(lost, 1e-4 * (trajectory.events[1].time_s - 1800.0), max_relative = 1e-7);
}

/// A 30 s, 40 K pulse in a quiet run: a solver that steps over it would miss 0.6 K.
#[test]
fn short_pulse_is_not_missed() {
    let mut scenario = still(288.15, 288.15, 20.0, 8.0);
    scenario.surroundings.air_k = Series::try_new(
        vec![0.0, 14_000.0, 14_000.0, 14_030.0, 14_030.0],
        vec![288.15, 288.15, 328.15, 328.15, 288.15],
    )
    .unwrap();
    let pulsed = run(&closed_bottle(), &scenario, 1e-6);
    let highest = pulsed.wall_mean_k.iter().copied().fold(0.0, f64::max);
    // 0.523 m² x 20 W/m²K x 40 K x 30 s over 12.35 kJ/K, less what the gas has taken up by the next sample.
    assert_relative_eq!(highest - 288.15, 0.523 * 20.0 * 40.0 * 30.0 / 12_350.0, max_relative = 0.1);
    let at_jump = pulsed.time_s.iter().position(|&t| t == 14_040.0).unwrap();
    assert!(pulsed.wall_mean_k[at_jump] > 288.8, "dense output after the jump");
}

/// Cold gas that condenses while the wall cools: the run ends with the time and the two phases, not with a number.
#[test]
fn run_into_two_phases_is_an_error_with_its_time() {
    let mut scenario = still(95.0, 150.0, 20.0, 6.0);
    scenario.initial.fill = Fill::Pressure { pressure_pa: 30e5 };
    let error =
        simulate(&closed_bottle(), &scenario, &SimulationSettings::default(), &mut |_| {}).unwrap_err();
    let ThermalError::AtTime { time_s, cause } = &error else { panic!("{error}") };
    assert!(*time_s > 600.0, "{error}");
    assert!(matches!(**cause, ThermalError::TwoPhase { .. } | ThermalError::NearCritical { .. }), "{error}");
    assert!(error.to_string().contains("two-phase"), "{error}");
}

/// Ideal monatomic gas filled adiabatically from a source of temperature T_s: `m cv T = m_0 cv T_0 + (m - m_0) cp T_s`.
#[test]
fn adiabatic_refill_of_an_ideal_gas_heats_by_its_flow_work_and_stops_at_its_pressure() {
    let vessel = insulated(Fluid::named("argon").unwrap().with_equation(Equation::IdealGas));
    let mut scenario = still(288.15, 288.15, 1e-9, 0.5);
    scenario.initial.fill = Fill::Pressure { pressure_pa: 50e5 };
    scenario.flows.push(Flow {
        name: "refill".into(),
        kind: FlowKind::Refill {
            mass_flow_kg_s: 5e-3,
            source_temperature_k: 300.0,
            source_pressure_pa: 250e5,
            inlet_diameter_m: None,
        },
        start_s: 100.0,
        stop_s: f64::INFINITY,
        opens_above_pa: None,
        closes_below_pa: None,
        closes_above_pa: Some(180e5),
    });
    let trajectory = run(&vessel, &scenario, 1e-9);
    let closed = trajectory.events.last().unwrap();
    assert_eq!(closed.kind, EventKind::FlowClosed { flow: "refill".into() });
    assert_relative_eq!(closed.pressure_pa, 180e5, epsilon = 10.0);
    let (m0, m) = (trajectory.mass_kg[0], *trajectory.mass_kg.last().unwrap());
    let expected = (m0 * 288.15 + (m - m0) * 5.0 / 3.0 * 300.0) / m;
    assert_relative_eq!(*trajectory.gas_mean_k.last().unwrap(), expected, max_relative = 1e-7);
    assert_relative_eq!(m - m0, 5e-3 * (closed.time_s - 100.0), max_relative = 1e-8);
    assert!(trajectory.ledger.energy_residual().abs() < 1e-12);
}

/// A relief device opens when the warming gas reaches its pressure and reseats below.
#[test]
fn relief_opens_at_its_pressure_and_closes_below_it() {
    let mut scenario = still(340.0, 288.15, 20.0, 3.0);
    scenario.flows.push(Flow {
        name: "relief".into(),
        kind: FlowKind::Orifice {
            diameter_m: 0.001,
            discharge_coefficient: 0.8,
            back_pressure_pa: 101_325.0,
        },
        start_s: 0.0,
        stop_s: f64::INFINITY,
        opens_above_pa: Some(230e5),
        closes_below_pa: Some(200e5),
        closes_above_pa: None,
    });
    let trajectory = run(&closed_bottle(), &scenario, 1e-7);
    let opened = &trajectory.events[0];
    assert_eq!(opened.kind, EventKind::FlowOpened { flow: "relief".into() });
    assert_relative_eq!(opened.pressure_pa, 230e5, epsilon = 10.0);
    let closed = &trajectory.events[1];
    assert_eq!(closed.kind, EventKind::FlowClosed { flow: "relief".into() });
    assert_relative_eq!(closed.pressure_pa, 200e5, epsilon = 10.0);
    assert!(trajectory.pressure_pa.iter().all(|&p| p <= 230.01e5));
}

/// Sun on the whole of an insulated bottle: it takes up `absorptivity * irradiance * outer area / pi`.
#[test]
fn sun_warms_by_the_projected_area() {
    let mut vessel = insulated(Fluid::named("nitrogen").unwrap());
    vessel.surface.solar_absorptivity = 0.6;
    let mut scenario = still(288.15, 288.15, 1e-9, 1.0);
    scenario.surroundings.sun = Some(Sun {
        irradiance_w_m2: Series::constant(800.0),
        from_fraction: 0.0,
        to_fraction: 1.0,
        valve: false,
    });
    let trajectory = run(&vessel, &scenario, 1e-9);
    let (d, l) = (0.1907 + 2.0 * 0.0067_f64, 0.70 + 2.0 * 0.0067_f64);
    let area = std::f64::consts::PI * d * (l + 0.5 * d);
    let heat = 0.6 * 800.0 * area / std::f64::consts::PI * 3600.0;
    assert_relative_eq!(trajectory.ledger.heat_in_j, heat, max_relative = 1e-6);
}

/// In wind and radiation the bottle comes to rest between air and surroundings, where both heat flows cancel.
#[test]
fn bottle_at_rest_balances_wind_against_radiation() {
    let mut vessel = closed_bottle();
    vessel.surface.emissivity = 0.9;
    let mut scenario = still(288.15, 288.15, 8.0, 12.0);
    scenario.surroundings.film = OutsideFilm::Convection { wind_m_s: Series::constant(3.0), multiplier: 1.0 };
    scenario.surroundings.radiation_k = Some(Series::constant(258.15));
    let trajectory = run(&vessel, &scenario, 1e-8);
    let wall = *trajectory.wall_mean_k.last().unwrap();
    // Film near 15 W/m²K (Churchill-Bernstein at 3 m/s), radiation 0.9 sigma (T⁴ - 258⁴).
    let radiated = 0.9 * 5.670_374e-8 * (wall.powi(4) - 258.15_f64.powi(4));
    let film = radiated / (288.15 - wall);
    assert!((13.0..18.0).contains(&film), "film {film} W/m²K at {wall} K");
    let last = trajectory.heat_to_gas_w.last().unwrap();
    assert!(last.abs() < 0.05, "still {last} W to the gas");
}

/// Gas that the wall cannot heat, in a vessel that grows with its wall's temperature: the gas works on it along its isentrope,
/// `T V^(g-1)` constant, and the ledger books `p dV`.
#[test]
fn gas_cools_by_the_work_on_its_growing_vessel() {
    let mut vessel = insulated(Fluid::named("argon").unwrap().with_equation(Equation::IdealGas));
    vessel.volume.thermal_expansion_per_k = 1e-3;
    vessel.volume.reference_temperature_k = 288.15;
    let mut scenario = still(338.15, 288.15, 50.0, 6.0);
    scenario.initial.fill = Fill::Pressure { pressure_pa: 100e5 };
    let trajectory = run(&vessel, &scenario, 1e-9);
    let last = trajectory.time_s.len() - 1;
    let growth = 1.0 + 1e-3 * (trajectory.wall_mean_k[last] - 288.15);
    assert!(growth > 1.049);
    assert_relative_eq!(trajectory.gas_mean_k[last], 288.15 * growth.powf(-2.0 / 3.0), max_relative = 1e-6);
    assert_relative_eq!(trajectory.pressure_pa[last], 100e5 * growth.powf(-5.0 / 3.0), max_relative = 1e-6);
    let cooled = trajectory.mass_kg[0] * 1.5 * vessel.fluid.specific_gas_constant_j_kg_k();
    assert_relative_eq!(
        trajectory.ledger.work_out_j,
        cooled * (288.15 - trajectory.gas_mean_k[last]),
        max_relative = 1e-4
    );
}

/// Elastic by pressure too: at rest the volume is the one that belongs to the pressure it shows.
#[test]
fn elastic_cylinder_reads_less_than_a_rigid_one() {
    let rigid = closed_bottle();
    let mut elastic = rigid.clone();
    elastic.volume.thermal_expansion_per_k = 3.5e-5;
    elastic.volume.pressure_expansion_per_pa = 1.5e-10;
    let scenario = still(328.15, 288.15, 20.0, 12.0);
    let (a, b) = (run(&rigid, &scenario, 1e-8), run(&elastic, &scenario, 1e-8));
    let last = a.time_s.len() - 1;
    let density =
        b.vessel.fluid.density_from_pressure_temperature(b.pressure_pa[last], b.gas_mean_k[last]).unwrap();
    let volume = elastic.volume.volume_m3(b.wall_mean_k[last], b.pressure_pa[last]);
    assert_relative_eq!(density * volume, b.mass_kg[0], max_relative = 1e-9);
    let drop_bar = (a.pressure_pa[last] - b.pressure_pa[last]) / 1e5;
    // 40 K x 3.5e-5 + 40 bar x 1.5e-5/bar = 0.2 % of the volume, over a bulk modulus of about 280 bar.
    assert!((0.3..0.9).contains(&drop_bar), "{drop_bar} bar");
}

/// After hours of rest the steps are long; the samples in the first step after a jump must not come from them.
#[test]
fn dense_output_is_right_just_after_a_jump_with_every_method() {
    let mut scenario = still(288.15, 288.15, 40.0, 10.0);
    scenario.sample_time_s = 10.0;
    scenario.surroundings.air_k =
        Series::try_new(vec![0.0, 30_000.0, 30_000.0], vec![288.15, 288.15, 348.15]).unwrap();
    let with = |method, relative_tolerance| {
        let settings = SimulationSettings { method, relative_tolerance, ..SimulationSettings::default() };
        simulate(&closed_bottle(), &scenario, &settings, &mut |_| {}).unwrap()
    };
    let truth = with(Method::Bdf, 1e-10);
    for method in [Method::Bdf, Method::TrBdf2, Method::Esdirk34] {
        let run = with(method, 1e-4);
        let worst =
            run.wall_mean_k.iter().zip(&truth.wall_mean_k).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
        println!("{method:?}: largest error of the wall {worst:.3} K");
        assert!(worst < 0.3, "{method:?}: {worst} K");
    }
}
