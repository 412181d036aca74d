//! Columns of the table for people.
use super::super::clustered::{Rate, Share};
use super::super::report::{CoverageRow, GroupReport};
use super::short;
use crate::judge::measures::{Class, Reached, SmallestLeak};
use crate::judge::score::coverage::Quantity;
use crate::world::Regime;

/// A column: its heading and what it says of a group; `None`: nothing.
pub(super) type Column<'a> = (String, Box<dyn Fn(&GroupReport) -> Option<String> + 'a>);

fn column<'a>(name: impl Into<String>, say: impl Fn(&GroupReport) -> Option<String> + 'a) -> Column<'a> {
    (name.into(), Box::new(say))
}

pub(super) fn false_statements() -> Vec<Column<'static>> {
    vec![
        column("tight worlds", |of| of.tight.leaks.map(|_| of.tight.worlds.to_string())),
        column("failed", |of| (of.failed > 0).then(|| of.failed.to_string())),
        column("simulations", |of| of.tight.leaks.map(|rate| rate.simulations.to_string())),
        column("tight years", |of| of.tight.leaks.map(|rate| short(rate.cylinder_years))),
        column("losses", |of| of.tight.losses.map(rate)),
        column("leaks", |of| of.tight.leaks.map(rate)),
        column("leaks in the first day", |of| {
            of.tight.leaks.map(|_| of.tight.leaks_in_first_day.to_string())
        }),
        column("simulations with", |of| of.tight.leaks.map(|rate| rate.simulations_with.to_string())),
        column("exchanges", |of| of.tight.exchanges.map(rate)),
        column("sensor faults", |of| of.tight.sensor_faults.map(rate)),
        column("unknown after a day, %", |of| of.tight.unknown_later.map(percent)),
    ]
}

pub(super) fn verdicts() -> Vec<Column<'static>> {
    let of_period = |period: usize, title: &'static str| {
        Class::ALL.into_iter().map(move |class| {
            column(format!("{class}, {title}"), move |of| {
                let shares = of.tight.shares[period].as_ref()?;
                Some(short(100.0 * shares.get(&class.to_string())?))
            })
        })
    };
    of_period(0, "first day").chain(of_period(1, "later")).collect()
}

pub(super) fn smallest() -> Vec<Column<'static>> {
    let horizon = |name: &'static str| {
        column(format!("{name}, %/h (bar/h)"), move |of| {
            let leaks = of.leaks.as_ref()?;
            leaks
                .smallest_percent_h
                .get(name)?
                .as_ref()
                .map(|leak| smallest_words(leak, leaks.bar_per_percent))
        })
    };
    vec![
        column("runs", |of| of.leaks.as_ref().map(|leaks| leaks.runs.to_string())),
        column("simulations", |of| of.leaks.as_ref().map(|leaks| leaks.simulations.to_string())),
        horizon("1 h"),
        horizon("24 h"),
        horizon("7 d"),
    ]
}

fn smallest_words(leak: &SmallestLeak, bar: f64) -> String {
    let value = |reached: Reached| match reached {
        Reached::AtMost(rate) => format!("≤ {}", short(rate)),
        Reached::At(rate) => short(rate),
        Reached::Above(rate) => format!("> {}", short(rate)),
    };
    let (low, high) = leak.interval;
    let rate = leak.rate.rate() * bar;
    format!("{} [{}, {}] ({})", value(leak.rate), value(low), value(high), short(rate))
}

