//! What a monitor says, as a table.
use cylwatch_detector::monitor::{Interval, LeakFinding, Outlook, Output};
use cylwatch_detector::prognosis::{Passage, Quantiles};

use super::words::{self, OUTCOME, REACTION, REASON, VERDICT};
use crate::variable::{Type, Unit};

/// An output of the monitor.
pub(super) struct Said {
    pub(super) name: &'static str,
    pub(super) description: &'static str,
    pub(super) kind: Type,
    /// Before there is a row.
    pub(super) before: f64,
    /// Of what is said of a row, and its value before.
    pub(super) of: fn(&Output, f64) -> f64,
}

const fn real(
    name: &'static str,
    description: &'static str,
    unit: Unit,
    of: fn(&Output, f64) -> f64,
) -> Said {
    Said { name, description, kind: Type::Real(unit), before: f64::NAN, of }
}

fn leak(output: &Output, of: fn(&LeakFinding) -> Interval) -> Option<Interval> {
    output.leak.as_ref().map(of)
}

/// Time that is left, s: 0 where a limit is reached, infinite beyond the horizon, NaN where it is not known.
fn left(output: &Output, of: fn(&Outlook) -> Quantiles, at: fn(&Quantiles) -> Passage) -> f64 {
    let Some(outlook) = &output.outlook else { return f64::NAN };
    match at(&of(outlook)) {
        Passage::Reached => 0.0,
        Passage::In(time_s) => time_s,
        Passage::BeyondHorizon => f64::INFINITY,
        Passage::Unknown => f64::NAN,
    }
}

