//! A unit that runs.
use cylwatch_detector::sealed::{self, Fingerprint, Kind};
use serde::{Deserialize, Serialize};

use crate::CosimulationError;
use crate::access::Access;
use crate::monitor::Watch;
use crate::phase::Phase;
use crate::plant::{Plant, SavedCourse};
use crate::resource::{self, Resource};
use crate::variable::{Causality, Variable};

/// Part of a step by which its beginning may differ from the time of the instance: a master adds up steps with roundings.
const SAME_TIME: f64 = 1e-6;

#[derive(Debug)]
enum Body {
    Plant(Box<Plant>),
    Monitor(Box<Watch>),
}

#[derive(Serialize, Deserialize)]
enum SavedBody {
    Plant(Option<SavedCourse>),
    Monitor(Vec<u8>),
}

#[derive(Serialize, Deserialize)]
struct Saved {
    phase: Phase,
    time_s: f64,
    values: Vec<f64>,
    body: SavedBody,
}

/// A unit that runs.
#[derive(Debug)]
pub struct Instance {
    fingerprint: Fingerprint,
    body: Body,
    variables: Vec<Variable>,
    /// One for each variable; whole numbers and words, too, are exact in it.
    values: Vec<f64>,
    /// Where the outputs begin.
    outputs: usize,
    phase: Phase,
    time_s: f64,
    /// Whether inputs or the state have changed since the outputs were made.
    is_stale: bool,
}

impl Instance {
    /// From the bytes of a [`Resource`].
    ///
    /// # Errors
    /// They are damaged, of another version or something else, or what they say is not possible.
    pub fn new(bytes: &[u8]) -> Result<Self, CosimulationError> {
        let body = match Resource::from_bytes(bytes)? {
            Resource::Plant(plant) => Body::Plant(Box::new(Plant::new(*plant)?)),
            Resource::Monitor(cylinder) => Body::Monitor(Box::new(Watch::new(*cylinder)?)),
        };
        let mut variables = vec![Variable::time()];
        variables.extend(match &body {
            Body::Plant(plant) => plant.variables(),
            Body::Monitor(watch) => watch.variables(),
        });
        let is_output = |variable: &Variable| variable.causality == Causality::Output;
        let outputs = variables.iter().position(is_output).unwrap_or(variables.len());
        let mut instance = Self {
            fingerprint: resource::fingerprint(bytes),
            body,
            values: Vec::new(),
            variables,
            outputs,
            phase: Phase::Instantiated,
            time_s: 0.0,
            is_stale: true,
        };
        instance.begin_anew();
        Ok(instance)
    }

    /// All variables; the place is the value reference.
    pub fn variables(&self) -> &[Variable] {
        &self.variables
    }

    /// What tells its resource from others.
    pub fn token(&self) -> String {
        resource::token(&self.fingerprint)
    }

    fn begin_anew(&mut self) {
        self.values = self.variables.iter().map(|variable| variable.start.unwrap_or(f64::NAN)).collect();
        if let Body::Monitor(_) = self.body {
            self.values[self.outputs..].copy_from_slice(&Watch::nothing_said());
        }
        (self.phase, self.time_s, self.values[0], self.is_stale) = (Phase::Instantiated, 0.0, 0.0, true);
    }

    fn in_phase(&self, call: &'static str, phases: &[Phase]) -> Result<(), CosimulationError> {
        if phases.contains(&self.phase) {
            return Ok(());
        }
        Err(CosimulationError::OutOfOrder { call, place: self.phase.place() })
    }

    fn place(&self, reference: u32, access: Access) -> Result<usize, CosimulationError> {
        let place = reference as usize;
        match self.variables.get(place) {
            Some(variable) if access.fits(variable.kind) => Ok(place),
            _ => Err(CosimulationError::NoVariable { reference, wanted: access.name() }),
        }
    }

    /// The value of a variable.
    ///
    /// # Errors
    /// There is none of that type, or the inputs make no state.
    pub fn get(&mut self, reference: u32, access: Access) -> Result<f64, CosimulationError> {
        let place = self.place(reference, access)?;
        if place >= self.outputs {
            self.refresh()?;
        }
        Ok(self.values[place])
    }

    fn refresh(&mut self) -> Result<(), CosimulationError> {
        if let (Body::Plant(plant), true) = (&self.body, self.is_stale) {
            let said = plant.outputs(&self.values[1..self.outputs])?;
            self.values[self.outputs..].copy_from_slice(&said);
            self.is_stale = false;
        }
        Ok(())
    }

    /// Set an input, or before the first step a parameter.
    ///
    /// # Errors
    /// There is none of that type, it cannot be set now, or the value is out of its bounds.
    pub fn set(&mut self, reference: u32, access: Access, value: f64) -> Result<(), CosimulationError> {
        let place = self.place(reference, access)?;
        let variable = &self.variables[place];
        let refused = |reason| Err(CosimulationError::NotSettable { name: variable.name.clone(), reason });
        match (variable.causality, self.phase) {
            (_, Phase::Terminated) => return refused("the run has ended"),
            (Causality::Independent, _) => return refused("the time follows from the steps"),
            (Causality::Output, _) => return refused("it is an output"),
            (Causality::Parameter, Phase::Stepping) => {
                return refused("a parameter is set before the first step");
            }
            (Causality::Parameter | Causality::Input, _) => {}
        }
        if !variable.admits(value) {
            let (low, high) = variable.range.unwrap_or((f64::MIN, f64::MAX));
            return Err(CosimulationError::OutOfBounds { name: variable.name.clone(), value, low, high });
        }
        self.values[place] = value;
        self.is_stale = true;
        Ok(())
    }

