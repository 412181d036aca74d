//! One estimate as a row of a CSV file or of a JSON array.
use crate::estimator::observer::Estimate;
use crate::thermal::units::{PASCAL_PER_BAR, ZERO_CELSIUS_K};
use std::fmt::Write;

const GRAM_PER_HOUR: f64 = 3.6e6;
const SECONDS_PER_HOUR: f64 = 3600.0;

/// Columns of an estimate.
pub const COLUMNS: [&str; 13] = [
    "time_s",
    "gas_mean_degc",
    "gas_mean_sd_k",
    "mass_kg",
    "mass_sd_g",
    "leak_g_h",
    "leak_sd_g_h",
    "leak_bar_h",
    "pressure_bar",
    "pressure_expected_bar",
    "p15_bar",
    "verdict",
    "quality",
];

/// What the columns mean, for a help page.
pub const DOCUMENTATION: &str = "\
Columns (empty where nothing is known; sd is a standard deviation):
  time_s                 of the row; counted from the first row where the log has dates
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
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct EstimateRow {
    /// Estimate.
    pub estimate: Estimate,
    /// The leak as fall of the pressure settled at 15 °C, Pa/s; NaN: unknown.
    pub leak_pa_s: f64,
}

impl EstimateRow {
    /// Numbers of the row in the order of [`COLUMNS`], with the decimals that are worth writing.
    fn numbers(&self) -> [(f64, usize); 11] {
        let e = &self.estimate;
        [
            (e.time_s, usize::MAX),
            (e.gas_mean_k - ZERO_CELSIUS_K, 4),
            (e.gas_mean_sd_k, 4),
            (e.mass_kg, 6),
            (e.mass_sd_kg * 1e3, 4),
            (e.leak_kg_s * GRAM_PER_HOUR, 6),
            (e.leak_sd_kg_s * GRAM_PER_HOUR, 6),
            (self.leak_pa_s / PASCAL_PER_BAR * SECONDS_PER_HOUR, 8),
            (e.pressure_pa / PASCAL_PER_BAR, 5),
            (e.pressure_expected_pa / PASCAL_PER_BAR, 5),
            (e.p15_pa / PASCAL_PER_BAR, 5),
        ]
    }
}

/// Names of the columns as a line, without its end.
pub fn csv_header() -> String {
    COLUMNS.join(",")
}

/// Appends a row with its line feed.
pub fn csv_row(row: &EstimateRow, text: &mut String) {
    // The verdict is the monitor's.
    csv_cells(row, "", text);
    text.push('\n');
}

/// Appends a row as a JSON array.
pub fn json_row(row: &EstimateRow, text: &mut String) {
    text.push('[');
    json_cells(row, None, text);
    text.push(']');
}

/// Appends the cells of a row with a verdict.
pub(in crate::report) fn csv_cells(row: &EstimateRow, verdict: &str, text: &mut String) {
    for number in row.numbers() {
        push_number(number, "", text);
        text.push(',');
    }
    text.push_str(verdict);
    text.push(',');
    text.push_str(row.estimate.quality.as_str());
}

/// Appends the values of a row as elements of a JSON array; no verdict is null.
pub(in crate::report) fn json_cells(row: &EstimateRow, verdict: Option<&str>, text: &mut String) {
    for number in row.numbers() {
        push_number(number, "null", text);
        text.push(',');
    }
    match verdict {
        Some(verdict) => _ = write!(text, "\"{verdict}\""),
        None => text.push_str("null"),
    }
    _ = write!(text, ",\"{}\"", row.estimate.quality.as_str());
}

/// Appends a number with so many decimals (`usize::MAX`: all that it has), or what stands for a missing one.
pub(in crate::report) fn push_number((value, decimals): (f64, usize), missing: &str, text: &mut String) {
    match decimals {
        _ if !value.is_finite() => text.push_str(missing),
        // Adding zero turns a negative zero into a positive one; writing to a string does not fail.
        usize::MAX if value.fract() != 0.0 => _ = write!(text, "{}", value + 0.0),
        usize::MAX => push_fixed(value, 0, text),
        _ => push_fixed(value, decimals, text),
    }
}

