//! cylwatch for Python: the commands `monitor`, `estimate`, `simulate`, `identify`, `calibrate`, `place` and `properties` on tables
//! in memory, and monitor and observer step by step.
//!
//! Thin: arguments become a [`cylwatch::run::Call`], results Python objects; all numbers are the library's. Tables come and go
//! through Arrow's C interface (`arrow`), which every frame library speaks, so that none of them is a dependency; a dict of arrays
//! is a log, too (`columns`). A run releases the interpreter, asks now and then whether Ctrl-C has come, and lets no panic pass
//! (`border`).
mod arguments;
mod arrow;
mod border;
mod columns;
mod error;
mod fleet;
mod outcome;
mod request;
mod rows;
mod steps;
mod table;
mod time;

use outcome::Outcome;
use pyo3::prelude::*;
use pyo3::types::PyDict;
use request::Request;

/// Monitors a log of a cylinder, as `cylwatch monitor` does.
#[pyfunction]
#[pyo3(signature = (vessel, log, **options))]
fn monitor(
    vessel: &Bound<'_, PyAny>,
    log: &Bound<'_, PyAny>,
    options: Option<&Bound<'_, PyDict>>,
) -> PyResult<Outcome> {
    Request::new("monitor", Some(vessel), options)?.with_log(log)?.run(vessel.py(), cylwatch::run::monitor)
}

/// Estimates gas temperature, mass and leak rate from a log, as `cylwatch estimate` does.
#[pyfunction]
#[pyo3(signature = (vessel, log, **options))]
fn estimate(
    vessel: &Bound<'_, PyAny>,
    log: &Bound<'_, PyAny>,
    options: Option<&Bound<'_, PyDict>>,
) -> PyResult<Outcome> {
    Request::new("estimate", Some(vessel), options)?.with_log(log)?.run(vessel.py(), cylwatch::run::estimate)
}

/// Simulates a vessel in a scenario, as `cylwatch simulate` does.
#[pyfunction]
#[pyo3(signature = (vessel, scenario, seed = 0, **options))]
fn simulate(
    vessel: &Bound<'_, PyAny>,
    scenario: &Bound<'_, PyAny>,
    seed: u64,
    options: Option<&Bound<'_, PyDict>>,
) -> PyResult<Outcome> {
    let request = Request::new("simulate", Some(vessel), options)?.with_scenario(scenario)?;
    request.with("seed", Some(seed.to_string())).run(vessel.py(), cylwatch::run::simulate)
}

/// Identifies a transfer function from one column of a log to another, as `cylwatch identify` does.
#[pyfunction]
#[pyo3(signature = (log, input, output, **options))]
fn identify(
    log: &Bound<'_, PyAny>,
    input: String,
    output: String,
    options: Option<&Bound<'_, PyDict>>,
) -> PyResult<Outcome> {
    let request = Request::new("identify", None, options)?.with_log(log)?;
    let request = request.with("input", Some(input)).with("output", Some(output));
    request.run(log.py(), cylwatch::run::identify)
}

/// Fits physical parameters of a vessel to logs, as `cylwatch calibrate` does.
#[pyfunction]
#[pyo3(signature = (vessel, logs, **options))]
fn calibrate(
    vessel: &Bound<'_, PyAny>,
    logs: &Bound<'_, PyAny>,
    options: Option<&Bound<'_, PyDict>>,
) -> PyResult<Outcome> {
    Request::of_logs(vessel, logs, options)?.run(vessel.py(), cylwatch::run::calibrate)
}

/// Finds where sensors should sit, as `cylwatch place` does.
#[pyfunction]
#[pyo3(signature = (vessel, **options))]
fn place(vessel: &Bound<'_, PyAny>, options: Option<&Bound<'_, PyDict>>) -> PyResult<Outcome> {
    Request::new("place", Some(vessel), options)?.run(vessel.py(), cylwatch::run::place)
}

/// Properties of a gas at a state, as `cylwatch properties` prints them.
#[pyfunction]
#[pyo3(signature = (gas, **options))]
fn properties<'py>(
    py: Python<'py>,
    gas: &str,
    options: Option<&Bound<'py, PyDict>>,
) -> PyResult<Bound<'py, PyDict>> {
    let mut given = Vec::new();
    for (name, value) in arguments::options(options)?.options {
        let value = value.ok_or_else(|| error::refused(py, &format!("{name} = True: give a number")))?;
        given.push((name, value));
    }
    let table = border::guarded(py, || cylwatch::run::properties(gas, &given))?;
    let dict = PyDict::new(py);
    for column in &table.columns {
        dict.set_item(&column.name, rows::cell(py, &column.values, 0)?)?;
    }
    Ok(dict)
}

/// The compiled part of the package `cylwatch`.
#[pymodule]
fn _cylwatch(module: &Bound<'_, PyModule>) -> PyResult<()> {
    module.add("CylwatchError", module.py().get_type::<error::CylwatchError>())?;
    module.add("__version__", env!("CARGO_PKG_VERSION"))?;
    module.add_class::<Outcome>()?;
    module.add_class::<rows::Rows>()?;
    module.add_class::<fleet::Fleet>()?;
    module.add_function(wrap_pyfunction!(fleet::fleet, module)?)?;
    module.add_class::<steps::Monitor>()?;
    module.add_class::<steps::Observer>()?;
    module.add_function(wrap_pyfunction!(monitor, module)?)?;
    module.add_function(wrap_pyfunction!(estimate, module)?)?;
    module.add_function(wrap_pyfunction!(simulate, module)?)?;
    module.add_function(wrap_pyfunction!(identify, module)?)?;
    module.add_function(wrap_pyfunction!(calibrate, module)?)?;
    module.add_function(wrap_pyfunction!(place, module)?)?;
    module.add_function(wrap_pyfunction!(properties, module)?)?;
    Ok(())
}
