//! One simulation, that several sets of sensors, slow leaks and faults can be laid over.
use cylwatch_thermal::scenario::{Initial, Scenario, Surroundings};
use cylwatch_thermal::simulate::{SimulationSettings, simulate};
use cylwatch_thermal::trajectory::{Event, EventKind, Ledger, Trajectory};
use cylwatch_thermal::units::QUOTED_K;
use cylwatch_thermal::vessel::Vessel;
use serde::{Deserialize, Serialize};

use super::climate::{self, Span};
use super::cylinder_fault::{self, CylinderFault};
use super::fill::FillDraw;
use super::flows::{Filled, LEAK};
use super::gas::GasDraw;
use super::samples::Samples;
use super::vessel::VesselDraw;
use super::{
    Climate, Family, GasKind, Leak, NominalVessel, Overlay, Request, RowPattern, VesselKind, WorldError,
};

/// Shortest and longest log, s.
const LENGTH_S: (f64, f64) = (900.0, 400.0 * 86_400.0);
/// Spacing of the knots of turbulence and gusts, s, for rows of up to 10 s and for slower ones.
const FINE_SPACING_S: f64 = 60.0;
const COARSE_SPACING_S: f64 = 300.0;
/// Most samples of a simulation: some 2 GB while it runs.
const SAMPLES_MOST: f64 = 3e6;
/// Longest interval of the samples, s.
const SAMPLE_S: f64 = 60.0;

/// What decides the cylinder and its surroundings.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
pub struct SimulationKey {
    /// Vessel; around an own one only a name.
    pub vessel: VesselKind,
    /// Climate.
    pub climate: Climate,
    /// How the gas is resolved.
    pub gas: GasKind,
    /// Seed.
    pub seed: u64,
}

impl SimulationKey {
    /// That of a request.
    pub const fn of(request: &Request) -> Self {
        let Family { vessel, climate, gas, .. } = request.family;
        Self { vessel, climate, gas, seed: request.seed }
    }
}

/// What was drawn for a cylinder and its gas.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct CylinderDraw {
    /// Vessel.
    pub vessel: VesselDraw,
    /// Gas, where it is stacked.
    pub gas: GasDraw,
    /// Fill.
    pub fill: FillDraw,
}

impl CylinderDraw {
    fn draw(key: &SimulationKey, fill_pa: (f64, f64), overlay: &Overlay) -> Self {
        let fill = FillDraw::draw(fill_pa, key.seed);
        let is_low = matches!(overlay, Overlay::Fault { row, .. } if cylinder_fault::begins_low(*row));
        Self {
            vessel: VesselDraw::draw(key.seed),
            gas: GasDraw::draw(key.seed),
            fill: if is_low { fill.part(cylinder_fault::BEFORE_REFILL) } else { fill },
        }
    }
}

/// Simulate a drawn cylinder with what of an overlay is simulated.
fn simulate_with(
    key: &SimulationKey,
    (vessel, inlet_m): (&Vessel, f64),
    drawn: &CylinderDraw,
    mut scenario: Scenario,
    overlay: &Overlay,
) -> Result<Trajectory, WorldError> {
    let FillDraw { pressure_pa, lead_s, .. } = drawn.fill;
    let density = vessel.fluid.density_from_pressure_temperature(pressure_pa, QUOTED_K)?;
    let mass_kg = density * vessel.volume.volume_m3(QUOTED_K, pressure_pa);
    let filled = Filled { inlet_m, vessel, seed: key.seed, pressure_pa, mass_kg, lead_s };
    scenario.flows = filled.flows(overlay)?;
    // Worlds of stratified gas only have to differ from the observer's.
    let settings = SimulationSettings {
        relative_tolerance: key.gas.tolerance(),
        fills_layers: true,
        ..SimulationSettings::default()
    };
    match *overlay {
        Overlay::Fault { row, onset_s, .. } => {
            let (seed, onset_s) = (key.seed, onset_s + lead_s);
            CylinderFault { row, inlet_m, vessel, seed, fill_pa: pressure_pa, onset_s }
                .simulate(scenario, &settings)
        }
        _ => Ok(simulate(vessel, &scenario, &settings, &mut |_| ())?),
    }
}

