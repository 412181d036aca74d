//! The monitor of a compiled cylinder for C and C++, and with them for a PLC.
//!
//! The caller gives an arena; everything that a monitor needs lies in it, with the handle at its head. Nothing is kept
//! elsewhere, and there is nothing to free. Errors are codes, with words on request.
//!
//! * `calls`: the functions, and what each checks of its pointers.
//! * [`output`], [`event`], [`code`]: what they hand over, in plain structs.
//! * `handle`, `session`: what lies at the head of an arena.
//! * `arena`: the allocator.
//! * `size`: how large an arena a cylinder needs.
//!
//! `include/cylwatch.h` is made from these files by cbindgen.
#![cfg_attr(target_os = "none", no_std)]
#![allow(non_camel_case_types)]
extern crate alloc;

mod arena;
mod calls;
pub mod code;
mod convert;
pub mod event;
mod handle;
pub mod output;
#[cfg(target_os = "none")]
mod panic;
mod pointer;
mod session;
#[cfg(not(target_os = "none"))]
mod size;

pub use arena::cw_memory;
pub use calls::*;
pub use handle::cw_handle;
