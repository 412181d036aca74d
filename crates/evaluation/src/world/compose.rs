//! From a simulation to a world: rows, readings, truth, and what is laid over them.
use cylwatch_estimator::log::Log;
use cylwatch_estimator::sensor::SensorSuite;
use cylwatch_thermal::units::QUOTED_K;

use super::flows::{DISCHARGE, FAST_LOSS, LEAK, REFILL};
use super::reading::Scene;
use super::rows::Rows;
use super::sensors::{SensorDraw, seed_of_set};
use super::simulation::Simulated;
use super::truth::Truth;
use super::{
    Drawn, FaultRow, OperatorData, Overlay, Request, SimulationKey, SteadyLeak, World, WorldError,
    WorldEvent, WorldEventKind, cylinder_fault, data_fault,
};
use crate::random::Purpose;

impl Simulated {
    /// The world of a request over this simulation. The request may differ from that of [`Simulated::run`] in sensors, set, rows
    /// that need no other samples, a shorter length, slow leaks and faults of data.
    ///
    /// # Errors
    /// A request that needs another simulation.
    pub fn world(&self, request: &Request) -> Result<World, WorldError> {
        let seed = seed_of_set(request.seed, request.set);
        self.world_of(request, rows(request, seed))
    }

    /// The same with a row exactly every interval: for what is repeated, shifted or counted by rows.
    ///
    /// # Errors
    /// As [`Simulated::world`].
    pub fn world_of_even_rows(&self, request: &Request) -> Result<World, WorldError> {
        self.world_of(request, Rows::even(request.family.rows, request.length_s))
    }

    fn world_of(&self, request: &Request, rows: Rows) -> Result<World, WorldError> {
        request.validate()?;
        self.check(request)?;
        world(self, request, rows)
    }
}

/// The world of a request that fits a simulation.
fn world(simulated: &Simulated, request: &Request, rows: Rows) -> Result<World, WorldError> {
    let family = request.family;
    let seed = seed_of_set(request.seed, request.set);
    let leak = SteadyLeak::laid_over(simulated, request);
    let truth = truth(simulated, &rows.time_s, leak.as_ref())?;
    let sensors = SensorDraw::draw(family.sensors, simulated.nominal.full_scale_pa, seed);
    let log = readings(simulated, &sensors, &rows, &truth, seed);
    let spec = sensors.data_sheets(family.sensors);
    let suite: SensorSuite = spec.build()?;
    let events = events(simulated, request, &rows, leak.as_ref());
    let operator_data = OperatorData {
        vessel: simulated.nominal.vessel.clone(),
        sensors: suite.sensors().to_vec(),
        sensors_spec: spec,
        commissioning: simulated.drawn.fill.commissioning(),
        announced: announced(&events, &rows),
    };
    let world = World {
        request: *request,
        simulation: SimulationKey::of(request),
        operator_data,
        log,
        historical: Vec::new(),
        power_cycles: Vec::new(),
        fault: None,
        truth,
        events,
        drawn: Drawn { cylinder: simulated.drawn, sensors },
    };
    match request.overlay {
        Overlay::Fault { row, onset_s, .. } => {
            with_fault(world, simulated, &rows, leak.as_ref(), (row, onset_s), seed)
        }
        _ => Ok(world),
    }
}

/// Rows of a request: with a good clock and without gaps where a fault is judged by itself.
fn rows(request: &Request, seed: u64) -> Rows {
    let Overlay::Fault { row, onset_s, .. } = request.overlay else {
        return Rows::draw(request.family.rows, request.length_s, seed, false);
    };
    let mut rows = Rows::draw(request.family.rows, request.length_s, seed, true);
    if let Some(away_s) = cylinder_fault::away_s(row, request.seed) {
        rows.remove((onset_s, onset_s + away_s));
    }
    rows
}

/// The same world with a fault of the table in its rows, if it is one of data.
fn with_fault(
    mut world: World,
    simulated: &Simulated,
    rows: &Rows,
    leak: Option<&SteadyLeak>,
    (row, onset_s): (FaultRow, f64),
    seed: u64,
) -> Result<World, WorldError> {
    let Some(fault) = data_fault::draw(row, world.drawn.sensors.pressure.full_scale_pa, seed) else {
        return Ok(world);
    };
    let faulty = data_fault::inject(&fault, &world.log, rows, &world.truth, onset_s, seed)?;
    world.truth = truth(simulated, &faulty.time_s, leak)?;
    (world.log, world.historical, world.power_cycles) = (faulty.log, faulty.historical, faulty.power_cycles);
    world.fault = Some(fault);
    Ok(world)
}

