//! The cylinder as a [`StateSpace`]: transition from the thermal model's own equations, outputs from the sensors.
//!
//! One step is an exponential Rosenbrock-Euler step: with `f` and `A = df/dx` at its start,
//! `x(t + h) = x + h phi_1(hA) f`, `F = exp(hA)`, of order 2 and exact where `f` is linear, whatever the step. The
//! exponential is a Taylor series over the few rows that are coupled (wall, valve, gas, mass, sensor lags); walks
//! with memory decay in closed form, constants stay. Process noise is integrated over the step,
//! `Q = int exp(As) diag(q) exp(As)^T ds`, by Gauss's rule with two points, of order 4: two columns of
//! [`Linearisation::g`] for each source. Intervals longer than the settings allow are divided, and the noise of
//! the parts is gathered into the same number of columns.
use nalgebra::DMatrix;

use super::settings::{LeakHypothesis, ObserverSettings, Walk};
use super::states::{StateKind, States};
use crate::EstimatorError;
use crate::filter::{Linearisation, StateSpace};
use crate::sensor::{Exposure, MAX_PARAMETERS, ParameterKind, Sensor, SensorKind};
use crate::thermal::model::reduced::{ReducedModel, SurfaceState, Unknowns, WarmStart};
use crate::thermal::vessel::Vessel;

/// A term of the series below this part of the largest sum is the last.
const SERIES_TOLERANCE: f64 = 1e-12;
const MAX_TERMS: usize = 60;
/// Least film outside, by radiation alone, and the largest, in a gale, W/(m² K).
const LEAST_FILM_W_M2_K: f64 = 4.0;
const LARGEST_FILM_W_M2_K: f64 = 80.0;
/// Bound on the logarithm of the inside film's multiplier.
const LN_INSIDE_BOUND: f64 = 1.5;
/// Bound on a coupling above its prior mean, in standard deviations of the prior.
const COUPLING_BOUND_SD: f64 = 2.5;
/// Points of Gauss's two-point rule on [0, 1].
const GAUSS: [f64; 2] = [0.211_324_865_405_187_1, 0.788_675_134_594_812_9];

/// What a sensor looks at.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Target {
    /// A place on the surface.
    Surface(SurfaceState),
    /// The gas.
    Gas,
    Air,
    Pressure,
}

/// Slow motion of a constant: `d(x - rest) = -decay (x - rest) dt + w`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SlowProcess {
    /// Variance gained in a second.
    pub intensity: f64,
    /// Inverse memory, 1/s; 0: a random walk.
    pub decay_per_s: f64,
    /// Value that it returns to.
    pub rest: f64,
}

impl SlowProcess {
    /// Factor on the departure from rest, and variance gained, over an interval, s.
    pub fn over(&self, dt_s: f64) -> (f64, f64) {
        let decay = self.decay_per_s * dt_s;
        let span_s = if decay > 0.0 { -(-2.0 * decay).exp_m1() / (2.0 * self.decay_per_s) } else { dt_s };
        ((-decay).exp(), self.intensity * span_s)
    }
}

/// The cylinder with its sensors in the variables of [`States`].
#[derive(Clone, Debug)]
pub struct Cylinder {
    model: ReducedModel,
    sensors: Vec<Sensor>,
    targets: Vec<Target>,
    states: States,
    settings: ObserverSettings,
    /// Variance that the noise adds to each leading state in a second.
    intensity: Vec<f64>,
    /// Inverse memory of each leading state that walks alone, 1/s.
    decay: Vec<f64>,
    /// Value that each leading state with a memory returns to.
    rest: Vec<f64>,
    /// Leading states with coupled rows of the transition, and the others.
    coupled: Vec<usize>,
    alone: Vec<usize>,
    /// Leading states that noise drives.
    sources: Vec<usize>,
    /// Interval since each sensor's last sample, s: how much of the model error it has seen before.
    interval_s: Vec<f64>,
    work: Work,
}

