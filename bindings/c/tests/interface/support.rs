//! A cylinder, a day of rows, and calls without their pointers.
use cylwatch_c::code::cw_code;
use cylwatch_c::output::cw_output;
use cylwatch_c::*;
use cylwatch_detector::compiled::CompiledCylinder;
use cylwatch_detector::estimator::observer::Commissioning;
use cylwatch_detector::estimator::sensor::Sensor;
use cylwatch_detector::estimator::thermal::vessel::presets;
use cylwatch_detector::monitor::MonitorSettings;
use std::alloc::{Layout, alloc, dealloc};
use std::mem::MaybeUninit;
use std::ptr;

pub(crate) fn cylinder(sensors: &[&str]) -> CompiledCylinder {
    CompiledCylinder {
        vessel: presets::load("nitrogen-20l").unwrap(),
        sensors: sensors.iter().map(|name| Sensor::typical(name).unwrap()).collect(),
        commissioning: Commissioning::filled(200e5, 288.15),
        settings: MonitorSettings::default(),
        learned: None,
    }
}

/// A nitrogen cylinder with two thermometers and a transmitter.
pub(crate) fn blob() -> Vec<u8> {
    cylinder(&["shoulder", "valve", "pressure"]).to_bytes().unwrap()
}

/// Rows every 10 s: weather, a leak from noon on, a spike, missing cells, a gap of an hour, two rows in each other's place.
pub(crate) fn rows(count: usize) -> Vec<(f64, [f64; 3])> {
    let mut state = 1_u64;
    // Between -1 and 1.
    let mut noise = || {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (state >> 11) as f64 / (1_u64 << 52) as f64 - 1.0
    };
    let mut rows: Vec<(f64, [f64; 3])> = (0..count)
        .map(|row| {
            let time_s = 10.0 * row as f64;
            let (gas_k, air_k) =
                (285.0 + 6.0 * (time_s / 9000.0).sin(), 285.0 + 8.0 * (time_s / 9000.0 + 0.3).sin());
            let leaked = 1.0 - 2e-6 * (time_s - 43_200.0).max(0.0);
            let spike = if row == 3000 { 0.6 } else { 1.0 };
            let shoulder_k = 0.9 * gas_k + 0.1 * air_k + 0.05 * noise();
            let valve_k = 0.85 * gas_k + 0.15 * air_k + 0.05 * noise();
            let pressure_pa = spike * (200e5 * gas_k / 288.15 * leaked + 1e3 * noise());
            (time_s, [shoulder_k, if row % 700 == 5 { f64::NAN } else { valve_k }, pressure_pa])
        })
        .collect();
    if count > 5400 {
        rows.swap(1000, 1003);
        rows.drain(5000..5360);
    }
    rows
}

/// Memory of any alignment, as C hands it over.
pub(crate) struct Memory {
    start: *mut u8,
    layout: Layout,
    skipped: usize,
}

impl Memory {
    pub(crate) fn of(size: usize) -> Self {
        Self::skipping(0, size)
    }

    /// So many bytes behind an address that everything is aligned to.
    pub(crate) fn skipping(skipped: usize, size: usize) -> Self {
        let layout = Layout::from_size_align(size + skipped + 1, 64).unwrap();
        Self { start: unsafe { alloc(layout) }, layout, skipped }
    }

    pub(crate) fn start(&self) -> *mut u8 {
        self.start.wrapping_add(self.skipped)
    }

    pub(crate) fn size(&self) -> usize {
        self.layout.size() - self.skipped - 1
    }
}

impl Drop for Memory {
    fn drop(&mut self) {
        unsafe { dealloc(self.start, self.layout) };
    }
}

/// A handle in memory of its own.
pub(crate) struct Handle {
    _memory: Memory,
    pub(crate) handle: *mut cw_handle,
}

impl Handle {
    pub(crate) fn init(memory: Memory, blob: &[u8]) -> (cw_code, Self) {
        let mut handle = ptr::null_mut();
        let code =
            unsafe { cw_init(memory.start(), memory.size(), blob.as_ptr(), blob.len(), &raw mut handle) };
        (code, Self { _memory: memory, handle })
    }

    pub(crate) fn restore(memory: Memory, blob: &[u8], state: &[u8]) -> (cw_code, Self) {
        let mut handle = ptr::null_mut();
        let (start, size) = (memory.start(), memory.size());
        let code = unsafe {
            cw_restore(start, size, blob.as_ptr(), blob.len(), state.as_ptr(), state.len(), &raw mut handle)
        };
        (code, Self { _memory: memory, handle })
    }

    /// A monitor of [`blob`].
    pub(crate) fn begun() -> Self {
        let (code, handle) = Self::init(Memory::of(4 << 20), &blob());
        assert_eq!(code, cw_code::CW_OK, "{}", handle.detail());
        handle
    }

    pub(crate) fn step(&self, time_s: f64, readings: &[f64]) -> (cw_code, MaybeUninit<cw_output>) {
        let mut output = MaybeUninit::uninit();
        let (start, count) = (readings.as_ptr(), readings.len());
        (unsafe { cw_step(self.handle, time_s, start, count, output.as_mut_ptr()) }, output)
    }

    pub(crate) fn next(&self) -> (cw_code, MaybeUninit<cw_output>) {
        let mut output = MaybeUninit::uninit();
        (unsafe { cw_next(self.handle, output.as_mut_ptr()) }, output)
    }

    pub(crate) fn finish(&self) -> (cw_code, MaybeUninit<cw_output>) {
        let mut output = MaybeUninit::uninit();
        (unsafe { cw_finish(self.handle, output.as_mut_ptr()) }, output)
    }

    /// All the rows that a call made ready.
    pub(crate) fn all(&self, first: (cw_code, MaybeUninit<cw_output>)) -> Vec<cw_output> {
        let mut outputs = Vec::new();
        let mut last = first;
        while last.0 == cw_code::CW_OK {
            outputs.push(unsafe { last.1.assume_init() });
            last = self.next();
        }
        assert_eq!(last.0, cw_code::CW_NO_ROW, "{}", self.detail());
        outputs
    }

    pub(crate) fn save(&self) -> Vec<u8> {
        let mut size = 0;
        let code = unsafe { cw_save(self.handle, ptr::null_mut(), 0, &raw mut size) };
        assert_eq!(code, cw_code::CW_BUFFER_TOO_SMALL, "{}", self.detail());
        let mut state = vec![0; size];
        let code = unsafe { cw_save(self.handle, state.as_mut_ptr(), size, &raw mut size) };
        assert_eq!((code, size), (cw_code::CW_OK, state.len()));
        state
    }

    pub(crate) fn memory(&self) -> cw_memory {
        let mut memory = cw_memory::default();
        assert_eq!(unsafe { cw_memory_of(self.handle, &raw mut memory) }, cw_code::CW_OK);
        memory
    }

    pub(crate) fn detail(&self) -> String {
        let mut text = [0_u8; 512];
        if self.handle.is_null() {
            return String::new();
        }
        let code = unsafe { cw_detail(self.handle, text.as_mut_ptr().cast(), text.len()) };
        assert_eq!(code, cw_code::CW_OK);
        std::ffi::CStr::from_bytes_until_nul(&text).unwrap().to_str().unwrap().to_owned()
    }
}
