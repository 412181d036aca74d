//! Typical sensors, for a log of which nothing but its columns is known.
use super::Sensor;
use crate::EstimatorError;
use cylwatch_thermal::sensor::SensorSpec;
use cylwatch_thermal::units::BAR_PA;

/// Ranges of pressure gauges, bar.
///
/// # References
/// EN 837-1:1996, 5.2.
const RANGES_BAR: [f64; 15] =
    [1.6, 2.5, 4.0, 6.0, 10.0, 16.0, 25.0, 40.0, 60.0, 100.0, 160.0, 250.0, 400.0, 600.0, 1000.0];
/// What a range has to hold beyond the pressure of the fill at 15 °C: nitrogen of 200 bar has 1.25 times that at 65 °C, at which a cylinder is tested.
const RESERVE: f64 = 1.2;

impl Sensor {
    /// The typical sensor of a log's column: `shoulder`, `valve`, `wall_<place>`, `ambient`, `pressure`, `gas_<k>`.
    ///
    /// # Errors
    /// [`EstimatorError::Thermal`] for a name that says no place.
    pub fn typical(name: &str) -> Result<Self, EstimatorError> {
        let spec = SensorSpec { name: name.to_owned(), ..SensorSpec::default() };
        Self::try_from(&spec.completed())
    }

    /// The typical transmitter of a vessel whose fill has such a pressure at 15 °C, Pa: with the smallest range that holds 1.2 times that.
    ///
    /// # Errors
    /// As [`Sensor::typical`].
    pub fn typical_transmitter(name: &str, full_pa: f64) -> Result<Self, EstimatorError> {
        let full_scale_pa = Some(full_scale_pa(full_pa));
        let spec = SensorSpec { name: name.to_owned(), full_scale_pa, ..SensorSpec::default() };
        Self::try_from(&spec.completed())
    }

    /// A gauge of an accuracy class, a part of its range, for a fill of such a pressure at 15 °C, Pa, with the smallest range that holds 1.2 times that. It reads anything
    /// within its class.
    ///
    /// # Errors
    /// As [`Sensor::typical`].
    ///
    /// # References
    /// EN 837-1:1996, 6.
    pub fn typical_gauge(name: &str, full_pa: f64, class: f64) -> Result<Self, EstimatorError> {
        let full_scale_pa = full_scale_pa(full_pa);
        let offset_tolerance_pa = Some(class * full_scale_pa);
        let full_scale_pa = Some(full_scale_pa);
        let spec =
            SensorSpec { name: name.to_owned(), full_scale_pa, offset_tolerance_pa, ..SensorSpec::default() };
        Self::try_from(&spec.completed())
    }

    /// The typical thermometer on the wall at a height above the outer bottom, m: `wall_<height in mm>mm`.
    ///
    /// # Errors
    /// As [`Sensor::typical`].
    pub fn typical_at_height(height_m: f64) -> Result<Self, EstimatorError> {
        let name = format!("wall_{:.0}mm", 1e3 * height_m);
        let spec = SensorSpec { name, height_m: Some(height_m), ..SensorSpec::default() };
        Self::try_from(&spec.completed())
    }
}

/// The smallest range of EN 837-1 that a fill of such a pressure at 15 °C is read with, Pa.
fn full_scale_pa(full_pa: f64) -> f64 {
    let range_bar = RANGES_BAR.into_iter().find(|range_bar| range_bar * BAR_PA >= RESERVE * full_pa);
    range_bar.map_or(RESERVE * full_pa, |range_bar| range_bar * BAR_PA)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sensor::SensorKind;

    #[test]
    fn a_transmitter_has_the_range_that_a_plant_builder_would_order() {
        for (full_bar, range_bar) in
            [(4.0, 6.0), (200.0, 250.0), (208.0, 250.0), (300.0, 400.0), (700.0, 1000.0), (1500.0, 1800.0)]
        {
            let transmitter = Sensor::typical_transmitter("pressure", 1e5 * full_bar).unwrap();
            let SensorKind::Pressure { full_scale_pa: Some(scale_pa), .. } = transmitter.kind else {
                panic!()
            };
            assert_eq!(scale_pa, 1e5 * range_bar, "{full_bar} bar");
        }
        assert_eq!(
            Sensor::typical_transmitter("pressure", 200e5).unwrap(),
            Sensor::typical("pressure").unwrap()
        );
    }
}