/// Reused memory of one step. Rows of a coupled state are `n + 1` long: the state's columns, then the mean's increment.
#[derive(Clone, Debug, Default)]
struct Work {
    rate: Vec<f64>,
    jacobian: DMatrix<f64>,
    /// `A` and right-hand side: coupled rows.
    a: Vec<f64>,
    /// Current term `(hA)^k / k!`: coupled rows.
    term: Vec<f64>,
    next: Vec<f64>,
    /// Sum of the terms, and the same at the two Gauss points.
    sum: Vec<f64>,
    at_gauss: [Vec<f64>; 2],
    /// Current term of the states that walk alone: of the transition, and of the mean.
    alone_term: Vec<f64>,
    alone_mean: Vec<f64>,
    part: Option<Box<Parts>>,
}

/// Reused memory of a divided interval.
#[derive(Clone, Debug)]
struct Parts {
    step: Linearisation,
    phi: DMatrix<f64>,
    noise: DMatrix<f64>,
}

impl Cylinder {
    /// A vessel seen by sensors.
    ///
    /// # Errors
    /// A setting is out of its bounds, no sensor is given, two have one name, or one sits where the vessel has no place.
    pub fn new(
        vessel: &Vessel,
        sensors: &[Sensor],
        settings: &ObserverSettings,
    ) -> Result<Self, EstimatorError> {
        settings.validate()?;
        let model = ReducedModel::new(vessel, settings.wall_nodes, settings.film_w_m2_k);
        let states = States::new(&model, sensors, settings);
        let targets =
            sensors.iter().map(|sensor| target(sensor, &model, vessel)).collect::<Result<_, _>>()?;
        if let Some(twice) =
            sensors.iter().enumerate().find(|(i, s)| sensors[..*i].iter().any(|o| o.name == s.name))
        {
            return Err(EstimatorError::SensorTwice { name: twice.1.name.clone() });
        }
        let walks_alone = |kind: &StateKind| {
            matches!(kind, StateKind::Leak | StateKind::Air | StateKind::OutsideFilm | StateKind::Sun)
        };
        let leading = &states.kinds[..states.leading];
        let split = |alone: bool| -> Vec<usize> {
            (0..leading.len()).filter(|&i| walks_alone(&leading[i]) == alone).collect()
        };
        let (coupled, alone) = (split(false), split(true));
        let sources = (0..leading.len()).filter(|&i| !matches!(leading[i], StateKind::Lag { .. })).collect();
        let (n, rows) = (states.count(), coupled.len());
        let zeros = || vec![0.0; rows * (n + 1)];
        let work = Work {
            rate: vec![0.0; model.states()],
            jacobian: DMatrix::zeros(model.states(), model.states() + Unknowns::COUNT),
            a: zeros(),
            term: zeros(),
            next: zeros(),
            sum: zeros(),
            at_gauss: [zeros(), zeros()],
            alone_term: vec![0.0; alone.len()],
            alone_mean: vec![0.0; alone.len()],
            part: None,
        };
        let mut cylinder = Self {
            interval_s: vec![f64::INFINITY; sensors.len()],
            intensity: vec![0.0; states.leading],
            decay: vec![0.0; states.leading],
            rest: vec![0.0; states.leading],
            sensors: sensors.to_vec(),
            targets,
            states,
            settings: settings.clone(),
            coupled,
            alone,
            sources,
            work,
            model,
        };
        cylinder.set_walks();
        cylinder.suppose(&settings.bank[0]);
        Ok(cylinder)
    }

    /// What each state is.
    pub fn state_map(&self) -> &States {
        &self.states
    }

    /// The sensors.
    pub fn sensors(&self) -> &[Sensor] {
        &self.sensors
    }

    /// The settings.
    pub fn settings(&self) -> &ObserverSettings {
        &self.settings
    }

    /// The thermal model.
    pub fn model(&mut self) -> &mut ReducedModel {
        &mut self.model
    }

