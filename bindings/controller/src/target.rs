//! The same in an emulated Cortex-M: files through semihosting, and what memory was needed.
use core::alloc::{GlobalAlloc, Layout};
use core::fmt::Write;
use core::panic::PanicInfo;
use core::ptr::addr_of_mut;
use core::sync::atomic::{AtomicUsize, Ordering::Relaxed};
use cortex_m::peripheral::{Peripherals, SYST, syst::SystClkSource};
use cortex_m_rt::entry;
use cortex_m_semihosting::{debug, hio, syscall};
use cylwatch_controller::{LARGEST_STATE, Observed, replay};
use embedded_alloc::TlsfHeap;

/// What the monitor may allocate, bytes.
const ARENA: usize = 1 << 20;
/// The longest compiled cylinder, bytes.
const CYLINDER: usize = 16 << 10;
/// The longest log, bytes.
const LOG: usize = 2 << 20;
/// Largest count of the clock.
const TICKS: u32 = 0xff_ffff;
/// Instructions to a tick, where an instruction takes 1 ns (`-icount shift=0`) and the clock has 25 MHz.
const PER_TICK: u64 = 40;
/// Time without rows that is a gap, s.
const GAP_S: f64 = 900.0;
/// What unused stack is filled with.
const PAINT: u32 = 0xc5c5_c5c5;

static HEAP: TlsfHeap = TlsfHeap::empty();
static USED: AtomicUsize = AtomicUsize::new(0);
static PEAK: AtomicUsize = AtomicUsize::new(0);
static COUNT: AtomicUsize = AtomicUsize::new(0);

/// The arena, counted.
struct Arena;

// SAFETY: every call is handed on to the heap as it came.
unsafe impl GlobalAlloc for Arena {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        COUNT.fetch_add(1, Relaxed);
        let used = USED.fetch_add(layout.size(), Relaxed) + layout.size();
        PEAK.fetch_max(used, Relaxed);
        // SAFETY: the caller keeps the contract of `GlobalAlloc::alloc`.
        unsafe { HEAP.alloc(layout) }
    }

    unsafe fn dealloc(&self, pointer: *mut u8, layout: Layout) {
        USED.fetch_sub(layout.size(), Relaxed);
        // SAFETY: the caller keeps the contract of `GlobalAlloc::dealloc`.
        unsafe { HEAP.dealloc(pointer, layout) }
    }
}

#[global_allocator]
static ARENA_OF_ALL: Arena = Arena;

#[panic_handler]
fn panic(info: &PanicInfo<'_>) -> ! {
    say(format_args!("{info}"));
    debug::exit(debug::EXIT_FAILURE);
    loop {}
}

fn say(words: core::fmt::Arguments<'_>) {
    if let Ok(mut out) = hio::hstdout() {
        let _ = out.write_fmt(words).and_then(|()| out.write_str("\n"));
    }
}

/// A file of the host.
struct File(usize);

impl File {
    fn open(name: &core::ffi::CStr, mode: usize) -> Self {
        // SAFETY: the host reads the name within its length.
        Self(unsafe { syscall!(OPEN, name.as_ptr(), mode, name.count_bytes()) })
    }

    /// Reads into `buffer`, and how many bytes came.
    fn read(&self, buffer: &mut [u8]) -> usize {
        // SAFETY: the host writes within the buffer.
        buffer.len() - unsafe { syscall!(READ, self.0, buffer.as_mut_ptr(), buffer.len()) }
    }

    fn write(&self, bytes: &[u8]) {
        // SAFETY: the host reads within the bytes.
        unsafe { syscall!(WRITE, self.0, bytes.as_ptr(), bytes.len()) };
    }
}

struct Told {
    out: File,
    /// Clock when the present work began, and its allocations then.
    begun: (u32, usize),
    /// Ticks of the present row, and of all; rows.
    ticks: (u64, u64, u64),
    /// Ticks of the longest row, and its line: of those that came after a gap, and of all others.
    longest: [(u64, usize); 2],
    /// Time of the last output, s, and whether the present row has one after a gap.
    last_s: f64,
    after_gap: bool,
    /// Allocations while rows were taken.
    allocations: usize,
    /// Allocations, bytes of the arena, and bytes of stack until the first row came.
    at_start: (usize, usize, usize),
    /// Most bytes of the arena between rows.
    held: usize,
    /// Bytes of stack that the caller of a row has, and that rows before the monitor was saved had below it.
    caller: usize,
    stack: usize,
    /// Bytes of stack that the caller of save and restore has, and allocations and bytes of stack below it that they needed.
    saver: usize,
    saving: (usize, usize),
    restoring: (usize, usize),
}

impl Observed for Told {
    fn write(&mut self, bytes: &[u8]) {
        self.out.write(bytes);
    }

    fn begun(&mut self) {
        self.at_start = (COUNT.load(Relaxed), PEAK.load(Relaxed), stack_used());
        paint();
    }

    fn saving(&mut self) {
        // What a row needs below its caller.
        self.stack = stack_used().saturating_sub(self.caller);
        self.saver = here();
        self.saving.0 = COUNT.load(Relaxed);
        paint();
    }

