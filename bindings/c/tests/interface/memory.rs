//! What a monitor needs lies in its arena, and how much that is.
use crate::support::{Handle, Memory, blob, cylinder, rows};
use cylwatch_c::code::cw_code;
use cylwatch_c::{cw_save, cw_size};
use std::ptr::null_mut;

fn needed(blob: &[u8]) -> usize {
    let mut size = 0;
    assert_eq!(unsafe { cw_size(blob.as_ptr(), blob.len(), &raw mut size) }, cw_code::CW_OK);
    size
}

/// Days of rows a minute apart, a leak from the third on, the state saved each day; the most memory that is reached.
fn live(handle: &Handle, days: usize) -> usize {
    let day = rows(8640);
    for row in 0..1440 * days {
        let (_, mut readings) = day[row % 1440 * day.len() / 1440];
        readings[2] *= 1.0 - 1e-3 * (row as f64 / 1440.0 - 2.0).max(0.0);
        handle.all(handle.step(60.0 * row as f64, &readings));
        if row % 1440 == 1439 {
            handle.save();
        }
    }
    handle.memory().reached_bytes
}

#[test]
fn an_arena_of_the_size_that_is_said_is_enough() {
    let blob = blob();
    let size = needed(&blob);
    let (code, handle) = Handle::init(Memory::skipping(5, size), &blob);
    assert_eq!(code, cw_code::CW_OK, "{}", handle.detail());
    let reached = live(&handle, 4);
    println!("{size} bytes, {reached} reached; {} allocations", handle.memory().allocations);
    let (code, handle) = Handle::restore(Memory::of(size), &blob, &handle.save());
    assert_eq!(code, cw_code::CW_OK, "{}", handle.detail());
    assert!(handle.memory().reached_bytes < size);
}

/// `cargo test -p cylwatch-c -- --ignored --nocapture an_arena_is_enough_for_months`
#[test]
#[ignore = "half a minute"]
fn an_arena_is_enough_for_months() {
    let blob = blob();
    let (code, handle) = Handle::init(Memory::of(needed(&blob)), &blob);
    assert_eq!(code, cw_code::CW_OK, "{}", handle.detail());
    println!("{} bytes reached in 90 days of {:?}", live(&handle, 90), handle.memory());
}

#[test]
fn an_arena_that_is_too_small_is_refused_whatever_its_size() {
    let blob = blob();
    let mut begins = None;
    for size in (0..64).chain((64..1 << 20).step_by(4099)) {
        let (code, handle) = Handle::init(Memory::of(size), &blob);
        match code {
            cw_code::CW_OK => begins = begins.or(Some(size)),
            code => {
                assert_eq!(code, cw_code::CW_ARENA_TOO_SMALL, "{size}");
                assert!(
                    handle.handle.is_null() || handle.detail().contains("cw_size"),
                    "{}",
                    handle.detail()
                );
                assert_eq!(begins, None, "one of {size} bytes");
            }
        }
    }
    println!("it begins in {begins:?} bytes");
}

/// The smallest arena that a monitor begins in.
fn smallest(blob: &[u8]) -> Handle {
    let begun = (40..100).find_map(|pages| {
        let (code, handle) = Handle::init(Memory::of(pages << 12), blob);
        (code == cw_code::CW_OK).then_some(handle)
    });
    begun.unwrap()
}

#[test]
fn where_a_monitor_begins_it_goes_on_and_is_saved() {
    let handle = smallest(&blob());
    for (time_s, readings) in rows(8640) {
        let code = handle.step(time_s, &readings).0;
        assert!(matches!(code, cw_code::CW_OK | cw_code::CW_NO_ROW), "{code:?}: {}", handle.detail());
    }
    assert!(handle.save().len() > 10_000);
    assert_eq!(handle.memory().allocations, 0);
}

#[test]
fn an_arena_that_becomes_full_ends_the_monitor_with_a_code() {
    // Rows that wait a day for late ones take as much memory as there are.
    let mut cylinder = cylinder(&["shoulder", "valve", "pressure"]);
    cylinder.settings.intake.lateness_s = 86_400.0;
    let handle = smallest(&cylinder.to_bytes().unwrap());
    let codes = rows(8640).into_iter().map(|(time_s, readings)| handle.step(time_s, &readings).0);
    let full = codes.into_iter().find(|code| *code != cw_code::CW_NO_ROW);
    assert_eq!(full, Some(cw_code::CW_OUT_OF_MEMORY));
    assert!(handle.detail().contains("did not fit"), "{}", handle.detail());
    assert_eq!(handle.next().0, cw_code::CW_ENDED);
    let mut size = 0;
    assert_eq!(unsafe { cw_save(handle.handle, null_mut(), 0, &raw mut size) }, cw_code::CW_ENDED);
    assert_eq!(handle.memory().used_bytes, 0, "what came from the system has gone back");
}

#[test]
fn every_cylinder_has_a_size() {
    let names =
        ["shoulder", "valve", "pressure", "ambient", "wall_bottom", "wall_middle", "wall_neck", "gas_1"];
    for count in [2, 8] {
        let mut names = names;
        names.swap(1, 2);
        let size = needed(&cylinder(&names[..count]).to_bytes().unwrap());
        println!("{count} sensors: {size} bytes");
        assert!((200 << 10..4 << 20).contains(&size), "{count} sensors: {size} bytes");
    }
}
