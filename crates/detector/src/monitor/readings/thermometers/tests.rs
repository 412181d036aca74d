use super::*;

const ERROR_K: f64 = 0.12;

fn surroundings(part: f64, away_k: f64) -> Surroundings {
    Surroundings { part, away_k, memory_s: 1200.0 }
}

fn course(shoulder: impl Fn(f64) -> f64, valve: impl Fn(f64) -> f64) -> Vec<Lonely> {
    told(Pair::new(0.0, ERROR_K), shoulder, valve)
}

fn told(mut pair: Pair, shoulder: impl Fn(f64) -> f64, valve: impl Fn(f64) -> f64) -> Vec<Lonely> {
    (0..600)
        .filter_map(|minute| {
            let t = f64::from(minute);
            pair.update(60.0 * t, [shoulder(t), valve(t)], surroundings(0.44, 0.0), true)
        })
        .filter(|lonely| !matches!(lonely, Lonely::Suspected(_)))
        .collect()
}

/// That this is the one thing told; the size is an estimate.
fn assert_shifted(told: &[Lonely], which: usize, by_k: f64) {
    let fits =
        matches!(told, [Lonely::Shifted(of, size_k)] if *of == which && (size_k / by_k - 1.0).abs() < 0.05);
    assert!(fits, "{told:?}");
}

#[test]
fn a_lonely_step_that_stays_is_an_offset() {
    let step = |t: f64| if t >= 100.0 { 281.0 } else { 280.0 };
    assert_shifted(&course(step, |_| 280.5), 0, 1.0);
    assert_shifted(&course(|_| 280.5, step), 1, 1.0);
}

#[test]
fn a_step_is_held_against_what_the_model_misses() {
    let step = |t: f64| if t >= 100.0 { 281.0 } else { 280.0 };
    assert_eq!(told(Pair::new(0.0, 2.0 * ERROR_K), step, |_| 280.5), []);
    let twice = |t: f64| 2.0 * step(t) - 280.0;
    assert_shifted(&told(Pair::new(0.0, 2.0 * ERROR_K), twice, |_| 280.5), 0, 2.0);
}

#[test]
fn a_reading_in_steps_jumps_by_more_than_its_steps() {
    // It drifts, and changes by a whole step of 0.5 K at a time.
    let coarse = |t: f64| 0.5 * (560.0 + 0.02 * t).floor();
    assert_eq!(told(Pair::new(0.5, ERROR_K), coarse, |_| 280.0), []);
    let jumps = |t: f64| coarse(t) + if t >= 120.0 { 5.0 } else { 0.0 };
    assert_shifted(&told(Pair::new(0.5, ERROR_K), jumps, |_| 280.0), 0, 5.0);
    // The mouth of a tunnel, where one bends by 3.8 K and the other one by 1.9 K.
    let mouth = |t: f64, by: f64| 280.0 + if t >= 120.0 { by } else { 0.0 };
    assert_eq!(told(Pair::new(0.5, ERROR_K), |t| mouth(t, 4.0), |t| mouth(t, 1.5)), []);
}

#[test]
fn what_the_surroundings_may_have_done_to_one_alone_is_no_jump() {
    let shifts = |doubt_k: f64| {
        let mut pair = Pair::new(0.0, ERROR_K);
        let step = |t: f64| if t >= 100.0 { 281.0 } else { 280.0 };
        let away_k = |t: f64| if t <= 100.0 { doubt_k } else { 0.0 };
        (0..200).map(f64::from).any(|t| {
            matches!(
                pair.update(60.0 * t, [step(t), 280.5], surroundings(1.0, away_k(t)), true),
                Some(Lonely::Shifted(0, _))
            )
        })
    };
    assert!(shifts(0.9) && !shifts(1.1));
}

#[test]
fn a_spike_and_a_tunnel_are_none() {
    assert_eq!(course(|t| if t == 100.0 { 290.0 } else { 280.0 }, |_| 280.0), []);
    let tunnel = |t: f64, coupling: f64| {
        let inside = if (100.0..130.0).contains(&t) { coupling * 45.0 } else { 0.0 };
        280.0 + inside
    };
    assert_eq!(course(|t| tunnel(t, 0.15), |t| tunnel(t, 0.05)), []);
}

#[test]
fn an_offset_in_a_tunnel_is_one_and_sun_on_both_is_none() {
    let warming = |t: f64| 280.0 + 0.5 * t.min(90.0);
    assert_shifted(&course(|t| warming(t) + if t >= 60.0 { -1.0 } else { 0.0 }, warming), 0, -1.0);
    assert_eq!(course(|t| 280.0 + (t - 100.0).max(0.0), |t| 280.0 + 0.3 * (t - 100.0).max(0.0)), []);
}

