//! Everything that can go wrong in this crate.
use alloc::string::String;
use cylwatch_thermal::shown;

/// What went wrong, with the offending value, the bound and the remedy.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum EstimatorError {
    /// The caller has given the work up.
    #[error("given up by the caller")]
    Abandoned,
    /// The thermal model refused.
    #[error(transparent)]
    Thermal(#[from] cylwatch_thermal::ThermalError),
    /// A covariance holds NaN or an infinity.
    #[error("covariance element ({row}, {column}) is not a finite number")]
    CovarianceNotFinite {
        /// Row, from 0.
        row: usize,
        /// Column, from 0.
        column: usize,
    },
    /// A covariance is not symmetric.
    #[error("covariance elements ({row}, {column}) = {upper} and ({column}, {row}) = {lower} must be equal")]
    CovarianceNotSymmetric {
        /// Row, from 0.
        row: usize,
        /// Column, from 0.
        column: usize,
        /// Element above the diagonal.
        upper: f64,
        /// Its mirror image.
        lower: f64,
    },
    /// A covariance is not positive semi-definite.
    #[error(
        "covariance is not positive semi-definite: of the variance {variance} of state {state} the others \
         leave {left}; lower its covariances or raise its variance"
    )]
    CovarianceIndefinite {
        /// State, from 0.
        state: usize,
        /// Its variance.
        variance: f64,
        /// What is left of it when others are known.
        left: f64,
    },
    /// A setting of the observer is out of its bounds.
    #[error("observer setting `{setting}` = {} must be {bound}", shown(*.value))]
    ObserverSetting {
        /// Name of the setting.
        setting: &'static str,
        /// Its value.
        value: f64,
        /// What it must be.
        bound: &'static str,
    },
    /// Two sensors have one name.
    #[error("sensor `{name}` is there twice; give each sensor a name of its own")]
    SensorTwice {
        /// The name.
        name: String,
    },
    /// A sensor sits where the vessel has nothing.
    #[error(
        "sensor `{name}` sits where `{vessel}` has no place: surface sensors sit at bottom, middle, shoulder, neck, a \
         height on the wall, or the valve if the vessel has one"
    )]
    SensorPlace {
        /// Name of the sensor.
        name: String,
        /// Name of the vessel.
        vessel: String,
    },
    /// An observer without sensors.
    #[error("an observer needs at least one sensor")]
    NoSensors,
    /// A row of readings of another length.
    #[error("the observer has {expected} sensors, but the row has {found} readings")]
    RowLength {
        /// Number of sensors.
        expected: usize,
        /// Number of readings.
        found: usize,
    },
    /// Time that runs backwards, or is no number.
    #[error("time {time_s} s must be a number not before the last sample at {last_s} s")]
    TimeBackwards {
        /// Time of the row, s.
        time_s: f64,
        /// Time of the last row, s; NaN: there was none.
        last_s: f64,
    },
    /// A covariance has no inverse, and one is needed.
    #[error(
        "the covariance has no inverse: other states explain state {state}; leave out what is known exactly"
    )]
    CovarianceSingular {
        /// State, from 0.
        state: usize,
    },
    /// A noise variance cannot be used.
    #[error("noise variance {variance} must be positive")]
    NoiseNotPositive {
        /// Variance as given, in the square of the output's unit.
        variance: f64,
    },
    /// A step goes back in time.
    #[error("interval {interval_s} s must not be negative: sort the samples by time")]
    IntervalNegative {
        /// Interval, s.
        interval_s: f64,
    },
    /// Readings and outputs differ in number.
    #[error("{readings} readings for {outputs} outputs: give one per output, NaN where there is none")]
    ReadingsLength {
        /// Number of readings.
        readings: usize,
        /// Number of outputs.
        outputs: usize,
    },
    /// A state or its covariance does not fit the process.
    #[error("state or covariance of length {length} for a process of {states} states")]
    StateLength {
        /// Length as given.
        length: usize,
        /// Number of states.
        states: usize,
    },
    /// A state is NaN or infinite.
    #[error("state {state} is not a finite number")]
    StateNotFinite {
        /// State, from 0.
        state: usize,
    },
    /// A transition holds NaN, an infinity, or a negative noise variance.
    #[error("the linearised transition must be finite, its noise variances not negative")]
    LinearisationUnusable,
    /// An output or its gradient is NaN or infinite.
    #[error("output {output} or its gradient is not a finite number")]
    OutputNotFinite {
        /// Output, from 0.
        output: usize,
    },
    /// The covariance of a filter grows without bound.
    #[error(
        "the filter has no steady state: a state that moves or is driven by noise is not seen by the outputs"
    )]
    NoSteadyState,
    /// A layout of sensors does not see a state.
    #[error(
        "the sensors do not see the state {state}: its error grows without bound; add a sensor that reads it"
    )]
    Unseen {
        /// Name of the state.
        state: String,
    },
    /// A quantity that a layout of sensors should know is none that is estimated.
    #[cfg(feature = "design")]
    #[error("the {quantity:?} is no state of this member of the bank: take one whose leak rate walks")]
    PlacementQuantity {
        /// The quantity.
        quantity: crate::placement::Quantity,
    },
    /// What is asked of a layout of sensors contradicts itself.
    #[error("no layout of sensors can be: {what}")]
    PlacementConstraints {
        /// The contradiction.
        what: String,
    },
    /// A setting of a placement is out of its range.
    #[error("placement setting {setting} = {value} must be {bound}")]
    PlacementSetting {
        /// Setting by its field name.
        setting: &'static str,
        /// As given.
        value: f64,
        /// Its range.
        bound: &'static str,
    },
    /// The program that bounds the layouts of sensors has no solution.
    #[error(
        "the bound of the layouts could not be computed: {what}; try fewer candidates or a shorter window"
    )]
    PlacementProgram {
        /// What happened.
        what: &'static str,
    },
    /// A setting of a moving-horizon estimator is out of its range.
    #[error("moving-horizon setting {name} = {value} must be {bound}")]
    HorizonSetting {
        /// Setting by its field name.
        name: &'static str,
        /// As given.
        value: f64,
        /// Its range.
        bound: &'static str,
    },
    /// A prior is not of the process's size.
    #[error(
        "a process of {states} states needs a prior mean of as many, not {mean}, and a square covariance, not {rows} x {columns}"
    )]
    HorizonPrior {
        /// States of the process.
        states: usize,
        /// Length of the mean.
        mean: usize,
        /// Rows of the covariance.
        rows: usize,
        /// Columns of the covariance.
        columns: usize,
    },
    /// A prior mean holds NaN or an infinity.
    #[error("prior mean {value} of state {state} must be finite")]
    HorizonPriorNotFinite {
        /// State, from 0.
        state: usize,
        /// Its mean.
        value: f64,
    },
    /// A constraint names a state that is not there.
    #[error("constraint {row} names state {state}, but states run from 0 to {} only", .states - 1)]
    ConstraintState {
        /// Constraint, from 0.
        row: usize,
        /// State that it names.
        state: usize,
        /// Number of states.
        states: usize,
    },
    /// A constraint is no inequality.
    #[error("constraint {row}: {reason}")]
    ConstraintRow {
        /// Constraint, from 0.
        row: usize,
        /// What it must be.
        reason: &'static str,
    },
    /// A sensor on a place that the vessel does not have.
    #[error(
        "sensor {name} needs {missing}, which vessel {vessel} does not have: give it another place or leave it out"
    )]
    SensorMisfit {
        /// Name of the sensor.
        name: String,
        /// Name of the vessel.
        vessel: String,
        /// What is missing.
        missing: String,
    },
    /// A time that cannot be sampled.
    #[error(
        "sampling time {number}, {time_s} s, must be later than the one before and lie within the trajectory, \
         {from_s} s to {to_s} s"
    )]
    SampleTime {
        /// Which one, from 1.
        number: usize,
        /// The time, s.
        time_s: f64,
        /// Start of the trajectory, s.
        from_s: f64,
        /// End of the trajectory, s.
        to_s: f64,
    },
    /// A trajectory without samples.
    #[error("the trajectory has no samples: simulate at least one")]
    EmptyTrajectory,
    /// An engine of the observer that is not there.
    #[error("there is no filter `{word}`: take ekf, ukf, stationary or mhe")]
    EngineUnknown {
        /// As given.
        word: String,
    },
    /// An engine whose pass cannot be smoothed.
    #[error("only ekf and ukf can be smoothed: the gains of the others are not those of their covariance")]
    EngineNotSmoothed,
    /// A smoother without room.
    #[error("a smoother needs room for {rows} rows: at least 2")]
    SmootherRows {
        /// As given.
        rows: usize,
    },
    /// An observer that has begun.
    #[error("the observer has already taken samples: smooth from the first one")]
    ObserverBegun,
    /// A significance that is no probability.
    #[error("significance {probability} must be a probability between 0 and 1, such as 0.01")]
    Significance {
        /// As given.
        probability: f64,
    },
    /// A time that an ensemble does not have.
    #[error("index {index} is beyond the {times} times of the ensemble")]
    TimeUnknown {
        /// Index, from 0.
        index: usize,
        /// Number of times.
        times: usize,
    },
    /// A bound that needs noise on every moving state.
    #[error(
        "the noise is singular where transitions differ from path to path: give these states noise, or take the mean transition"
    )]
    BoundNoiseSingular,
    /// Errors that nothing can be concluded from.
    #[error(
        "the errors of {runs} runs have no spread to compare with a bound: give at least two runs with errors"
    )]
    NoErrors {
        /// Number of runs.
        runs: usize,
    },
    /// A bound without paths.
    #[error("the bound needs at least one true path")]
    NoPaths,
    /// An observer without a sample.
    #[error("the observer has not taken a sample yet")]
    NoEstimate,
    /// The filter is not part of this build.
    #[error("this build has the extended filter alone: build it with the feature `design` for the others")]
    EngineMissing,
    /// A snapshot of another observer.
    #[error(
        "the snapshot is that of an observer of another cylinder, other sensors or another bank: begin anew"
    )]
    SnapshotForeign,
    /// A number of a snapshot that no observer can have had.
    #[error("`{what}` = {} of the snapshot must be {bound}: begin anew", shown(*.value))]
    SnapshotValue {
        /// Name of the number.
        what: &'static str,
        /// Its value.
        value: f64,
        /// What it must be.
        bound: &'static str,
    },
    /// What was learnt is of another version of its format.
    #[error("what was learnt has version {found}, this program reads {expected}: learn again")]
    LearnedVersion {
        /// Version as found.
        found: u32,
        /// Version that is read.
        expected: u32,
    },
    /// What was learnt is no mean with its covariance.
    #[error(
        "names, means and covariance of what was learnt must have matching lengths and be numbers: learn again"
    )]
    LearnedInconsistent,
    /// What was learnt is of another vessel.
    #[error("this was learnt on `{learned}`, and this is `{vessel}`: learn on this one")]
    LearnedForeign {
        /// Vessel that it was learnt on.
        learned: String,
        /// Vessel that it was given for.
        vessel: String,
    },
    /// Nothing could be identified.
    #[cfg(feature = "design")]
    #[error(transparent)]
    Identify(#[from] crate::identify::IdentifyError),
    /// Nothing could be calibrated.
    #[cfg(feature = "design")]
    #[error(transparent)]
    Calibrate(#[from] crate::calibrate::CalibrateError),
}
