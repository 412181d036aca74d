//! Drawn cylinders in a climatic chamber: the paper's scenarios and a tunnel, each after an hour of rest.
//!
//! A climate has its changes at drawn times; a published case has them at a stated one. So the paper's rebuild and the tests of the observer
//! have cylinders of the same kind here, with draws of their own that keep the published numbers:
//!
//! | drawn evenly around the nominal cylinder of 20 L | from, to |
//! |---|---|
//! | films inside and outside, heat capacity of the valve | 0.75, 1.3 |
//! | heat capacity of the wall; contact of the valve | 0.8, 1.25; 0.7, 1.3 |
//! | emissivity; expansions; change of the film along the axis | 0.6, 0.95; 0.9, 1.1; -0.3, 0.3 |
//! | exchange length of the stacked gas, inner diameters; mixing of its core | 0.7, 1.4; 0.02, 0.1 |
//! | offsets and couplings of the thermometers | -0.3, 0.3 K (class B at 0 °C); 0.05, 0.15 |
//! | offset and coefficient of the transmitter, either sign | 0.25, 0.625 bar; 0.0125, 0.0375 bar/K |
//!
//! The film is 16 W/(m² K) by the fan, the walls have the temperature of the air; noise is 0.05 K and 10 mbar. On top the air is
//! unrestful as in [a climate](super::Climate): 0.4 K, gusts of 10 %, 0.5 K from bottom to top.
//!
//! Source of the scenarios: Bücking, Pfaff, Dirksmeier, "Sensor positioning and thermal model for condition monitoring of pressure gas
//! reservoirs in vehicles".
use cylwatch_estimator::log::Log;
use cylwatch_thermal::ThermalError;
use cylwatch_thermal::scenario::{AxialVariation, Initial, OutsideFilm, Scenario, Series, Surroundings};
use cylwatch_thermal::simulate::{SimulationSettings, simulate};
use cylwatch_thermal::trajectory::Trajectory;
use cylwatch_thermal::units::{BAR_PA, HOUR_S, QUOTED_K, ZERO_CELSIUS_K};
use cylwatch_thermal::vessel::{Fill, GasResolution, Stratification, Vessel};

use super::climate::unrest::Unrest;
use super::reading::Scene;
use super::samples::Samples;
use super::{SensorDraw, SteadyLeak, Thermometer, Transmitter, VesselDraw, VesselKind};
use crate::random::{Purpose, Random};

const REST_S: f64 = HOUR_S;
const FILL_PA: f64 = 200.0 * BAR_PA;
const FULL_SCALE_PA: f64 = 250.0 * BAR_PA;
const FILM_W_M2_K: f64 = 16.0;
const UNREST: Unrest = Unrest { turbulence_k: 0.4, gust: 0.1, difference_k: 0.5 };
/// Spacing of the knots, s.
const SPACING_S: f64 = 120.0;
/// Knots of an exponential approach in time constants; the chords stay within 2.5 % of the step.
const APPROACH: [f64; 7] = [0.0, 0.5, 1.0, 1.75, 2.75, 4.0, 7.0];
const NOISE_K: f64 = 0.05;
const NOISE_PA: f64 = 1000.0;

/// Air of a chamber: an hour at rest, a change, and what follows it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Chamber {
    /// Air during the rest, °C.
    pub start_degc: f64,
    /// Air in the end, °C.
    pub end_degc: f64,
    /// Duration of the linear change, s; 0: at once.
    pub ramp_s: f64,
    /// Time constant of the change instead, s; 0: none.
    pub lag_s: f64,
    /// From the beginning of the change to the end, s.
    pub after_s: f64,
}

impl Chamber {
    /// Scenarios 1 to 4 of the paper.
    pub const SCENARIOS: [Self; 4] = [
        Self::jump(21.0, -25.0, 3.0),
        Self::jump(-25.0, 40.0, 3.45),
        Self { ramp_s: 5.0 * HOUR_S, ..Self::jump(10.0, 60.0, 5.0) },
        Self { ramp_s: 14.0 * HOUR_S, ..Self::jump(60.0, 28.0, 14.0) },
    ];

    /// From -10 into a tunnel of 35 °C, with a lag of 6 s.
    pub const TUNNEL: Self = Self { lag_s: 6.0, ..Self::jump(-10.0, 35.0, 3.0) };

    const fn jump(start_degc: f64, end_degc: f64, after_h: f64) -> Self {
        Self { start_degc, end_degc, ramp_s: 0.0, lag_s: 0.0, after_s: after_h * HOUR_S }
    }

    /// When the air begins to change, s.
    pub const fn change_s(&self) -> f64 {
        REST_S
    }

    /// Rest, change and what follows, s.
    pub const fn duration_s(&self) -> f64 {
        REST_S + self.after_s
    }

