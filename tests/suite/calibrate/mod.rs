//! `cylwatch calibrate`.
mod advice;
mod bad_input;
mod outputs;
mod session;

use crate::support::{Outcome, rows, run};
use std::path::Path;

/// Air that rests, falls and rises, and what stands on the cylinder; `FILL` and `END` are replaced.
const SCENARIO: &str = r#"
name = "rest, cold, warm"
duration_min = 100
sample_time_min = 1
[initial]
fill_pressure_bar = FILL
fill_temperature_degc = 15
temperature_degc = 20
[ambient]
air_degc = 20
wind_m_s = 0
[[ambient.air_change]]
at_min = 10
over_min = 15
to_degc = -10
[[ambient.air_change]]
at_min = 50
over_min = 10
to_degc = END
[[sensor]]
name = "ambient"
noise_k = 0.05
[[sensor]]
name = "shoulder"
air_coupling = 0.1
noise_k = 0.05
[[sensor]]
name = "valve"
air_coupling = 0.1
noise_k = 0.05
[[sensor]]
name = "pressure"
noise_mbar = 10
"#;

/// What the cylinder of the logs is other than its file says.
const OUTSIDE: f64 = 1.3;
const INSIDE: f64 = 0.77;
const CONTACT: f64 = 1.2;

/// What a logger on such a cylinder writes, cells by rows, header first.
#[derive(Clone)]
struct Log(Vec<Vec<String>>);

impl Log {
    /// Records a course.
    fn recorded(folder: &Path, fill_bar: u32, end_degc: i32, seed: u32) -> Self {
        let plain = cylwatch::thermal::vessel::presets::FILES.text("nitrogen-20l").unwrap();
        let contact = format!("contact_w_k = {}", 8.0 * CONTACT);
        let truth = plain
            .replace(
                "[inside_film]",
                &format!("film_factor = {OUTSIDE}\n[inside_film]\nmultiplier = {INSIDE}"),
            )
            .replace("contact_w_k = 8", &contact);
        let scenario = SCENARIO.replace("FILL", &fill_bar.to_string()).replace("END", &end_degc.to_string());
        std::fs::write(folder.join("truth.toml"), truth).unwrap();
        std::fs::write(folder.join("scenario.toml"), scenario).unwrap();
        let outcome =
            run(folder, &["simulate", "truth.toml", "scenario.toml", "--seed", &seed.to_string(), "-q"]);
        assert_eq!(outcome.code, Some(0), "{}", outcome.stderr);
        for file in ["truth.toml", "scenario.toml"] {
            std::fs::remove_file(folder.join(file)).unwrap();
        }
        let (header, rows) = rows(&outcome.stdout);
        let kept: Vec<usize> = (0..header.len())
            .filter(|&k| header[k] == "time_s" || header[k].starts_with("measured_"))
            .collect();
        let line = |row: &Vec<&str>| kept.iter().map(|&k| row[k].replace("measured_", "")).collect();
        Self(std::iter::once(&header).chain(&rows).map(line).collect())
    }

    fn place(&self, column: &str) -> usize {
        self.0[0].iter().position(|name| name == column).unwrap()
    }

    /// The same with the cells of a column changed, row by row.
    fn with(mut self, column: &str, change: impl Fn(usize, &str) -> String) -> Self {
        let place = self.place(column);
        for (number, row) in self.0.iter_mut().skip(1).enumerate() {
            row[place] = change(number, &row[place]);
        }
        self
    }

    fn without(mut self, column: &str) -> Self {
        let place = self.place(column);
        self.0.iter_mut().for_each(|row| drop(row.remove(place)));
        self
    }

    fn text(&self) -> String {
        self.0.iter().map(|row| row.join(",") + "\n").collect()
    }

    fn write(&self, folder: &Path, name: &str) {
        std::fs::write(folder.join(name), self.text()).unwrap();
    }
}

/// A folder's `log.csv`.
fn log(folder: &Path) -> Log {
    let log = Log::recorded(folder, 200, 25, 1);
    log.write(folder, "log.csv");
    log
}

/// Calibrates the built-in vessel, which must succeed.
fn calibrate(folder: &Path, arguments: &[&str]) -> Outcome {
    let outcome = run(folder, &[&["calibrate", "nitrogen-20l"], arguments].concat());
    assert_eq!(outcome.code, Some(0), "{}", outcome.stderr);
    outcome
}

/// Start, estimate, low and high of a row of the table for people.
fn shown(table: &str, name: &str) -> [f64; 4] {
    let line = table.lines().find(|line| line.starts_with(&format!("{name} ")));
    let line = line.unwrap_or_else(|| panic!("no {name} in {table}"));
    let cells: Vec<&str> = line[name.len()..].split_whitespace().collect();
    [0, 1, 2, 3].map(|k| cells[k].parse().unwrap())
}
