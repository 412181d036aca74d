//! What a row calls, not inlined: an image then says which functions a row reaches (`bindings/controller/panics`).
use cylwatch_detector::DetectorError;
use cylwatch_detector::monitor::{Monitor, Output};

#[inline(never)]
pub(crate) fn take(monitor: &mut Monitor, time_s: f64, readings: &[f64]) -> Result<(), DetectorError> {
    monitor.take(time_s, readings)
}

#[inline(never)]
pub(crate) fn next_output(monitor: &mut Monitor) -> Result<Option<&Output>, DetectorError> {
    monitor.next_output()
}

#[inline(never)]
pub(crate) fn flush(monitor: &mut Monitor) {
    monitor.flush();
}