    /// Air at a time, K.
    pub fn air_k(&self, time_s: f64) -> f64 {
        let since_s = time_s - REST_S;
        let done = if since_s > 0.0 { self.done(since_s) } else { 0.0 };
        self.at_k(done)
    }

    /// Part of the change that is done a time after its beginning.
    fn done(&self, since_s: f64) -> f64 {
        if self.ramp_s > 0.0 {
            (since_s / self.ramp_s).min(1.0)
        } else if self.lag_s > 0.0 && since_s < APPROACH[APPROACH.len() - 1] * self.lag_s {
            1.0 - (-since_s / self.lag_s).exp()
        } else {
            1.0
        }
    }

    fn at_k(&self, done: f64) -> f64 {
        self.start_degc + ZERO_CELSIUS_K + done * (self.end_degc - self.start_degc)
    }

    /// Knots of the air until a time: time, s, and air, K; two at the beginning of a jump.
    fn knots(&self, until_s: f64) -> Vec<(f64, f64)> {
        let grid = |from_s: f64, to_s: f64| {
            let (first, last) =
                ((from_s / SPACING_S).floor() as usize + 1, (to_s / SPACING_S).ceil() as usize);
            std::iter::once(from_s)
                .chain((first..last).map(|knot| knot as f64 * SPACING_S))
                .chain(std::iter::once(to_s))
        };
        let mut after: Vec<f64> = grid(REST_S, until_s)
            .chain(APPROACH.map(|n| REST_S + n * self.lag_s))
            .chain([REST_S + self.ramp_s])
            .collect();
        after.sort_by(f64::total_cmp);
        after.dedup();
        let is_jump = self.ramp_s == 0.0 && self.lag_s == 0.0;
        grid(0.0, REST_S)
            .filter(|&t_s| is_jump || t_s < REST_S)
            .map(|t_s| (t_s, self.at_k(0.0)))
            .chain(after.into_iter().map(|t_s| (t_s, self.at_k(self.done(t_s - REST_S)))))
            .collect()
    }

    /// The surroundings of a cylinder of a seed until a time, s.
    fn surroundings(
        &self,
        seed: u64,
        drawn: &VesselDraw,
        until_s: f64,
    ) -> Result<Surroundings, ThermalError> {
        let streams = [Purpose::ChamberTurbulence, Purpose::ChamberGusts, Purpose::ChamberDifference];
        let unrest = UNREST.draw((seed, streams), SPACING_S, until_s);
        let knots = self.knots(until_s);
        let series = |value: &dyn Fn(f64, f64) -> f64| {
            let values = knots.iter().map(|&(t_s, air_k)| value(t_s, air_k)).collect();
            Series::try_new(knots.iter().map(|&(t_s, _)| t_s).collect(), values)
        };
        Ok(Surroundings {
            air_k: series(&|t_s, air_k| air_k + unrest.air_k(t_s))?,
            film: OutsideFilm::Coefficient {
                film_w_m2_k: series(&|t_s, _| FILM_W_M2_K * unrest.gust(t_s) * drawn.outside_film)?,
            },
            radiation_k: Some(series(&|_, air_k| air_k)?),
            sun: None,
            axial: AxialVariation {
                film_slope: drawn.film_slope,
                air_difference_k: Some(series(&|t_s, _| unrest.difference_k(t_s))?),
            },
        })
    }
}

/// Everything that decides a cylinder in a chamber.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ChamberRequest {
    /// The chamber.
    pub chamber: Chamber,
    /// Seed of everything that is drawn.
    pub seed: u64,
    /// Interval of samples and readings, s.
    pub sample_s: f64,
    /// Axial cells of the cylindrical part of the wall.
    pub wall_cells: usize,
    /// Stacked cells of the gas.
    pub gas_cells: usize,
    /// Relative tolerance of the simulation.
    pub relative_tolerance: f64,
    /// A leak, if any.
    pub leak: Option<SteadyLeak>,
}

impl ChamberRequest {
    /// A tight cylinder of six cells of the wall and ten of the gas.
    pub const fn new(chamber: Chamber, seed: u64, sample_s: f64) -> Self {
        Self { chamber, seed, sample_s, wall_cells: 6, gas_cells: 10, relative_tolerance: 1e-6, leak: None }
    }

    /// Simulate the cylinder and read it.
    ///
    /// # Errors
    /// The simulation's: a mesh or a leak that cannot be.
    pub fn run(&self) -> Result<ChamberRun, ThermalError> {
        let (vessel, drawn) = self.cylinder()?;
        let sensors = sensors(self.seed);
        let trajectory = self.simulate(&vessel, &drawn)?;
        let scene = Scene {
            vessel: &vessel,
            surroundings: &trajectory.scenario.surroundings,
            samples: &Samples::of(trajectory.clone(), self.sample_s),
            seed: self.seed,
            noise: [Purpose::ChamberShoulderNoise, Purpose::ChamberValveNoise, Purpose::ChamberPressureNoise],
        };
        let log =
            scene.read(&sensors, &trajectory.time_s, trajectory.time_s.clone(), &trajectory.pressure_pa);
        Ok(ChamberRun { request: *self, vessel: drawn, sensors, trajectory, log })
    }