    /// Say when the run begins, s.
    ///
    /// # Errors
    /// It has begun, or the time is no number.
    pub fn start_at(&mut self, time_s: f64) -> Result<(), CosimulationError> {
        self.in_phase("a start time", &[Phase::Instantiated])?;
        if !time_s.is_finite() {
            return Err(CosimulationError::Step { from_s: time_s, step_s: f64::NAN, time_s: self.time_s });
        }
        (self.time_s, self.values[0]) = (time_s, time_s);
        Ok(())
    }

    /// Enter the initialization.
    ///
    /// # Errors
    /// The instance is not at its beginning.
    pub fn enter_initialization(&mut self) -> Result<(), CosimulationError> {
        self.in_phase("a beginning", &[Phase::Instantiated])?;
        self.phase = Phase::Initialization;
        Ok(())
    }

    /// Leave the initialization: what is set then is what the unit begins with.
    ///
    /// # Errors
    /// The instance is not in its initialization, or what was set is no state.
    pub fn exit_initialization(&mut self) -> Result<(), CosimulationError> {
        self.in_phase("an end of the initialization", &[Phase::Initialization])?;
        if let Body::Plant(plant) = &mut self.body {
            plant.begin(&self.values[1..self.outputs])?;
        }
        (self.phase, self.is_stale) = (Phase::Stepping, true);
        Ok(())
    }

    /// A step from a time, s, of a length, s, with the inputs as they are.
    ///
    /// # Errors
    /// It begins at another time than the last one has ended, or its length is not positive, or what it does is not possible.
    pub fn step(&mut self, from_s: f64, step_s: f64) -> Result<(), CosimulationError> {
        self.in_phase("a step", &[Phase::Stepping])?;
        let time_s = self.time_s;
        let is_next = (from_s - time_s).abs() <= SAME_TIME * step_s + f64::EPSILON * time_s.abs();
        if !(step_s > 0.0 && step_s.is_finite() && is_next) {
            return Err(CosimulationError::Step { from_s, step_s, time_s });
        }
        let (settings, said) = self.values.split_at_mut(self.outputs);
        let done = match &mut self.body {
            Body::Plant(plant) => plant.step(&settings[1..], step_s),
            Body::Monitor(watch) => watch.row(from_s, &settings[1..], said),
        };
        done.map_err(|cause| CosimulationError::During { from_s, cause: Box::new(cause) })?;
        let to_s = from_s + step_s;
        (self.time_s, self.values[0], self.is_stale) = (to_s, to_s, true);
        Ok(())
    }

    /// There are no more steps.
    ///
    /// # Errors
    /// Rows that the monitor held back are not possible.
    pub fn terminate(&mut self) -> Result<(), CosimulationError> {
        self.in_phase("an end", &[Phase::Stepping])?;
        if let Body::Monitor(watch) = &mut self.body {
            watch.finish(&mut self.values[self.outputs..])?;
        }
        self.phase = Phase::Terminated;
        Ok(())
    }

    /// Begin again, with all that was set forgotten.
    ///
    /// # Errors
    /// Never of an instance that has begun once.
    pub fn reset(&mut self) -> Result<(), CosimulationError> {
        match &mut self.body {
            Body::Plant(plant) => plant.reset(),
            Body::Monitor(watch) => watch.reset()?,
        }
        self.begin_anew();
        Ok(())
    }

    /// Everything that it goes on from, as bytes.
    ///
    /// # Errors
    /// [`CosimulationError::Sealed`]: never.
    pub fn save(&self) -> Result<Vec<u8>, CosimulationError> {
        let body = match &self.body {
            Body::Plant(plant) => SavedBody::Plant(plant.save()),
            Body::Monitor(watch) => SavedBody::Monitor(watch.save()?),
        };
        let saved = Saved { phase: self.phase, time_s: self.time_s, values: self.values.clone(), body };
        Ok(sealed::encode(Kind::Instance, &saved, &self.fingerprint)?)
    }

    /// Whether a state can be gone back to.
    ///
    /// # Errors
    /// As [`Instance::restore`].
    pub fn check(&self, bytes: &[u8]) -> Result<(), CosimulationError> {
        self.saved(bytes).map(|_| ())
    }

    fn saved(&self, bytes: &[u8]) -> Result<Saved, CosimulationError> {
        let saved: Saved = sealed::decode(Kind::Instance, bytes, &self.fingerprint)?;
        let is_kind = matches!(
            (&self.body, &saved.body),
            (Body::Plant(_), SavedBody::Plant(_)) | (Body::Monitor(_), SavedBody::Monitor(_))
        );
        if saved.values.len() == self.values.len() && is_kind {
            return Ok(saved);
        }
        Err(sealed::SealError::Foreign(Kind::Instance).into())
    }

    /// Go back to what was saved, by this or another instance of the same unit.
    ///
    /// # Errors
    /// The bytes are damaged, of another version or of another unit; all is then as before.
    pub fn restore(&mut self, bytes: &[u8]) -> Result<(), CosimulationError> {
        let saved = self.saved(bytes)?;
        match (&mut self.body, &saved.body) {
            (Body::Plant(plant), SavedBody::Plant(course)) => {
                plant.restore(course.as_ref(), &saved.values[1..self.outputs])?;
            }
            (Body::Monitor(watch), SavedBody::Monitor(bytes)) => watch.restore(bytes)?,
            _ => {}
        }
        (self.phase, self.time_s, self.values, self.is_stale) =
            (saved.phase, saved.time_s, saved.values, true);
        Ok(())
    }
}
