//! Leaks, losses, refills and faults over a world.
use super::{family, request};
use crate::fault::Fault;
use crate::world::{
    Family, FaultRow, Leak, Overlay, Request, Simulated, SteadyLeak, VesselKind, World, WorldEventKind,
    compose, data_fault, generate,
};
use cylwatch_thermal::units::DAY_S;
use cylwatch_thermal::units::HOUR_S;

/// The largest leak that is laid over, against its own simulation.
#[test]
fn a_slow_leak_laid_over_is_that_of_a_full_simulation_within_the_noise_of_a_transmitter() {
    for &vessel in VesselKind::ALL {
        let family = Family { vessel, ..family("nitrogen-20l/switching/mixed/class-b/60s") };
        let tight = Request::tight(family, 7, 2.0 * DAY_S);
        // Just above what is laid over: simulated.
        let leak = Overlay::Leak { part_per_h: 1.001e-4, onset_s: 6.0 * HOUR_S };
        assert!(leak.is_simulated(tight.length_s));
        let full = generate(&tight.with(leak)).unwrap().truth;
        let simulated = Simulated::run(&tight).unwrap();
        let rate_kg_s = 1.001e-4 * simulated.samples.mass_kg[0] / HOUR_S;
        let slow = SteadyLeak { rate_kg_s, onset_s: 6.0 * HOUR_S };
        let over = compose::truth(&simulated, &full.time_s, Some(&slow)).unwrap();
        let noise_pa = 4e-5 * vessel.nominal().unwrap().full_scale_pa;
        for (over, full) in over.mass_kg.iter().zip(&full.mass_kg) {
            assert!((over / full - 1.0).abs() < 1e-6, "{vessel}: {over} kg, {full} kg");
        }
        // Two runs of the solver differ by its tolerance: seen by a loss that is none.
        let nothing = Overlay::FastLoss { part: 1e-6, within_s: 1.0, onset_s: 6.0 * HOUR_S, goes_on: false };
        let other = generate(&tight.with(nothing)).unwrap().truth;
        let clean = compose::truth(&simulated, &full.time_s, None).unwrap();
        let (off_pa, floor_pa) =
            (rms(&over.pressure_pa, &full.pressure_pa), rms(&clean.pressure_pa, &other.pressure_pa));
        let own_pa = (off_pa.powi(2) - floor_pa.powi(2)).max(0.0).sqrt();
        assert!(own_pa < noise_pa, "{vessel}: {own_pa} Pa, {floor_pa} Pa by the solver, noise {noise_pa} Pa");
    }
}

fn rms(a: &[f64], b: &[f64]) -> f64 {
    (a.iter().zip(b).map(|(a, b)| (a - b).powi(2)).sum::<f64>() / a.len() as f64).sqrt()
}

#[test]
fn a_leak_loses_its_rate_times_its_time_however_it_is_made() {
    for part_per_h in [1e-4, 1e-2] {
        let leak = Overlay::Leak { part_per_h, onset_s: 2.0 * HOUR_S };
        let world = generate(&request("helium-10l/workshop/mixed/class-b/60s", 3, 0.5).with(leak)).unwrap();
        let truth = &world.truth;
        let lost_kg = part_per_h * 10.0 * truth.mass_kg[0];
        let found_kg = truth.mass_kg[0] - truth.mass_kg[truth.mass_kg.len() - 1];
        assert!((found_kg / lost_kg - 1.0).abs() < 1e-3, "{found_kg} kg, {lost_kg} kg");
        let [event] = &world.events[..] else { panic!("one event") };
        assert_eq!(event.kind, WorldEventKind::Leak);
        assert!((event.lost_kg / lost_kg - 1.0).abs() < 1e-3);
        let rate = truth.outflow_kg_s[truth.outflow_kg_s.len() - 1];
        assert!((rate / (part_per_h * truth.mass_kg[0] / HOUR_S) - 1.0).abs() < 1e-3);
        assert_eq!(truth.outflow_kg_s[0], 0.0);
    }
}

fn mass_at(world: &World, time_s: f64) -> f64 {
    let truth = &world.truth;
    truth.mass_kg[truth.time_s.partition_point(|&t| t < time_s).min(truth.time_s.len() - 1)]
}

/// Through an orifice the cooling gas takes a little longer; at a constant rate the part is exact.
#[test]
fn a_fast_loss_loses_its_part_within_its_time_in_every_vessel() {
    for &vessel in VesselKind::ALL {
        for seed in 1..=4 {
            for (part, within_s) in [(0.1, 60.0), (0.3, 900.0)] {
                let family = Family { vessel, ..family("nitrogen-20l/railway/mixed/class-b/1s") };
                let loss = Overlay::FastLoss { part, within_s, onset_s: 30.0, goes_on: false };
                let world = generate(&Request::tight(family, seed, 1800.0).with(loss)).unwrap();
                let before_kg = world.truth.mass_kg[0];
                let lost = 1.0 - mass_at(&world, 30.0 + within_s + 1.5) / before_kg;
                assert!((0.8 * part..1.02 * part).contains(&lost), "{vessel} {seed}: {lost} of {part}");
                let [event] = &world.events[..] else { panic!("one event") };
                assert_eq!(event.kind, WorldEventKind::FastLoss);
                assert!((event.end_s - 30.0 - within_s).abs() < 1e-6, "{vessel}: {}", event.end_s);
                assert!((event.lost_kg / before_kg - lost).abs() < 1e-3, "{vessel}");
            }
        }
    }
}