    /// What is drawn for the cylinder and its sensors.
    #[cfg(test)]
    pub(super) fn drawn(&self) -> Result<(VesselDraw, SensorDraw), ThermalError> {
        Ok((self.cylinder()?.1, sensors(self.seed)))
    }

    /// The drawn cylinder and what was drawn for it.
    fn cylinder(&self) -> Result<(Vessel, VesselDraw), ThermalError> {
        let nominal = VesselKind::Nitrogen20.nominal()?.vessel;
        let random = &mut Random::new(self.seed, Purpose::ChamberVessel);
        let drawn = VesselDraw {
            volume: 1.0,
            absorptivity: nominal.surface.solar_absorptivity,
            outside_film: random.uniform((0.75, 1.3)),
            inside_film: random.uniform((0.75, 1.3)),
            wall_capacity: random.uniform((0.8, 1.25)),
            valve_capacity: random.uniform((0.75, 1.3)),
            valve_contact: random.uniform((0.7, 1.3)),
            emissivity: random.uniform((0.6, 0.95)),
            thermal_expansion: random.uniform((0.9, 1.1)),
            pressure_expansion: random.uniform((0.9, 1.1)),
            film_slope: random.uniform((-0.3, 0.3)),
        };
        let mut vessel = drawn.apply(&nominal);
        vessel.geometry.cylinder_cells = self.wall_cells;
        vessel.geometry.layers.iter_mut().for_each(|layer| layer.cells = 1);
        vessel.gas = GasResolution::Stratified(Stratification {
            cells: self.gas_cells,
            exchange_length_diameters: random.uniform((0.7, 1.4)),
            core_mixing: random.uniform((0.02, 0.1)),
        });
        Ok((vessel, drawn))
    }

    fn simulate(&self, vessel: &Vessel, drawn: &VesselDraw) -> Result<Trajectory, ThermalError> {
        // Whole intervals, so that all samples are equally far apart.
        let duration_s = (self.chamber.duration_s() / self.sample_s).ceil() * self.sample_s;
        let settled_k = self.chamber.air_k(0.0);
        let scenario = Scenario {
            name: format!("chamber, seed {}", self.seed),
            initial: Initial {
                fill: Fill::Settled { pressure_pa: FILL_PA, temperature_k: QUOTED_K },
                wall_temperature_k: settled_k,
                gas_temperature_k: settled_k,
            },
            surroundings: self.chamber.surroundings(self.seed, drawn, duration_s)?,
            flows: self.leak.iter().map(SteadyLeak::flow).collect(),
            pressure_limits_pa: Vec::new(),
            sensors: Vec::new(),
            duration_s,
            sample_time_s: self.sample_s,
        };
        let settings = SimulationSettings {
            relative_tolerance: self.relative_tolerance,
            ..SimulationSettings::default()
        };
        simulate(vessel, &scenario, &settings, &mut |_| ())
    }
}

/// The sensors of a seed.
fn sensors(seed: u64) -> SensorDraw {
    let random = &mut Random::new(seed, Purpose::ChamberSensors);
    let mut surface = || Thermometer {
        offset_k: random.uniform((-0.3, 0.3)),
        air_coupling: random.uniform((0.05, 0.15)),
        lag_s: 0.0,
        stated_lag_s: 0.0,
        noise_k: NOISE_K,
        resolution_k: 0.0,
    };
    // The third and the fourth, of the wall, are drawn as the published numbers have them, and not read.
    let [shoulder, valve, ..] = [surface(), surface(), surface(), surface()];
    let pressure = Transmitter {
        offset_pa: random.either_sign((0.25 * BAR_PA, 0.625 * BAR_PA)),
        coefficient_pa_k: random.either_sign((0.0125 * BAR_PA, 0.0375 * BAR_PA)),
        noise_pa: NOISE_PA,
        resolution_pa: 0.0,
        full_scale_pa: FULL_SCALE_PA,
        is_gauge: false,
    };
    SensorDraw { shoulder, valve, pressure }
}

/// A drawn cylinder in a chamber: what really happened, and what was read of it at the same times.
#[derive(Clone, Debug)]
pub struct ChamberRun {
    /// What was asked for.
    pub request: ChamberRequest,
    /// What was drawn for the cylinder.
    pub vessel: VesselDraw,
    /// What was drawn for its sensors.
    pub sensors: SensorDraw,
    /// What really happened.
    pub trajectory: Trajectory,
    /// Readings: channels `shoulder`, `valve`, `pressure`.
    pub log: Log,
}
