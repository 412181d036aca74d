//! Accuracy of a layout in a scenario, with the error of the observer where the cylinder is not as modelled.
//!
//! The ordinary model runs the scenario once as the vessel file says and once for each [`Variant`]; ideal sensors read it; the ordinary observer takes the
//! readings of a layout. Its covariance then is that in the scenario, `P(t)`, and its error in readings without noise is what model error alone
//! leaves, `e_v(t)`. A filter does not know of the latter: as consider parameters (Schmidt 1966) the variants add
//!
//! `P_S(t) = P(t) + e_0(t)^2 + sum_v w_v (e_v(t) - e_0(t))^2`
//!
//! to its variance, with the nominal variant 0 and the weights of `Variant::weight`; the worst case is `P(t) + max_v e_v(t)^2`. So model error is not
//! taken for information. A scenario that begins settled has three hours of rest before it.
//!
//! Assumes that the variants' errors add: each is small beside what it varies. Films that the observer learns are in `P` and among
//! the variants, so `P_S` is rather too large.
use rayon::prelude::*;
use serde::{Deserialize, Serialize};

use super::objective::{Objective, Relaxed};
use crate::EstimatorError;
use crate::observer::{Commissioning, Observer, ObserverSettings};
use crate::sensor::{Exposure, ParameterKind, Sensor, SensorTruth, Specimen, SuiteTruth, sample};
use crate::thermal::scenario::Scenario;
use crate::thermal::simulate::{SimulationSettings, simulate};
use crate::thermal::trajectory::Trajectory;
use crate::thermal::vessel::{GasResolution, InsideFilm, Stratification, Vessel};
use crate::thermal::wall::geometry::Orientation;

/// Factors of an uncertain film: ±50 %.
const FILM: [f64; 2] = [0.5, 1.5];
/// Rest before a scenario that begins settled, s: the observer has begun before the air changes.
const REST_S: f64 = 3.0 * 3600.0;
/// How the cylinder differs from what the vessel file says.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Variant {
    /// Not at all.
    Nominal,
    /// Outside film times a factor.
    OutsideFilm(f64),
    /// Inside film times a factor.
    InsideFilm(f64),
    /// All mounting couplings so many standard deviations from their means.
    Couplings(f64),
    /// Stratified gas instead of well mixed.
    StratifiedGas,
    /// The same in a cylinder that lies instead of standing, or the other way round: in well-mixed gas it is all one.
    OtherAttitude,
}

impl Variant {
    /// All that are looked at, the nominal one first.
    pub const ALL: [Self; 9] = [
        Self::Nominal,
        Self::OutsideFilm(FILM[0]),
        Self::OutsideFilm(FILM[1]),
        Self::InsideFilm(FILM[0]),
        Self::InsideFilm(FILM[1]),
        Self::Couplings(-1.0),
        Self::Couplings(1.0),
        Self::StratifiedGas,
        Self::OtherAttitude,
    ];

    /// Part of the square of its error that counts as variance: of a film that lies anywhere within its bounds a third, half for either bound;
    /// of a coupling half for either side; well mixed, stratified and stratified in the other attitude a third each.
    pub(crate) fn weight(&self) -> f64 {
        match self {
            Self::Nominal => 0.0,
            Self::OutsideFilm(_) | Self::InsideFilm(_) => 1.0 / 6.0,
            Self::Couplings(_) => 0.5,
            Self::StratifiedGas | Self::OtherAttitude => 1.0 / 3.0,
        }
    }

    /// Description for reports.
    pub fn description(&self) -> String {
        match self {
            Self::Nominal => "as stated".into(),
            Self::OutsideFilm(factor) => format!("outside film x {factor}"),
            Self::InsideFilm(factor) => format!("inside film x {factor}"),
            Self::Couplings(sd) => format!("couplings {sd:+} sd"),
            Self::StratifiedGas => "stratified gas".into(),
            Self::OtherAttitude => "stratified, other attitude".into(),
        }
    }

