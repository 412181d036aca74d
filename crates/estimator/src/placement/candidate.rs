//! Places where a sensor could sit, and what is asked of their choice.
//!
//! Every axial cell of the wall is a place, by its name (bottom, middle, shoulder, neck) or by its height; beside them the valve, the air, the
//! pressure at the valve, and thermocouples in the gas, which are a reference that no vehicle has: forbidden unless a rule allows them.
//! Each is the typical sensor of its kind ([`Sensor::typical`]) unless a file says otherwise.
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::constraints::{Constraints, Group};
use crate::EstimatorError;
use crate::sensor::{Sensor, SensorSpec, SensorSuite, SensorsSpec, Site, SurfacePlace};
use crate::thermal::document::{self, check};
use crate::thermal::sensor::PLACES;
use crate::thermal::vessel::Vessel;
use crate::thermal::wall::mesh::Mesh;

/// Name of the thermocouple in the gas that every vessel has a place for.
const GAS_REFERENCE: &str = "gas_1";

/// Whether a candidate may be chosen.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Status {
    /// It may.
    #[default]
    Allowed,
    /// It may not, but it is judged as a reference.
    Forbidden,
    /// It must.
    Required,
}

/// A place with the sensor that would sit there.
#[derive(Clone, Debug, PartialEq)]
pub struct Candidate {
    /// What would be read.
    pub sensor: Sensor,
    /// Height above the outer bottom along the axis, m; `None`: it is on no wall.
    pub height_m: Option<f64>,
    /// Cost, in any unit that all candidates share.
    pub cost: f64,
    /// Whether it may be chosen.
    pub status: Status,
}

/// All candidates of a vessel.
#[derive(Clone, Debug, PartialEq)]
pub struct Candidates {
    /// The candidates.
    pub list: Vec<Candidate>,
    /// Of which so many are taken.
    pub groups: Vec<Group>,
    /// Thermometers on the wall are at least so far from each other, m.
    pub minimum_distance_m: f64,
}

/// Raw content of a file of candidates.
#[derive(Clone, Debug, Default, Deserialize, JsonSchema, PartialEq)]
pub(super) struct CandidatesSpec {
    /// Sensors that could be there; all places of the vessel by default.
    #[serde(default)]
    pub sensor: Vec<SensorSpec>,
    /// Costs and status of single candidates.
    #[serde(default)]
    pub rule: Vec<RuleSpec>,
    /// Groups of which so many are taken.
    #[serde(default)]
    pub group: Vec<GroupSpec>,
    /// Least distance of thermometers on the wall along the axis, 0 by default.
    pub minimum_distance_m: Option<f64>,
}

/// Rule for a candidate.
#[derive(Clone, Debug, Deserialize, JsonSchema, PartialEq)]
pub(super) struct RuleSpec {
    /// Name of the candidate.
    pub sensor: String,
    /// Its cost, 1 by default.
    pub cost: Option<f64>,
    /// Whether it may be chosen: allowed, forbidden or required.
    pub status: Option<Status>,
}

/// Rule for a group.
#[derive(Clone, Debug, Deserialize, JsonSchema, PartialEq)]
pub(super) struct GroupSpec {
    /// Names of the candidates.
    pub members: Vec<String>,
    /// Fewest of them, 0 by default.
    pub at_least: Option<usize>,
    /// Most of them, all by default.
    pub at_most: Option<usize>,
}

impl Candidates {
    /// Every place of a vessel, with the pressure required and the thermocouple in the gas forbidden.
    ///
    /// # Errors
    /// None with a vessel that was checked.
    pub fn of_vessel(vessel: &Vessel) -> Result<Self, EstimatorError> {
        let mesh = Mesh::new(&vessel.geometry);
        let named = |column| PLACES.iter().find(|place| mesh.column_of(place) == Some(column));
        let on_wall = |column: usize| match named(column) {
            Some(place) => Sensor::typical(place),
            None => Sensor::typical_at_height(middle_m(vessel, &mesh, column)),
        };
        let mut sensors = (0..mesh.columns.len()).map(on_wall).collect::<Result<Vec<_>, _>>()?;
        if vessel.valve.is_some() {
            sensors.push(Sensor::typical("valve")?);
        }
        for name in ["ambient", GAS_REFERENCE, "pressure"] {
            sensors.push(Sensor::typical(name)?);
        }
        Self::of_sensors(vessel, sensors)
    }