/// All of it.
pub(super) static SAID: [Said; 40] = [
    Said {
        name: "verdict",
        description: "What is happening to the gas",
        kind: Type::Enumeration(&VERDICT),
        before: 6.0,
        of: |output, _| words::verdict(output.decision.verdict).into(),
    },
    Said {
        name: "reason",
        description: "Why the verdict is unknown",
        kind: Type::Enumeration(&REASON),
        before: 2.0,
        of: |output, _| words::reason(output.decision.verdict.reason()).into(),
    },
    Said {
        name: "outcome",
        description: "Whether gas is being lost",
        kind: Type::Enumeration(&OUTCOME),
        before: 3.0,
        of: |output, _| words::outcome(output.decision.outcome).into(),
    },
    Said {
        name: "reaction",
        description: "What is due",
        kind: Type::Enumeration(&REACTION),
        before: 1.0,
        of: |output, _| words::reaction(output.decision.reaction).into(),
    },
    Said {
        name: "exit_code",
        description: "The outcome as a number, for masters without enumerations: 0 no loss, 1 loss, 3 unknown",
        kind: Type::Integer,
        before: 3.0,
        of: |output, _| output.decision.outcome.exit_code().into(),
    },
    Said {
        name: "rows",
        description: "Rows that have been judged",
        kind: Type::Integer,
        before: 0.0,
        of: |_, before| before + 1.0,
    },
    Said {
        name: "events",
        description: "Events so far",
        kind: Type::Integer,
        before: 0.0,
        of: |output, before| before + output.events.len() as f64,
    },
    Said {
        name: "alarm_changes",
        description: "Changes of alarms so far",
        kind: Type::Integer,
        before: 0.0,
        of: |output, before| before + output.alarms.len() as f64,
    },
    real("row_time_s", "Time of the row that the outputs are of", Unit::Second, |o, _| o.stamp_s),
    real("leak_probability", "Probability that gas is being lost", Unit::One, |o, _| {
        o.decision.leak_probability.unwrap_or(f64::NAN)
    }),
    real("gas_mean_k", "Mean gas temperature", Unit::Kelvin, |o, _| o.estimate.gas_mean_k),
    real("gas_mean_sd_k", "Its standard deviation", Unit::KelvinDifference, |o, _| o.estimate.gas_mean_sd_k),
    real("mass_kg", "Gas mass", Unit::Kilogram, |o, _| o.estimate.mass_kg),
    real("mass_sd_kg", "Its standard deviation", Unit::Kilogram, |o, _| o.estimate.mass_sd_kg),
    real(
        "pressure_expected_pa",
        "Pressure that the transmitter would show with the reference mass",
        Unit::Pascal,
        |o, _| o.estimate.pressure_expected_pa,
    ),
    real("pressure_15_degc_pa", "Pressure of the mass settled at 15 degC", Unit::Pascal, |o, _| {
        o.estimate.p15_pa
    }),
    real("cold_pressure_pa", "Pressure at the coldest temperature expected", Unit::Pascal, |o, _| {
        o.cold_pressure_pa
    }),
    real("observer_leak_kg_s", "Leak rate in the eyes of the observer", Unit::KilogramPerSecond, |o, _| {
        o.estimate.leak_kg_s
    }),
    real("observer_leak_sd_kg_s", "Its standard deviation", Unit::KilogramPerSecond, |o, _| {
        o.estimate.leak_sd_kg_s
    }),
    real("leak_kg_s", "Leak rate: of the leak that is found, else 0", Unit::KilogramPerSecond, |o, _| {
        o.leak_rate_kg_s.value
    }),
    real("leak_low_kg_s", "Lower end of its 95 % interval", Unit::KilogramPerSecond, |o, _| {
        o.leak_rate_kg_s.low
    }),
    real("leak_high_kg_s", "Upper end of its 95 % interval", Unit::KilogramPerSecond, |o, _| {
        o.leak_rate_kg_s.high
    }),
    real("leak_pa_s", "Leak as loss of the pressure at 15 degC", Unit::PascalPerSecond, |o, _| {
        leak(o, |leak| leak.rate_pa_s).map_or(f64::NAN, |rate| rate.value)
    }),
    real("leak_low_pa_s", "Lower end of its 95 % interval", Unit::PascalPerSecond, |o, _| {
        leak(o, |leak| leak.rate_pa_s).map_or(f64::NAN, |rate| rate.low)
    }),
    real("leak_high_pa_s", "Upper end of its 95 % interval", Unit::PascalPerSecond, |o, _| {
        leak(o, |leak| leak.rate_pa_s).map_or(f64::NAN, |rate| rate.high)
    }),
    real("onset_s", "When the leak began", Unit::Second, |o, _| {
        leak(o, |leak| leak.onset_s).map_or(f64::NAN, |onset| onset.value)
    }),
    real("onset_low_s", "Lower end of its 95 % interval", Unit::Second, |o, _| {
        leak(o, |leak| leak.onset_s).map_or(f64::NAN, |onset| onset.low)
    }),
    real("onset_high_s", "Upper end of its 95 % interval", Unit::Second, |o, _| {
        leak(o, |leak| leak.onset_s).map_or(f64::NAN, |onset| onset.high)
    }),
    real("lost_kg", "Mass lost since", Unit::Kilogram, |o, _| {
        leak(o, |leak| leak.lost_kg).map_or(f64::NAN, |lost| lost.value)
    }),
    real("lost_low_kg", "Lower end of its 95 % interval", Unit::Kilogram, |o, _| {
        leak(o, |leak| leak.lost_kg).map_or(f64::NAN, |lost| lost.low)
    }),
    real("lost_high_kg", "Upper end of its 95 % interval", Unit::Kilogram, |o, _| {
        leak(o, |leak| leak.lost_kg).map_or(f64::NAN, |lost| lost.high)
    }),
    real(
        "operational_limit_p5_s",
        "Time until the operational limit at 15 degC, quantile of 5 %",
        Unit::Second,
        |o, _| left(o, |left| left.operational, |at| at.p5),
    ),
    real("operational_limit_p50_s", "Its median", Unit::Second, |o, _| {
        left(o, |left| left.operational, |at| at.p50)
    }),
    real("operational_limit_p95_s", "Its quantile of 95 %", Unit::Second, |o, _| {
        left(o, |left| left.operational, |at| at.p95)
    }),
    real(
        "cold_limit_p5_s",
        "Time until the operational limit on the coldest night, quantile of 5 %",
        Unit::Second,
        |o, _| left(o, |left| left.cold, |at| at.p5),
    ),
    real("cold_limit_p50_s", "Its median", Unit::Second, |o, _| left(o, |left| left.cold, |at| at.p50)),
    real("cold_limit_p95_s", "Its quantile of 95 %", Unit::Second, |o, _| {
        left(o, |left| left.cold, |at| at.p95)
    }),
    real(
        "maintenance_limit_p5_s",
        "Time until the maintenance limit, quantile of 5 %",
        Unit::Second,
        |o, _| left(o, |left| left.maintenance, |at| at.p5),
    ),
    real("maintenance_limit_p50_s", "Its median", Unit::Second, |o, _| {
        left(o, |left| left.maintenance, |at| at.p50)
    }),
    real("maintenance_limit_p95_s", "Its quantile of 95 %", Unit::Second, |o, _| {
        left(o, |left| left.maintenance, |at| at.p95)
    }),
];