    /// The vessel as it then is.
    fn vessel(&self, vessel: &Vessel) -> Vessel {
        let mut vessel = vessel.clone();
        match *self {
            Self::Nominal | Self::Couplings(_) => {}
            Self::OutsideFilm(by) => vessel.surface.film_factor *= by,
            Self::InsideFilm(by) => match &mut vessel.inside_film {
                InsideFilm::Rayleigh { multiplier, .. } => *multiplier *= by,
                InsideFilm::Coefficient { film_w_m2_k } => *film_w_m2_k *= by,
            },
            Self::StratifiedGas => vessel.gas = stratified(),
            Self::OtherAttitude => {
                vessel.gas = stratified();
                vessel.geometry.orientation = match vessel.geometry.orientation {
                    Orientation::Vertical => Orientation::Horizontal,
                    Orientation::Horizontal => Orientation::Vertical,
                };
            }
        }
        vessel
    }

    /// An ideal specimen of a sensor.
    fn specimen(&self, sensor: &Sensor) -> Specimen {
        let mut parameters = sensor.nominal().parameters;
        if let Self::Couplings(by_sd) = *self {
            for (value, parameter) in parameters.iter_mut().zip(sensor.parameters()) {
                if parameter.kind == ParameterKind::Coupling {
                    *value = (*value + by_sd * parameter.sd).clamp(0.0, 1.0);
                }
            }
        }
        Specimen { sensor: sensor.ideal(), truth: SensorTruth { parameters } }
    }
}

/// Readings of all candidates in one variant of a scenario, and the true gas temperature and mass.
#[derive(Clone, Debug)]
struct Run {
    variant: Variant,
    gas_k: Vec<f64>,
    mass_kg: Vec<f64>,
    /// Readings of all candidates at rest before the scenario; none where it does not begin settled.
    rest: Option<Vec<f64>>,
    /// A row of readings of all candidates for each sample.
    rows: Vec<Vec<f64>>,
}

/// A scenario, simulated in all variants and read by all candidates: layouts are evaluated in it.
#[derive(Clone, Debug)]
pub struct ScenarioAnalysis {
    name: String,
    vessel: Vessel,
    candidates: Vec<Sensor>,
    settings: ObserverSettings,
    commissioning: Commissioning,
    time_s: Vec<f64>,
    runs: Vec<Run>,
}

/// Accuracy of a layout in a scenario.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct ScenarioAccuracy {
    /// Name of the scenario.
    pub scenario: String,
    /// Mean and largest standard deviation of the gas temperature as the observer states it, K.
    pub gas_sd_k: Summary,
    /// Of the mass, kg.
    pub mass_sd_kg: Summary,
    /// Of the leak rate, kg/s.
    pub leak_sd_kg_s: Summary,
    /// Of the gas temperature with model error as consider parameters, K.
    pub gas_schmidt_k: Summary,
    /// The same of the mass, kg.
    pub mass_schmidt_kg: Summary,
    /// The same of the gas temperature in the worst variant at each time, K.
    pub gas_worst_case_k: Summary,
    /// Error of the gas temperature and of the mass in each variant.
    pub variants: Vec<VariantError>,
}

/// A quantity over a scenario.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Summary {
    /// Root of the mean square.
    pub mean: f64,
    /// Largest.
    pub worst: f64,
}

/// What model error alone leaves.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct VariantError {
    /// What differs.
    pub variant: Variant,
    /// Error of the gas temperature, K.
    pub gas_k: Summary,
    /// Error of the mass, kg.
    pub mass_kg: Summary,
}

/// What a search minimises in a scenario; all of the gas temperature.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum ScenarioMeasure {
    /// Mean standard deviation.
    Mean,
    /// Largest standard deviation.
    Worst,
    /// Mean with model error as consider parameters.
    Schmidt,
    /// Largest in the worst variant.
    WorstCase,
}