    /// Where the model's iterations start next.
    pub(super) fn warm_start(&self) -> WarmStart {
        self.model.warm_start()
    }

    /// Whether a sensor reads the gas pressure.
    pub fn reads_pressure(&self, sensor: usize) -> bool {
        self.targets[sensor] == Target::Pressure
    }

    /// Longest step of the transition, s.
    pub fn set_longest_step_s(&mut self, longest_step_s: f64) {
        self.settings.longest_step_s = longest_step_s;
    }

    /// Let mass and leak rate walk as one member of the bank supposes.
    pub fn suppose(&mut self, leak: &LeakHypothesis) {
        self.intensity[self.states.mass] = leak.mass_walk_kg_per_sqrt_s.powi(2);
        self.intensity[self.states.leak] = leak.rate.per_sqrt_s.powi(2);
        self.decay[self.states.leak] = leak.rate.decay_per_s();
    }

    /// Whether a state has gas, at temperatures and a density that the equation of state knows.
    pub fn is_possible(&mut self, x: &[f64]) -> bool {
        let domain = self.model.fluid().domain();
        let temperatures = domain.lowest_temperature_k..=domain.highest_temperature_k;
        let warm = |state: usize| temperatures.contains(&x[state]);
        let mass_kg = x[self.states.mass];
        (0..self.states.wall).chain(self.states.valve).chain([self.states.gas]).all(warm)
            && mass_kg > 0.0
            && mass_kg <= self.model.highest_mass_kg()
    }

    /// Interval since the last sample of a sensor, s.
    pub fn set_interval_s(&mut self, sensor: usize, interval_s: f64) {
        self.interval_s[sensor] = interval_s;
    }

    /// Interval since the last sample of a sensor, s.
    pub fn interval_s(&self, sensor: usize) -> f64 {
        self.interval_s[sensor]
    }

    /// Pressure at a state, Pa.
    ///
    /// # Errors
    /// The state has no gas.
    pub fn pressure_pa(&mut self, x: &[f64]) -> Result<f64, EstimatorError> {
        let n = self.model.states();
        Ok(self.model.pressure(&x[..n])?.pressure_pa)
    }

    /// How a trailing state moves while nobody looks.
    pub fn slow_process(&self, state: usize) -> SlowProcess {
        let of = |walk: &Walk, rest| SlowProcess {
            intensity: walk.per_sqrt_s * walk.per_sqrt_s,
            decay_per_s: walk.decay_per_s(),
            rest,
        };
        match &self.states.kinds[state] {
            StateKind::InsideFilm => of(&self.settings.ln_inside_film, 0.0),
            StateKind::Capacity => of(&self.settings.ln_capacity, 0.0),
            StateKind::FilmSlope => of(&self.settings.film_slope, 0.0),
            StateKind::Parameter { sensor, parameter } => {
                let parameter = &self.sensors[*sensor].parameters()[*parameter];
                let walk = self.settings.walk_of(parameter, self.sensors[*sensor].quantity());
                of(&walk, parameter.mean)
            }
            _ => SlowProcess { intensity: 0.0, decay_per_s: 0.0, rest: 0.0 },
        }
    }

    /// Values of a state that can be; beyond them an estimate has left what it knows.
    pub fn bounds(&self, state: usize) -> Option<(f64, f64)> {
        let film_w_m2_k = self.settings.film_w_m2_k;
        match &self.states.kinds[state] {
            StateKind::OutsideFilm => {
                Some(((LEAST_FILM_W_M2_K / film_w_m2_k).ln(), (LARGEST_FILM_W_M2_K / film_w_m2_k).ln()))
            }
            StateKind::InsideFilm => Some((-LN_INSIDE_BOUND, LN_INSIDE_BOUND)),
            StateKind::Parameter { sensor, parameter } => {
                let parameter = &self.sensors[*sensor].parameters()[*parameter];
                let (low, high) = parameter.domain();
                (parameter.kind == ParameterKind::Coupling)
                    .then(|| (low, high.min(parameter.mean + COUPLING_BOUND_SD * parameter.sd)))
            }
            _ => None,
        }
    }

