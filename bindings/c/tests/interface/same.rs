//! What comes out in C is what the monitor says, bit for bit.
use crate::support::{Handle, Memory, blob, rows};
use cylwatch_c::code::cw_code;
use cylwatch_c::event::{cw_alarm, cw_event};
use cylwatch_c::output::{cw_health, cw_interval, cw_output, cw_time_left};
use cylwatch_c::{cw_acknowledge, cw_alarm_at, cw_event_at};
use cylwatch_detector::compiled::CompiledCylinder;
use cylwatch_detector::monitor::{Health, Interval, Output, Reason, Verdict};
use cylwatch_detector::prognosis::{Passage, Quantiles};
use std::ffi::CStr;
use std::mem::MaybeUninit;

fn interval(of: &cw_interval) -> [u64; 3] {
    [of.value, of.low, of.high].map(f64::to_bits)
}

fn left(of: &cw_time_left) -> [u64; 4] {
    [of.p5_s, of.p50_s, of.p95_s, of.horizon_s].map(f64::to_bits)
}

fn health(of: &cw_health) -> [u64; 2] {
    [of.state as u64, of.off_k_or_pa.to_bits()]
}

/// All that C has of a row.
pub(crate) fn bits_in_c(output: &cw_output) -> Vec<u64> {
    let numbers = [
        output.stamp_s,
        output.time_s,
        output.leak_probability,
        output.gas_mean_k,
        output.gas_mean_sd_k,
        output.mass_kg,
        output.mass_sd_kg,
        output.estimated_leak_kg_s,
        output.estimated_leak_sd_kg_s,
        output.pressure_pa,
        output.pressure_expected_pa,
        output.pressure_at_15_degc_pa,
        output.cold_pressure_pa,
        output.before_safe_state_probability,
        output.before_next_service_probability,
        output.before_following_service_probability,
    ];
    let counts = [output.sensor_count, output.event_count, output.alarm_count].map(u64::from);
    let words = [
        output.verdict as u64,
        output.reason as u64,
        output.outcome as u64,
        output.reaction as i64 as u64,
        output.advice as i64 as u64,
        output.quality as u64,
        u64::from(output.leak_found),
        u64::from(output.outlook_known),
        u64::from(output.outlook_of_leak),
    ];
    let mut bits: Vec<u64> = numbers.map(f64::to_bits).to_vec();
    bits.extend(counts);
    bits.extend(words);
    for of in [&output.leak_rate_kg_s, &output.leak_rate_pa_s, &output.leak_onset_s, &output.lost_kg] {
        bits.extend(interval(of));
    }
    for of in [&output.operational_limit, &output.cold_limit, &output.maintenance_limit] {
        bits.extend(left(of));
    }
    bits.extend(output.health.iter().flat_map(health));
    bits
}

fn nan() -> u64 {
    f64::NAN.to_bits()
}

fn wanted_reason(verdict: Verdict) -> u64 {
    verdict.reason().map_or(0, |reason| 1 + Reason::ALL.iter().position(|one| *one == reason).unwrap() as u64)
}

fn wanted_health(health: Option<&Health>) -> [u64; 2] {
    match health {
        Some(Health::Shifted(by)) => [5, by.to_bits()],
        Some(Health::Deviates(by)) => [6, by.to_bits()],
        Some(Health::Good) => [0, nan()],
        Some(Health::Missing) => [1, nan()],
        Some(Health::Implausible) => [2, nan()],
        Some(Health::Stuck) => [3, nan()],
        Some(Health::Spikes) => [4, nan()],
        Some(Health::Detached) => [7, nan()],
        None => [8, nan()],
    }
}

fn wanted_left(quantiles: Option<Quantiles>) -> [u64; 4] {
    let Some(Quantiles { p5, p50, p95, horizon_s }) = quantiles else { return [nan(); 4] };
    let seconds = |passage| match passage {
        Passage::Reached => 0.0,
        Passage::In(seconds) => seconds,
        Passage::BeyondHorizon => f64::INFINITY,
        Passage::Unknown => f64::NAN,
    };
    [seconds(p5), seconds(p50), seconds(p95), horizon_s].map(f64::to_bits)
}

