//! The columns of an estimate.
use crate::estimator::observer::Estimate;
use crate::report::{BAR_PER_HOUR, Digits, Field, GRAM, GRAM_PER_HOUR};
use crate::thermal::units::{BAR_PA, ZERO_CELSIUS_K};

/// What the columns mean, for a help page.
pub(crate) const DOCUMENTATION: &str = "\
Columns (empty where nothing is known; sd is a standard deviation):
  time_s                 of the row; counted from the first row where the log has dates
  time                   the date of the row in the zone of the log, where it has dates
  gas_mean_degc, _sd_k   mean temperature of the gas
  mass_kg, mass_sd_g     mass of the gas; fast losses show here at once
  leak_g_h, leak_sd_g_h  rate of a slow, lasting leak, averaged over days
  leak_bar_h             the same as fall of p15_bar
  pressure_bar           pressure as read, absolute
  pressure_expected_bar  what the sensor would read with the mass of a day after the first row
                         (until then: with the mass as estimated)
  p15_bar                pressure of this mass when all is at 15 degC
  verdict                empty: `estimate` does not decide
  quality                good, degraded (a reading is missing or refused), predicted (none),
                         open (mass is free after many refusals) or restarted";

/// An estimate with what a file says beside it.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct EstimateRow {
    /// Date; empty: the log has none.
    pub time: String,
    /// Estimate.
    pub estimate: Estimate,
    /// The leak as fall of the pressure settled at 15 °C, Pa/s; NaN: unknown.
    pub leak_pa_s: f64,
    /// The monitor's verdict; empty: the observer alone does not decide.
    pub verdict: &'static str,
}

impl AsRef<Self> for EstimateRow {
    fn as_ref(&self) -> &Self {
        self
    }
}

/// Columns of an estimate, with the decimals that are worth writing; `time` where the log has dates.
pub(crate) fn fields<R: AsRef<EstimateRow>>(has_dates: bool) -> Vec<Field<R>> {
    use Digits::{All, Decimals};
    let time_s = Field::number("time_s", All, |row: &R| row.as_ref().estimate.time_s);
    let time = has_dates.then(|| Field::text("time", |row: &R| row.as_ref().time.as_str()));
    let values = [
        Field::number("gas_mean_degc", Decimals(4), |row: &R| {
            row.as_ref().estimate.gas_mean_k - ZERO_CELSIUS_K
        }),
        Field::number("gas_mean_sd_k", Decimals(4), |row| row.as_ref().estimate.gas_mean_sd_k),
        Field::number("mass_kg", Decimals(6), |row| row.as_ref().estimate.mass_kg),
        Field::number("mass_sd_g", Decimals(4), |row| row.as_ref().estimate.mass_sd_kg * GRAM),
        Field::number("leak_g_h", Decimals(6), |row| row.as_ref().estimate.leak_kg_s * GRAM_PER_HOUR),
        Field::number("leak_sd_g_h", Decimals(6), |row| row.as_ref().estimate.leak_sd_kg_s * GRAM_PER_HOUR),
        Field::number("leak_bar_h", Decimals(8), |row| row.as_ref().leak_pa_s * BAR_PER_HOUR),
        Field::number("pressure_bar", Decimals(5), |row| row.as_ref().estimate.pressure_pa / BAR_PA),
        Field::number("pressure_expected_bar", Decimals(5), |row| {
            row.as_ref().estimate.pressure_expected_pa / BAR_PA
        }),
        Field::number("p15_bar", Decimals(5), |row| row.as_ref().estimate.p15_pa / BAR_PA),
        Field::text("verdict", |row| row.as_ref().verdict),
        Field::text("quality", |row| row.as_ref().estimate.quality.as_str()),
    ];
    [time_s].into_iter().chain(time).chain(values).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::estimator::observer::Quality;
    use crate::report::{RowFormat, Rows};

    fn row() -> EstimateRow {
        let estimate = Estimate {
            time_s: 0.5,
            gas_mean_k: 288.15,
            gas_mean_sd_k: 0.25,
            mass_kg: 4.5,
            mass_sd_kg: 2e-3,
            leak_kg_s: 1e-6,
            leak_sd_kg_s: 1e-8,
            pressure_pa: f64::NAN,
            pressure_expected_pa: 200e5,
            p15_pa: 199e5,
            quality: Quality::Degraded,
        };
        EstimateRow { time: String::new(), estimate, leak_pa_s: 1.0, verdict: "" }
    }

    #[test]
    fn a_row_has_the_units_of_its_columns_and_empty_cells_for_what_is_missing() {
        let mut rows = Rows::new(fields(false), RowFormat::Csv);
        // 1e-6 kg/s are 3.6 g/h, 1 Pa/s is 0.036 bar/h.
        let expected = "0.5,15.0000,0.2500,4.500000,2.0000,3.600000,0.036000,0.03600000,,200.00000,199.00000,,degraded\n";
        assert_eq!(rows.row(&row()), expected);
    }

    #[test]
    fn a_row_of_a_log_with_dates_has_its_date_beside_its_time() {
        let mut rows = Rows::new(fields(true), RowFormat::Csv);
        assert!(rows.header().starts_with("time_s,time,gas_mean_degc,"));
        let row = EstimateRow { time: "2026-10-25T02:30:00+01:00".to_owned(), ..row() };
        assert!(rows.row(&row).starts_with("0.5,2026-10-25T02:30:00+01:00,15.0000,"));
    }

    #[test]
    fn a_json_row_is_an_array_with_null_for_what_is_missing() {
        let mut rows = Rows::new(fields(false), RowFormat::Json);
        let values: Vec<serde_json::Value> = serde_json::from_str(rows.row(&row())).unwrap();
        assert_eq!(values.len(), fields::<EstimateRow>(false).len());
        assert!(values[8].is_null() && values[11].is_null());
        assert_eq!((values[0].as_f64(), values[12].as_str()), (Some(0.5), Some("degraded")));
    }
}
