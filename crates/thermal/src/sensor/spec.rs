//! Raw content of a `[[sensor]]` table. Fields are SI; the file may use any unit of the field's dimension.
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::{KindChoice, Pt100Class};

/// A sensor. In a scenario it is ideal unless its errors are stated, and what is stated with a standard deviation, a
/// tolerance or a class is drawn by the run's seed.
#[derive(Clone, Debug, Default, Deserialize, Serialize, JsonSchema, PartialEq)]
pub struct SensorSpec {
    /// Name; it becomes part of a column's name.
    pub name: String,
    /// What it reads; by default pressure for the name `pressure`, ambient for `ambient`, gas for `gas_<number>`, else
    /// surface.
    pub kind: Option<KindChoice>,
    /// Surface: where it sits: bottom, middle, shoulder, neck or valve; its name by default, without a leading `wall_`.
    pub place: Option<String>,
    /// Surface: distance from the outer bottom along the axis, instead of a place. Gas: vertical distance from there,
    /// instead of a cell.
    pub height_m: Option<f64>,
    /// Gas: cell of the model, 1 at the bottom; by default the number of the name `gas_<number>`.
    pub cell: Option<usize>,
    /// Surface: mounting coupling to the air, 0 (default) to 1: it reads `T_surface + coupling (T_air - T_surface)`.
    pub air_coupling: Option<f64>,
    /// Surface: standard deviation of the coupling, 0 by default.
    pub air_coupling_sd: Option<f64>,
    /// Immersion: coupling to the valve through its stem, 0 (default) to 1: it reads `T_gas + coupling (T_valve - T_gas)`.
    pub stem_coupling: Option<f64>,
    /// Immersion: standard deviation of the coupling, 0 by default.
    pub stem_coupling_sd: Option<f64>,
    /// Time constant of its first-order lag, 0 by default.
    pub lag_s: Option<f64>,
    /// Constant error of a temperature, 0 by default.
    pub offset_k: Option<f64>,
    /// Standard deviation of the constant error of a temperature, normal; 0 by default.
    pub offset_sd_k: Option<f64>,
    /// Largest deviation of a temperature from its stated offset; all within are equally likely.
    pub offset_tolerance_k: Option<f64>,
    /// Tolerance class after IEC 60751 (AA, A, B, C), instead of an offset tolerance: its tolerance at 20 °C.
    pub class: Option<Pt100Class>,
    /// Standard deviation of the white noise of a temperature, 0 by default.
    pub noise_k: Option<f64>,
    /// Standard deviation of the correlated noise of a temperature, 0 by default.
    pub correlated_noise_k: Option<f64>,
    /// Correlation time of the correlated noise.
    pub correlation_time_s: Option<f64>,
    /// Smallest step of a temperature; none by default.
    pub resolution_k: Option<f64>,
    /// Steady drift of a temperature, 0 by default.
    pub drift_k_s: Option<f64>,
    /// Random walk of a temperature's offset: the standard deviation that it reaches in `walk_time`; 0 by default.
    pub walk_sd_k: Option<f64>,
    /// Time in which the random walk reaches its standard deviation.
    pub walk_time_s: Option<f64>,
    /// Lowest temperature that can be a reading; a lower one is a fault. -90 °C outside, -180 °C in the gas by default.
    pub lowest_k: Option<f64>,
    /// Highest temperature that can be a reading; 150 °C outside, 330 °C in the gas by default.
    pub highest_k: Option<f64>,
    /// Constant error of a pressure, 0 by default.
    pub offset_pa: Option<f64>,
    /// Standard deviation of the constant error of a pressure, normal; 0 by default.
    pub offset_sd_pa: Option<f64>,
    /// Largest deviation of a pressure from its stated offset; all within are equally likely.
    pub offset_tolerance_pa: Option<f64>,
    /// Relative error of a transmitter's span, 0 by default.
    pub span_ratio: Option<f64>,
    /// Standard deviation of the relative error of the span, 0 by default.
    pub span_sd_ratio: Option<f64>,
    /// Error of a pressure per kelvin of the transmitter away from 15 °C, 0 by default.
    pub temperature_coefficient_pa_k: Option<f64>,
    /// Standard deviation of that error, 0 by default.
    pub temperature_coefficient_sd_pa_k: Option<f64>,
    /// Standard deviation of the white noise of a pressure, 0 by default.
    pub noise_pa: Option<f64>,
    /// Standard deviation of the correlated noise of a pressure, 0 by default.
    pub correlated_noise_pa: Option<f64>,
    /// Smallest step of a pressure; none by default.
    pub resolution_pa: Option<f64>,
    /// Steady drift of a pressure, 0 by default.
    pub drift_pa_s: Option<f64>,
    /// Random walk of a pressure's offset: the standard deviation that it reaches in `walk_time`; 0 by default.
    pub walk_sd_pa: Option<f64>,
    /// Upper end of a transmitter's range; a reading stays between -1.25 and 103.125 % of it (NAMUR NE 43). No end by
    /// default.
    pub full_scale_pa: Option<f64>,
    /// Whether a transmitter counts from the air's pressure and not from vacuum; false by default.
    pub gauge: Option<bool>,
    /// Gauge transmitters: altitude above the sea, which gives the air's pressure; 0 by default.
    pub altitude_m: Option<f64>,
    /// Probability that a reading is missing, 0 by default.
    pub dropout: Option<f64>,
}