/// Appends a number with so many decimals; the general formatter of the standard library, which is exact to the last
/// of all digits, would take longer than reading, and a year has 35 million numbers.
fn push_fixed(value: f64, decimals: usize, text: &mut String) {
    const EXACT: f64 = 9_007_199_254_740_992.0;
    let power = 10_u64.pow(decimals as u32);
    let scaled = (value.abs() * power as f64).round();
    if scaled >= EXACT {
        _ = write!(text, "{value:.decimals$}");
        return;
    }
    let (mut rest, mut cells) = (scaled as u64, [0_u8; 24]);
    let mut at = cells.len();
    for place in 0.. {
        if place > decimals && rest == 0 {
            break;
        }
        at -= 1;
        if place == decimals && decimals > 0 {
            cells[at] = b'.';
            at -= 1;
        }
        cells[at] = b'0' + (rest % 10) as u8;
        rest /= 10;
    }
    if value < 0.0 && scaled > 0.0 {
        text.push('-');
    }
    text.extend(cells[at..].iter().map(|&digit| char::from(digit)));
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::estimator::observer::Quality;

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
        EstimateRow { estimate, leak_pa_s: 1.0 }
    }

    #[test]
    fn a_row_has_the_units_of_its_columns_and_empty_cells_for_what_is_missing() {
        let mut text = String::new();
        csv_row(&row(), &mut text);
        // 1e-6 kg/s are 3.6 g/h, 1 Pa/s is 0.036 bar/h.
        let expected = "0.5,15.0000,0.2500,4.500000,2.0000,3.600000,0.036000,0.03600000,,200.00000,199.00000,,degraded\n";
        assert_eq!(text, expected);
        assert_eq!(text.matches(',').count() + 1, COLUMNS.len());
    }

    #[test]
    fn a_json_row_is_an_array_with_null_for_what_is_missing() {
        let mut text = String::new();
        json_row(&row(), &mut text);
        let values: Vec<serde_json::Value> = serde_json::from_str(&text).unwrap();
        assert_eq!(values.len(), COLUMNS.len());
        assert!(values[8].is_null() && values[11].is_null());
        assert_eq!((values[0].as_f64(), values[12].as_str()), (Some(0.5), Some("degraded")));
    }

    proptest::proptest! {
        #[test]
        fn a_fixed_number_is_within_half_a_last_digit_and_written_as_the_standard_library_does(
            value in -1e7..1e7_f64,
            decimals in 0..9_usize,
        ) {
            let mut text = String::new();
            push_fixed(value, decimals, &mut text);
            let read: f64 = text.parse().unwrap();
            let half_a_digit = 0.5 * 10f64.powi(-(decimals as i32));
            proptest::prop_assert!((read - value).abs() <= half_a_digit + 1e-15 * value.abs());
            let written = format!("{read:.decimals$}");
            proptest::prop_assert_eq!(text, if read == 0.0 { written.replace('-', "") } else { written });
        }
    }

    #[test]
    fn small_whole_and_huge_numbers_keep_their_places() {
        for (value, decimals, expected) in [
            (0.0, 0, "0"),
            (-0.0, 3, "0.000"),
            (0.05, 1, "0.1"),
            (-0.049, 1, "0.0"),
            (9.9996, 3, "10.000"),
            (-12.5, 2, "-12.50"),
            (1e15, 3, "1000000000000000.000"),
            (7.0, usize::MAX, "7"),
            (-7.25, usize::MAX, "-7.25"),
            (1e17, usize::MAX, "100000000000000000"),
        ] {
            let mut text = String::new();
            push_number((value, decimals), "", &mut text);
            assert_eq!(text, expected);
        }
    }

    #[test]
    fn nothing_is_minus_zero() {
        let mut text = String::new();
        push_number((-1e-9, 4), "", &mut text);
        assert_eq!(text, "0.0000");
    }
}
