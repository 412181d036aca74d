//! Railway weeks and chamber courses against what is stated for them.
use super::super::course::Climate;
use super::super::railway::Railway;
use super::super::weather::draw_spaced;
use super::super::{Course, Passage, draw_weather, passages};
use super::{assert_uniform, mean, sd};
use cylwatch_thermal::scenario::{OutsideFilm, Scenario, Series};
use cylwatch_thermal::units::{DAY_S, HOUR_S};

fn inside(passages: &[Passage], t_s: f64) -> bool {
    // Long after the slowest lag the air outside is back to 1e-6 of the step.
    passages.iter().any(|p| t_s >= p.enter_s && t_s <= p.leave_s + 300.0)
}

#[test]
fn mean_air_is_uniform_and_the_days_swing_by_three_to_seven_kelvin_with_their_top_at_three() {
    let days = 60;
    let (mut means, mut swings, mut quadratures) = (Vec::new(), Vec::new(), Vec::new());
    for seed in 0..200 {
        let railway = Railway::draw(seed, days as f64 * DAY_S, Climate::Winter);
        let tunnels = passages(seed, days);
        // Half a day apart the diurnal parts cancel in the sum, and everything slow in the difference.
        let at = |hour: f64, sign: f64| {
            let tunnels = &tunnels;
            let railway = &railway;
            let values: Vec<f64> = (0..days - 1)
                .map(|day| day as f64 * DAY_S + hour * HOUR_S)
                .filter(|&t| !inside(tunnels, t) && !inside(tunnels, t + DAY_S / 2.0))
                .map(|t| 0.5 * (railway.air_degc(t) + sign * railway.air_degc(t + DAY_S / 2.0)))
                .collect();
            mean(&values)
        };
        means.push(at(3.0, 1.0));
        swings.push(-at(3.0, -1.0));
        quadratures.push(at(9.0, -1.0));
    }
    // The weather, 4 K and 2 d, leaves 2 s^2 tau / T = 1.07 K² in the mean of 60 days, beside (16 K)²/12 of the climate.
    let expected = (256.0 / 12.0 + 2.0 * 16.0 * 2.0 / 60.0_f64).sqrt();
    assert!((sd(&means) / expected - 1.0).abs() < 0.15, "sd of the means {} K, {expected}", sd(&means));
    assert!(mean(&means).abs() < 4.0 * expected / 200_f64.sqrt(), "mean {} °C", mean(&means));
    let outside = means.iter().filter(|mean| mean.abs() > 8.0 + 2.0).count();
    assert!(outside == 0 && means.iter().any(|&m| m < -6.5) && means.iter().any(|&m| m > 6.5));
    // Half of a difference over 12 h of the weather: 4 K sqrt(2 (1 - e^-1/4)) / 2, over some 50 days.
    let doubt = 4.0 * (2.0 * (1.0 - (-0.25_f64).exp())).sqrt() / 2.0 / 50_f64.sqrt();
    let (least, most) =
        (swings.iter().fold(f64::INFINITY, |a, &b| a.min(b)), swings.iter().fold(0.0, |a: f64, &b| a.max(b)));
    assert!(least > 3.0 - 4.0 * doubt && most < 7.0 + 4.0 * doubt, "swings {least} to {most} K");
    assert!((mean(&swings) - 5.0).abs() < 4.0 * (16.0 / 12.0 + doubt * doubt).sqrt() / 200_f64.sqrt());
    assert!(mean(&quadratures).abs() < 4.0 * doubt / 200_f64.sqrt(), "{}", mean(&quadratures));
}

