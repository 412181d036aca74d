//! Everything that can be wrong with the input of this crate, and what its numerics can refuse.
use crate::problem::Problem;
use alloc::boxed::Box;
use alloc::string::String;
use alloc::string::ToString;

/// A number of a message without the digits that a change of units leaves, 126.192 and not 126.19200000000001, and with an exponent
/// where it would have a row of zeros.
pub fn shown(value: f64) -> String {
    let rounded: f64 = format!("{value:.9e}").parse().unwrap_or(value);
    let plain = rounded == 0.0 || !rounded.is_finite() || (1e-7..1e15).contains(&rounded.abs());
    if plain { rounded.to_string() } else { format!("{rounded:e}") }
}

/// Errors of the thermal crate. Messages are fragments that name value, bound and remedy.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum ThermalError {
    /// A value of a specification, or of what was made of one, cannot be used.
    #[error("{problem}")]
    Specification {
        /// Path of the value by field names, e.g. `layer[1].thickness_m`.
        path: String,
        /// What is wrong with it.
        problem: Box<Problem>,
    },
    /// A line of a document cannot be used.
    #[cfg(feature = "files")]
    #[error("{file}:{line}: {problem}")]
    Document {
        /// File as the caller named it.
        file: String,
        /// Line, from 1.
        line: usize,
        /// What is wrong there.
        problem: Box<Problem>,
    },
    /// A name that is no built-in vessel or scenario.
    #[error("no built-in {kind} {name}{nearest}; there are {known}")]
    UnknownPreset {
        /// `vessel` or `scenario`.
        kind: &'static str,
        /// Name as given.
        name: String,
        /// Suggestion, empty or `, did you mean ...?`.
        nearest: String,
        /// The built-in names.
        known: String,
    },
    /// A specification that has no TOML form.
    #[error("the specification cannot be written as TOML: {message}")]
    Unwritable {
        /// The writer's words.
        message: String,
    },
    /// Times and values of a series differ in number, or there are none.
    #[error("a series needs as many times as values and at least one, not {times} times and {values} values")]
    SeriesLengths {
        /// Number of times.
        times: usize,
        /// Number of values.
        values: usize,
    },
    /// A series holds NaN or an infinity.
    #[error("row {row} of the series is not a finite number: write a number or leave the row out")]
    SeriesNotFinite {
        /// Row, from 1.
        row: usize,
    },
    /// A series goes back in time.
    #[error(
        "row {row} of the series goes back in time, from {previous_s} s to {time_s} s: sort the rows by time"
    )]
    SeriesGoesBack {
        /// Row, from 1.
        row: usize,
        /// Time of this row, s.
        time_s: f64,
        /// Time of the row before, s.
        previous_s: f64,
    },
    /// Three knots at one time.
    #[error("row {row} of the series is the third at {time_s} s: a jump takes two rows, before and after")]
    SeriesTripleTime {
        /// Row, from 1.
        row: usize,
        /// Time, s.
        time_s: f64,
    },
    // --- fluid ---
    /// The fluid is not known.
    #[error("fluid {name} is not known{nearest}; known are {known}")]
    UnknownFluid {
        /// Name given.
        name: String,
        /// Suggestion, empty or `, did you mean ...?`.
        nearest: String,
        /// All names.
        known: String,
    },
    /// The temperature is outside the equation's range.
    #[error(
        "temperature {} K of {fluid} must lie between {lowest_k} K and {highest_k} K, the range of its equation of state",
        shown(*.temperature_k)
    )]
    TemperatureOutside {
        /// Fluid.
        fluid: &'static str,
        /// Temperature, K.
        temperature_k: f64,
        /// Lower bound, K.
        lowest_k: f64,
        /// Upper bound, K.
        highest_k: f64,
    },
    /// The pressure is outside the equation's range.
    #[error(
        "pressure {} Pa of {fluid} must be positive and at most {highest_pa} Pa, the range of its equation of state",
        shown(*.pressure_pa)
    )]
    PressureOutside {
        /// Fluid.
        fluid: &'static str,
        /// Pressure, Pa.
        pressure_pa: f64,
        /// Upper bound, Pa.
        highest_pa: f64,
    },
    /// The state is on the solid side of the melting line.
    #[error(
        "{fluid} at {} Pa and {} K is solid (melting pressure {melting_pa:.4e} Pa): lower the pressure or raise the temperature",
        shown(*.pressure_pa), shown(*.temperature_k)
    )]
    Solid {
        /// Fluid.
        fluid: &'static str,
        /// Pressure, Pa.
        pressure_pa: f64,
        /// Temperature, K.
        temperature_k: f64,
        /// Melting pressure, Pa.
        melting_pa: f64,
    },
    /// The density is outside the equation's range.
    #[error("density {} kg/m3 of {fluid} must be positive and at most {highest_kg_m3:.1} kg/m3", shown(*.density_kg_m3))]
    DensityOutside {
        /// Fluid.
        fluid: &'static str,
        /// Density, kg/m³.
        density_kg_m3: f64,
        /// Upper bound, kg/m³.
        highest_kg_m3: f64,
    },
    /// A pressure belongs to a density beyond the domain.
    #[error(
        "{fluid} at {} Pa is denser than {highest_kg_m3:.1} kg/m3, the bound of its domain: lower the pressure or raise the temperature",
        shown(*.pressure_pa)
    )]
    TooDense {
        /// Fluid.
        fluid: &'static str,
        /// Pressure, Pa.
        pressure_pa: f64,
        /// Upper bound of the density, kg/m³.
        highest_kg_m3: f64,
    },
    /// The state is between vapour and liquid.
    #[error(
        "{fluid} at {temperature_k:.3} K and {density_kg_m3:.3} kg/m3 is two-phase (vapour up to {vapour_kg_m3:.3}, liquid from {liquid_kg_m3:.3} kg/m3): only single-phase gas is modelled"
    )]
    TwoPhase {
        /// Fluid.
        fluid: &'static str,
        /// Temperature, K.
        temperature_k: f64,
        /// Density, kg/m³.
        density_kg_m3: f64,
        /// Density of the saturated vapour, kg/m³.
        vapour_kg_m3: f64,
        /// Density of the saturated liquid, kg/m³.
        liquid_kg_m3: f64,
    },
    /// A gas that condenses at room temperature is liquid or two-phase.
    #[error(
        "{fluid} at {temperature_k:.2} K is liquid or two-phase from {:.1} bar absolute on, in a cylinder at 15 degC from {:.1} bar on, and cylwatch \
         treats one phase only: stay below that pressure or above that temperature",
        .saturation_pa / 1e5, .at_15_degc_pa / 1e5
    )]
    Condensed {
        /// Fluid.
        fluid: &'static str,
        /// Temperature, K.
        temperature_k: f64,
        /// Saturation pressure, Pa.
        saturation_pa: f64,
        /// Saturation pressure at 15 °C, Pa.
        at_15_degc_pa: f64,
    },
    /// A mixture between its dew and its bubble line.
    #[error(
        "{fluid} at {} Pa and {} K is between its dew line ({dew_pa:.0} Pa) and its bubble line ({bubble_pa:.0} Pa), part vapour and part \
         liquid: only single-phase states are modelled",
        shown(*.pressure_pa), shown(*.temperature_k)
    )]
    BetweenDewAndBubble {
        /// Fluid.
        fluid: &'static str,
        /// Pressure, Pa.
        pressure_pa: f64,
        /// Temperature, K.
        temperature_k: f64,
        /// Pressure at which the vapour begins to condense, Pa.
        dew_pa: f64,
        /// Pressure at which the liquid begins to boil, Pa.
        bubble_pa: f64,
    },
    /// An enthalpy or entropy between vapour and liquid.
    #[error(
        "{fluid} at {} Pa is two-phase at its boiling temperature {saturation_k:.3} K: only single-phase states are modelled",
        shown(*.pressure_pa)
    )]
    TwoPhaseIsobar {
        /// Fluid.
        fluid: &'static str,
        /// Pressure, Pa.
        pressure_pa: f64,
        /// Saturation temperature, K.
        saturation_k: f64,
    },
    /// Pressure and temperature on the saturation line do not fix the density.
    #[error(
        "{fluid} at {} Pa and {} K is on its saturation line ({} Pa): pressure and temperature do not fix the density",
        shown(*.pressure_pa), shown(*.temperature_k), shown(*.saturation_pa)
    )]
    OnSaturation {
        /// Fluid.
        fluid: &'static str,
        /// Pressure, Pa.
        pressure_pa: f64,
        /// Temperature, K.
        temperature_k: f64,
        /// Saturation pressure, Pa.
        saturation_pa: f64,
    },
    /// Too near the critical point.
    #[error(
        "{fluid} at {temperature_k:.3} K is within 0.5 % below its critical temperature {} K, where its phase is not resolved: stay outside",
        shown(*.critical_k)
    )]
    NearCritical {
        /// Fluid.
        fluid: &'static str,
        /// Temperature, K.
        temperature_k: f64,
        /// Critical temperature, K.
        critical_k: f64,
    },
    /// No temperature has the energy.
    #[error(
        "no temperature gives {fluid} at {} kg/m3 the internal energy {} J/kg",
        shown(*.density_kg_m3), shown(*.energy_j_kg)
    )]
    NoTemperature {
        /// Fluid.
        fluid: &'static str,
        /// Density, kg/m³.
        density_kg_m3: f64,
        /// Internal energy, J/kg.
        energy_j_kg: f64,
    },
    /// No state on an isobar.
    #[error(
        "no state of {fluid} at {} Pa inside the domain has the {property} {} (SI)",
        shown(*.pressure_pa), shown(*.target)
    )]
    NoState {
        /// Fluid.
        fluid: &'static str,
        /// Pressure, Pa.
        pressure_pa: f64,
        /// Which property.
        property: &'static str,
        /// Its value, SI.
        target: f64,
    },
    // --- flow and simulation ---
    /// The throat of an orifice has no single-phase state.
    #[error(
        "no critical flow of {fluid} from {pressure_pa:.0} Pa and {temperature_k:.2} K: \
         the throat leaves the fluid's domain; warm the gas or end the flow earlier"
    )]
    NoThroat {
        /// Stagnation pressure, Pa.
        pressure_pa: f64,
        /// Stagnation temperature, K.
        temperature_k: f64,
        /// Fluid.
        fluid: String,
    },
    /// The source of a refill has no usable state.
    #[error("the source of {flow}: {cause}")]
    Source {
        /// Name of the refill.
        flow: String,
        /// What is wrong with its gas.
        cause: Box<ThermalError>,
    },
    /// No temperature and volume belong to the gas's mass and energy.
    #[error(
        "no gas state has mass {mass_kg} kg and internal energy {energy_j} J: the vessel is empty or the step was too long"
    )]
    NoGasState {
        /// Gas mass, kg.
        mass_kg: f64,
        /// Internal energy, J.
        energy_j: f64,
    },
    /// A gas cell is too small for what flows through it.
    #[error(
        "{flow_kg_s:.3} kg/s through a gas cell of {mass_kg:.1e} kg, one of {cells}, is more than neighbours of one pressure pass on: \
         take at most {at_most} gas cells, or model = \"well-mixed\""
    )]
    GasCellTooSmall {
        /// Mass flow across the vessel's boundary, kg/s.
        flow_kg_s: f64,
        /// Gas in the cell at the valve, kg.
        mass_kg: f64,
        /// Number of gas cells.
        cells: usize,
        /// Number with which the cell would be large enough, roughly.
        at_most: usize,
    },
    /// A refill of gas in layers.
    #[error(
        "{flow}: a refill of stratified gas is not simulated, since no model of what its jet mixes holds on measured fills: \
         take model = \"well-mixed\" under [gas]"
    )]
    FillOfLayers {
        /// Name of the refill.
        flow: String,
    },
    /// A setting of the simulation is out of range.
    #[error("setting {setting} = {value} must lie between {low} and {high}")]
    Setting {
        /// Name.
        setting: &'static str,
        /// Value given.
        value: f64,
        /// Lower bound.
        low: f64,
        /// Upper bound.
        high: f64,
    },
    /// The solver refused the problem.
    #[error("the solver cannot start: {reason}")]
    SolverSetup {
        /// What it said.
        reason: String,
    },
    /// A neighbour has another mesh or number of gas cells than the run.
    #[error(
        "neighbour {index} of the run has another mesh or number of gas cells: change values, not shapes"
    )]
    NeighbourOfAnotherShape {
        /// Its place in the list, from 0.
        index: usize,
    },
    /// A state vector of something else.
    #[error(
        "the state of a step has {found} numbers and not {expected}: it is that of another vessel or other flows"
    )]
    StateLength {
        /// As many as it has.
        expected: usize,
        /// Found.
        found: usize,
    },
    /// The solver cannot go on.
    #[error(
        "the integration stops at {time_s:.3} s (gas {gas_k:.2} K, {pressure_pa:.0} Pa): {reason}; \
         try a larger relative tolerance or a scenario with milder rates"
    )]
    Integration {
        /// Time, s.
        time_s: f64,
        /// Mean gas temperature, K.
        gas_k: f64,
        /// Pressure, Pa.
        pressure_pa: f64,
        /// What the solver said.
        reason: String,
    },
    /// The caller wanted the run to end.
    #[error("stopped at {time_s:.3} s of the scenario")]
    Stopped {
        /// Time, s.
        time_s: f64,
    },
    /// Something else went wrong at a time of a run.
    #[error("at {time_s:.3} s of the scenario: {cause}")]
    AtTime {
        /// Time, s.
        time_s: f64,
        /// What went wrong.
        cause: Box<ThermalError>,
    },
}

impl ThermalError {
    /// The same error with the time of the run at which it happened.
    #[cfg(feature = "simulate")]
    pub(crate) fn at_time(self, time_s: f64) -> Self {
        match self {
            Self::AtTime { .. } => self,
            cause => Self::AtTime { time_s, cause: Box::new(cause) },
        }
    }
}