#[test]
fn a_loss_that_goes_on_ends_at_a_fifth_of_the_pressure() {
    for &vessel in VesselKind::ALL {
        let family = Family { vessel, ..family("nitrogen-20l/workshop/mixed/class-b/10s") };
        let loss = Overlay::FastLoss { part: 0.3, within_s: 600.0, onset_s: 0.0, goes_on: true };
        let world = generate(&Request::tight(family, 2, 6.0 * HOUR_S).with(loss)).unwrap();
        let end_s = world.events[0].end_s;
        assert!(end_s > 600.0 && end_s < 6.0 * HOUR_S, "{vessel}: {end_s} s");
        let at_end = world.truth.time_s.partition_point(|&t| t < end_s);
        let left = world.truth.pressure_pa[at_end] / world.drawn.cylinder.fill.pressure_pa;
        // The smallest pressure is that of a subsonic orifice's end: 1.5 atm for the tank.
        let least = (1.5 * 101_325.0 / world.drawn.cylinder.fill.pressure_pa).max(0.2);
        assert!((left - least).abs() < 0.03, "{vessel}: {left}");
        let (closed_kg, last_kg) = (mass_at(&world, end_s + 30.0), mass_at(&world, 5.9 * HOUR_S));
        assert!((closed_kg / last_kg - 1.0).abs() < 1e-6, "{vessel}: {closed_kg} kg, {last_kg} kg");
        let last_pa = world.truth.pressure_pa[world.truth.pressure_pa.len() - 1];
        assert!(last_pa > world.truth.pressure_pa[at_end], "{vessel}: the gas warms again");
    }
}

#[test]
fn a_refill_adds_its_part_and_a_discharge_is_told_only_if_it_is_announced() {
    let base = request("air-composite-7l/hall/mixed/class-b/10s", 5, 0.25);
    let refill = Overlay::Refill { part: 0.2, within_s: 300.0, onset_s: 3600.0 };
    let world = generate(&base.with(refill)).unwrap();
    assert!((mass_at(&world, 4000.0) / world.truth.mass_kg[0] - 1.2).abs() < 1e-6);
    assert!(world.events[0].lost_kg < 0.0);
    let warmest_k = world.truth.gas_mean_k.iter().copied().fold(0.0, f64::max);
    assert!(warmest_k > world.truth.gas_mean_k[0] + 3.0, "compressed gas is warm: {warmest_k}");
    for announced in [false, true] {
        let discharge = Overlay::Discharge { part: 0.3, within_s: 60.0, onset_s: 3600.0, announced };
        let world = generate(&base.with(discharge)).unwrap();
        assert_eq!(world.events[0].announced, announced);
        let told: Vec<(f64, f64)> = if announced { vec![(3600.0, 3660.0)] } else { Vec::new() };
        assert_eq!(world.operator_data.announced, told);
    }
}

fn with_fault(row: FaultRow, family: &str, seed: u64, days: f64) -> World {
    let fault = Overlay::Fault { row, onset_s: DAY_S, leak: None };
    generate(&request(family, seed, days).with(fault)).unwrap()
}

#[test]
fn every_row_of_the_fault_table_makes_a_world_whose_truth_has_an_entry_for_each_row() {
    for row in FaultRow::ALL {
        for family in ["nitrogen-20l/switching/mixed/class-b/300s", "air-tank-8l/hall/mixed/class-b/300s"] {
            let world = with_fault(row, family, 8, 3.0);
            let truth = &world.truth;
            let rows = world.log.time_s.len();
            assert_eq!(world.log.values.len(), 3 * rows);
            for column in
                [&truth.time_s, &truth.mass_kg, &truth.settled_pa, &truth.gas_mean_k, &truth.valve_k]
            {
                assert_eq!(column.len(), rows, "{row:?}");
                assert!(column.iter().all(|value| value.is_finite()), "{row:?}");
            }
            assert_eq!(truth.regime.len(), rows);
            assert_eq!(world.fault.is_some(), row.is_of_data(), "{row:?}");
            assert!(world.events.iter().any(|event| event.kind == WorldEventKind::Fault(row)));
        }
    }
}

