//! Writes a year of readings, one row every 10 s, to stdout: a week of a railway vehicle in winter that repeats itself.
//!
//! `cargo run --release -p cylwatch-evaluation --example year_log > year.csv`, then
//! `cylwatch estimate nitrogen-20l year.csv -o estimates.csv` for the time and the memory of a long log.
use std::error::Error;
use std::io::{BufWriter, Write as _};

use cylwatch_evaluation::world::{Family, Request, RowPattern, Simulated};

const DAYS: usize = 365;

fn main() -> Result<(), Box<dyn Error>> {
    let family = Family { rows: RowPattern::TenSeconds, ..Family::usual() };
    let interval_s = family.rows.interval_s();
    let request = Request::tight(family, 1, 7.0 * 86_400.0);
    let world = Simulated::run(&request)?.world_of_even_rows(&request)?;
    let week: Vec<[f64; 3]> =
        world.log.rows().map(|(_, row)| [row[0] - 273.15, row[1] - 273.15, row[2] * 1e-5]).collect();
    let mut out = BufWriter::new(std::io::stdout().lock());
    writeln!(out, "time_s,shoulder_degc,valve_degc,pressure_bar")?;
    // The last row of the week has the time of the first of the next.
    let rows = week[..week.len() - 1].iter().cycle();
    let count = (DAYS as f64 * 86_400.0 / interval_s) as usize;
    for (index, [shoulder, valve, pressure]) in rows.take(count + 1).enumerate() {
        writeln!(out, "{},{shoulder:.3},{valve:.3},{pressure:.3}", index as f64 * interval_s)?;
    }
    Ok(out.flush()?)
}