/// What really happened at times of the log, s.
pub(super) fn truth(
    simulated: &Simulated,
    time_s: &[f64],
    leak: Option<&SteadyLeak>,
) -> Result<Truth, WorldError> {
    let lead_s = simulated.drawn.fill.lead_s;
    let samples = &simulated.samples;
    let column = |values: &[f64]| time_s.iter().map(|t| samples.at(values, t + lead_s)).collect::<Vec<f64>>();
    let mut truth = Truth {
        time_s: time_s.to_vec(),
        gas_mean_k: column(&samples.gas_mean_k),
        mass_absolute_kg: column(&samples.mass_kg),
        pressure_pa: column(&samples.pressure_pa),
        outflow_kg_s: column(&samples.outflow_kg_s),
        air_k: time_s.iter().map(|t| simulated.surroundings.air_k.at(t + lead_s)).collect(),
        wall_mean_k: column(&samples.wall_mean_k),
        shoulder_k: column(&samples.shoulder_k),
        valve_k: column(&samples.valve_k),
        regime: simulated.regimes(time_s),
        ..Truth::default()
    };
    if let Some(leak) = leak {
        leak.apply(simulated, &mut truth);
    }
    let stated = 1.0 / simulated.drawn.vessel.volume;
    truth.mass_kg = truth.mass_absolute_kg.iter().map(|mass| mass * stated).collect();
    truth.outflow_kg_s.iter_mut().for_each(|flow| *flow *= stated);
    truth.settled_pa = settled(simulated, &truth.mass_absolute_kg);
    Ok(truth)
}

/// Pressures that masses have at 15 °C in the true vessel, Pa.
fn settled(simulated: &Simulated, mass_kg: &[f64]) -> Vec<f64> {
    let vessel = &simulated.vessel;
    let (mut before_kg, mut pressure_pa) = (f64::NAN, simulated.drawn.fill.pressure_pa);
    mass_kg
        .iter()
        .map(|&mass| {
            if mass != before_kg {
                // The volume gives way by 1e-5 per bar: two rounds leave less than 1 Pa.
                for _ in 0..3 {
                    let volume_m3 = vessel.volume.volume_m3(QUOTED_K, pressure_pa);
                    pressure_pa = vessel.fluid.pressure_pa(mass / volume_m3, QUOTED_K);
                }
                before_kg = mass;
            }
            pressure_pa
        })
        .collect()
}

fn readings(simulated: &Simulated, sensors: &SensorDraw, rows: &Rows, truth: &Truth, seed: u64) -> Log {
    let scene = Scene {
        vessel: &simulated.vessel,
        surroundings: &simulated.surroundings,
        samples: &simulated.samples,
        seed,
        noise: [Purpose::WorldShoulderNoise, Purpose::WorldValveNoise, Purpose::WorldPressureNoise],
    };
    let times_s: Vec<f64> = rows.time_s.iter().map(|t| t + simulated.drawn.fill.lead_s).collect();
    scene.read(sensors, &times_s, rows.stamp_s.clone(), &truth.pressure_pa)
}

fn events(
    simulated: &Simulated,
    request: &Request,
    rows: &Rows,
    leak: Option<&SteadyLeak>,
) -> Vec<WorldEvent> {
    let mut all: Vec<WorldEvent> =
        rows.gaps_s.iter().map(|&gap| WorldEvent::of_rows(WorldEventKind::Gap, gap)).collect();
    all.extend(rows.clock.map(|(at_s, _)| WorldEvent::of_rows(WorldEventKind::ClockStep, (at_s, at_s))));
    all.extend(of_overlay(simulated, request, leak));
    all.sort_by(|a, b| a.start_s.total_cmp(&b.start_s));
    all
}

/// What the overlay does to the cylinder and its sensors.
fn of_overlay(simulated: &Simulated, request: &Request, slow: Option<&SteadyLeak>) -> Vec<WorldEvent> {
    let samples = &simulated.samples;
    let mass_kg = |t_s: f64| samples.at(&samples.mass_kg, t_s + simulated.drawn.fill.lead_s);
    let simulated_kg = mass_kg(0.0) - mass_kg(request.length_s);
    let event = |kind, start_s, flow: &str, lost_kg: f64| WorldEvent {
        kind,
        start_s,
        end_s: simulated.closed_s(flow),
        lost_kg: lost_kg / simulated.drawn.vessel.volume,
        announced: matches!(request.overlay, Overlay::Discharge { announced: true, .. }),
    };
    let leak = request.overlay.leak().map(|leak| {
        let lost_kg = match slow {
            Some(slow) => slow.lost_kg(request.length_s),
            None => simulated.lost_by_kg(&leak, request.length_s),
        };
        (lost_kg, event(WorldEventKind::Leak, leak.onset_s, LEAK, lost_kg))
    });
    let (kind, start_s, flow) = match request.overlay {
        Overlay::Nothing | Overlay::Leak { .. } => return leak.into_iter().map(|(_, leak)| leak).collect(),
        Overlay::FastLoss { onset_s, .. } => (WorldEventKind::FastLoss, onset_s, FAST_LOSS),
        Overlay::Discharge { onset_s, .. } => (WorldEventKind::Discharge, onset_s, DISCHARGE),
        Overlay::Refill { onset_s, .. } => (WorldEventKind::Refill, onset_s, REFILL),
        Overlay::Fault { row, onset_s, .. } => (WorldEventKind::Fault(row), onset_s, ""),
    };
    let beside_kg = if slow.is_some() { 0.0 } else { leak.as_ref().map_or(0.0, |(lost_kg, _)| *lost_kg) };
    let own = event(kind, start_s, flow, simulated_kg - beside_kg);
    std::iter::once(own).chain(leak.map(|(_, leak)| leak)).collect()
}

/// Announced discharges by the clock of the log, s.
fn announced(events: &[WorldEvent], rows: &Rows) -> Vec<(f64, f64)> {
    let announced = events.iter().filter(|event| event.announced);
    announced.map(|event| (rows.stamp(event.start_s), rows.stamp(event.end_s))).collect()
}