    fn set_walks(&mut self) {
        let s = &self.settings;
        self.rest[self.states.air] = s.air_rest_k;
        for (i, kind) in self.states.kinds[..self.states.leading].iter().enumerate() {
            let (walk, decay) = match kind {
                StateKind::Wall(_) | StateKind::Valve => (s.temperature_walk_k_per_sqrt_s, 0.0),
                StateKind::Gas => (s.gas_walk_k_per_sqrt_s, 0.0),
                StateKind::Air => (s.air.per_sqrt_s, s.air.decay_per_s()),
                StateKind::OutsideFilm => (s.ln_outside_film.per_sqrt_s, s.ln_outside_film.decay_per_s()),
                StateKind::Sun => (s.sun.per_sqrt_s, s.sun.decay_per_s()),
                _ => continue,
            };
            self.intensity[i] = walk * walk;
            self.decay[i] = decay;
        }
    }

    fn unknowns(&self, x: &[f64]) -> Unknowns {
        let value = |state: Option<usize>| state.map_or(0.0, |i| x[i]);
        Unknowns {
            air_k: x[self.states.air],
            ln_outside_film: value(self.states.outside),
            ln_inside_film: value(self.states.inside),
            ln_capacity: value(self.states.capacity),
            sun_w: value(self.states.sun),
            film_slope: value(self.states.slope),
            outflow_kg_s: x[self.states.leak],
        }
    }

    /// `A` and the right-hand side of the coupled rows at `x`.
    fn linearise(&mut self, x: &[f64]) -> Result<(), EstimatorError> {
        let (n, physical) = (self.states.count(), self.model.states());
        let unknowns = self.unknowns(x);
        let Work { rate, jacobian, a, .. } = &mut self.work;
        self.model.rates(&x[..physical], &unknowns, rate, Some(jacobian))?;
        a.fill(0.0);
        let states = &self.states;
        let columns = [
            Some(states.air),
            states.outside,
            states.inside,
            states.capacity,
            states.sun,
            states.slope,
            Some(states.leak),
        ];
        for (row, &state) in a.chunks_exact_mut(n + 1).zip(&self.coupled) {
            if state >= physical {
                continue;
            }
            for (to, column) in row.iter_mut().zip(0..physical) {
                *to = jacobian[(state, column)];
            }
            for (unknown, column) in columns.iter().enumerate() {
                if let Some(column) = column {
                    row[*column] = jacobian[(state, physical + unknown)];
                }
            }
            row[n] = rate[state];
        }
        self.linearise_lags(x)
    }

    /// Rows of the sensors' lags: `dz/dt = (y - z) / tau`.
    fn linearise_lags(&mut self, x: &[f64]) -> Result<(), EstimatorError> {
        let n = self.states.count();
        for sensor in 0..self.sensors.len() {
            let Some(state) = self.states.lag[sensor] else { continue };
            let rate = self.sensors[sensor].lag_s().recip();
            let row = self.coupled.iter().position(|&i| i == state).expect("a lag is coupled");
            let mut a = std::mem::take(&mut self.work.a);
            let row = &mut a[row * (n + 1)..(row + 1) * (n + 1)];
            let reading = self.static_reading(sensor, x, Some(row));
            row[..n].iter_mut().for_each(|by| *by *= rate);
            row[state] -= rate;
            let outcome = reading.map(|reading| row[n] = rate * (reading - x[state]));
            self.work.a = a;
            outcome?;
        }
        Ok(())
    }

    /// Temperature of a place on the surface, K.
    fn surface_k(&self, place: SurfaceState, x: &[f64]) -> f64 {
        let departure = self.states.valve.map_or(0.0, |valve| x[valve] - x[self.states.wall - 1]);
        let sun_w = self.states.sun.map_or(0.0, |sun| x[sun]);
        x[place.state] + place.valve_share * departure + place.sun_rise_k_w * sun_w
    }

