//! What a call answers, and why it refused.
use crate::event::CW_TEXT_SIZE;
use crate::output::CW_MOST_SENSORS;
use core::ffi::CStr;
use core::fmt::{self, Write};
use cylwatch_detector::DetectorError;
use cylwatch_detector::sealed::SealError;

/// What a call answers. Below `CW_NULL` nothing is wrong.
/// cbindgen:rename-all=None
#[repr(i32)]
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum cw_code {
    /// Done; where there is an output, it is filled in.
    CW_OK = 0,
    /// Done; no row is ready, and the output is as it was.
    CW_NO_ROW = 1,
    /// A pointer is null.
    CW_NULL = 2,
    /// A pointer is not aligned.
    CW_MISALIGNED = 3,
    /// A size reaches beyond the address space.
    CW_SIZE = 4,
    /// The handle is none, or its arena has been moved or written over.
    CW_HANDLE = 5,
    /// The monitor did not begin, or has ended with an error.
    CW_ENDED = 6,
    /// The arena is too small to begin in.
    CW_ARENA_TOO_SMALL = 7,
    /// The arena is full: the monitor has ended.
    CW_OUT_OF_MEMORY = 8,
    /// The buffer is too small; the size that is needed is filled in.
    CW_BUFFER_TOO_SMALL = 9,
    /// The bytes are no compiled cylinder, or no state of a monitor.
    CW_OTHER_BYTES = 10,
    /// The bytes have another version.
    CW_VERSION = 11,
    /// The state is that of another cylinder.
    CW_FOREIGN = 12,
    /// The bytes are cut short.
    CW_CUT = 13,
    /// The bytes are damaged.
    CW_DAMAGED = 14,
    /// The cylinder has more than `CW_MOST_SENSORS` sensors.
    CW_SENSORS = 15,
    /// A row has another number of readings than the cylinder has sensors.
    CW_READINGS = 16,
    /// Rows are waiting: take them with cw_next first.
    CW_ROWS_WAITING = 17,
    /// There is none with this index.
    CW_INDEX = 18,
    /// A text is not UTF-8 or too long.
    CW_TEXT = 19,
    /// The monitor refuses a value: a setting out of its bounds, or a gas that has no such state.
    CW_REFUSED = 20,
    /// Not without an operating system.
    CW_HOSTED_ONLY = 21,
    /// A mistake inside the library: the monitor has ended.
    CW_PANICKED = 22,
}

/// Words for the codes, in their order.
pub(crate) const TEXTS: [&CStr; 23] = [
    c"done",
    c"no row is ready",
    c"a pointer is null",
    c"a pointer is not aligned",
    c"a size reaches beyond the address space",
    c"the handle is none, or its arena has been moved or written over",
    c"the monitor did not begin or has ended: begin with cw_init or cw_restore",
    c"the arena is too small: cw_size says what is needed",
    c"the arena is full and the monitor has ended: go on from the last saved state in a larger one",
    c"the buffer is too small",
    c"the bytes are no compiled cylinder or no state of a monitor",
    c"the bytes have another version: compile the cylinder, or begin, with this one",
    c"the state is that of another cylinder",
    c"the bytes are cut short",
    c"the bytes are damaged",
    c"the cylinder has more sensors than CW_MOST_SENSORS",
    c"a row has another number of readings than the cylinder has sensors",
    c"rows are waiting: take them with cw_next first",
    c"there is none with this index",
    c"a text is not UTF-8 or too long",
    c"the monitor refuses a value",
    c"not without an operating system: ask on a computer",
    c"a mistake inside the library, and the monitor has ended: go on from the last saved state",
];