/// The same of the monitor's output, in the same order.
pub(crate) fn bits(output: &Output) -> Vec<u64> {
    let (estimate, decision, outlook) = (&output.estimate, &output.decision, output.outlook);
    let probability = |of: fn(&cylwatch_detector::prognosis::Advice) -> f64| {
        outlook.map_or(f64::NAN, |outlook| of(&outlook.advice))
    };
    let numbers = [
        output.stamp_s,
        estimate.time_s,
        decision.leak_probability.unwrap_or(f64::NAN),
        estimate.gas_mean_k,
        estimate.gas_mean_sd_k,
        estimate.mass_kg,
        estimate.mass_sd_kg,
        estimate.leak_kg_s,
        estimate.leak_sd_kg_s,
        estimate.pressure_pa,
        estimate.pressure_expected_pa,
        estimate.p15_pa,
        output.cold_pressure_pa,
        probability(|advice| advice.before_safe_state),
        probability(|advice| advice.before_next_service),
        probability(|advice| advice.before_following_service),
    ];
    let mut bits: Vec<u64> = numbers.map(f64::to_bits).to_vec();
    bits.extend([output.health.len(), output.events.len(), output.alarms.len()].map(|count| count as u64));
    let verdicts = ["tight", "leak", "discharge", "refill", "sensor fault", "unknown"];
    let verdict = decision.verdict.as_str();
    bits.push(verdicts.iter().position(|one| *one == verdict).unwrap() as u64);
    bits.push(wanted_reason(decision.verdict));
    bits.push(
        [0, 1, 3, 2].iter().position(|code| *code == decision.outcome.exit_code()).unwrap().min(2) as u64
    );
    let reaction =
        |reaction: Option<cylwatch_detector::prognosis::Reaction>| reaction.map_or(-1, |of| of as i64) as u64;
    bits.push(reaction(decision.reaction));
    bits.push(reaction(outlook.map(|outlook| outlook.advice.reaction)));
    bits.push(estimate.quality as u64);
    bits.push(u64::from(output.leak.is_some()));
    bits.push(u64::from(outlook.is_some()));
    bits.push(u64::from(outlook.is_some_and(|outlook| outlook.known)));
    let interval =
        |of: Option<Interval>| of.map_or([nan(); 3], |of| [of.value, of.low, of.high].map(f64::to_bits));
    let leak = output.leak;
    bits.extend(interval(Some(output.leak_rate_kg_s)));
    bits.extend(interval(leak.map(|leak| leak.rate_pa_s)));
    bits.extend(interval(leak.map(|leak| leak.onset_s)));
    bits.extend(interval(leak.map(|leak| leak.lost_kg)));
    bits.extend(wanted_left(outlook.map(|outlook| outlook.operational)));
    bits.extend(wanted_left(outlook.map(|outlook| outlook.cold)));
    bits.extend(wanted_left(outlook.map(|outlook| outlook.maintenance)));
    bits.extend((0..8).flat_map(|sensor| wanted_health(output.health.get(sensor))));
    bits
}

fn text(id: &[std::ffi::c_char]) -> &str {
    unsafe { CStr::from_ptr(id.as_ptr()) }.to_str().unwrap()
}

fn event(handle: &Handle, index: usize) -> cw_event {
    let mut event = MaybeUninit::uninit();
    let code = unsafe { cw_event_at(handle.handle, index as u32, event.as_mut_ptr()) };
    assert_eq!(code, cw_code::CW_OK, "{}", handle.detail());
    unsafe { event.assume_init() }
}

fn alarm(handle: &Handle, index: usize) -> cw_alarm {
    let mut alarm = MaybeUninit::uninit();
    let code = unsafe { cw_alarm_at(handle.handle, index as u32, alarm.as_mut_ptr()) };
    assert_eq!(code, cw_code::CW_OK, "{}", handle.detail());
    unsafe { alarm.assume_init() }
}

