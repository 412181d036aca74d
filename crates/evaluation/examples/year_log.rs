//! Writes a year of readings, one row every 10 s, to stdout: a week of a railway vehicle in winter that repeats itself.
//!
//! `cargo run --release -p cylwatch-evaluation --example year_log > year.csv`, then
//! `cylwatch estimate nitrogen-20l year.csv -o estimates.csv` for the time and the memory of a long log.
use std::error::Error;
use std::io::{BufWriter, Write as _};

use cylwatch_evaluation::truth::{Course, generate};

const INTERVAL_S: f64 = 10.0;
const DAYS: usize = 365;

fn main() -> Result<(), Box<dyn Error>> {
    let truth = generate(&Course::RailwayWeeks { days: 7.0 }, 1, INTERVAL_S)?;
    let column = |name: &str| {
        truth
            .log
            .channels
            .iter()
            .position(|channel| channel.name == name)
            .ok_or("the truth has no such sensor")
    };
    let [shoulder, valve, pressure] = [column("shoulder")?, column("valve")?, column("pressure")?];
    let week: Vec<[f64; 3]> = truth
        .log
        .rows()
        .map(|(_, row)| [row[shoulder] - 273.15, row[valve] - 273.15, row[pressure] * 1e-5])
        .collect();
    let mut out = BufWriter::new(std::io::stdout().lock());
    writeln!(out, "time_s,shoulder_degc,valve_degc,pressure_bar")?;
    // The last row of the week has the time of the first of the next.
    let rows = week[..week.len() - 1].iter().cycle();
    let count = (DAYS as f64 * 86_400.0 / INTERVAL_S) as usize;
    for (index, [shoulder, valve, pressure]) in rows.take(count + 1).enumerate() {
        writeln!(out, "{},{shoulder:.3},{valve:.3},{pressure:.3}", index as f64 * INTERVAL_S)?;
    }
    Ok(out.flush()?)
}