    /// Reading of a sensor before its lag, with its gradient.
    fn static_reading(
        &mut self,
        sensor: usize,
        x: &[f64],
        gradient: Option<&mut [f64]>,
    ) -> Result<f64, EstimatorError> {
        let (states, target) = (&self.states, self.targets[sensor]);
        let electronics = states.valve.unwrap_or(states.wall - 1);
        let pressure = match target {
            Target::Pressure => Some(self.model.pressure(&x[..self.model.states()])?),
            _ => None,
        };
        let exposure = Exposure {
            body_k: match target {
                Target::Surface(place) => self.surface_k(place, x),
                Target::Gas => x[states.gas],
                Target::Air | Target::Pressure => 0.0,
            },
            air_k: x[states.air],
            pressure_pa: pressure.map_or(0.0, |p| p.pressure_pa),
            electronics_k: x[electronics],
        };
        let object = &self.sensors[sensor];
        let mut parameters: [f64; MAX_PARAMETERS] = object.means();
        for (value, state) in parameters.iter_mut().zip(&states.parameters[sensor]) {
            if let Some(state) = state {
                *value = x[*state];
            }
        }
        let prediction = object.predict(&exposure, &parameters);
        let Some(h) = gradient else { return Ok(prediction.value) };
        h.fill(0.0);
        match target {
            Target::Surface(place) => {
                h[place.state] += prediction.per_body;
                if let Some(valve) = states.valve {
                    h[valve] += prediction.per_body * place.valve_share;
                    h[states.wall - 1] -= prediction.per_body * place.valve_share;
                }
                if let Some(sun) = states.sun {
                    h[sun] += prediction.per_body * place.sun_rise_k_w;
                }
            }
            Target::Gas => h[states.gas] += prediction.per_body,
            Target::Air | Target::Pressure => {}
        }
        h[states.air] += prediction.per_air;
        if let Some(p) = pressure {
            h[states.gas] += prediction.per_pressure * p.per_gas_k;
            h[states.mass] += prediction.per_pressure * p.per_mass_kg;
            for (node, by) in h[..states.wall].iter_mut().enumerate() {
                *by += prediction.per_pressure * p.per_wall_k * self.model.mean_wall_per_node(x, node);
            }
            h[electronics] += prediction.per_electronics;
        }
        for (by, state) in prediction.per_parameter.iter().zip(&states.parameters[sensor]) {
            if let Some(state) = state {
                h[*state] += by;
            }
        }
        Ok(prediction.value)
    }

    /// Sum the series of the exponential over a step of `h` seconds; noise points only where `noise`.
    fn sum_series(&mut self, x: &[f64], h: f64, noise: bool) {
        let stride = self.states.count() + 1;
        let Work { a, term, next, sum, at_gauss, alone_term, alone_mean, .. } = &mut self.work;
        for (to, from) in term.iter_mut().zip(a.iter()) {
            *to = h * from;
        }
        for ((term, mean), &state) in alone_term.iter_mut().zip(alone_mean.iter_mut()).zip(&self.alone) {
            *term = -h * self.decay[state];
            *mean = *term * (x[state] - self.rest[state]);
        }
        sum.copy_from_slice(term);
        for (points, at) in at_gauss.iter_mut().zip(GAUSS) {
            points.iter_mut().zip(term.iter()).for_each(|(to, from)| *to = at * from);
        }
        for k in 2..MAX_TERMS {
            let scale = h / k as f64;
            for (to, a) in next.chunks_exact_mut(stride).zip(a.chunks_exact(stride)) {
                to.fill(0.0);
                for (from, &state) in term.chunks_exact(stride).zip(&self.coupled) {
                    let factor = scale * a[state];
                    if factor != 0.0 {
                        to.iter_mut().zip(from).for_each(|(to, from)| *to += factor * from);
                    }
                }
                for ((term, mean), &state) in alone_term.iter().zip(alone_mean.iter()).zip(&self.alone) {
                    to[state] += scale * a[state] * term;
                    to[stride - 1] += scale * a[state] * mean;
                }
            }
            for ((term, mean), &state) in alone_term.iter_mut().zip(alone_mean.iter_mut()).zip(&self.alone) {
                let factor = -scale * self.decay[state];
                *term *= factor;
                *mean *= factor;
            }
            std::mem::swap(term, next);
            let mut largest = 0.0_f64;
            for (to, from) in sum.iter_mut().zip(term.iter()) {
                *to += from;
                largest = largest.max(from.abs() - SERIES_TOLERANCE * to.abs());
            }
            if noise {
                for (points, at) in at_gauss.iter_mut().zip(GAUSS) {
                    let power = at.powi(k as i32);
                    points.iter_mut().zip(term.iter()).for_each(|(to, from)| *to += power * from);
                }
            }
            if largest <= 1e-16 {
                break;
            }
        }
    }