    /// Sensors on a vessel, each allowed at the cost 1, but a pressure required and what hangs in the gas forbidden.
    ///
    /// # Errors
    /// Two have one name, or one has no place on the vessel.
    pub fn of_sensors(vessel: &Vessel, sensors: Vec<Sensor>) -> Result<Self, EstimatorError> {
        let suite = SensorSuite::try_new(sensors)?;
        let mesh = Mesh::new(&vessel.geometry);
        let candidate = |sensor: &Sensor| {
            if let Some(missing) = sensor.misfit(vessel) {
                let (name, vessel) = (sensor.name.clone(), vessel.name.clone());
                return Err(EstimatorError::SensorMisfit { name, vessel, missing });
            }
            let status = match sensor.site() {
                Site::Gas(_) => Status::Forbidden,
                Site::Port => Status::Required,
                Site::Surface(_) | Site::Air => Status::Allowed,
            };
            let height_m = height_m(vessel, &mesh, sensor);
            Ok(Candidate { sensor: sensor.clone(), height_m, cost: 1.0, status })
        };
        let list = suite.sensors().iter().map(candidate).collect::<Result<_, _>>()?;
        Ok(Self { list, groups: Vec::new(), minimum_distance_m: 0.0 })
    }

    /// The sensors, in the order of the candidates.
    pub fn sensors(&self) -> Vec<Sensor> {
        self.list.iter().map(|candidate| candidate.sensor.clone()).collect()
    }

    /// Index of a name.
    pub fn index(&self, name: &str) -> Option<usize> {
        self.list.iter().position(|candidate| candidate.sensor.name == name)
    }

    /// Names of a layout.
    pub fn names(&self, layout: &[usize]) -> Vec<&str> {
        layout.iter().map(|&index| &*self.list[index].sensor.name).collect()
    }

    /// Layouts of so many sensors at no more than a cost.
    pub fn constraints(&self, sensors: usize, budget: f64) -> Constraints {
        let with = |status| {
            let is = move |(_, candidate): &(usize, &Candidate)| candidate.status == status;
            self.list.iter().enumerate().filter(is).map(|(index, _)| index).collect()
        };
        Constraints {
            must: with(Status::Required),
            forbidden: with(Status::Forbidden),
            groups: self.groups.clone(),
            apart: self.too_close(),
            costs: self.list.iter().map(|candidate| candidate.cost).collect(),
            budget,
            ..Constraints::of(sensors)
        }
    }

    /// Pairs that are closer than the least distance.
    fn too_close(&self) -> Vec<(usize, usize)> {
        let mut pairs = Vec::new();
        for (index, one) in self.list.iter().enumerate() {
            for (other, candidate) in self.list.iter().enumerate().skip(index + 1) {
                let distance_m = one.height_m.zip(candidate.height_m).map(|(a, b)| (a - b).abs());
                if distance_m.is_some_and(|distance_m| distance_m < self.minimum_distance_m) {
                    pairs.push((index, other));
                }
            }
        }
        pairs
    }

    fn known(&self, name: &str, path: &str) -> Result<usize, EstimatorError> {
        let known =
            || self.list.iter().map(|candidate| &*candidate.sensor.name).collect::<Vec<_>>().join(", ");
        let unknown = || check::broken(path, format!("{name:?}"), "the name of a candidate", &known());
        Ok(self.index(name).ok_or_else(unknown)?)
    }

    fn rule(&mut self, number: usize, rules: &[RuleSpec]) -> Result<(), EstimatorError> {
        let rule = &rules[number];
        let path = format!("rule[{number}].sensor");
        let index = self.known(&rule.sensor, &path)?;
        if rules[..number].iter().any(|before| before.sensor == rule.sensor) {
            let name = format!("{:?}", rule.sensor);
            return Err(check::broken(&path, name, "a sensor without a rule yet", "put both into one").into());
        }
        let candidate = &mut self.list[index];
        if let Some(cost) = rule.cost {
            if !(cost >= 0.0 && cost.is_finite()) {
                let path = format!("rule[{number}].cost");
                return Err(check::broken(
                    &path,
                    cost,
                    "finite and at least 0",
                    "costs add up to a layout's",
                )
                .into());
            }
            candidate.cost = cost;
        }
        candidate.status = rule.status.unwrap_or(candidate.status);
        Ok(())
    }

