//! The columns of an output of the monitor: those of an estimate, then the decision.
use super::reaction_word;
use crate::detector::monitor::Output;
use crate::report::estimate::{self, EstimateRow};
use crate::report::{Clock, Digits, Field, GRAM, GRAM_PER_HOUR};
use crate::thermal::units::BAR_PA;

/// Standard deviations between the bounds of a 95 % interval.
const INTERVAL_SD: f64 = 2.0 * 1.959_963_984_540_054;

/// What the columns mean, for a help page.
pub(crate) const DOCUMENTATION: &str = "\
Columns (those of `estimate`, then):
  leak_g_h, leak_sd_g_h  while a leak is found, the one that explains the masses best, else the
                         observer's; leak_bar_h is the same as fall of p15_bar
  mass_kg, mass_sd_g     while a leak is found, by the observer's freest member, which does not
                         lag; so p15_bar and cold_pressure_bar
  verdict                tight, leak, discharge, refill, sensor fault or unknown
  leak_probability       that gas is being lost, by the evidence; empty while there is none
  leak_low_g_h, _high_   95 % interval of the leak that is found; else from 0 to the largest that
                         the masses leave room for
  onset_s                when it began
  lost_g                 gas lost since
  cold_pressure_bar      what the transmitter would show at the coldest temperature expected
  reaction               none, next-interval, as-soon-as-possible or shutdown; empty: not known yet
  reason                 why the verdict is unknown";

/// An output as a file has it.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct MonitorRow {
    estimate: EstimateRow,
    leak_probability: f64,
    leak_low_kg_s: f64,
    leak_high_kg_s: f64,
    onset_s: f64,
    lost_kg: f64,
    cold_pressure_pa: f64,
    reaction: &'static str,
    reason: &'static str,
}

impl AsRef<EstimateRow> for MonitorRow {
    fn as_ref(&self) -> &EstimateRow {
        &self.estimate
    }
}

impl MonitorRow {
    /// Of an output; `leak_pa_s` is the observer's leak rate as fall of the pressure settled at 15 °C, Pa/s; NaN: unknown. A leak that is
    /// found stands in place of the observer's rate.
    pub(crate) fn new(output: &Output, leak_pa_s: f64, clock: &Clock) -> Self {
        let Output { decision, leak_rate_kg_s, leak, .. } = output;
        let verdict = decision.verdict.as_str();
        let time = clock.date_of_log(output.stamp_s).unwrap_or_default();
        let mut row = EstimateRow { time, estimate: output.estimate, leak_pa_s, verdict };
        row.estimate.time_s = output.stamp_s;
        // Until a leak is found its rate is as uncertain as the masses leave it, not as one member of the bank supposes.
        let uncertain_kg_s = leak_rate_kg_s.high / (0.5 * INTERVAL_SD);
        row.estimate.leak_sd_kg_s = row.estimate.leak_sd_kg_s.max(uncertain_kg_s);
        let (mut onset_s, mut lost_kg) = (f64::NAN, f64::NAN);
        if let Some(leak) = leak {
            row.estimate.leak_kg_s = leak.rate_kg_s.value;
            row.estimate.leak_sd_kg_s = (leak.rate_kg_s.high - leak.rate_kg_s.low) / INTERVAL_SD;
            row.leak_pa_s = leak.rate_pa_s.value;
            onset_s = clock.of_log_s(leak.onset_s.value);
            lost_kg = leak.lost_kg.value;
        }
        Self {
            estimate: row,
            leak_probability: decision.leak_probability.unwrap_or(f64::NAN),
            leak_low_kg_s: leak_rate_kg_s.low,
            leak_high_kg_s: leak_rate_kg_s.high,
            onset_s,
            lost_kg,
            cold_pressure_pa: output.cold_pressure_pa,
            reaction: decision.reaction.map_or("", reaction_word),
            reason: decision.verdict.reason().map_or("", |reason| reason.as_str()),
        }
    }
}

/// Columns of an output, with the decimals that are worth writing; `time` where the log has dates.
pub(crate) fn fields(has_dates: bool) -> Vec<Field<MonitorRow>> {
    use Digits::Decimals;
    let decision = [
        Field::number("leak_probability", Decimals(6), |row: &MonitorRow| row.leak_probability),
        Field::number("leak_low_g_h", Decimals(6), |row| row.leak_low_kg_s * GRAM_PER_HOUR),
        Field::number("leak_high_g_h", Decimals(6), |row| row.leak_high_kg_s * GRAM_PER_HOUR),
        Field::number("onset_s", Decimals(1), |row| row.onset_s),
        Field::number("lost_g", Decimals(3), |row| row.lost_kg * GRAM),
        Field::number("cold_pressure_bar", Decimals(4), |row| row.cold_pressure_pa / BAR_PA),
        Field::text("reaction", |row| row.reaction),
        Field::text("reason", |row| row.reason),
    ];
    estimate::fields(has_dates).into_iter().chain(decision).collect()
}

#[cfg(test)]
pub(super) mod tests {
    use super::*;
    use crate::detector::monitor::{
        Decision, Health, Interval, LeakFinding, Outcome, Outlook, Reason, Verdict,
    };
    use crate::detector::prognosis::{Advice, Passage, Quantiles, Reaction};
    use crate::estimator::observer::{Estimate, Quality};
    use crate::report::{RowFormat, Rows};