impl ScenarioAnalysis {
    /// Run a scenario in all variants, read by all candidates.
    ///
    /// # Errors
    /// A simulation fails, a candidate has no place on the vessel, or the scenario is shorter than two samples.
    pub fn new(
        vessel: &Vessel,
        scenario: &Scenario,
        candidates: &[Sensor],
        settings: &ObserverSettings,
    ) -> Result<Self, EstimatorError> {
        let simulated: Vec<(Run, Vec<f64>)> = Variant::ALL
            .into_par_iter()
            .map(|variant| run(vessel, scenario, candidates, variant))
            .collect::<Result<_, EstimatorError>>()?;
        let time_s = simulated.first().map(|(_, time_s)| time_s.clone()).unwrap_or_default();
        let initial = &scenario.initial;
        let settled = simulated.first().is_some_and(|(run, _)| run.rest.is_some());
        let commissioning = Commissioning {
            fill: initial.fill,
            settled,
            ..Commissioning::filled(200e5, initial.gas_temperature_k)
        };
        Ok(Self {
            name: scenario.name.clone(),
            vessel: vessel.clone(),
            candidates: candidates.to_vec(),
            settings: settings.clone(),
            commissioning,
            time_s,
            runs: simulated.into_iter().map(|(run, _)| run).collect(),
        })
    }

    /// Name of the scenario.
    pub(crate) fn name(&self) -> &str {
        &self.name
    }

    /// Accuracy of a layout in it.
    ///
    /// # Errors
    /// The observer cannot be built or cannot follow.
    pub fn accuracy(&self, layout: &[usize]) -> Result<ScenarioAccuracy, EstimatorError> {
        let sensors: Vec<Sensor> = layout.iter().map(|&index| self.candidates[index].clone()).collect();
        let followed: Vec<Vec<Point>> =
            self.runs.iter().map(|run| self.follow(layout, &sensors, run)).collect::<Result<_, _>>()?;
        let nominal = &followed[0];
        let samples = 0..nominal.len();
        let over = |of: &dyn Fn(usize) -> f64| Summary::of(samples.clone().map(of));
        let schmidt = |variance: &dyn Fn(&Point) -> f64, error: &dyn Fn(&Point) -> f64| {
            over(&|at| {
                let base = error(&nominal[at]);
                let of_variants = self
                    .runs
                    .iter()
                    .zip(&followed)
                    .map(|(run, points)| run.variant.weight() * (error(&points[at]) - base).powi(2));
                (variance(&nominal[at]) + base * base + of_variants.sum::<f64>()).sqrt()
            })
        };
        let variants = self.runs.iter().zip(&followed).map(|(run, points)| VariantError {
            variant: run.variant,
            gas_k: Summary::of(points.iter().map(|point| point.gas_error_k.abs())),
            mass_kg: Summary::of(points.iter().map(|point| point.mass_error_kg.abs())),
        });
        Ok(ScenarioAccuracy {
            scenario: self.name.clone(),
            gas_sd_k: over(&|at| nominal[at].gas_sd_k),
            mass_sd_kg: over(&|at| nominal[at].mass_sd_kg),
            leak_sd_kg_s: over(&|at| nominal[at].leak_sd_kg_s),
            gas_schmidt_k: schmidt(&|point| point.gas_sd_k.powi(2), &|point| point.gas_error_k),
            mass_schmidt_kg: schmidt(&|point| point.mass_sd_kg.powi(2), &|point| point.mass_error_kg),
            gas_worst_case_k: over(&|at| {
                let errors = followed.iter().map(|points| points[at].gas_error_k.powi(2));
                (nominal[at].gas_sd_k.powi(2) + errors.fold(0.0, f64::max)).sqrt()
            }),
            variants: variants.collect(),
        })
    }

    fn follow(&self, layout: &[usize], sensors: &[Sensor], run: &Run) -> Result<Vec<Point>, EstimatorError> {
        let mut observer = Observer::new(&self.vessel, sensors, &self.commissioning, &self.settings)?;
        let mut readings = vec![0.0; layout.len()];
        let mut step = |time_s, row: &[f64]| {
            readings.iter_mut().zip(layout).for_each(|(reading, &index)| *reading = row[index]);
            observer.step(time_s, &readings)
        };
        if let (Some(rest), Some(&second_s)) = (&run.rest, self.time_s.get(1)) {
            let samples = (REST_S / second_s).ceil() as usize;
            for sample in (1..=samples).rev() {
                step(-second_s * sample as f64, rest)?;
            }
        }
        let point = |(at, row): (usize, &Vec<f64>)| {
            let estimate = step(self.time_s[at], row)?;
            Ok(Point {
                gas_sd_k: estimate.gas_mean_sd_k,
                mass_sd_kg: estimate.mass_sd_kg,
                leak_sd_kg_s: estimate.leak_sd_kg_s,
                gas_error_k: estimate.gas_mean_k - run.gas_k[at],
                mass_error_kg: estimate.mass_kg - run.mass_kg[at],
            })
        };
        run.rows.iter().enumerate().map(point).collect()
    }
}

