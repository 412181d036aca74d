//! Simulations and what becomes of them: balances, repeatability, what sets share.
use super::{family, request};
use crate::world::{
    Climate, Family, GasKind, NominalVessel, Overlay, Request, SensorClass, Simulated, VesselKind, World,
    WorldError, generate,
};
use cylwatch_thermal::units::DAY_S;

fn bits(world: &World) -> Vec<u64> {
    let truth = &world.truth;
    let columns =
        [&world.log.time_s, &world.log.values, &truth.gas_mean_k, &truth.mass_kg, &truth.settled_pa];
    columns.iter().flat_map(|column| column.iter().map(|value| value.to_bits())).collect()
}

#[test]
fn a_request_gives_one_world_and_another_seed_or_set_another() {
    let request = request("argon-50l/switching/mixed/lagging/60s", 4, 1.0);
    let world = generate(&request).unwrap();
    assert_eq!(bits(&world), bits(&generate(&request).unwrap()));
    assert_ne!(bits(&world), bits(&generate(&Request { seed: 5, ..request }).unwrap()));
    let simulated = Simulated::run(&request).unwrap();
    let other = simulated.world(&Request { set: 1, ..request }).unwrap();
    assert_eq!(bits(&world), bits(&simulated.world(&request).unwrap()));
    assert_eq!(other.simulation, world.simulation);
    assert_ne!(other.drawn.sensors, world.drawn.sensors);
    assert_eq!(other.drawn.cylinder, world.drawn.cylinder);
    assert_ne!(other.log.values[..30], world.log.values[..30]);
}

#[test]
fn worlds_around_an_own_vessel_are_those_of_the_kind_that_it_was_taken_from() {
    let loss = Overlay::FastLoss { part: 0.1, within_s: 60.0, onset_s: 3600.0, goes_on: false };
    let request = request("helium-10l/switching/mixed/transmitter/60s", 4, 0.5).with(loss);
    let nominal = VesselKind::Helium10.nominal().unwrap();
    let own = NominalVessel { fill_pa: nominal.fill_pa, ..NominalVessel::own(nominal.vessel, 200e5) };
    // The kind of the request is only a name.
    let named = Request { family: Family { vessel: VesselKind::AirTank8, ..request.family }, ..request };
    let around = Simulated::around(own, &named).unwrap().world(&named).unwrap();
    assert_eq!(bits(&around), bits(&generate(&request).unwrap()));
    assert_ne!(bits(&around), bits(&generate(&named).unwrap()));
}

#[test]
fn an_own_vessel_is_filled_to_nine_tenths_and_more_of_what_is_stated() {
    let vessel = VesselKind::AirTank8.nominal().unwrap().vessel;
    let nominal = NominalVessel::own(vessel, 8e5);
    assert_eq!(nominal.full_scale_pa, 10e5);
    for seed in 0..20 {
        let request = request("nitrogen-20l/workshop/mixed/class-b/300s", seed, 0.02);
        let simulated = Simulated::around(nominal.clone(), &request).unwrap();
        let pressure_pa = simulated.drawn().fill.pressure_pa;
        assert!((7.2e5..=8e5).contains(&pressure_pa), "{pressure_pa}");
        assert_eq!(simulated.world(&request).unwrap().drawn.sensors.pressure.full_scale_pa, 10e5);
    }
}

/// All but the last samples, whose interval of the solver ends elsewhere.
#[test]
fn a_longer_log_begins_like_a_shorter_one() {
    for climate in Climate::ALL {
        let family = Family { climate: *climate, ..family("nitrogen-20l/railway/mixed/class-b/300s") };
        let of = |days: f64| generate(&Request::tight(family, 9, days * DAY_S)).unwrap();
        let (short, long) = (of(1.5), of(3.0));
        let rows = short.log.time_s.len() - 3;
        assert_eq!(short.log.time_s[..rows], long.log.time_s[..rows], "{climate}");
        assert_eq!(short.log.values[..3 * rows], long.log.values[..3 * rows], "{climate}");
        assert_eq!(short.truth.mass_kg[..rows], long.truth.mass_kg[..rows], "{climate}");
        assert_eq!(short.truth.regime[..rows], long.truth.regime[..rows], "{climate}");
    }
}

#[test]
fn mass_and_energy_are_balanced_in_every_vessel_and_a_tight_one_keeps_its_gas() {
    for &vessel in VesselKind::ALL {
        let request =
            Request::tight(Family { vessel, ..family("nitrogen-20l/switching/mixed/class-b/60s") }, 2, DAY_S);
        let simulated = Simulated::run(&request).unwrap();
        let ledger = simulated.ledger();
        assert!(ledger.mass_residual().abs() < 1e-9, "{vessel}: mass {}", ledger.mass_residual());
        assert!(ledger.energy_residual().abs() < 1e-4, "{vessel}: energy {}", ledger.energy_residual());
        let world = simulated.world(&request).unwrap();
        let (first, last) = (world.truth.mass_kg[0], world.truth.mass_kg[world.truth.mass_kg.len() - 1]);
        assert!((last / first - 1.0).abs() < 1e-9, "{vessel}: {first} kg, {last} kg");
        assert!(world.events.is_empty());
    }
}

