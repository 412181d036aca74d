//! Rows and state that a program in C wrote, against those of `replay` on the same log (`bindings/controller`).
use crate::same::{bits, bits_in_c};
use cylwatch_c::output::cw_output;
use cylwatch_detector::monitor::Output;
use std::path::PathBuf;

/// A count of four bytes, and as many bytes.
fn frames(mut bytes: &[u8]) -> Vec<&[u8]> {
    let mut frames = Vec::new();
    while let Some((count, rest)) = bytes.split_first_chunk::<4>() {
        let (frame, rest) = rest.split_at(u32::from_le_bytes(*count) as usize);
        frames.push(frame);
        bytes = rest;
    }
    frames
}

#[test]
#[ignore = "bindings/c/test runs it, in the folder of its files"]
fn a_program_in_c_says_what_replay_says() {
    let folder = PathBuf::from(std::env::var_os("REPLAYED").expect("REPLAYED is the folder of the files"));
    let read = |name: &str| std::fs::read(folder.join(name)).unwrap();
    let host = read("host.bin");
    let mut frames = frames(&host);
    let state = frames.pop().unwrap();
    assert!(state == read("state.raw"), "the state differs");
    let raw = read("rows.raw");
    let rows = raw.chunks_exact(size_of::<cw_output>());
    assert_eq!((rows.len(), rows.remainder().len()), (frames.len(), 0));
    for (row, (raw, frame)) in rows.zip(&frames).enumerate() {
        // SAFETY: the program wrote what the library had filled in.
        let row_in_c = unsafe { raw.as_ptr().cast::<cw_output>().read_unaligned() };
        let output: Output = postcard::from_bytes(frame).unwrap();
        assert_eq!(bits_in_c(&row_in_c), bits(&output), "row {row}");
    }
    println!("{} rows and {} bytes of state are the same", frames.len(), state.len());
}