#[test]
fn weather_is_of_four_kelvin_and_two_days() {
    // At 3 h of the night, free of tunnels, the diurnal part is the same every day.
    let (days, seeds) = (400_u32, 20_u32);
    let (mut variance, mut neighbours) = (0.0, 0.0);
    for seed in 0..seeds {
        let railway = Railway::draw(u64::from(seed), f64::from(days) * DAY_S, Climate::Winter);
        let air: Vec<f64> =
            (0..days).map(|day| railway.air_degc(f64::from(day) * DAY_S + 3.0 * HOUR_S)).collect();
        variance += super::covariance(&air, &air) / f64::from(seeds);
        neighbours += super::covariance(&air[1..], &air[..air.len() - 1]) / f64::from(seeds);
    }
    // 20 x 400 d hold 2000 times 4 d: 3 % of the variance; 1 % of it goes with the mean.
    assert!((variance.sqrt() / 4.0 - 1.0).abs() < 0.06, "sd {} K", variance.sqrt());
    let correlation = neighbours / variance;
    assert!((correlation - (-0.5_f64).exp()).abs() < 0.05, "a day apart {correlation}");
}

#[test]
fn tunnels_keep_to_their_number_hours_temperatures_and_stays() {
    let days = 400;
    let tunnels = passages(4, days);
    let mut counts = [0_u32; 4];
    for day in 0..days {
        let of_day: Vec<&Passage> =
            tunnels.iter().filter(|p| (p.enter_s / DAY_S).floor() == day as f64).collect();
        counts[of_day.len() - 3] += 1;
        let begin_s = day as f64 * DAY_S;
        assert!(of_day.iter().all(|p| p.enter_s >= begin_s + 5.0 * HOUR_S));
        assert!(of_day.iter().all(|p| p.leave_s <= begin_s + 22.0 * HOUR_S));
    }
    let pearson: f64 = counts.iter().map(|&count| (f64::from(count) - 100.0).powi(2) / 100.0).sum();
    assert!(pearson < 21.1, "tunnels a day {counts:?}");
    let all = |value: fn(&Passage) -> f64| tunnels.iter().map(value).collect::<Vec<f64>>();
    assert_uniform("air, °C", &all(|p| p.air_degc), (32.0, 40.0));
    // Entry and exit are whole seconds, half a second from what was drawn.
    assert_uniform("stay, min", &all(|p| (p.leave_s - p.enter_s) / 60.0), (20.0 - 0.02, 35.0 + 0.02));
    let fast = tunnels.iter().filter(|p| p.lag_s == 6.0).count() as f64;
    assert!(tunnels.iter().all(|p| p.lag_s == 6.0 || p.lag_s == 20.0));
    let n = tunnels.len() as f64;
    assert!((fast - n / 2.0).abs() < 2.0 * n.sqrt(), "{fast} of {n} fast");
    assert!(tunnels.windows(2).all(|p| p[1].enter_s - p[0].leave_s >= 299.0), "tunnels five minutes apart");
}

#[test]
fn air_follows_into_a_tunnel_and_out_of_it_with_its_lag() {
    let railway = Railway::draw(9, 10.0 * DAY_S, Climate::Winter);
    let outside_degc = |p: &Passage| railway.air_degc(p.enter_s - 1e-6);
    for p in &passages(9, 10) {
        // Within a minute and a half the air outside changes by less than 0.1 K.
        let share = |t_s: f64| (railway.air_degc(t_s) - outside_degc(p)) / (p.air_degc - outside_degc(p));
        let e = 1.0 / std::f64::consts::E;
        assert!((share(p.enter_s + p.lag_s) - (1.0 - e)).abs() < 0.01, "{}", share(p.enter_s + p.lag_s));
        assert!((share(p.enter_s + 2.0 * p.lag_s) - (1.0 - e * e)).abs() < 0.01);
        assert!((railway.air_degc(p.leave_s) - p.air_degc).abs() < 1e-9);
        let after = railway.air_degc(p.leave_s + 20.0 * p.lag_s);
        let left = (railway.air_degc(p.leave_s + p.lag_s) - after) / (p.air_degc - after);
        assert!((left - e).abs() < 0.01, "{left} left after the lag");
        assert_eq!(railway.irradiance_w_m2(0.5 * (p.enter_s + p.leave_s)), 0.0);
    }
}

