//! The same in an emulated Cortex-M: files through semihosting, and what memory was needed.
use crate::counted::{Arena, Counted};
use core::fmt::Write;
use core::panic::PanicInfo;
use core::ptr::addr_of_mut;
use cortex_m::peripheral::{Peripherals, SYST, syst::SystClkSource};
use cortex_m_rt::{ExceptionFrame, entry, exception};
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

#[global_allocator]
static ARENA_OF_ALL: Counted<TlsfHeap> = Counted(TlsfHeap::empty());

#[panic_handler]
fn panic(info: &PanicInfo<'_>) -> ! {
    say(format_args!("{info}"));
    debug::exit(debug::EXIT_FAILURE);
    loop {}
}

/// What a panic becomes where it aborts at once (`IMMEDIATE_ABORT=1 bindings/controller/test`).
#[exception]
unsafe fn HardFault(frame: &ExceptionFrame) -> ! {
    say(format_args!("hard fault at {:#x}", frame.pc()));
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
    arena: Arena,
    /// Clock when the present work began.
    begun: u32,
    /// Ticks of the present row, and of all; rows.
    ticks: (u64, u64, u64),
    /// Ticks of the longest row, and its line: of those that came after a gap, and of all others.
    longest: [(u64, usize); 2],
    /// Time of the last output, s, and whether the present row has one after a gap.
    last_s: f64,
    after_gap: bool,
    /// Bytes of stack until the first row came, that the caller of a row has, and that rows before the monitor was saved had below it.
    stack_begin: usize,
    stack_caller: usize,
    stack_row: usize,
    /// Bytes of stack that the caller of save and restore has, and that they had below it.
    stack_saver: usize,
    stack_save: usize,
    stack_restore: usize,
}

impl Observed for Told {
    fn write(&mut self, bytes: &[u8]) {
        self.out.write(bytes);
    }

    fn begun(&mut self) {
        self.arena.begun();
        self.stack_begin = stack_used();
        paint();
    }

    fn saving(&mut self) {
        // What a row needs below its caller.
        self.stack_row = stack_used().saturating_sub(self.stack_caller);
        self.stack_saver = here();
        self.arena.saving();
        paint();
    }

    fn saved(&mut self) {
        self.arena.saved();
        self.stack_save = stack_used().saturating_sub(self.stack_saver);
        paint();
    }

    fn restored(&mut self) {
        self.arena.restored();
        self.stack_restore = stack_used().saturating_sub(self.stack_saver);
    }

    fn work(&mut self) {
        self.arena.work();
        self.stack_caller = here();
        self.begun = SYST::get_current();
    }

    fn rest(&mut self) {
        // It counts down.
        self.ticks.0 += u64::from(self.begun.wrapping_sub(SYST::get_current()) & TICKS);
        self.arena.rest();
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

impl Told {
    /// Names and values, a line each.
    fn tell(&self) {
        let (_, all, rows) = self.ticks;
        let [(after_gap, _), (longest, line)] = self.longest;
        let stack = [
            ("stack_begin_bytes", self.stack_begin),
            ("stack_row_bytes", self.stack_row),
            ("stack_save_bytes", self.stack_save),
            ("stack_restore_bytes", self.stack_restore),
            ("stack_caller_bytes", self.stack_caller),
            ("longest_row_line", line),
        ];
        for (name, value) in self.arena.measured().into_iter().chain(stack) {
            say(format_args!("{name} {value}"));
        }
        for (name, ticks) in
            [("row", all / rows.max(1)), ("longest_row", longest), ("row_after_gap", after_gap)]
        {
            say(format_args!("instructions_{name} {}", ticks * PER_TICK));
        }
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
    unsafe { ARENA_OF_ALL.0.init(MEMORY.as_mut_ptr() as usize, ARENA) };
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
        arena: Arena::empty(),
        begun: 0,
        ticks: (0, 0, 0),
        longest: [(0, 0); 2],
        last_s: f64::INFINITY,
        after_gap: false,
        stack_begin: 0,
        stack_caller: 0,
        stack_row: 0,
        stack_saver: 0,
        stack_save: 0,
        stack_restore: 0,
    };
    paint();
    match core::str::from_utf8(&TEXT[..length]) {
        Err(_) => say(format_args!("log.csv is no text")),
        Ok(log) => match replay(compiled, log, STATE, &mut told) {
            Err(error) => say(format_args!("{error}")),
            Ok(rows) => {
                say(format_args!("rows {rows}"));
                told.tell();
                debug::exit(debug::EXIT_SUCCESS);
            }
        },
    }
    debug::exit(debug::EXIT_FAILURE);
    loop {}
}
