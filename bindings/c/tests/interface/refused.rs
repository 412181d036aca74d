//! Whatever is wrong has a code, words, and no other consequence.
use crate::support::{Handle, Memory, blob, cylinder, rows};
use cylwatch_c::code::cw_code::{self, *};
use cylwatch_c::*;
use std::mem::MaybeUninit;
use std::ptr::{null, null_mut};

/// So many bytes are more than an object can have.
const WILD: usize = isize::MAX as usize + 1;

/// The code of a call that is given a pointer that is wrong.
fn with_bytes(mut call: impl FnMut(*const u8, usize) -> cw_code, other: cw_code) {
    let one = 0_u8;
    assert_eq!(call(null(), 1), CW_NULL);
    assert_eq!(call(&raw const one, WILD), CW_SIZE);
    assert_eq!(call(&raw const one, usize::MAX), CW_SIZE);
    assert_eq!(call(null(), 0), other);
    assert_eq!(call(&raw const one, 1), other);
}

#[test]
fn pointers_of_what_begins_are_checked() {
    let (memory, blob) = (Memory::of(4 << 20), blob());
    let mut handle = null_mut();
    let (start, size) = (memory.start(), memory.size());
    unsafe {
        let mut bytes = 0;
        with_bytes(|at, size| cw_size(at, size, &raw mut bytes), CW_OTHER_BYTES);
        assert_eq!(cw_size(blob.as_ptr(), blob.len(), null_mut()), CW_NULL);
        assert_eq!(cw_size(blob.as_ptr(), blob.len(), (&raw mut bytes).wrapping_byte_add(1)), CW_MISALIGNED);
        with_bytes(|at, bytes| cw_init(start, size, at, bytes, &raw mut handle), CW_OTHER_BYTES);
        assert!(!handle.is_null(), "it says why");
        let state = blob.as_ptr();
        with_bytes(|at, bytes| cw_restore(start, size, at, bytes, state, 1, &raw mut handle), CW_OTHER_BYTES);
        with_bytes(
            |at, bytes| cw_restore(start, size, state, blob.len(), at, bytes, &raw mut handle),
            CW_OTHER_BYTES,
        );
        assert_eq!(cw_init(null_mut(), size, blob.as_ptr(), blob.len(), &raw mut handle), CW_NULL);
        assert!(handle.is_null());
        assert_eq!(cw_init(start, WILD, blob.as_ptr(), blob.len(), &raw mut handle), CW_SIZE);
        assert_eq!(cw_init(start, size, blob.as_ptr(), blob.len(), null_mut()), CW_NULL);
        let askew = (&raw mut handle).wrapping_byte_add(1);
        assert_eq!(cw_init(start, size, blob.as_ptr(), blob.len(), askew), CW_MISALIGNED);
    }
}

#[test]
fn pointers_of_a_monitor_are_checked() {
    let handle = Handle::begun();
    let at = handle.handle;
    let readings = [285.0, 285.0, 200e5];
    let (mut output, mut event, mut alarm) =
        (MaybeUninit::uninit(), MaybeUninit::uninit(), MaybeUninit::uninit());
    let (mut count, mut size, mut memory) = (0, 0, cw_memory::default());
    let mut text = [0; 8];
    unsafe {
        let numbers = readings.as_ptr();
        let to = output.as_mut_ptr();
        // One after the other is wrong; the rest is right.
        for (handle, expected) in [(null_mut(), CW_NULL), (at.wrapping_byte_add(1), CW_MISALIGNED)] {
            assert_eq!(cw_step(handle, 0.0, numbers, 3, to), expected);
            assert_eq!(cw_next(handle, to), expected);
            assert_eq!(cw_finish(handle, to), expected);
            assert_eq!(cw_event_at(handle, 0, event.as_mut_ptr()), expected);
            assert_eq!(cw_alarm_at(handle, 0, alarm.as_mut_ptr()), expected);
            assert_eq!(cw_acknowledge(handle, null(), 0, &raw mut count), expected);
            assert_eq!(cw_announce(handle, 0.0, 1.0), expected);
            assert_eq!(cw_save(handle, null_mut(), 0, &raw mut size), expected);
            assert_eq!(cw_detail(handle, text.as_mut_ptr(), 8), expected);
            assert_eq!(cw_memory_of(handle, &raw mut memory), expected);
        }
        for (askew, expected) in [(false, CW_NULL), (true, CW_MISALIGNED)] {
            fn wrong<T>(right: *mut T, askew: bool) -> *mut T {
                if askew { right.wrapping_byte_add(1) } else { null_mut() }
            }
            assert_eq!(cw_step(at, 0.0, numbers, 3, wrong(to, askew)), expected);
            assert_eq!(cw_step(at, 0.0, wrong(numbers.cast_mut(), askew), 3, to), expected);
            assert_eq!(cw_next(at, wrong(to, askew)), expected);
            assert_eq!(cw_finish(at, wrong(to, askew)), expected);
            assert_eq!(cw_event_at(at, 0, wrong(event.as_mut_ptr(), askew)), expected);
            assert_eq!(cw_alarm_at(at, 0, wrong(alarm.as_mut_ptr(), askew)), expected);
            assert_eq!(cw_acknowledge(at, null(), 0, wrong(&raw mut count, askew)), expected);
            assert_eq!(cw_save(at, null_mut(), 0, wrong(&raw mut size, askew)), expected);
            assert_eq!(cw_memory_of(at, wrong(&raw mut memory, askew)), expected);
        }
        assert_eq!(cw_step(at, 0.0, numbers, WILD / 8, to), CW_SIZE);
        assert_eq!(cw_step(at, 0.0, numbers, usize::MAX, to), CW_SIZE);
        assert_eq!(cw_save(at, null_mut(), 1, &raw mut size), CW_NULL);
        assert_eq!(cw_save(at, text.as_mut_ptr().cast(), WILD, &raw mut size), CW_SIZE);
        assert_eq!(cw_acknowledge(at, null(), 1, &raw mut count), CW_NULL);
        assert_eq!(cw_detail(at, null_mut(), 1), CW_NULL);
        assert_eq!(cw_detail(at, null_mut(), 0), CW_BUFFER_TOO_SMALL);
    }
    assert_eq!(handle.memory().allocations, 0, "nothing was begun in vain");
    assert_eq!(handle.step(0.0, &readings).0, CW_NO_ROW, "{}", handle.detail());
}