#[test]
fn film_is_four_when_parked_and_ten_to_thirty_on_trips() {
    let days = 60;
    let railway = Railway::draw(2, days as f64 * DAY_S, Climate::Winter);
    let mut cruises = Vec::new();
    for day in 0..days {
        let at = |hour: f64, minute: usize| {
            railway.film_w_m2_k(day as f64 * DAY_S + hour * HOUR_S + minute as f64 * 60.0)
        };
        // The last trip of a day may begin at 22 h and takes at most 83 min.
        assert!(
            (0..300).all(|minute| at(0.0, minute) == 4.0) && (0..35).all(|minute| at(23.4, minute) == 4.0)
        );
        let film: Vec<f64> = (0..17 * 60).map(|minute| at(5.0, minute)).collect();
        assert!(film.iter().all(|film| (4.0..=30.0).contains(film)));
        // What holds for two minutes in a row is a cruise; every one counts once.
        let mut steady: Vec<f64> = film
            .windows(2)
            .filter(|pair| pair[0] > 4.0 && (pair[0] - pair[1]).abs() < 1e-12)
            .map(|pair| pair[0])
            .collect();
        steady.dedup_by(|a, b| (*a - *b).abs() < 1e-12);
        cruises.extend(steady);
        let running = film.iter().filter(|&&film| film > 4.0).count() as f64 / film.len() as f64;
        // Cruise of 47.5 min and ramps of 2.5 min on each side against stops of 11.5 min.
        assert!((0.6..0.98).contains(&running), "running {running} of the service");
    }
    assert!(cruises.len() > 10 * days, "{} trips in {days} days", cruises.len());
    assert_uniform("film on trips", &cruises, (10.0, 30.0));
}

#[test]
fn sun_shines_in_patches_from_eight_to_sixteen_with_a_peak_of_up_to_five_hundred() {
    let days = 10;
    let (mut peaks, mut lit, mut light) = (Vec::new(), 0, 0);
    for seed in 0..30 {
        let railway = Railway::draw(seed, days as f64 * DAY_S, Climate::Winter);
        for day in 0..days {
            let at = |minute: usize| railway.irradiance_w_m2(day as f64 * DAY_S + minute as f64 * 60.0);
            assert!((0..=480).chain(960..1440).all(|minute| at(minute) == 0.0), "sun at night");
            // The arch: a parabola over the eight hours, one at noon.
            let of_peak = |minute: usize| {
                let from_noon = (minute as f64 - 720.0) / 240.0;
                at(minute) / (1.0 - from_noon * from_noon)
            };
            let shares: Vec<f64> = (500..940).map(of_peak).collect();
            let peak = shares.iter().fold(0.0, |a: f64, &b| a.max(b));
            peaks.push(peak);
            lit += shares.iter().filter(|&&share| share > 0.5 * peak).count();
            light += shares.len();
        }
    }
    assert_uniform("peak, W/m²", &peaks, (0.0, 500.0));
    // Patches and gaps last alike; tunnels (4.5 x 27.5 min of 17 h) take 12 % away.
    let share = lit as f64 / light as f64;
    assert!((0.37..0.5).contains(&share), "lit {share} of the day");
}

fn value<'a>(scenario: &'a Scenario, which: &str) -> &'a Series {
    let around = &scenario.surroundings;
    match (which, &around.film) {
        ("air", _) => &around.air_k,
        ("radiation", _) => around.radiation_k.as_ref().unwrap(),
        ("difference", _) => around.axial.air_difference_k.as_ref().unwrap(),
        ("film", OutsideFilm::Coefficient { film_w_m2_k }) => film_w_m2_k,
        _ => panic!("no {which}"),
    }
}