/// Of those that have an onset.
#[test]
fn a_fault_of_data_leaves_the_rows_before_its_onset_and_the_cylinder_alone() {
    use FaultRow::{D1, D3, P1, P2, P3, P6, P7, T1, T2, T3, T4, T5, T7};
    let key = "argon-50l/railway/mixed/class-b/300s";
    for row in [P1, P2, P3, P6, P7, T1, T2, T3, T4, T5, T7, D1, D3] {
        let (world, clean) = (with_fault(row, key, 2, 3.0), with_fault(FaultRow::E2, key, 2, 3.0));
        let before = world.truth.time_s.partition_point(|&t| t < DAY_S);
        assert!(before > 250);
        assert_eq!(world.log.values[..3 * before], clean.log.values[..3 * before], "{row:?}");
        assert_eq!(world.log.time_s[..before], clean.log.time_s[..before], "{row:?}");
        let mass = |world: &World| world.truth.mass_kg[world.truth.mass_kg.len() - 1];
        assert!((mass(&world) / mass(&clean) - 1.0).abs() < 1e-9);
        let later = (before..world.log.time_s.len()).any(|index| {
            let row = world.log.row(index);
            let same = clean.truth.time_s.iter().position(|t| *t == world.truth.time_s[index]);
            same.is_none_or(|at| clean.log.row(at).iter().zip(row).any(|(a, b)| a.to_bits() != b.to_bits()))
        });
        let fewer = world.log.time_s.len() != clean.log.time_s.len();
        assert!(later || fewer, "{row:?} changes nothing");
    }
}

#[test]
fn pressures_of_the_fault_table_are_parts_of_the_transmitters_range() {
    for row in FaultRow::ALL.into_iter().filter(|row| row.is_of_data()) {
        for seed in 0..20 {
            let (table, tank) = (row.draw(seed).unwrap(), data_fault::draw(row, 10e5, seed).unwrap());
            let size = |fault: &Fault| match fault {
                Fault::Offset { sensor, by } if sensor == "pressure" => Some(*by),
                Fault::Drift { sensor, per_s } if sensor == "pressure" => Some(*per_s),
                Fault::Span { per_k, .. } => Some(*per_k),
                Fault::Noise { sd, .. } => Some(*sd),
                Fault::Quantised { step, .. } => Some(*step),
                Fault::Spikes { sensor, height, .. } if sensor == "pressure" => Some(*height),
                Fault::Dead { full_scale_pa, .. } => Some(*full_scale_pa),
                _ => None,
            };
            match (size(&table), size(&tank)) {
                (Some(of_table), Some(of_tank)) => {
                    assert!((of_tank / of_table - 0.04).abs() < 1e-12, "{row:?}")
                }
                _ if row == FaultRow::D4 => assert_eq!(table.name(), tank.name()),
                _ => assert_eq!(table, tank, "{row:?}"),
            }
        }
    }
}

#[test]
fn what_happens_to_the_gas_by_the_table_is_in_proportion_to_the_fill() {
    let lost = |row: FaultRow, family: &str, seed: u64| {
        let world = with_fault(row, family, seed, 4.0);
        let fault = world.events.iter().find(|h| h.kind == WorldEventKind::Fault(row)).unwrap();
        fault.lost_kg / world.truth.mass_kg[0]
    };
    for seed in 0..3 {
        for family in ["nitrogen-20l/workshop/mixed/class-b/300s", "air-tank-8l/workshop/mixed/class-b/300s"]
        {
            // From four fifths of the pressure to the whole.
            let refilled = -lost(FaultRow::G1, family, seed);
            assert!((0.2..0.27).contains(&refilled), "{family}: refilled {refilled}");
            // Three puffs of 0.25 to 1 % of the pressure.
            let puffed = lost(FaultRow::G3, family, seed);
            assert!((0.0055..0.032).contains(&puffed), "{family}: puffed {puffed}");
            let discharged = lost(FaultRow::G2, family, seed);
            assert!((0.02..0.95).contains(&discharged), "{family}: discharged {discharged}");
        }
    }
}

#[test]
fn a_leak_beside_a_fault_is_the_leak_alone() {
    let leak = Leak { part_per_h: 5e-4, onset_s: DAY_S };
    let base = request("nitrogen-20l/parked/mixed/class-b/300s", 3, 3.0);
    let alone = generate(&base.with(Overlay::Leak { part_per_h: 5e-4, onset_s: DAY_S })).unwrap();
    for row in [FaultRow::T1, FaultRow::E6] {
        let both =
            generate(&base.with(Overlay::Fault { row, onset_s: 1.5 * DAY_S, leak: Some(leak) })).unwrap();
        let of =
            |world: &World| world.events.iter().find(|h| h.kind == WorldEventKind::Leak).unwrap().lost_kg;
        assert!((of(&both) / of(&alone) - 1.0).abs() < 1e-6, "{row:?}");
        let last = |world: &World| world.truth.mass_kg[world.truth.mass_kg.len() - 1];
        assert!((last(&both) / last(&alone) - 1.0).abs() < 1e-6, "{row:?}");
    }
}
