//! Cylinders and states that have been damaged at random: each is refused, whatever the damage.
use crate::mutation::{Random, count, damaged, forged};
use crate::support::{Handle, Memory, blob, cylinder, rows};
use cylwatch_c::code::cw_code;
use cylwatch_c::{cw_handle, cw_init, cw_restore};
use std::collections::BTreeMap;
use std::ptr::null_mut;

/// A cylinder, and its state after two hours.
fn originals() -> (Vec<u8>, Vec<u8>) {
    let handle = Handle::begun();
    for (time_s, readings) in rows(720) {
        handle.all(handle.step(time_s, &readings));
    }
    (blob(), handle.save())
}

fn begin(arena: &Memory, blob: &[u8], state: Option<&[u8]>) -> (cw_code, *mut cw_handle) {
    let mut handle = null_mut();
    let (start, size) = (arena.start(), arena.size());
    let code = unsafe {
        match state {
            None => cw_init(start, size, blob.as_ptr(), blob.len(), &raw mut handle),
            Some(state) => cw_restore(
                start,
                size,
                blob.as_ptr(),
                blob.len(),
                state.as_ptr(),
                state.len(),
                &raw mut handle,
            ),
        }
    };
    (code, handle)
}

/// `MUTATIONS=1000000 cargo test -p cylwatch-c mutations -- --nocapture` is the long run.
#[test]
fn every_mutation_is_refused() {
    let (blob, state) = originals();
    let foreign = cylinder(&["shoulder", "pressure"]).to_bytes().unwrap();
    let arena = Memory::skipping(1, 4 << 20);
    let mut random = Random(0x5eed_0001);
    let mut codes = BTreeMap::new();
    for round in 0..count("MUTATIONS", 20_000) {
        let (original, other) = if round % 2 == 0 { (&blob, &foreign) } else { (&state, &blob) };
        let bytes = damaged(original, other, &mut random);
        if bytes == *original {
            continue;
        }
        let (code, handle) =
            if round % 2 == 0 { begin(&arena, &bytes, None) } else { begin(&arena, &blob, Some(&bytes)) };
        assert!(!matches!(code, cw_code::CW_OK | cw_code::CW_PANICKED), "round {round}: {code:?}");
        assert!(!handle.is_null());
        *codes.entry(format!("{code:?}")).or_insert(0_usize) += 1;
    }
    println!("{codes:?}");
}

/// The check sum finds accidents, not intent: with the right one anything may be in the bytes. They are then refused or taken, and
/// nothing panics where a monitor begins. `FORGERIES=100000` is longer; what the rows after it do the detector's own tests show.
#[test]
fn no_mutation_with_a_right_check_sum_panics() {
    let (blob, state) = originals();
    let foreign = cylinder(&["shoulder", "pressure"]).to_bytes().unwrap();
    let arena = Memory::of(4 << 20);
    let mut random = Random(0x5eed_0002);
    let mut codes = BTreeMap::new();
    for round in 0..count("FORGERIES", 300) {
        let (original, other) = if round % 2 == 0 { (&blob, &foreign) } else { (&state, &blob) };
        let bytes = forged(original, other, &mut random);
        let (code, _) =
            if round % 2 == 0 { begin(&arena, &bytes, None) } else { begin(&arena, &blob, Some(&bytes)) };
        assert!(code != cw_code::CW_PANICKED, "round {round}");
        *codes.entry(format!("{code:?}")).or_insert(0_usize) += 1;
    }
    println!("{codes:?}");
}