/// Which sensors have a key.
#[derive(Clone, Copy)]
pub(super) enum KeyOf {
    /// All that measure a temperature.
    Temperature,
    /// All that measure a pressure.
    Pressure,
    /// Those of the kinds that list it, and what to say to others.
    Kind(&'static str),
}

impl SensorSpec {
    /// What the sensor reads: as stated, or as its name says.
    pub fn kind_or_default(&self) -> KindChoice {
        self.kind.unwrap_or_else(|| KindChoice::of_name(&self.name))
    }

    /// The table with the typical numbers of its kind wherever it says nothing.
    pub fn completed(&self) -> Self {
        let mut full = self.clone();
        (self.kind_or_default().kind().stated.typical)(&mut full);
        full
    }

    /// Value and standard deviation of its coupling; `None` for a kind that has none.
    pub fn coupling_mut(&mut self) -> Option<[&mut Option<f64>; 2]> {
        self.kind_or_default().kind().stated.coupling.map(|keys| keys(self))
    }

    /// Whether the table says how far the offset may be off.
    pub(super) fn says_offset(&self) -> bool {
        self.class.is_some()
            || self.offset_sd_k.is_some()
            || self.offset_tolerance_k.is_some()
            || self.offset_sd_pa.is_some()
            || self.offset_tolerance_pa.is_some()
    }

    /// The stated keys that do not belong to every sensor.
    pub(super) fn stated_keys(&self) -> impl Iterator<Item = (&'static str, KeyOf)> {
        use KeyOf::{Kind, Pressure, Temperature};
        let surface = Kind("it belongs to surface sensors");
        let immersion = Kind("it belongs to immersion sensors");
        [
            ("place", self.place.is_some(), surface),
            (
                "height_m",
                self.height_m.is_some(),
                Kind("it belongs to sensors on the surface and in the gas"),
            ),
            ("cell", self.cell.is_some(), Kind("it belongs to sensors in the gas")),
            ("air_coupling", self.air_coupling.is_some(), surface),
            ("air_coupling_sd", self.air_coupling_sd.is_some(), surface),
            ("stem_coupling", self.stem_coupling.is_some(), immersion),
            ("stem_coupling_sd", self.stem_coupling_sd.is_some(), immersion),
            ("offset_k", self.offset_k.is_some(), Temperature),
            ("offset_sd_k", self.offset_sd_k.is_some(), Temperature),
            ("offset_tolerance_k", self.offset_tolerance_k.is_some(), Temperature),
            ("class", self.class.is_some(), Temperature),
            ("noise_k", self.noise_k.is_some(), Temperature),
            ("correlated_noise_k", self.correlated_noise_k.is_some(), Temperature),
            ("resolution_k", self.resolution_k.is_some(), Temperature),
            ("drift_k_s", self.drift_k_s.is_some(), Temperature),
            ("walk_sd_k", self.walk_sd_k.is_some(), Temperature),
            ("lowest_k", self.lowest_k.is_some(), Temperature),
            ("highest_k", self.highest_k.is_some(), Temperature),
            ("offset_pa", self.offset_pa.is_some(), Pressure),
            ("offset_sd_pa", self.offset_sd_pa.is_some(), Pressure),
            ("offset_tolerance_pa", self.offset_tolerance_pa.is_some(), Pressure),
            ("span_ratio", self.span_ratio.is_some(), Pressure),
            ("span_sd_ratio", self.span_sd_ratio.is_some(), Pressure),
            ("temperature_coefficient_pa_k", self.temperature_coefficient_pa_k.is_some(), Pressure),
            ("temperature_coefficient_sd_pa_k", self.temperature_coefficient_sd_pa_k.is_some(), Pressure),
            ("noise_pa", self.noise_pa.is_some(), Pressure),
            ("correlated_noise_pa", self.correlated_noise_pa.is_some(), Pressure),
            ("resolution_pa", self.resolution_pa.is_some(), Pressure),
            ("drift_pa_s", self.drift_pa_s.is_some(), Pressure),
            ("walk_sd_pa", self.walk_sd_pa.is_some(), Pressure),
            ("full_scale_pa", self.full_scale_pa.is_some(), Pressure),
            ("gauge", self.gauge.is_some(), Pressure),
            ("altitude_m", self.altitude_m.is_some(), Pressure),
        ]
        .into_iter()
        .filter_map(|(key, stated, of)| stated.then_some((key, of)))
    }
}
