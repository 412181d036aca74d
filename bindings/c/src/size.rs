//! How large an arena a cylinder needs: found by trying three days in which everything happens.
//!
//! What a monitor remembers is bounded, and full after two days. Beside weather there are a leak, a spike, missing readings, a gap, a
//! discharge and a refill, alarms that are acknowledged at length, and states that are saved and restored.
use crate::arena::{Arena, within};
use crate::code::Failure;
use crate::event::CW_TEXT_SIZE;
use crate::session::{Rows, Session};
use alloc::vec::Vec;
use core::mem::{ManuallyDrop, MaybeUninit};
use core::ptr::NonNull;
use cylwatch_detector::compiled::CompiledCylinder;
use cylwatch_detector::estimator::log::Quantity;
use cylwatch_detector::prognosis::Contents;

/// No cylinder needs more, bytes.
const MOST: usize = 24 << 20;
/// A quarter is added: what happens in the field is not what was tried.
const MARGIN: usize = 4;
/// Sizes are multiples of it, bytes.
const PAGE: usize = 4096;

/// Time between rows, s; rows between states that are saved, and in all.
const ROW_S: f64 = 60.0;
const SAVED: usize = 360;
const ROWS: usize = 3 * 1440;
/// Temperature at which the fill is looked at, K.
const FILL_K: f64 = 288.15;

/// Size of an arena, handle and all, bytes.
pub(crate) fn needed(blob: &[u8]) -> Result<usize, Failure> {
    // What is refused is refused here, outside any arena.
    Rows::of(blob, None)?;
    let rows = rows(&CompiledCylinder::from_bytes(blob)?)?;
    let (reached, _) = tried(blob, &rows, MOST);
    let mut size = (reached + reached / MARGIN).next_multiple_of(PAGE);
    // A smaller arena is cut up in another way.
    while tried(blob, &rows, size).1 > 0 {
        size += PAGE;
    }
    Ok(size + size_of::<crate::cw_handle>().next_multiple_of(PAGE))
}

/// Readings of the rows.
fn rows(cylinder: &CompiledCylinder) -> Result<Vec<Vec<f64>>, Failure> {
    let CompiledCylinder { vessel, commissioning, sensors, .. } = cylinder;
    let full_kg = commissioning.mass_kg(vessel, FILL_K).map_err(cylwatch_detector::DetectorError::from)?;
    let full_pa = Contents::of(vessel).pressure_pa(full_kg, FILL_K)?;
    let mut state = 1_u32;
    // Between -1 and 1.
    let mut noise = move || {
        state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        f64::from(state) / f64::from(u32::MAX >> 1) - 1.0
    };
    let reading = |row: usize, sensor: usize, noise: f64| {
        let day = row as f64 / 1440.0;
        let gas_k = FILL_K + 8.0 * (6.0 * day).sin();
        // A leak from the first noon on, a discharge at the second, a refill in the evening.
        let leaked = 1.0 - 0.05 * (day - 0.5).max(0.0);
        let left = if (1.5..1.75).contains(&day) { 0.6 * leaked } else { leaked };
        match sensors[sensor].quantity() {
            _ if row % 97 == sensor || (1000..1060).contains(&row) => f64::NAN,
            Quantity::Temperature => gas_k + 0.3 * (6.0 * day + sensor as f64).sin() + 0.05 * noise,
            Quantity::Pressure if row == 300 => 0.5 * full_pa,
            Quantity::Pressure => full_pa * gas_k / FILL_K * left + 1e3 * noise,
        }
    };
    Ok((0..ROWS)
        .map(|row| (0..sensors.len()).map(|sensor| reading(row, sensor, noise())).collect())
        .collect())
}

/// Bytes that are reached in an arena, and those that did not fit.
fn tried(blob: &[u8], rows: &[Vec<f64>], size: usize) -> (usize, usize) {
    let mut memory: Vec<MaybeUninit<u8>> = Vec::with_capacity(size);
    let mut state = Vec::new();
    let (mut reached, mut short) = (0, 0);
    for restored in [false, true] {
        let block =
            NonNull::slice_from_raw_parts(NonNull::from(memory.spare_capacity_mut()).cast::<u8>(), size);
        // SAFETY: the memory belongs to this arena until the next is laid over it.
        let mut arena = unsafe { Arena::new(block.cast::<u8>().addr().get(), block) };
        // Not dropped outside its arena, not even by a panic.
        let mut session = ManuallyDrop::new(Session::EMPTY);
        // SAFETY: the arena stays where it is, and is looked at between these alone.
        let mut inside = |work: &mut dyn FnMut(&mut Session) -> Result<(), Failure>| unsafe {
            // What is refused here is no matter of size.
            within(&raw mut arena, || drop(work(&mut session)));
        };
        let before = restored.then(|| core::mem::take(&mut state));
        inside(&mut |session| Rows::of(blob, before.as_deref()).map(|rows| session.begin(rows)));
        // The restored one lives on for a quarter of a day.
        let (from, count) = if restored { (rows.len(), SAVED) } else { (0, rows.len()) };
        for (at, readings) in rows.iter().enumerate().take(count) {
            inside(&mut |session| lived(session, ROW_S * (from + at) as f64, readings));
            if at % SAVED == SAVED - 1 {
                state = vec![0; size];
                let mut length = 0;
                inside(&mut |session| session.rows()?.save_into(&mut state).map(|needed| length = needed));
                state.truncate(length);
                inside(&mut |session| session.acknowledge(&[b'a'; CW_TEXT_SIZE - 1]).map(drop));
            }
        }
        inside(&mut |session| {
            session.end();
            Ok(())
        });
        let memory = arena.memory();
        (reached, short) = (reached.max(memory.reached_bytes), short + arena.take_overdrawn());
    }
    (reached, short)
}

fn lived(session: &mut Session, time_s: f64, readings: &[f64]) -> Result<(), Failure> {
    session.rows()?.take_in(time_s, readings)?;
    while session.next()?.is_some() {}
    Ok(())
}