/// A drawn cylinder with every cell of its wall and its gas.
#[derive(Debug)]
pub(crate) struct Run {
    pub drawn: CylinderDraw,
    vessel: Vessel,
    jumps_s: Vec<f64>,
    heated_s: Vec<(f64, f64)>,
    calm_flow: f64,
    /// From the lead on, which is before the log.
    pub trajectory: Trajectory,
}

impl Run {
    /// The cylinder of a request around a vessel, with all of an overlay simulated.
    pub(crate) fn around(
        nominal: &NominalVessel,
        request: &Request,
        overlay: &Overlay,
    ) -> Result<Self, WorldError> {
        let key = SimulationKey::of(request);
        let drawn = CylinderDraw::draw(&key, nominal.fill_pa, overlay);
        let mut vessel = drawn.vessel.apply(&nominal.vessel);
        key.gas.resolve(&mut vessel, &drawn.gas);
        let (spacing_s, sample_s) = (spacing_s(request.family.rows), sample_s(request.family.rows));
        let span = Span::draw(key.seed, drawn.fill.lead_s, request.length_s, spacing_s);
        let (film, film_slope) = (drawn.vessel.outside_film, drawn.vessel.film_slope);
        let climate::Drawn { surroundings, jumps_s, heated_s, calm_flow } =
            climate::surroundings(key.climate, &span, film, film_slope)?;
        let scenario = scenario(&key, &span, &drawn.fill, surroundings, sample_s);
        let trajectory = simulate_with(&key, (&vessel, nominal.inlet_m), &drawn, scenario, overlay)?;
        Ok(Self { drawn, vessel, jumps_s, heated_s, calm_flow, trajectory })
    }
}

/// When flows closed, by their names, s from the start of the log.
fn closed_s(trajectory: &Trajectory, lead_s: f64) -> Vec<(String, f64)> {
    let closing = |event: &Event| match &event.kind {
        EventKind::FlowClosed { flow } => Some((flow.clone(), event.time_s - lead_s)),
        _ => None,
    };
    trajectory.events.iter().filter_map(closing).collect()
}

/// A simulated cylinder without sensors.
#[derive(Clone, Debug)]
pub struct Simulated {
    pub(super) key: SimulationKey,
    /// Length of the longest log, s.
    pub(super) length_s: f64,
    /// Spacing of the knots of the weather, s.
    pub(super) spacing_s: f64,
    /// What was simulated on top of the climate.
    pub(super) overlay: Overlay,
    pub(super) drawn: CylinderDraw,
    pub(super) nominal: NominalVessel,
    pub(super) vessel: Vessel,
    pub(super) surroundings: Surroundings,
    pub(super) jumps_s: Vec<f64>,
    pub(super) heated_s: Vec<(f64, f64)>,
    pub(super) calm_flow: f64,
    /// When flows closed, by their names, s from the start of the log.
    closed_s: Vec<(String, f64)>,
    pub(super) samples: Samples,
    ledger: Ledger,
}

impl Simulated {
    /// Simulate what a request needs: its cylinder, its surroundings, its fast flows.
    ///
    /// # Errors
    /// A request out of range, or a simulation that fails.
    pub fn run(request: &Request) -> Result<Self, WorldError> {
        Self::around(request.family.vessel.nominal()?, request)
    }

    /// The same around an own vessel: the request's kind of vessel is only a name, as in its worlds.
    ///
    /// # Errors
    /// As [`Simulated::run`].
    pub fn around(nominal: NominalVessel, request: &Request) -> Result<Self, WorldError> {
        request.validate()?;
        let overlay = request.overlay.simulated_part(request.length_s);
        let Run { drawn, vessel, jumps_s, heated_s, calm_flow, trajectory } =
            Run::around(&nominal, request, &overlay)?;
        let ledger = trajectory.ledger;
        Ok(Self {
            key: SimulationKey::of(request),
            length_s: request.length_s,
            spacing_s: spacing_s(request.family.rows),
            overlay,
            drawn,
            nominal,
            vessel,
            surroundings: trajectory.scenario.surroundings.clone(),
            closed_s: closed_s(&trajectory, drawn.fill.lead_s),
            jumps_s,
            heated_s,
            calm_flow,
            samples: Samples::of(trajectory, sample_s(request.family.rows)),
            ledger,
        })
    }