#[test]
fn what_is_no_handle_is_refused() {
    let zeros = Memory::of(1 << 16);
    let mut output = MaybeUninit::uninit();
    unsafe {
        zeros.start().write_bytes(0, zeros.size());
        assert_eq!(cw_next(zeros.start().cast(), output.as_mut_ptr()), CW_HANDLE);
        let handle = Handle::begun();
        zeros.start().copy_from_nonoverlapping(handle.handle.cast(), 1 << 13);
        assert_eq!(cw_next(zeros.start().cast(), output.as_mut_ptr()), CW_HANDLE, "it has been moved");
    }
}

#[test]
fn a_row_of_another_length_changes_nothing() {
    let (one, other) = (Handle::begun(), Handle::begun());
    for (time_s, readings) in rows(200) {
        for wrong in [&readings[..0], &readings[..2], &[readings[0]; 4][..], &[0.0; 1000][..]] {
            assert_eq!(one.step(time_s, wrong).0, CW_READINGS);
        }
        assert!(one.detail().contains("does not fit 3 sensors"), "{}", one.detail());
        let outputs =
            (one.all(one.step(time_s, &readings)).len(), other.all(other.step(time_s, &readings)).len());
        assert_eq!(outputs.0, outputs.1);
    }
    assert_eq!(one.save(), other.save());
}

#[test]
fn rows_that_wait_are_not_lost() {
    let handle = Handle::begun();
    let mut size = 0;
    // Two hours, then days later: the first rows wait for others, which say that the clock is right.
    let later = |row: usize| if row > 700 { 3e5 + 300.0 * (row - 700) as f64 } else { 0.0 };
    let rows = rows(720).into_iter().enumerate();
    let day: Vec<_> = rows.map(|(row, (time_s, readings))| (time_s + later(row), readings)).collect();
    let waiting = day.iter().position(|(time_s, readings)| {
        let (code, output) = handle.step(*time_s, readings);
        let saved = unsafe { cw_save(handle.handle, null_mut(), 0, &raw mut size) };
        if saved == CW_ROWS_WAITING {
            return true;
        }
        assert_eq!(saved, CW_BUFFER_TOO_SMALL);
        handle.all((code, output));
        false
    });
    let (time_s, readings) = day[waiting.expect("two rows at once")];
    assert_eq!(handle.step(time_s + 10.0, &readings).0, CW_ROWS_WAITING);
    assert_eq!(handle.finish().0, CW_ROWS_WAITING);
    assert!(handle.detail().contains("rows are waiting"), "{}", handle.detail());
    let waited = handle.all(handle.next());
    assert!(!waited.is_empty());
    assert_ne!(handle.step(time_s + 10.0, &readings).0, CW_ROWS_WAITING);
}

