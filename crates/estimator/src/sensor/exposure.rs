//! What a sensor on a simulated vessel is exposed to, at any time within the trajectory.
use super::{Exposure, Prediction, Sensor, Site, SurfacePlace};
use crate::EstimatorError;
use cylwatch_thermal::scenario::Series;
use cylwatch_thermal::trajectory::Trajectory;
use cylwatch_thermal::wall::mesh::Mesh;

/// Step before the start of a trajectory at which everything is at rest, s.
const BEFORE_S: f64 = 1.0;

/// A specimen in a trajectory.
pub(super) struct ExposedSensor<'a> {
    sensor: &'a Sensor,
    parameters: &'a [f64],
    time_s: &'a [f64],
    air_k: &'a Series,
    /// Air at the top minus that at the bottom, with the sensor's height above the middle.
    air_difference: Option<(&'a Series, f64)>,
    pressure_pa: &'a [f64],
    /// Temperature of surface, valve or gas at the sensor's place at every sample, K.
    body_k: Vec<f64>,
    /// Temperature of the valve at every sample, K.
    electronics_k: Vec<f64>,
}

impl<'a> ExposedSensor<'a> {
    /// A sensor with a specimen's parameters in a trajectory that has samples.
    pub(super) fn new(
        trajectory: &'a Trajectory,
        sensor: &'a Sensor,
        parameters: &'a [f64],
    ) -> Result<Self, EstimatorError> {
        let surroundings = &trajectory.scenario.surroundings;
        let difference_k = surroundings.axial.air_difference_k.as_ref();
        Ok(Self {
            sensor,
            parameters,
            time_s: &trajectory.time_s,
            air_k: &surroundings.air_k,
            air_difference: difference_k.and_then(|series| Some((series, above_middle(trajectory, sensor)?))),
            pressure_pa: &trajectory.pressure_pa,
            body_k: body_k(trajectory, sensor)?,
            electronics_k: electronics_k(trajectory),
        })
    }

    /// Start of the trajectory, s.
    pub(super) fn start_s(&self) -> f64 {
        self.time_s[0]
    }

    /// Static reading at a time, after a jump of the air.
    pub(super) fn at(&self, t_s: f64) -> Prediction {
        let difference_k = self.air_difference.map_or(0.0, |(series, above)| above * series.at(t_s));
        self.predicted(t_s, self.air_k.at(t_s) + difference_k)
    }

    /// Static reading before the trajectory begins: the air as it was, everything else as at the start.
    pub(super) fn before_start(&self) -> f64 {
        let start_s = self.start_s();
        self.predicted(start_s, self.air_at(start_s, start_s - BEFORE_S, start_s)).value
    }

    /// Static readings at the start and at the end of an interval that contains no knot in its inside, both approached
    /// from inside.
    pub(super) fn between(&self, from_s: f64, to_s: f64) -> (f64, f64) {
        let at = |t_s| self.predicted(t_s, self.air_at(t_s, from_s, to_s)).value;
        (at(from_s), at(to_s))
    }

    /// Air at the sensor at a time in an interval that contains no edge of it in its inside, K.
    fn air_at(&self, t_s: f64, from_s: f64, to_s: f64) -> f64 {
        let air = |series: &Series| series.segment(from_s, to_s).at(t_s);
        air(self.air_k) + self.air_difference.map_or(0.0, |(series, above)| above * air(series))
    }

    /// Times between which the static reading is linear, s.
    pub(super) fn knots_s(&self) -> Vec<f64> {
        let (from_s, to_s) = (self.start_s(), self.time_s[self.time_s.len() - 1]);
        let of_difference = self.air_difference.iter().flat_map(|(series, _)| series.edges_s());
        let edges = self.air_k.edges_s().chain(of_difference).filter(|t| (from_s..to_s).contains(t));
        self.time_s.iter().copied().chain(edges).collect()
    }

    fn predicted(&self, t_s: f64, air_k: f64) -> Prediction {
        let (index, weight) = position(self.time_s, t_s);
        let linear = |values: &[f64]| match values.get(index + 1) {
            Some(next) => values[index] + weight * (next - values[index]),
            None => values[index],
        };
        let exposure = Exposure {
            body_k: linear(&self.body_k),
            air_k,
            pressure_pa: linear(self.pressure_pa),
            electronics_k: linear(&self.electronics_k),
        };
        self.sensor.predict(&exposure, self.parameters)
    }
}

/// The sample at or before a time, and how far the time is on the way to the next one.
fn position(time_s: &[f64], t_s: f64) -> (usize, f64) {
    let index = time_s.partition_point(|&t| t <= t_s).saturating_sub(1);
    let weight = time_s.get(index + 1).map_or(0.0, |next| (t_s - time_s[index]) / (next - time_s[index]));
    (index, weight)
}

fn body_k(trajectory: &Trajectory, sensor: &Sensor) -> Result<Vec<f64>, EstimatorError> {
    let vessel = &trajectory.vessel;
    let mesh = Mesh::new(&vessel.geometry);
    if let Some(missing) = sensor.misfit_on(vessel, &mesh) {
        let (name, vessel) = (sensor.name.clone(), vessel.name.clone());
        return Err(EstimatorError::SensorMisfit { name, vessel, missing });
    }
    let column = |cells: &[Vec<f64>], cell: usize| cells.iter().map(|sample| sample[cell]).collect();
    let found = match sensor.site() {
        Site::Surface(SurfacePlace::Valve) => trajectory.valve_k.clone(),
        Site::Surface(place) => {
            place.column(&vessel.geometry, &mesh).map(|cell| column(&trajectory.wall_outer_k, cell))
        }
        Site::Gas(place) => place.cell(vessel, &mesh).map(|cell| column(&trajectory.gas_cells_k, cell)),
        Site::Air | Site::Port => Some(electronics_k(trajectory)),
    };
    Ok(found.expect("a sensor that fits on the vessel has a place in its trajectory"))
}

/// Height of a surface sensor above the middle of the vessel, as a fraction; `None` for others, which have the
/// scenario's air around them.
fn above_middle(trajectory: &Trajectory, sensor: &Sensor) -> Option<f64> {
    let Site::Surface(place) = sensor.site() else { return None };
    let geometry = &trajectory.vessel.geometry;
    place.above_middle(geometry, &Mesh::new(geometry))
}

/// Temperature of the valve, or of the topmost wall cell where there is no valve, K.
fn electronics_k(trajectory: &Trajectory) -> Vec<f64> {
    match &trajectory.valve_k {
        Some(valve_k) => valve_k.clone(),
        None => trajectory.wall_outer_k.iter().map(|sample| sample[sample.len() - 1]).collect(),
    }
}