#[test]
fn what_is_apart_in_a_tunnel_alone_is_no_offset() {
    // Both meet warm air at once and warm up; what the valve reads of the air passes, the shoulder of a composite cylinder stays 3 K warmer until it is outside.
    let inside = |t: f64| (100.0..130.0).contains(&t);
    let warmed = |t: f64| 262.0 + 0.5 * (t - 100.0).clamp(0.0, 30.0);
    let shoulder = |t: f64| warmed(t) + if inside(t) { 3.0 } else { 0.0 };
    let valve = |t: f64| warmed(t) + if inside(t) { 3.0 * ((100.0 - t) / 8.0).exp() } else { 0.0 };
    assert_eq!(course(shoulder, valve), []);
}

#[test]
fn what_a_tunnel_hides_is_seen_after_it() {
    let tunnel = |t: f64, coupling: f64| {
        let warmed = 0.4 * (t - 100.0).clamp(0.0, 25.0);
        280.0 + warmed + if (100.0..125.0).contains(&t) { coupling * 45.0 } else { 0.0 }
    };
    let jumped = course(|t| tunnel(t, 0.15) + if t >= 98.0 { 5.0 } else { 0.0 }, |t| tunnel(t, 0.05));
    assert!(matches!(jumped[..], [Lonely::Shifted(0, by_k)] if (by_k - 5.0).abs() < 0.5), "{jumped:?}");
}

#[test]
fn at_the_mouth_of_a_tunnel_each_bends_in_its_own_way() {
    // As simulated: the shoulder bends two minutes after the mouth while the valve goes on.
    let shoulder = [1.72, 4.99, 8.18, 9.72, 10.66, 11.61, 12.56, 13.34, 14.05];
    let valve = [1.53, 2.89, 4.68, 6.34, 7.74, 8.98, 10.23, 11.38, 12.40];
    let of = |course: [f64; 9], t: f64| {
        let at = (t - 100.0).max(0.0);
        let (n, last) = (at as usize, course.len() - 1);
        273.15 + if n < last { course[n] } else { course[last] + 0.8 * (at - last as f64) }
    };
    assert_eq!(course(|t| of(shoulder, t), |t| of(valve, t)), []);
}

#[test]
fn what_bends_just_after_both_were_shaken_is_no_jump() {
    // As simulated: a train leaves a warm tunnel, and sun keeps the shoulder 0.9 K warmer than the valve from then on.
    let of = |mouth: [f64; 4], t: f64, after_k: f64| match t - 100.0 {
        at if at < 0.0 => 280.0,
        at if at < 4.0 => mouth[at as usize],
        _ => after_k,
    };
    let (shoulder, valve) = ([312.0, 312.82, 305.4, 303.58], [316.42, 316.95, 308.72, 305.06]);
    let courses = course(|t| of(shoulder, t, 300.9), |t| of(valve, t, 300.0));
    assert_eq!(courses, []);
}

#[test]
fn noise_of_the_other_one_hides_no_jump() {
    let step = |t: f64| if t >= 100.0 { 279.0 } else { 280.0 };
    let noise = |t: f64| [0.08, -0.1, 0.07][t as usize % 3];
    let jumped = course(step, |t| 280.5 + if t > 97.0 && t < 103.0 { noise(t) } else { 0.0 });
    assert!(matches!(jumped[..], [Lonely::Shifted(0, by_k)] if (by_k + 1.0).abs() < 0.35), "{jumped:?}");
}

#[test]
fn a_restless_one_beside_a_calm_one_is_detached() {
    let noise = |t: f64| 0.5 * if t as i64 % 3 == 0 { 1.0 } else { -0.5 };
    assert!(course(|_| 280.0, |t| 281.0 + noise(t)).contains(&Lonely::Detached(1)));
    assert_eq!(course(|t| 280.0 + noise(t), |t| 281.0 + 0.6 * noise(t)), []);
}

/// What a pair says first, with its minute, of readings that are so restless, K; five minutes apart for four days.
fn restless(sizes_k: impl Fn(f64) -> [f64; 2]) -> Option<(f64, Lonely)> {
    let mut pair = Pair::new(0.0, ERROR_K);
    (0..1152).find_map(|row| {
        let minute = 5.0 * f64::from(row);
        let noise = if row % 3 == 0 { 1.0 } else { -0.5 };
        let readings = sizes_k(minute).map(|size_k| 290.0 + size_k * noise);
        pair.update(60.0 * minute, readings, surroundings(0.44, 0.0), true).map(|told| (minute, told))
    })
}

#[test]
fn a_thin_valve_in_gusts_is_not_detached_and_one_that_comes_off_there_is() {
    assert_eq!(restless(|_| [0.1, 0.23]), None);
    let comes_off = |minute: f64| if minute < 2880.0 { [0.1, 0.23] } else { [0.1, 0.7] };
    let told = restless(comes_off);
    assert!(matches!(told, Some((2880.0..3120.0, Lonely::Detached(1)))), "{told:?}");
}

#[test]
fn one_that_jumps_with_the_air_again_and_again_is_detached() {
    let air = |t: f64| if (t / 50.0) as i64 % 2 == 0 { 270.0 } else { 300.0 };
    assert!(course(air, |_| 280.0).contains(&Lonely::Detached(0)));
}