/// Coverage of one quantity, and its error on tight cylinders after the first day: in the unit of its name.
pub(super) fn coverage(quantity: Quantity) -> Vec<Column<'static>> {
    let mut columns = Vec::new();
    for gas in ["tight", "lost", "exchanged"] {
        for period in ["first day", "later"] {
            columns.push(column(format!("{gas}, {period}"), move |of: &GroupReport| {
                coverage_row(of, quantity, gas, period)?.held.map(percent)
            }));
        }
    }
    let error = match quantity {
        Quantity::Mass => Some(("rms, tight, later, % of the gas", 100.0)),
        Quantity::Gas => Some(("rms, tight, later, K", 1.0)),
        Quantity::Leak | Quantity::Onset => None,
    };
    columns.extend(error.map(|(name, unit)| {
        column(name, move |of: &GroupReport| {
            coverage_row(of, quantity, "tight", "later")?.rms.map(|rms| short(unit * rms))
        })
    }));
    columns
}

fn coverage_row<'a>(
    of: &'a GroupReport,
    quantity: Quantity,
    gas: &str,
    period: &str,
) -> Option<&'a CoverageRow> {
    of.coverage.iter().find(|row| row.quantity == quantity && row.gas == gas && row.period == period)
}

pub(super) fn innovations() -> Vec<Column<'static>> {
    let mut columns = Vec::new();
    for regime in Regime::ALL {
        let name = format!("{regime:?}").to_lowercase();
        let of_regime =
            move |of: &GroupReport| of.innovations.iter().find(|row| row.regime == regime).cloned();
        columns.push(column(format!("NIS {name}"), move |of| of_regime(of)?.nis.map(short)));
        for (lag, title) in ["1 min", "10 min"].into_iter().enumerate() {
            columns.push(column(format!("{title} {name}"), move |of| {
                of_regime(of)?.autocorrelation[lag].map(|rho| format!("{rho:.2}"))
            }));
        }
    }
    columns
}

pub(super) fn exchanges() -> Vec<Column<'static>> {
    let of = |name: &'static str, direction: usize| {
        column(name, move |of: &GroupReport| of.recognised_exchanges[direction].map(percent))
    };
    vec![of("discharge", 0), of("refill", 1)]
}

pub(super) fn fast_losses() -> Vec<Column<'static>> {
    let mut columns = Vec::new();
    // An announced discharge is none, and must not be told.
    columns.push(column("announced discharge: told as a loss, %", |of: &GroupReport| {
        of.fast.iter().find(|row| row.kind == "discharge, announced")?.told.map(percent)
    }));
    for kind in ["fast loss", "discharge, not announced"] {
        let of_kind = move |of: &GroupReport| of.fast.iter().find(|row| row.kind == kind).cloned();
        columns.push(column(format!("{kind}: n"), move |of| {
            of_kind(of)?.told.map(|share| format!("{} in {}", share.trials, share.simulations))
        }));
        columns.push(column(format!("{kind}: in time, %"), move |of| of_kind(of)?.in_time.map(percent)));
        columns.push(column(format!("{kind}: told, %"), move |of| of_kind(of)?.told.map(percent)));
        columns.push(column(format!("{kind}: median delay, min"), move |of| {
            of_kind(of)?.median_delay_s.map(|delay_s| short(delay_s / 60.0))
        }));
        columns.push(column(format!("{kind}: told before"), move |of| {
            Some(of_kind(of)?.before).filter(|before| *before > 0).map(|before| before.to_string())
        }));
    }
    columns
}

pub(super) fn contradictions() -> Vec<Column<'static>> {
    vec![
        column("rows", |of| of.disagreements.as_ref().map(|found| found.rows.to_string())),
        column("contradicting", |of| of.disagreements.as_ref().map(|found| found.disagreeing.to_string())),
    ]
}

fn rate(rate: Rate) -> String {
    let ((low, high), (wide_low, wide_high)) = (rate.poisson, rate.by_simulation);
    let [value, low, high] = [rate.per_ten_years, low, high].map(short);
    format!("{} = {value}, {low} to {high} [{}, {}]", rate.count, short(wide_low), short(wide_high))
}

fn percent(share: Share) -> String {
    let (low, high) = share.by_simulation;
    let [value, low, high] = [share.share, low, high].map(|part| short(100.0 * part));
    format!("{value} [{low}, {high}]")
}