    /// Transition and noise of the step just summed.
    fn write_linearisation(&self, h: f64, linear: &mut Linearisation) {
        let stride = self.states.count() + 1;
        let Linearisation { phi, g, q } = linear;
        phi.fill(0.0);
        g.fill(0.0);
        for (row, &state) in self.work.sum.chunks_exact(stride).zip(&self.coupled) {
            for (column, value) in row[..stride - 1].iter().enumerate() {
                phi[(state, column)] = *value;
            }
            phi[(state, state)] += 1.0;
        }
        for &state in &self.alone {
            phi[(state, state)] = (-h * self.decay[state]).exp();
        }
        for (index, &source) in self.sources.iter().enumerate() {
            for (point, at) in GAUSS.into_iter().enumerate() {
                let column = 2 * index + point;
                q[column] = 0.5 * h * self.intensity[source];
                for (row, &state) in self.work.at_gauss[point].chunks_exact(stride).zip(&self.coupled) {
                    g[(state, column)] = row[source];
                }
                if self.coupled.contains(&source) {
                    g[(source, column)] += 1.0;
                } else {
                    g[(source, column)] = (-h * at * self.decay[source]).exp();
                }
            }
        }
    }

    /// One undivided step.
    fn step(
        &mut self,
        x: &mut [f64],
        h: f64,
        linear: Option<&mut Linearisation>,
    ) -> Result<(), EstimatorError> {
        self.linearise(x)?;
        self.sum_series(x, h, linear.is_some());
        let stride = self.states.count() + 1;
        for (row, &state) in self.work.sum.chunks_exact(stride).zip(&self.coupled) {
            x[state] += row[stride - 1];
        }
        for &state in &self.alone {
            let rest = self.rest[state];
            x[state] = rest + (x[state] - rest) * (-h * self.decay[state]).exp();
        }
        if let Some(linear) = linear {
            self.write_linearisation(h, linear);
        }
        Ok(())
    }

    /// Several steps as one transition; the noise of the parts becomes a triangular factor.
    fn divided(
        &mut self,
        x: &mut [f64],
        h: f64,
        parts: usize,
        linear: &mut Linearisation,
    ) -> Result<(), EstimatorError> {
        let (n, leading) = (self.states.count(), self.states.leading);
        let mut memory = self.work.part.take().unwrap_or_else(|| {
            Box::new(Parts {
                step: Linearisation::zeros(n, leading, 2 * self.sources.len()),
                phi: DMatrix::zeros(leading, n),
                noise: DMatrix::zeros(leading, leading),
            })
        });
        let Parts { step, phi, noise } = memory.as_mut();
        phi.fill_with_identity();
        noise.fill(0.0);
        for _ in 0..parts {
            self.step(x, h, Some(step))?;
            let moved = step.phi.columns(0, leading) * &*phi;
            let constant = step.phi.columns(leading, n - leading).into_owned();
            phi.copy_from(&moved);
            let mut tail = phi.columns_mut(leading, n - leading);
            tail += constant;
            let spread = step.phi.columns(0, leading) * &*noise * step.phi.columns(0, leading).transpose();
            *noise = spread + &step.g * DMatrix::from_diagonal(&step.q) * step.g.transpose();
        }
        linear.phi.copy_from(phi);
        linear.g.fill(0.0);
        linear.q.fill(0.0);
        triangular_factor(noise, linear);
        self.work.part = Some(memory);
        Ok(())
    }
}