fn compare(handle: &Handle, in_c: (cw_code, MaybeUninit<cw_output>), outputs: &[Output]) -> usize {
    let mut last = in_c;
    for (row, output) in outputs.iter().enumerate() {
        assert_eq!(last.0, cw_code::CW_OK, "row {row}: {}", handle.detail());
        let plain = unsafe { last.1.assume_init() };
        assert_eq!(bits_in_c(&plain), bits(output), "{plain:?}\n{output:?}");
        for (index, of) in output.events.iter().enumerate() {
            let event = event(handle, index);
            assert_eq!(
                (text(&event.id), event.time_s, event.onset_s),
                (of.id().to_string().as_str(), of.time_s, of.onset_s)
            );
        }
        for (index, of) in output.alarms.iter().enumerate() {
            let (alarm, condition) = (alarm(handle, index), &of.transition.condition);
            assert_eq!((text(&alarm.id), alarm.time_s), (of.id().to_string().as_str(), of.transition.time_s));
            let states = (alarm.active, alarm.acked, alarm.confirmed, alarm.latched);
            assert_eq!(states, (condition.active, condition.acked, condition.confirmed, condition.latched));
        }
        last = handle.next();
    }
    assert_eq!(last.0, cw_code::CW_NO_ROW);
    outputs.len()
}

#[test]
fn a_day_with_a_restore_in_its_middle_has_the_bits_of_the_monitor() {
    let blob = blob();
    let cylinder = CompiledCylinder::from_bytes(&blob).unwrap();
    let mut monitor = cylinder.monitor().unwrap();
    let mut handle = Handle::begun();
    let rows = rows(8640);
    let mut compared = 0;
    for (row, (time_s, readings)) in rows.iter().enumerate() {
        if row == rows.len() / 2 {
            let state = monitor.save().unwrap();
            assert_eq!(handle.save(), state);
            monitor = cylinder.restored(&state).unwrap();
            let (code, restored) = Handle::restore(Memory::skipping(3, 4 << 20), &blob, &state);
            assert_eq!(code, cw_code::CW_OK, "{}", restored.detail());
            handle = restored;
        }
        let outputs = monitor.step(*time_s, readings).unwrap();
        compared += compare(&handle, handle.step(*time_s, readings), &outputs);
    }
    let outputs = monitor.finish().unwrap();
    compared += compare(&handle, handle.finish(), &outputs);
    assert_eq!(handle.save(), monitor.save().unwrap());
    assert!(compared > 1300, "{compared} rows");
}

#[test]
fn an_acknowledgement_and_an_announcement_reach_the_monitor() {
    let cylinder = CompiledCylinder::from_bytes(&blob()).unwrap();
    let mut monitor = cylinder.monitor().unwrap();
    let handle = Handle::begun();
    let (from_s, until_s) = (3600.0, 7200.0);
    monitor.announce(from_s, until_s);
    assert_eq!(unsafe { cylwatch_c::cw_announce(handle.handle, from_s, until_s) }, cw_code::CW_OK);
    for (time_s, readings) in rows(2000) {
        // The transmitter is dead from the first hour on: an alarm.
        let readings = if time_s > 3600.0 { [readings[0], readings[1], f64::NAN] } else { readings };
        let outputs = monitor.step(time_s, &readings).unwrap();
        compare(&handle, handle.step(time_s, &readings), &outputs);
    }
    let comment = "seen: geprüft";
    let wanted = monitor.acknowledge(comment);
    assert!(!wanted.is_empty());
    let mut count = 0;
    let code =
        unsafe { cw_acknowledge(handle.handle, comment.as_ptr().cast(), comment.len(), &raw mut count) };
    assert_eq!((code, count as usize), (cw_code::CW_OK, wanted.len()));
    for (index, of) in wanted.iter().enumerate() {
        assert_eq!(text(&alarm(&handle, index).id), of.id().to_string());
    }
    assert_eq!(handle.save(), monitor.save().unwrap());
}