#[test]
fn bytes_that_are_no_cylinder_or_no_state_of_it_have_codes_of_their_own() {
    let blob = blob();
    let handle = Handle::begun();
    let state = handle.save();
    let other = cylinder(&["shoulder", "pressure"]).to_bytes().unwrap();
    let changed = |bytes: &[u8], at: usize| {
        let mut bytes = bytes.to_vec();
        bytes[at] ^= 1;
        bytes
    };
    let arena = || Memory::of(4 << 20);
    let init = |blob: &[u8]| {
        let (code, handle) = Handle::init(arena(), blob);
        (code, handle.detail())
    };
    let restore = |blob: &[u8], state: &[u8]| {
        let (code, handle) = Handle::restore(arena(), blob, state);
        (code, handle.detail())
    };
    for (found, code, words) in [
        (init(b""), CW_OTHER_BYTES, "no compiled cylinder"),
        (init(&state), CW_OTHER_BYTES, "no compiled cylinder"),
        (init(&blob[..blob.len() - 1]), CW_CUT, "cut short"),
        (init(&blob[..20]), CW_CUT, "cut short"),
        (init(&changed(&blob, 8)), CW_VERSION, "version"),
        (init(&changed(&blob, blob.len() / 2)), CW_DAMAGED, "check sum"),
        (restore(&blob, b""), CW_OTHER_BYTES, "no state of a monitor"),
        (restore(&blob, &blob), CW_OTHER_BYTES, "no state of a monitor"),
        (restore(&other, &state), CW_FOREIGN, "another vessel"),
        (restore(&blob, &state[..state.len() - 1]), CW_CUT, "cut short"),
        (restore(&blob, &changed(&state, 8)), CW_VERSION, "version"),
        (restore(&blob, &changed(&state, state.len() / 2)), CW_DAMAGED, "check sum"),
        (restore(&changed(&blob, blob.len() / 2), &state), CW_DAMAGED, "compiled cylinder"),
    ] {
        assert_eq!(found.0, code, "{}", found.1);
        assert!(found.1.contains(words), "{}", found.1);
    }
    assert_eq!(restore(&blob, &state).0, CW_OK);
}

#[test]
fn a_monitor_that_did_not_begin_says_so_at_every_call() {
    let (code, handle) = Handle::init(Memory::of(4 << 20), b"nothing of the kind");
    assert_eq!(code, CW_OTHER_BYTES);
    assert_eq!(handle.step(0.0, &[1.0]).0, CW_ENDED);
    assert_eq!((handle.next().0, handle.finish().0), (CW_ENDED, CW_ENDED));
    let mut size = 0;
    assert_eq!(unsafe { cw_save(handle.handle, null_mut(), 0, &raw mut size) }, CW_ENDED);
    assert_eq!(unsafe { cw_announce(handle.handle, 0.0, 1.0) }, CW_ENDED);
    assert!(handle.detail().contains("cw_init"), "{}", handle.detail());
}

#[test]
fn more_sensors_than_an_output_has_room_for_are_refused() {
    let names = [
        "shoulder",
        "valve",
        "pressure",
        "ambient",
        "wall_bottom",
        "wall_middle",
        "wall_neck",
        "gas_1",
        "gas_2",
    ];
    let bytes = |count: usize| cylinder(&names[..count]).to_bytes().unwrap();
    let (code, handle) = Handle::init(Memory::of(8 << 20), &bytes(8));
    assert_eq!(code, CW_OK, "{}", handle.detail());
    let (code, handle) = Handle::init(Memory::of(8 << 20), &bytes(9));
    assert_eq!(code, CW_SENSORS);
    assert!(handle.detail().contains("9 sensors"), "{}", handle.detail());
}

#[test]
fn indices_texts_and_buffers_have_their_bounds() {
    let handle = Handle::begun();
    let mut event = MaybeUninit::uninit();
    let mut alarm = MaybeUninit::uninit();
    let mut count = 0;
    for index in [0, 1, u32::MAX] {
        assert_eq!(unsafe { cw_event_at(handle.handle, index, event.as_mut_ptr()) }, CW_INDEX);
        assert_eq!(unsafe { cw_alarm_at(handle.handle, index, alarm.as_mut_ptr()) }, CW_INDEX);
    }
    let mut acknowledge = |comment: &[u8]| unsafe {
        cw_acknowledge(handle.handle, comment.as_ptr().cast(), comment.len(), &raw mut count)
    };
    assert_eq!(acknowledge(&[0xff, 0xfe]), CW_TEXT);
    assert_eq!(acknowledge(&[b'a'; 512]), CW_TEXT);
    assert_eq!(acknowledge(&[b'a'; 511]), CW_OK);
    let mut size = 0;
    let mut buffer = [0_u8; 16];
    assert_eq!(
        unsafe { cw_save(handle.handle, buffer.as_mut_ptr(), 16, &raw mut size) },
        CW_BUFFER_TOO_SMALL
    );
    assert_eq!((buffer, size), ([0; 16], handle.save().len()));
    let mut short = [1_u8; 8];
    assert_eq!(unsafe { cw_detail(handle.handle, short.as_mut_ptr().cast(), 8) }, CW_OK);
    assert_eq!(&short, b"a state\0");
}