    fn group(&mut self, number: usize, group: &GroupSpec) -> Result<(), EstimatorError> {
        let path = |member: usize| format!("group[{number}].members[{member}]");
        let members = group.members.iter().enumerate();
        let members: Vec<usize> =
            members.map(|(member, name)| self.known(name, &path(member))).collect::<Result<_, _>>()?;
        let (fewest, most) = (group.at_least.unwrap_or(0), group.at_most.unwrap_or(members.len()));
        if fewest > most || fewest > members.len() {
            let path = format!("group[{number}].at_least");
            let bound = format!("at most {}", most.min(members.len()));
            return Err(check::broken(&path, fewest, &bound, "a group cannot give more than it has").into());
        }
        let with = |status| members.iter().filter(|member| self.list[**member].status == status).count();
        let (required, open) = (with(Status::Required), members.len() - with(Status::Forbidden));
        if fewest > open {
            let (path, bound) = (format!("group[{number}].at_least"), format!("at most {open}"));
            return Err(check::broken(&path, fewest, &bound, "the others are forbidden").into());
        }
        if most < required {
            let (path, bound) = (format!("group[{number}].at_most"), format!("at least {required}"));
            return Err(check::broken(&path, most, &bound, "so many are required").into());
        }
        self.groups.push(Group { members, fewest, most });
        Ok(())
    }

    /// The least distance is one that the required ones have.
    fn check_distance(&self) -> Result<(), EstimatorError> {
        let distance_m = self.minimum_distance_m;
        if !(distance_m >= 0.0 && distance_m.is_finite()) {
            let (bound, remedy) = ("finite and at least 0", "it is measured along the axis");
            return Err(check::broken("minimum_distance_m", distance_m, bound, remedy).into());
        }
        let required = |index: usize| self.list[index].status == Status::Required;
        if let Some((a, b)) = self.too_close().into_iter().find(|(a, b)| required(*a) && required(*b)) {
            let names = self.names(&[a, b]).join(" and ");
            let remedy = format!("{names} are required and nearer to each other");
            return Err(check::broken("minimum_distance_m", distance_m, "smaller", &remedy).into());
        }
        Ok(())
    }
}

impl CandidatesSpec {
    /// Checks the candidates for a vessel and fills in the typical numbers.
    ///
    /// # Errors
    /// [`EstimatorError::Thermal`] with the path of the first value that breaks a bound.
    pub(crate) fn build(&self, vessel: &Vessel) -> Result<Candidates, EstimatorError> {
        let mut candidates = if self.sensor.is_empty() {
            Candidates::of_vessel(vessel)?
        } else {
            let suite = SensorsSpec { sensor: self.sensor.clone() }.build()?;
            Candidates::of_sensors(vessel, suite.sensors().to_vec()).map_err(|error| self.placed(error))?
        };
        for number in 0..self.rule.len() {
            candidates.rule(number, &self.rule)?;
        }
        for (number, group) in self.group.iter().enumerate() {
            candidates.group(number, group)?;
        }
        candidates.minimum_distance_m = self.minimum_distance_m.unwrap_or(0.0);
        candidates.check_distance()?;
        Ok(candidates)
    }

    /// A sensor that the vessel has no place for, as an error about its name.
    fn placed(&self, error: EstimatorError) -> EstimatorError {
        let EstimatorError::SensorMisfit { name, vessel, missing } = error else { return error };
        let number = self.sensor.iter().position(|sensor| sensor.name == name).unwrap_or(0);
        let bound = format!("a sensor on a place that vessel {vessel} has");
        let remedy = format!("it needs {missing}; give it another place or leave it out");
        check::broken(&format!("sensor[{number}].name"), format!("{name:?}"), &bound, &remedy).into()
    }
}

/// Reads a file of candidates; `source` is its name in messages.
///
/// # Errors
/// [`EstimatorError::Thermal`] with file, line, value and remedy for whatever is wrong with the text.
pub fn read_candidates(text: &str, source: &str, vessel: &Vessel) -> Result<Candidates, EstimatorError> {
    let (specification, places) = document::read::<CandidatesSpec>(text, source)?;
    specification.build(vessel).map_err(|error| match error {
        EstimatorError::Thermal(error) => places.locate(error).into(),
        other => other,
    })
}

/// JSON schema of files of candidates.
pub fn candidates_schema() -> serde_json::Value {
    document::schema::of::<CandidatesSpec>("cylwatch sensor candidates")
}

/// Height of a sensor above the outer bottom along the axis, m.
fn height_m(vessel: &Vessel, mesh: &Mesh, sensor: &Sensor) -> Option<f64> {
    let Site::Surface(place) = sensor.site() else { return None };
    match place {
        SurfacePlace::Height { height_m } => Some(height_m),
        SurfacePlace::Valve => None,
        place => Some(middle_m(vessel, mesh, place.column(&vessel.geometry, mesh)?)),
    }
}

/// Height of the middle of a column of the mesh, m.
fn middle_m(vessel: &Vessel, mesh: &Mesh, column: usize) -> f64 {
    let (low, high) = mesh.columns[column].inner_height_m;
    vessel.geometry.bottom.thickness_m + 0.5 * (low + high)
}