    fn saved(&mut self) {
        self.saving = (COUNT.load(Relaxed) - self.saving.0, stack_used().saturating_sub(self.saver));
        self.restoring.0 = COUNT.load(Relaxed);
        paint();
    }

    fn restored(&mut self) {
        self.restoring = (COUNT.load(Relaxed) - self.restoring.0, stack_used().saturating_sub(self.saver));
    }

    fn work(&mut self) {
        self.held = self.held.max(USED.load(Relaxed));
        self.caller = here();
        self.begun = (SYST::get_current(), COUNT.load(Relaxed));
    }

    fn rest(&mut self) {
        let (begun, count) = self.begun;
        // It counts down.
        self.ticks.0 += u64::from(begun.wrapping_sub(SYST::get_current()) & TICKS);
        self.allocations += COUNT.load(Relaxed) - count;
    }

    fn said(&mut self, time_s: f64) {
        self.after_gap |= time_s - self.last_s > GAP_S;
        self.last_s = time_s;
    }

    fn done(&mut self, line: usize) {
        let (ticks, all, rows) = self.ticks;
        self.ticks = (0, all + ticks, rows + 1);
        let longest = &mut self.longest[usize::from(!core::mem::take(&mut self.after_gap))];
        *longest = (*longest).max((ticks, line));
    }
}

unsafe extern "C" {
    static mut __sheap: u32;
    static mut _stack_start: u32;
}

/// Bytes of stack that are used here.
#[inline(always)]
fn here() -> usize {
    addr_of_mut!(_stack_start) as usize - cortex_m::register::msp::read() as usize
}

/// Fills the stack below with paint.
#[inline(never)]
fn paint() {
    let here = cortex_m::register::msp::read() as usize;
    let mut at = addr_of_mut!(__sheap);
    while (at as usize) < here - 256 {
        // SAFETY: between the end of the variables and the stack nothing lives.
        unsafe {
            at.write_volatile(PAINT);
            at = at.add(1);
        }
    }
}

/// Bytes of stack that lost their paint.
fn stack_used() -> usize {
    let mut at = addr_of_mut!(__sheap);
    // SAFETY: as in `paint`; reading what may be stack is no harm.
    while unsafe { at.read_volatile() } == PAINT {
        at = unsafe { at.add(1) };
    }
    addr_of_mut!(_stack_start) as usize - at as usize
}

#[entry]
fn main() -> ! {
    static mut MEMORY: [u8; ARENA] = [0; ARENA];
    static mut COMPILED: [u8; CYLINDER] = [0; CYLINDER];
    static mut TEXT: [u8; LOG] = [0; LOG];
    static mut STATE: [u8; LARGEST_STATE] = [0; LARGEST_STATE];
    // SAFETY: once, before anything is allocated.
    unsafe { HEAP.init(MEMORY.as_mut_ptr() as usize, ARENA) };
    let length = File::open(c"cylinder.bin", 1).read(COMPILED);
    let compiled = &COMPILED[..length];
    let length = File::open(c"log.csv", 1).read(TEXT);
    let Some(Peripherals { SYST: mut clock, .. }) = Peripherals::take() else { loop {} };
    clock.set_clock_source(SystClkSource::Core);
    clock.set_reload(TICKS);
    clock.clear_current();
    clock.enable_counter();
    let mut told = Told {
        out: File::open(c"out.bin", 5),
        begun: (0, 0),
        ticks: (0, 0, 0),
        longest: [(0, 0); 2],
        last_s: f64::INFINITY,
        after_gap: false,
        allocations: 0,
        at_start: (0, 0, 0),
        held: 0,
        caller: 0,
        stack: 0,
        saver: 0,
        saving: (0, 0),
        restoring: (0, 0),
    };
    paint();
    match core::str::from_utf8(&TEXT[..length]) {
        Err(_) => say(format_args!("log.csv is no text")),
        Ok(log) => match replay(compiled, log, STATE, &mut told) {
            Err(error) => say(format_args!("{error}")),
            Ok(rows) => {
                let (count, bytes, stack) = told.at_start;
                say(format_args!("rows {rows}"));
                say(format_args!(
                    "arena {bytes} bytes when the monitor began, {} between rows, {} at most",
                    told.held,
                    PEAK.load(Relaxed)
                ));
                say(format_args!(
                    "allocations {count} before the first row, {} in rows, {} to save, {} to restore",
                    told.allocations, told.saving.0, told.restoring.0
                ));
                let (_, all, rows) = told.ticks;
                let [(after, gap), (most, line)] = told.longest;
                say(format_args!(
                    "instructions of a row {} on average, {} at most, in line {line}, {} after a gap, in line {gap}",
                    all * PER_TICK / rows.max(1),
                    most * PER_TICK,
                    after * PER_TICK
                ));
                say(format_args!(
                    "stack {stack} bytes until the first row, {} for rows, {} to save, {} to restore, below a caller with {}",
                    told.stack, told.saving.1, told.restoring.1, told.caller
                ));
                debug::exit(debug::EXIT_SUCCESS);
            }
        },
    }
    debug::exit(debug::EXIT_FAILURE);
    loop {}
}