    /// Balance of mass and energy of the simulation.
    pub const fn ledger(&self) -> &Ledger {
        &self.ledger
    }

    /// What was drawn for the cylinder.
    pub const fn drawn(&self) -> &CylinderDraw {
        &self.drawn
    }

    /// When the overlay's own flow of a name closed, s from the start of the log; infinity: it did not.
    pub(super) fn closed_s(&self, flow: &str) -> f64 {
        self.closed_s.iter().find(|(name, _)| name == flow).map_or(f64::INFINITY, |(_, at_s)| *at_s)
    }

    /// Mass that a simulated leak loses until a time while it runs at its rate, kg.
    pub(super) fn lost_by_kg(&self, leak: &Leak, t_s: f64) -> f64 {
        let end_s = self.closed_s(LEAK).min(t_s);
        leak.part_per_h * self.samples.mass_kg[0] * (end_s - leak.onset_s).max(0.0) / 3600.0
    }

    /// Whether a request fits this simulation.
    pub(super) fn check(&self, request: &Request) -> Result<(), WorldError> {
        let same_overlay = request.overlay.simulated_part(request.length_s) == self.overlay;
        let is_same = SimulationKey::of(request) == self.key
            && same_overlay
            && request.length_s <= self.length_s
            && spacing_s(request.family.rows) == self.spacing_s
            && sample_s(request.family.rows) >= self.samples.interval_s;
        if is_same {
            return Ok(());
        }
        let text = |key: &SimulationKey, overlay: &Overlay, length_s: f64, spacing_s: f64| {
            let SimulationKey { vessel, climate, gas, seed } = key;
            format!(
                "{vessel}/{climate}/{gas}, seed {seed}, {length_s} s, knots every {spacing_s} s, {overlay:?}"
            )
        };
        let spacing = spacing_s(request.family.rows);
        Err(WorldError::OtherSimulation {
            simulated: text(&self.key, &self.overlay, self.length_s, self.spacing_s),
            needed: text(&SimulationKey::of(request), &request.overlay, request.length_s, spacing),
        })
    }
}

impl Request {
    /// Check the numbers.
    ///
    /// # Errors
    /// [`WorldError::Number`] with the first one outside its range.
    pub fn validate(&self) -> Result<(), WorldError> {
        let (low, high) = LENGTH_S;
        if !(low..=high).contains(&self.length_s) {
            return Err(WorldError::Number { what: "length_s", value: self.length_s, low, high });
        }
        let samples = self.length_s / sample_s(self.family.rows);
        if samples > SAMPLES_MOST {
            return Err(WorldError::Number {
                what: "number of samples",
                value: samples,
                low: 1.0,
                high: SAMPLES_MOST,
            });
        }
        self.overlay.validate()
    }
}

/// Spacing of the weather's knots for rows, s.
const fn spacing_s(rows: RowPattern) -> f64 {
    match rows {
        RowPattern::EverySecond | RowPattern::TenSeconds => FINE_SPACING_S,
        RowPattern::Minute | RowPattern::TwoMinutes | RowPattern::FiveMinutes => COARSE_SPACING_S,
    }
}

/// Interval of the samples for rows, s.
const fn sample_s(rows: RowPattern) -> f64 {
    rows.interval_s().min(SAMPLE_S)
}

fn scenario(
    key: &SimulationKey,
    span: &Span,
    fill: &FillDraw,
    surroundings: Surroundings,
    sample_s: f64,
) -> Scenario {
    let settled_k = surroundings.air_k.at(0.0);
    Scenario {
        name: format!("{}, seed {}", key.climate, key.seed),
        initial: Initial { fill: fill.fill(), wall_temperature_k: settled_k, gas_temperature_k: settled_k },
        surroundings,
        flows: Vec::new(),
        pressure_limits_pa: Vec::new(),
        sensors: Vec::new(),
        // A sample beyond the last row.
        duration_s: span.duration_s + sample_s,
        sample_time_s: sample_s,
    }
}