#[test]
fn turbulence_gusts_and_the_difference_along_the_height_have_their_deviations() {
    let (mut turbulence, mut gusts, mut difference) = (Vec::new(), Vec::new(), Vec::new());
    for seed in 0..12 {
        let days = 10.0;
        let scenario = draw_weather(&Course::RailwayWeeks { days }, seed).unwrap();
        let railway = Railway::draw(seed, days * DAY_S, Climate::Winter);
        // Nights, where nothing else bends; steps that see every part of the lines between knots alike.
        for t_s in (0..10).flat_map(|day| (0..600).map(move |k| f64::from(day) * DAY_S + f64::from(k) * 27.0))
        {
            turbulence.push(value(&scenario, "air").at(t_s) - 273.15 - railway.air_degc(t_s));
            gusts.push(value(&scenario, "film").at(t_s) / 4.0 - 1.0);
            difference.push(value(&scenario, "difference").at(t_s));
        }
    }
    // 540 h of nights: 16 000 correlation times of 2 min, 540 of one hour.
    for (what, values, expected, tau_s) in [
        ("turbulence", turbulence, 0.4, 120.0),
        ("gusts", gusts, 0.1, 120.0),
        ("difference", difference, 0.5, 3600.0),
    ] {
        let doubt = (tau_s / (2.0 * 540.0 * HOUR_S)).sqrt();
        let deviation = mean(&values.iter().map(|v| v * v).collect::<Vec<f64>>()).sqrt() / expected;
        assert!((deviation - 1.0).abs() < 4.0 * doubt, "{what}: {deviation} of the stated sd");
        let lag = |values: &[f64], k: usize| -> f64 {
            (0..values.len() - k).map(|i| values[i] * values[i + k]).sum::<f64>()
        };
        // 40 samples are 1080 s, nine times 2 min, and a third of an hour.
        let correlation = lag(&values, 40) / lag(&values, 0);
        assert!((correlation - (-1080.0 / tau_s).exp()).abs() < 0.1, "{what}: {correlation} at 18 min");
    }
}

#[test]
fn radiation_follows_the_undisturbed_air_with_half_an_hour() {
    let scenario = draw_weather(&Course::RailwayWeeks { days: 1.0 }, 21).unwrap();
    let railway = Railway::draw(21, DAY_S, Climate::Winter);
    let mut follows = railway.air_degc(0.0);
    for second in 0..86_400_u32 {
        let t_s = f64::from(second);
        if second % 600 == 0 {
            let drawn = value(&scenario, "radiation").at(t_s) - 273.15;
            // Air is linear between knots there and an exponential here: 2.5 % of 40 K for 20 s of 30 min.
            assert!((drawn - follows).abs() < 0.05, "{drawn} against {follows} at {t_s} s");
        }
        let middle = railway.air_degc(t_s + 0.5);
        follows = middle + (follows - middle) * (-1.0 / 1800.0_f64).exp();
    }
}

#[test]
fn a_longer_course_begins_like_a_shorter_one() {
    let week = |days: f64| draw_weather(&Course::RailwayWeeks { days }, 3).unwrap();
    let (short, long) = (week(1.0), week(4.0));
    for which in ["air", "film", "radiation", "difference"] {
        for k in 0..1400 {
            let t_s = f64::from(k) * 61.0;
            assert_eq!(value(&short, which).at(t_s), value(&long, which).at(t_s), "{which} at {t_s} s");
        }
    }
    let days = passages(3, 2);
    assert_eq!(days[..], passages(3, 9)[..days.len()]);
}

#[test]
fn chamber_air_follows_its_course_within_turbulence() {
    // Name, time after the change in h, stated air in °C.
    let stated = [
        (Course::Scenario1, vec![(-0.5, 21.0), (0.01, -25.0), (2.9, -25.0)]),
        (Course::Scenario2, vec![(-0.5, -25.0), (0.01, 40.0), (3.4, 40.0)]),
        (Course::Scenario3, vec![(-0.5, 10.0), (0.5, 15.0), (2.5, 35.0), (5.0, 60.0)]),
        (Course::Scenario4, vec![(-0.5, 60.0), (3.5, 52.0), (7.0, 44.0), (14.0, 28.0)]),
        (Course::Tunnel, vec![(-0.5, -10.0), (6.0 / 3600.0, 35.0 - 45.0 / std::f64::consts::E), (1.0, 35.0)]),
    ];
    let seeds = 100;
    for (course, points) in stated {
        for (after_h, degc) in points {
            let t_s = course.change_s() + after_h * HOUR_S;
            let air: Vec<f64> = (0..seeds)
                .map(|seed| value(&draw_weather(&course, seed).unwrap(), "air").at(t_s) - 273.15)
                .collect();
            let deviation = mean(&air) - degc;
            assert!(
                deviation.abs() < 4.5 * 0.4 * 1.13 / 10.0,
                "{}, {after_h} h: {deviation} K",
                course.name()
            );
            assert!((0.25..0.6).contains(&sd(&air)), "{}, {after_h} h: sd {}", course.name(), sd(&air));
        }
    }
}

