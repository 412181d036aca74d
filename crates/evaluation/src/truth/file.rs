//! A truth as a text file: a line of JSON with what was drawn, then comma-separated samples.
//!
//! Temperatures are written to 0.1 mK, pressures to 1 Pa, masses to 0.1 mg: far below any sensor's noise.
use std::io::{BufRead, Write};

use serde::{Deserialize, Serialize};

use super::{Course, CylinderParameters, SensorParameters, Truth, TruthLeak};
use crate::EvaluationError;
use crate::estimator::log::{Channel, Log, Quantity};

/// Leading columns; the log's channels follow.
const COLUMNS: [&str; 10] = [
    "time_s",
    "gas_mean_k",
    "mass_kg",
    "pressure_pa",
    "ambient_k",
    "wall_mean_k",
    "shoulder_k",
    "valve_k",
    "middle_k",
    "bottom_k",
];

/// The first line.
#[derive(Serialize, Deserialize)]
struct Head {
    course: Course,
    seed: u64,
    parameters: CylinderParameters,
    sensors: SensorParameters,
    leak: Option<TruthLeak>,
    /// Name and whether it is a pressure.
    channels: Vec<(String, bool)>,
}

impl Truth {
    fn columns(&self) -> [&[f64]; 10] {
        [
            &self.time_s,
            &self.gas_mean_k,
            &self.mass_kg,
            &self.pressure_pa,
            &self.ambient_k,
            &self.wall_mean_k,
            &self.shoulder_k,
            &self.valve_k,
            &self.middle_k,
            &self.bottom_k,
        ]
    }

    /// Write it as text.
    ///
    /// # Errors
    /// The writer's.
    pub fn write_to(&self, out: &mut dyn Write) -> Result<(), EvaluationError> {
        let pressure = |channel: &Channel| channel.quantity == Quantity::Pressure;
        let head = Head {
            course: self.course.clone(),
            seed: self.seed,
            parameters: self.parameters,
            sensors: self.sensors,
            leak: self.leak,
            channels: self.log.channels.iter().map(|c| (c.name.clone(), pressure(c))).collect(),
        };
        let head = serde_json::to_string(&head).map_err(std::io::Error::from)?;
        let readings = self.log.channels.iter().map(|c| format!("measured_{}", c.name));
        let names: Vec<String> = COLUMNS.into_iter().map(String::from).chain(readings).collect();
        writeln!(out, "{head}\n{}", names.join(","))?;
        let digits: Vec<usize> = COLUMNS
            .iter()
            .map(|&name| digits(name))
            .chain(self.log.channels.iter().map(|c| if pressure(c) { 0 } else { 4 }))
            .collect();
        for row in 0..self.time_s.len() {
            let truths = self.columns().map(|column| column[row]);
            for (index, value) in truths.iter().chain(self.log.row(row)).enumerate() {
                let comma = if index == 0 { "" } else { "," };
                write!(out, "{comma}{value:.*}", digits[index])?;
            }
            writeln!(out)?;
        }
        Ok(())
    }

    /// Read what [`Truth::write_to`] wrote.
    ///
    /// # Errors
    /// The reader's; [`EvaluationError::TruthFile`] with the line that cannot be read.
    pub fn read_from(input: &mut dyn BufRead) -> Result<Self, EvaluationError> {
        let mut lines = input.lines();
        let mut next = || lines.next().transpose();
        let head = next()?.unwrap_or_default();
        let head: Head = serde_json::from_str(&head)
            .map_err(|error| EvaluationError::TruthFile { line: 1, reason: error.to_string() })?;
        next()?;
        let width = COLUMNS.len() + head.channels.len();
        let mut columns: [Vec<f64>; 10] = Default::default();
        let mut values = Vec::new();
        for (index, line) in lines.enumerate() {
            let line_number = index + 3;
            let row = numbers(&line?, width, line_number)?;
            for (column, value) in columns.iter_mut().zip(&row) {
                column.push(*value);
            }
            values.extend_from_slice(&row[COLUMNS.len()..]);
        }
        Ok(Self::assemble(head, columns, values))
    }

    fn assemble(head: Head, columns: [Vec<f64>; 10], values: Vec<f64>) -> Self {
        let [
            time_s,
            gas_mean_k,
            mass_kg,
            pressure_pa,
            ambient_k,
            wall_mean_k,
            shoulder_k,
            valve_k,
            middle_k,
            bottom_k,
        ] = columns;
        let channel = |(name, pressure): (String, bool)| Channel {
            name,
            quantity: if pressure { Quantity::Pressure } else { Quantity::Temperature },
        };
        let channels = head.channels.into_iter().map(channel).collect();
        Self {
            course: head.course,
            seed: head.seed,
            parameters: head.parameters,
            sensors: head.sensors,
            leak: head.leak,
            log: Log { channels, time_s: time_s.clone(), values },
            time_s,
            gas_mean_k,
            mass_kg,
            pressure_pa,
            ambient_k,
            wall_mean_k,
            shoulder_k,
            valve_k,
            middle_k,
            bottom_k,
        }
    }
}

/// Decimals that a column is written with.
fn digits(name: &str) -> usize {
    match name {
        "time_s" => 3,
        "mass_kg" => 7,
        "pressure_pa" => 0,
        _ => 4,
    }
}

fn numbers(line: &str, width: usize, line_number: usize) -> Result<Vec<f64>, EvaluationError> {
    let row: Result<Vec<f64>, _> = line.split(',').map(str::parse).collect();
    let fault = |reason: String| EvaluationError::TruthFile { line: line_number, reason };
    let row = row.map_err(|error: std::num::ParseFloatError| fault(error.to_string()))?;
    if row.len() != width {
        return Err(fault(format!("{} values where there must be {width}", row.len())));
    }
    Ok(row)
}