    /// A leak of 3.6 g/h in the third row of a log, and what else an output has.
    pub(crate) fn leaking() -> Output {
        let interval = |value: f64, low: f64, high: f64| Interval { value, low, high };
        Output {
            estimate: Estimate {
                time_s: 7200.0,
                gas_mean_k: 288.15,
                gas_mean_sd_k: 0.25,
                mass_kg: 4.4,
                mass_sd_kg: 2e-3,
                leak_kg_s: 5e-7,
                leak_sd_kg_s: 1e-7,
                pressure_pa: f64::NAN,
                pressure_expected_pa: 199e5,
                p15_pa: 196e5,
                quality: Quality::Degraded,
            },
            decision: Decision {
                verdict: Verdict::Leak,
                outcome: Outcome::Loss,
                leak_probability: Some(0.999),
                reaction: Some(Reaction::AsSoonAsPossible),
            },
            leak_rate_kg_s: interval(1e-6, 0.8e-6, 1.3e-6),
            leak: Some(LeakFinding {
                rate_kg_s: interval(1e-6, 0.8e-6, 1.3e-6),
                rate_pa_s: interval(4.5, 3.6, 5.85),
                onset_s: interval(3600.0, 0.0, 5400.0),
                lost_kg: interval(0.0036, 0.003, 0.0045),
            }),
            cold_pressure_pa: 158e5,
            health: vec![Health::Good, Health::Missing],
            outlook: Some(outlook(Reaction::AsSoonAsPossible)),
            events: Vec::new(),
            alarms: Vec::new(),
            stamp_s: 7200.0,
        }
    }

    /// Two weeks to the limit.
    fn outlook(reaction: Reaction) -> Outlook {
        let day_s = 86_400.0;
        let [p5, p50, p95] = [12.0, 14.0, 17.5].map(|days| Passage::In(days * day_s));
        let left = Quantiles { p5, p50, p95, horizon_s: 3652.5 * day_s };
        let advice = Advice {
            reaction,
            before_safe_state: 0.0,
            before_next_service: 0.97,
            before_following_service: 1.0,
        };
        Outlook { operational: left, cold: left, maintenance: left, advice, known: true }
    }

    /// The same where nothing can be told.
    pub(crate) fn unknown() -> Output {
        let decision = Decision {
            verdict: Verdict::Unknown(Reason::NoPressure),
            outcome: Outcome::Unknown,
            leak_probability: None,
            reaction: None,
        };
        let leak_rate_kg_s = Interval { value: 0.0, low: 0.0, high: 1e-6 };
        Output { decision, leak_rate_kg_s, leak: None, outlook: None, ..leaking() }
    }

    fn csv(output: &Output, leak_pa_s: f64) -> String {
        Rows::new(fields(false), RowFormat::Csv)
            .row(&MonitorRow::new(output, leak_pa_s, &Clock::default()))
            .to_owned()
    }

    #[test]
    fn a_leak_that_is_found_stands_in_the_columns_of_the_leak_in_their_units() {
        // 1e-6 kg/s are 3.6 g/h; 0.5e-6 kg/s wide, which is 3.92 standard deviations; 4.5 Pa/s are 0.162 bar/h.
        let expected = "7200,15.0000,0.2500,4.400000,2.0000,3.600000,0.459192,0.16200000,,199.00000,196.00000,leak,degraded,\
                        0.999000,2.880000,4.680000,3600.0,3.600,158.0000,as-soon-as-possible,\n";
        assert_eq!(csv(&leaking(), 2.0), expected);
        assert_eq!(expected.matches(',').count() + 1, fields(false).len());
    }

    #[test]
    fn without_a_finding_the_cells_are_empty_and_unknown_has_its_reason() {
        let text = csv(&unknown(), 2.0);
        let cells: Vec<&str> = text.trim_end().split(',').collect();
        // Nothing is found: up to 3.6 g/h, which is 1.96 standard deviations.
        assert_eq!(cells[5..8], ["1.800000", "1.836768", "0.07200000"]);
        assert_eq!(
            cells[11..],
            ["unknown", "degraded", "", "0.000000", "3.600000", "", "", "158.0000", "", "no usable pressure"]
        );
    }

    #[test]
    fn a_json_row_is_the_csv_row_with_null_for_what_is_missing() {
        for output in [leaking(), unknown()] {
            let mut rows = Rows::new(fields(false), RowFormat::Json);
            let json = rows.row(&MonitorRow::new(&output, f64::NAN, &Clock::default()));
            let values: Vec<serde_json::Value> = serde_json::from_str(json).unwrap();
            for (cell, value) in csv(&output, f64::NAN).trim_end().split(',').zip(&values) {
                match value {
                    serde_json::Value::Null => assert_eq!(cell, ""),
                    serde_json::Value::String(word) => assert_eq!(cell, word),
                    number => assert_eq!(cell.parse().ok(), number.as_f64()),
                }
            }
            assert_eq!(values.len(), fields(false).len());
        }
    }
}