#[test]
fn every_gas_kind_is_balanced_in_every_vessel() {
    for &vessel in VesselKind::ALL {
        for &gas in GasKind::ALL {
            let family = Family { vessel, gas, ..family("nitrogen-20l/switching/mixed/class-b/60s") };
            let simulated = Simulated::run(&Request::tight(family, 3, 6.0 * 3600.0)).unwrap();
            let energy = simulated.ledger().energy_residual();
            assert!(energy.abs() < 1e-4, "{family}: energy {energy}");
        }
    }
}

/// The mass in the stated volume is what readings show; the pressure at 15 °C is that of the fill.
#[test]
fn a_tight_cylinder_has_the_stated_mass_times_the_error_of_the_statement_and_the_pressure_of_its_fill() {
    for &vessel in VesselKind::ALL {
        let family = Family { vessel, ..family("nitrogen-20l/workshop/mixed/class-b/300s") };
        let world = generate(&Request::tight(family, 6, 3.0 * 3600.0)).unwrap();
        let drawn = &world.drawn.cylinder;
        let absolute = world.truth.mass_absolute_kg[0];
        assert!((world.truth.mass_kg[0] * drawn.vessel.volume / absolute - 1.0).abs() < 1e-12);
        for settled_pa in &world.truth.settled_pa {
            assert!((settled_pa / drawn.fill.pressure_pa - 1.0).abs() < 1e-6, "{vessel}: {settled_pa}");
        }
        let density =
            |pa: f64| world.operator_data.vessel.fluid.density_from_pressure_temperature(pa, 288.15).unwrap();
        let told_kg = world.operator_data.commissioning.mass_kg(&world.operator_data.vessel, 288.15).unwrap();
        let statement = density(drawn.fill.stated_pa) / density(drawn.fill.pressure_pa);
        // Expansions of the real vessel are within 10 % of the nominal ones, which are 1 % at most.
        assert!((told_kg / world.truth.mass_kg[0] / statement - 1.0).abs() < 2e-3, "{vessel}");
    }
}

/// Resolutions of the gas and the wall are alike where heat has time, and differ where it moves.
#[test]
fn gas_kinds_agree_in_a_workshop_and_differ_at_the_mouths_of_tunnels() {
    let gas_k = |climate: Climate, gas: GasKind| {
        let family = Family { climate, gas, ..family("nitrogen-20l/railway/mixed/class-b/60s") };
        generate(&Request::tight(family, 12, DAY_S)).unwrap().truth.gas_mean_k
    };
    for gas in [GasKind::Stratified, GasKind::FullMesh] {
        let largest_k = |climate: Climate| {
            let (mixed, other) = (gas_k(climate, GasKind::Mixed), gas_k(climate, gas));
            mixed.iter().zip(other).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max)
        };
        let (calm_k, mouths_k) = (largest_k(Climate::Workshop), largest_k(Climate::Switching));
        assert!(calm_k < 0.1, "{gas}: {calm_k} K in a workshop");
        assert!(mouths_k > 2.0 * calm_k && mouths_k < 5.0, "{gas}: {mouths_k} K at mouths");
    }
}

#[test]
fn a_request_that_needs_another_simulation_is_refused() {
    let simulated = Simulated::run(&request("nitrogen-20l/workshop/mixed/class-b/60s", 1, 1.0)).unwrap();
    let like = |change: fn(&mut Request)| {
        let mut other = request("nitrogen-20l/workshop/mixed/class-b/60s", 1, 1.0);
        change(&mut other);
        simulated.world(&other)
    };
    let loss = Overlay::FastLoss { part: 0.1, within_s: 60.0, onset_s: 0.0, goes_on: false };
    let refused: [fn(&mut Request); 3] =
        [|other| other.seed = 2, |other| other.length_s *= 2.0, |other| other.family.gas = GasKind::FullMesh];
    for change in refused {
        assert!(matches!(like(change), Err(WorldError::OtherSimulation { .. })));
    }
    let with_loss = request("nitrogen-20l/workshop/mixed/class-b/60s", 1, 1.0).with(loss);
    assert!(matches!(simulated.world(&with_loss), Err(WorldError::OtherSimulation { .. })));
    let finer = request("nitrogen-20l/workshop/mixed/class-b/10s", 1, 1.0);
    assert!(matches!(simulated.world(&finer), Err(WorldError::OtherSimulation { .. })));
    assert!(like(|other| other.family.sensors = SensorClass::Coarse).is_ok());
    assert!(like(|other| other.length_s /= 2.0).is_ok());
}

#[test]
fn numbers_out_of_range_are_refused_by_name() {
    let good = request("nitrogen-20l/workshop/mixed/class-b/60s", 1, 1.0);
    let error = |request: Request| generate(&request).unwrap_err().to_string();
    assert!(error(Request { length_s: 60.0, ..good }).contains("length_s"));
    assert!(error(Request { length_s: f64::NAN, ..good }).contains("length_s"));
    assert!(error(good.with(Overlay::Leak { part_per_h: -1.0, onset_s: 0.0 })).contains("part_per_h"));
    assert!(error(good.with(Overlay::Leak { part_per_h: 1e-3, onset_s: -1.0 })).contains("onset_s"));
    let loss = |part| Overlay::FastLoss { part, within_s: 60.0, onset_s: 0.0, goes_on: false };
    assert!(error(good.with(loss(1.5))).contains("part"));
    let second =
        Request { length_s: 60.0 * DAY_S, ..request("nitrogen-20l/workshop/mixed/class-b/1s", 1, 1.0) };
    assert!(error(second).contains("samples"), "too many rows");
}