/// `Q = L diag(q) L^T` with unit lower triangular `L`, columns without variance left zero.
fn triangular_factor(noise: &mut DMatrix<f64>, linear: &mut Linearisation) {
    let n = noise.nrows();
    for j in 0..n {
        let d = noise[(j, j)];
        if d <= f64::MIN_POSITIVE {
            continue;
        }
        linear.q[j] = d;
        for i in j..n {
            linear.g[(i, j)] = noise[(i, j)] / d;
        }
        for i in j..n {
            for k in j..n {
                noise[(i, k)] -= d * linear.g[(i, j)] * linear.g[(k, j)];
            }
        }
    }
}

fn target(sensor: &Sensor, model: &ReducedModel, vessel: &Vessel) -> Result<Target, EstimatorError> {
    Ok(match &sensor.kind {
        SensorKind::Surface { place } => Target::Surface(model.surface(place).ok_or_else(|| {
            EstimatorError::SensorPlace { name: sensor.name.clone(), vessel: vessel.name.clone() }
        })?),
        SensorKind::Gas { .. } => Target::Gas,
        SensorKind::Ambient => Target::Air,
        SensorKind::Pressure { .. } => Target::Pressure,
    })
}

impl StateSpace for Cylinder {
    type Error = EstimatorError;

    fn states(&self) -> usize {
        self.states.count()
    }

    fn leading(&self) -> usize {
        self.states.leading
    }

    fn noises(&self) -> usize {
        2 * self.sources.len()
    }

    fn outputs(&self) -> usize {
        self.sensors.len()
    }

    fn propagate(
        &mut self,
        x: &mut [f64],
        dt_s: f64,
        linear: Option<&mut Linearisation>,
    ) -> Result<(), EstimatorError> {
        let parts = (dt_s / self.settings.longest_step_s).ceil().max(1.0) as usize;
        let h = dt_s / parts as f64;
        match linear {
            Some(linear) if parts > 1 => self.divided(x, h, parts, linear),
            linear @ Some(_) => self.step(x, h, linear),
            None => (0..parts).try_for_each(|_| self.step(x, h, None)),
        }
    }

    fn output(&mut self, j: usize, x: &[f64], h: Option<&mut [f64]>) -> Result<f64, EstimatorError> {
        let Some(state) = self.states.lag[j] else { return self.static_reading(j, x, h) };
        if let Some(h) = h {
            h.fill(0.0);
            h[state] = 1.0;
        }
        Ok(x[state])
    }

    fn noise_variance(&self, j: usize, x: &[f64]) -> f64 {
        let error = &self.settings.model_error;
        let states = &self.states;
        let square = |v: f64| v * v;
        let model = match self.targets[j] {
            Target::Gas => square(error.gas_k),
            Target::Surface(place) => {
                let away_k = x[states.air] - self.surface_k(place, x);
                square(error.surface_k) + square(error.surface_per_air_k * away_k)
            }
            Target::Air => square(error.air_k),
            Target::Pressure => {
                let wall_k = self.model.mean_wall_k(x);
                square(error.pressure_pa) + square(error.pressure_per_wall_k * (wall_k - x[states.gas]))
            }
        };
        let again = (error.correlation_s / self.interval_s[j]).max(1.0);
        self.sensors[j].noise_variance() + model * again
    }
}