#[test]
fn courses_are_found_by_their_names_and_last_as_stated() {
    // One hour before the change; learning is ten days, an hour of transfer and four of rest.
    for (name, hours) in [
        ("scenario1", 4.0),
        ("scenario2", 4.45),
        ("scenario3", 6.0),
        ("scenario4", 15.0),
        ("tunnel", 4.0),
        ("week", 48.0),
    ] {
        let course = Course::named(name, 2.0).unwrap();
        assert_eq!(course.name(), name);
        assert_eq!(course.duration_s(), hours * HOUR_S, "{name}");
        assert_eq!(course.opening_s(), 0.0);
        let learnt = Course::named(&format!("{name}-learnt"), 2.0).unwrap();
        assert_eq!(learnt, course.learnt());
        let rest_h = if name == "week" { 0.0 } else { 5.0 };
        assert_eq!(learnt.duration_s(), (240.0 + rest_h + hours) * HOUR_S, "{name}");
        assert_eq!(learnt.opening_s(), (240.0 + rest_h) * HOUR_S, "{name}");
        let scenario = draw_weather(&learnt, 1).unwrap();
        assert_eq!(scenario.duration_s, learnt.duration_s());
    }
    assert_eq!(Course::named("scenario5", 2.0), None);
}

#[test]
fn years_have_winters_and_summers_of_the_railways_climate() {
    let (seeds, days) = (30_u32, 365_u32);
    let (mut coldest, mut warmest) = (Vec::new(), Vec::new());
    for seed in 0..seeds {
        let year = Railway::draw(u64::from(seed), f64::from(days) * DAY_S, Climate::Seasons);
        // Outside the hours of service there are no tunnels; at 15 h most days have none either.
        let tunnels = passages(u64::from(seed), days as usize);
        let at = |hour: f64| {
            let times = (0..days).map(move |day| f64::from(day) * DAY_S + hour * HOUR_S);
            times.filter(|&t| !inside(&tunnels, t)).map(|t| year.air_degc(t)).collect::<Vec<f64>>()
        };
        coldest.push(at(3.0).into_iter().fold(f64::INFINITY, f64::min));
        warmest.push(at(15.0).into_iter().fold(f64::NEG_INFINITY, f64::max));
    }
    // Mean 1 to 6, swing 14 to 18, day 3 to 7, weather 4 K of which some 2.5 standard deviations meet the coldest weeks.
    assert!((mean(&coldest) + 24.0).abs() < 4.0, "coldest {}", mean(&coldest));
    assert!((mean(&warmest) - 31.0).abs() < 4.0, "warmest {}", mean(&warmest));
    assert!(coldest.iter().all(|&t| t > -45.0) && warmest.iter().all(|&t| t < 48.0));
}

#[test]
fn knots_farther_apart_keep_the_variance_of_the_turbulence() {
    let course = Course::RailwayWeeks { days: 20.0 };
    let weeks = Railway::draw(8, 20.0 * DAY_S, Climate::Winter);
    for spacing_s in [120.0, 300.0, 600.0] {
        let scenario = draw_spaced(&course, 8, spacing_s).unwrap();
        let tunnels = passages(8, 20);
        let turbulence: Vec<f64> = (0..40_000)
            .map(|n| 43.0 * f64::from(n))
            .filter(|&t| !inside(&tunnels, t))
            .map(|t| value(&scenario, "air").at(t) - 273.15 - weeks.air_degc(t))
            .collect();
        assert!((sd(&turbulence) / 0.4 - 1.0).abs() < 0.06, "{spacing_s} s: {} K", sd(&turbulence));
    }
}