/// Why a call refused, in the words of `cw_detail`.
#[derive(Debug, thiserror::Error)]
pub(crate) enum Failure {
    #[error("{0} is null: give the address of one")]
    Null(&'static str),
    #[error("{name} at {address:#x} must be aligned to {needed} bytes")]
    Misaligned { name: &'static str, address: usize, needed: usize },
    #[error("{name} of {bytes} bytes reaches beyond the address space")]
    Size { name: &'static str, bytes: usize },
    #[error("this is no handle, or its arena has been moved or written over")]
    Handle,
    #[error("the monitor did not begin or has ended: begin with cw_init or cw_restore")]
    Ended,
    #[error("an arena of {size} bytes is too small for a monitor: cw_size says what is needed")]
    ArenaTooSmall { size: usize },
    #[error("the arena of {size} bytes is full, {short} bytes did not fit: cw_size says what is needed")]
    OutOfMemory { size: usize, short: usize },
    #[error("a state of {needed} bytes does not fit a buffer of {capacity}")]
    BufferTooSmall { needed: usize, capacity: usize },
    #[error("the cylinder has {0} sensors, which must be at most {most}", most = CW_MOST_SENSORS)]
    Sensors(usize),
    #[error("{0} rows are waiting: take them with cw_next until it says CW_NO_ROW")]
    RowsWaiting(usize),
    #[error("index {index} must be below {count}")]
    Index { index: u32, count: usize },
    #[error("the comment must be UTF-8 and shorter than {most} bytes", most = CW_TEXT_SIZE)]
    Text,
    #[cfg(target_os = "none")]
    #[error("without an operating system the size cannot be found: ask on a computer")]
    HostedOnly,
    #[cfg(not(target_os = "none"))]
    #[error("a mistake inside the library: go on from the last saved state, and report it")]
    Panicked,
    #[error(transparent)]
    Monitor(#[from] DetectorError),
}

impl Failure {
    pub(crate) fn code(&self) -> cw_code {
        match self {
            Self::Null(_) => cw_code::CW_NULL,
            Self::Misaligned { .. } => cw_code::CW_MISALIGNED,
            Self::Size { .. } => cw_code::CW_SIZE,
            Self::Handle => cw_code::CW_HANDLE,
            Self::Ended => cw_code::CW_ENDED,
            Self::ArenaTooSmall { .. } => cw_code::CW_ARENA_TOO_SMALL,
            Self::OutOfMemory { .. } => cw_code::CW_OUT_OF_MEMORY,
            Self::BufferTooSmall { .. } => cw_code::CW_BUFFER_TOO_SMALL,
            Self::Sensors(_) => cw_code::CW_SENSORS,
            Self::RowsWaiting(_) => cw_code::CW_ROWS_WAITING,
            Self::Index { .. } => cw_code::CW_INDEX,
            Self::Text => cw_code::CW_TEXT,
            #[cfg(target_os = "none")]
            Self::HostedOnly => cw_code::CW_HOSTED_ONLY,
            #[cfg(not(target_os = "none"))]
            Self::Panicked => cw_code::CW_PANICKED,
            Self::Monitor(error) => match error {
                DetectorError::Sealed(SealError::Other(_)) => cw_code::CW_OTHER_BYTES,
                DetectorError::Sealed(SealError::Version { .. }) => cw_code::CW_VERSION,
                DetectorError::Sealed(SealError::Foreign(_)) => cw_code::CW_FOREIGN,
                DetectorError::Sealed(SealError::Cut { .. }) => cw_code::CW_CUT,
                DetectorError::Sealed(SealError::Corrupted(_)) => cw_code::CW_DAMAGED,
                DetectorError::RowLength { .. } => cw_code::CW_READINGS,
                _ => cw_code::CW_REFUSED,
            },
        }
    }
}

/// Text in a place of its own: nothing is allocated for it.
pub(crate) struct Text<const SIZE: usize> {
    bytes: [u8; SIZE],
    length: usize,
}

impl<const SIZE: usize> Text<SIZE> {
    pub(crate) const EMPTY: Self = Self { bytes: [0; SIZE], length: 0 };

    /// What is displayed, cut where it does not fit.
    pub(crate) fn of(shown: &impl fmt::Display) -> Self {
        let mut text = Self::EMPTY;
        // It ends early where it is full.
        let _ = write!(text, "{shown}");
        text
    }

    pub(crate) fn as_bytes(&self) -> &[u8] {
        &self.bytes[..self.length]
    }
}

impl<const SIZE: usize> Write for Text<SIZE> {
    fn write_str(&mut self, more: &str) -> fmt::Result {
        let room = SIZE - self.length;
        let fits = (0..=room.min(more.len())).rev().find(|&end| more.is_char_boundary(end)).unwrap_or(0);
        self.bytes[self.length..][..fits].copy_from_slice(&more.as_bytes()[..fits]);
        self.length += fits;
        if fits == more.len() { Ok(()) } else { Err(fmt::Error) }
    }
}