/// The observer at a sample, and how wrong it is.
#[derive(Clone, Copy, Debug)]
struct Point {
    gas_sd_k: f64,
    mass_sd_kg: f64,
    leak_sd_kg_s: f64,
    gas_error_k: f64,
    mass_error_kg: f64,
}

impl Summary {
    fn of(values: impl Iterator<Item = f64>) -> Self {
        let (mut sum, mut count, mut worst) = (0.0, 0.0_f64, 0.0_f64);
        for value in values {
            (sum, count, worst) = (sum + value * value, count + 1.0, worst.max(value));
        }
        Self { mean: (sum / count.max(1.0)).sqrt(), worst }
    }
}

fn run(
    vessel: &Vessel,
    scenario: &Scenario,
    candidates: &[Sensor],
    variant: Variant,
) -> Result<(Run, Vec<f64>), EstimatorError> {
    let vessel = variant.vessel(vessel);
    // The variant only has to differ from the observer's gas.
    let fills_layers = variant == Variant::StratifiedGas;
    let settings = SimulationSettings { fills_layers, ..SimulationSettings::default() };
    let trajectory = simulate(&vessel, scenario, &settings, &mut |_| {})?;
    let specimens: Vec<Specimen> = candidates.iter().map(|sensor| variant.specimen(sensor)).collect();
    let log = sample(&trajectory, &SuiteTruth { specimens: specimens.clone() }, 0)?;
    let rows = log.rows().map(|(_, row)| row.to_vec()).collect();
    let settled = scenario.initial.wall_temperature_k == scenario.initial.gas_temperature_k;
    let rest = settled.then(|| at_rest(&trajectory, &specimens));
    let run = Run { variant, gas_k: trajectory.gas_mean_k, mass_kg: trajectory.mass_kg, rest, rows };
    Ok((run, trajectory.time_s))
}

/// Readings while everything is as warm as the gas at the start of a trajectory.
fn at_rest(trajectory: &Trajectory, specimens: &[Specimen]) -> Vec<f64> {
    let (body_k, pressure_pa) = (trajectory.gas_mean_k[0], trajectory.pressure_pa[0]);
    let exposure = Exposure { body_k, air_k: body_k, pressure_pa, electronics_k: body_k };
    specimens.iter().map(|of| of.sensor.predict(&exposure, &of.truth.parameters).value).collect()
}

/// A measure of a scenario as an objective: its square, K². It has no relaxation, hence no certificate.
#[derive(Clone, Copy, Debug)]
pub(crate) struct ScenarioObjective<'a> {
    /// The scenario.
    pub scenario: &'a ScenarioAnalysis,
    /// The measure.
    pub measure: ScenarioMeasure,
}

impl ScenarioMeasure {
    /// The measure of a layout, K.
    pub fn of(self, accuracy: &ScenarioAccuracy) -> f64 {
        match self {
            Self::Mean => accuracy.gas_sd_k.mean,
            Self::Worst => accuracy.gas_sd_k.worst,
            Self::Schmidt => accuracy.gas_schmidt_k.mean,
            Self::WorstCase => accuracy.gas_worst_case_k.worst,
        }
    }
}

impl Objective for ScenarioObjective<'_> {
    fn candidates(&self) -> usize {
        self.scenario.candidates.len()
    }

    fn value(&self, layout: &[usize]) -> f64 {
        self.scenario.accuracy(layout).map_or(f64::INFINITY, |accuracy| self.measure.of(&accuracy).powi(2))
    }

    fn relaxed(&self, _: &[f64]) -> Option<Relaxed> {
        None
    }
}

/// Fewer cells than usual: in air that changes over an hour they differ by 0.3 K from many, and a study makes thousands of runs.
fn stratified() -> GasResolution {
    GasResolution::Stratified(Stratification { cells: 8, ..Stratification::default() })
}
