//! Each climate keeps to its statement.
use super::part::{Stay, StayAir};
use super::weather::Weather;
use super::{Span, draw};
use crate::world::Climate;
use crate::world::statistics::{Law, assert_equal_counts, assert_law, mean, sd};
use cylwatch_thermal::units::{DAY_S, HOUR_S, MINUTE_S, YEAR_S};

fn span(seed: u64, days: f64) -> Span {
    Span::draw(seed, 0.0, days * DAY_S, 300.0)
}

fn weather(climate: Climate, seed: u64, days: f64) -> Weather {
    draw(climate, &span(seed, days))
}

/// A value of each seed.
fn over<T>(climate: Climate, seeds: u64, days: f64, value: impl Fn(&Weather) -> T) -> Vec<T> {
    (0..seeds).map(|seed| value(&weather(climate, seed, days))).collect()
}

/// Every stay of twenty seeds.
fn stays(climate: Climate) -> Vec<Stay> {
    over(climate, 20, 60.0, |weather| weather.stays.clone()).into_iter().flatten().collect()
}

fn values<T>(of: &[T], value: impl Fn(&T) -> f64) -> Vec<f64> {
    of.iter().map(value).collect()
}

/// Stays of each whole day.
fn a_day(climate: Climate) -> Vec<usize> {
    let days = |weather: &Weather| -> Vec<usize> {
        let on = |day: usize| move |stay: &&Stay| (stay.enter_s / DAY_S) as usize == day;
        (0..60).map(|day| weather.stays.iter().filter(on(day)).count()).collect()
    };
    over(climate, 20, 60.0, days).into_iter().flatten().collect()
}

fn assert_whole_numbers(what: &str, found: &[usize], low: usize, high: usize) {
    assert!(found.iter().all(|n| (low..=high).contains(n)), "{what}: {found:?}");
    let counts: Vec<usize> = (low..=high).map(|n| found.iter().filter(|&&m| m == n).count()).collect();
    assert_equal_counts(what, &counts);
}

#[test]
fn a_log_begins_at_any_time_of_the_day() {
    let begins = values(&(0..1000).collect::<Vec<u64>>(), |&seed| span(seed, 1.0).start_s.rem_euclid(DAY_S));
    assert_law("time of day", &begins, Law::Uniform(0.0, DAY_S));
    let early = Span::draw(3, 6.0 * HOUR_S, DAY_S, 300.0);
    assert_eq!(early.start_s + 6.0 * HOUR_S, span(3, 1.0).start_s);
    assert_eq!(early.duration_s, DAY_S + 6.0 * HOUR_S);
}

#[test]
fn outside_air_has_its_mean_its_seasons_its_days_and_its_weather() {
    let drawn = over(Climate::Railway, 1000, 1.0, |weather| {
        let o = &weather.outside;
        [o.mean_degc, o.swing_k, o.diurnal_k, o.coldest_s]
    });
    assert_law("mean", &values(&drawn, |d| d[0]), Law::Uniform(1.0, 6.0));
    assert_law("swing", &values(&drawn, |d| d[1]), Law::Uniform(8.0, 14.0));
    assert_law("diurnal", &values(&drawn, |d| d[2]), Law::Uniform(3.0, 7.0));
    let from_coldest_d = values(&drawn, |d| {
        let by = d[3] / YEAR_S;
        365.25 * if by > 0.5 { 1.0 - by } else { -by }
    });
    assert_law("begin of the log", &from_coldest_d, Law::Uniform(-45.0, 45.0));
    // Weather at one time: what is left when mean, season and day are taken away.
    let weather = over(Climate::Railway, 1000, 1.0, |weather| {
        let (o, t) = (&weather.outside, 1.5 * DAY_S);
        let season = o.swing_k * (std::f64::consts::TAU * (t - o.coldest_s) / YEAR_S).cos();
        let day = o.diurnal_k * (std::f64::consts::TAU * (t / DAY_S - 15.0 / 24.0)).cos();
        o.degc(t) - o.mean_degc + season - day
    });
    assert_law("weather", &weather, Law::Normal(0.0, 4.0));
}

#[test]
fn days_are_warmest_at_three_and_years_half_a_year_after_the_coldest_day() {
    let weather = weather(Climate::Railway, 4, 400.0);
    let o = &weather.outside;
    // Mean over the days of an hour, against its neighbours.
    let at_hour = |hour: f64| {
        mean(&(1..396).map(|day| o.degc((f64::from(day) * 24.0 + hour) * HOUR_S)).collect::<Vec<_>>())
    };
    let hours: Vec<f64> = (0..24).map(|hour| at_hour(f64::from(hour))).collect();
    let warmest = (0..24).max_by(|&a, &b| hours[a].total_cmp(&hours[b])).unwrap();
    assert!((14..=16).contains(&warmest), "{warmest} h");
    assert!((hours[warmest] - hours[(warmest + 12) % 24] - 2.0 * o.diurnal_k).abs() < 0.5);
}

#[test]
fn railway_tunnels_keep_to_their_number_hours_temperatures_and_stays() {
    assert_whole_numbers("tunnels a day", &a_day(Climate::Railway), 3, 6);
    let stays = stays(Climate::Railway);
    let degc = values(&stays, |stay| match stay.air {
        StayAir::Degc(degc) => degc,
        _ => f64::NAN,
    });
    assert_law("air", &degc, Law::Uniform(32.0, 40.0));
    let lasting = values(&stays, |stay| stay.leave_s - stay.enter_s);
    assert_law("stay", &lasting, Law::Uniform(20.0 * MINUTE_S, 35.0 * MINUTE_S));
    assert_law("ramp", &values(&stays, |stay| stay.ramp_s), Law::Uniform(15.0, 60.0));
    assert!(stays.iter().all(|stay| (5.0..22.0).contains(&(stay.enter_s.rem_euclid(DAY_S) / HOUR_S))));
    assert!(stays.iter().all(|stay| stay.flow.is_none() && stay.is_dark));
}

#[test]
fn wind_switches_at_the_mouths_within_one_to_sixty_seconds_and_tunnels_are_42_to_48_kelvin_warmer() {
    let stays = stays(Climate::Switching);
    let warmer = values(&stays, |stay| match stay.air {
        StayAir::Warmer(by_k, 55.0) => by_k,
        _ => f64::NAN,
    });
    assert_law("warmer", &warmer, Law::Uniform(42.0, 48.0));
    assert_law("wind", &values(&stays, |stay| stay.flow.unwrap().0), Law::Uniform(3.0, 30.0));
    assert_law("switching", &values(&stays, |stay| stay.flow.unwrap().1), Law::Logarithmic(1.0, 60.0));
    assert_law("portal", &values(&stays, |stay| stay.ramp_s), Law::Uniform(14.0, 16.0));
    assert_whole_numbers("tunnels a day", &a_day(Climate::Switching), 3, 6);
    // In the air itself: as much warmer as drawn, but never above 55 °C unless the day is.
    let weather = weather(Climate::Switching, 3, 300.0);
    for stay in &weather.stays {
        let (inside, before) = (weather.air_degc(stay.leave_s), weather.outside.degc(stay.leave_s));
        let StayAir::Warmer(by_k, _) = stay.air else { panic!("warmer") };
        assert!((inside - (before + by_k).min(55.0)).abs() < 1e-9, "{inside} after {before}");
        // The wind of a stay is there when its switching is over, and that outside after it has switched back.
        let (wind, within_s) = stay.flow.unwrap();
        assert!((weather.flow(stay.enter_s + within_s, 0.3) - wind).abs() < 1e-6);
        let outside = 0.3 + super::part::sum_at(&weather.trips, stay.leave_s + within_s);
        assert!((weather.flow(stay.leave_s + within_s, 0.3) - outside).abs() < 1e-6);
    }
}

#[test]
fn trips_keep_to_their_wind_ramps_and_durations() {
    for (climate, height, ramp_s, cruise_s) in [
        (Climate::Railway, (6.0, 26.0), (60.0, 240.0), (1200.0, 4500.0)),
        (Climate::Switching, (8.0, 30.0), (60.0, 240.0), (1200.0, 4500.0)),
        (Climate::Metro, (5.0, 20.0), (15.0, 40.0), (240.0, 900.0)),
    ] {
        let trips: Vec<_> =
            over(climate, 5, 20.0, |weather| weather.trips.clone()).into_iter().flatten().collect();
        assert_law("height", &values(&trips, |trip| trip.height), Law::Uniform(height.0, height.1));
        assert_law(
            "ramp",
            &values(&trips, |trip| trip.corners_s[1] - trip.corners_s[0]),
            Law::Uniform(ramp_s.0, ramp_s.1),
        );
        let cruise = values(&trips, |trip| trip.corners_s[2] - trip.corners_s[1]);
        assert_law("cruise", &cruise, Law::Uniform(cruise_s.0, cruise_s.1));
    }
}

#[test]
fn a_metro_passes_twenty_tunnels_a_day_of_one_to_six_minutes() {
    assert!(a_day(Climate::Metro).iter().all(|&count| count == 20));
    let stays = stays(Climate::Metro);
    let lasting = values(&stays, |stay| stay.leave_s - stay.enter_s);
    assert_law("stay", &lasting, Law::Uniform(60.0, 360.0));
    assert_law("switching", &values(&stays, |stay| stay.flow.unwrap().1), Law::Logarithmic(1.0, 20.0));
}

#[test]
fn a_desert_has_days_of_40_to_50_degrees_and_a_sun_of_a_thousand_watts() {
    let hottest = over(Climate::Desert, 100, 10.0, |weather| {
        (0..2400).map(|k| weather.air_degc(DAY_S + 360.0 * f64::from(k))).fold(f64::MIN, f64::max)
    });
    assert!((40.0..52.0).contains(&mean(&hottest)), "{}", mean(&hottest));
    let peaks: Vec<f64> = over(Climate::Desert, 20, 40.0, |weather| {
        // One height for each day.
        let mut heights = values(&weather.sun, |patch| patch.height);
        heights.dedup();
        heights
    })
    .into_iter()
    .flatten()
    .collect();
    assert_law("peak", &peaks, Law::Uniform(900.0, 1000.0));
    let weather = weather(Climate::Desert, 1, 30.0);
    let noon: Vec<f64> =
        (1..30).map(|day| weather.irradiance_w_m2((24.0 * f64::from(day) + 12.5) * HOUR_S)).collect();
    let lit = noon.iter().filter(|&&light| light > 850.0).count();
    assert!(lit > 20, "{lit} of 29 noons");
    assert!(noon.iter().all(|light| *light <= 1000.0));
    assert_eq!(weather.irradiance_w_m2(DAY_S + 3.0 * HOUR_S), 0.0);
}

#[test]
fn an_arctic_winter_is_far_below_zero_and_has_stays_in_a_garage() {
    let coldest = over(Climate::Arctic, 100, 20.0, |weather| {
        (0..480).map(|hour| weather.outside.degc(DAY_S + HOUR_S * f64::from(hour))).fold(f64::MAX, f64::min)
    });
    assert!((-40.0..-25.0).contains(&mean(&coldest)), "{}", mean(&coldest));
    assert!(coldest.iter().all(|&degc| degc > -58.0));
    assert_whole_numbers("garage a day", &a_day(Climate::Arctic), 0, 1);
    let degc = values(&stays(Climate::Arctic), |stay| match stay.air {
        StayAir::Degc(degc) => degc,
        _ => f64::NAN,
    });
    assert_law("garage", &degc, Law::Uniform(5.0, 15.0));
}

#[test]
fn a_workshop_stays_within_half_a_kelvin_of_its_set_point() {
    let spread = over(Climate::Workshop, 50, 30.0, |weather| {
        let air: Vec<f64> = (0..1440).map(|k| weather.air_degc(DAY_S + 1800.0 * f64::from(k))).collect();
        let set = mean(&air);
        assert!(air.iter().all(|degc| (degc - set).abs() < 0.5));
        assert!((17.9..24.1).contains(&set));
        sd(&air)
    });
    assert!((0.17..0.22).contains(&mean(&spread)), "{}", mean(&spread));
}

#[test]
fn a_heater_switches_within_its_band_and_the_night_is_colder() {
    let mut on_s = Vec::new();
    let mut off_s = Vec::new();
    for seed in 0..5 {
        let weather = weather(Climate::Hall, seed, 20.0);
        let heated = &weather.heated_s;
        on_s.extend(heated.iter().map(|(begin, end)| end - begin));
        off_s.extend(heated.windows(2).map(|pair| pair[1].0 - pair[0].1));
        let inside = weather.inside.as_ref().unwrap();
        let rise: Vec<f64> = heated.iter().map(|(begin, end)| inside.at(*end) - inside.at(*begin)).collect();
        // Twice the band, less what the set point moves meanwhile.
        let usual = {
            let mut sorted = rise.clone();
            sorted.sort_by(f64::total_cmp);
            sorted[sorted.len() / 2]
        };
        assert!((1.0..=3.0).contains(&usual), "{usual}");
        let at = |hour: f64| {
            mean(&(1..20).map(|day| inside.at((24.0 * f64::from(day) + hour) * HOUR_S)).collect::<Vec<_>>())
        };
        assert!((2.0..7.0).contains(&(at(14.0) - at(4.0))), "{} K colder", at(14.0) - at(4.0));
    }
    assert_law("on", &on_s, Law::Uniform(4.0 * MINUTE_S, 15.0 * MINUTE_S));
    assert_law("off", &off_s, Law::Uniform(10.0 * MINUTE_S, 45.0 * MINUTE_S));
    assert_whole_numbers("doors a day", &a_day(Climate::Hall), 2, 8);
    let shares = values(&stays(Climate::Hall), |stay| match stay.air {
        StayAir::Outside(share) => share,
        _ => f64::NAN,
    });
    assert_law("outside air", &shares, Law::Uniform(0.3, 0.7));
}

#[test]
fn an_open_door_mixes_in_its_share_of_outside_air() {
    let weather = weather(Climate::Hall, 2, 10.0);
    let inside = weather.inside.as_ref().unwrap();
    for stay in &weather.stays {
        let StayAir::Outside(share) = stay.air else { panic!("a door") };
        let t = stay.leave_s;
        let expected = inside.at(t) + share * (weather.outside.degc(t) - inside.at(t));
        assert!((weather.air_degc(t) - expected).abs() < 1e-9);
    }
}

#[test]
fn a_chamber_passes_all_four_profiles_in_each_round() {
    let weather = weather(Climate::Chamber, 3, 30.0);
    let air = weather.inside.as_ref().unwrap();
    // Four points for a profile: rest, change, end, begin of the next.
    let rounds: Vec<Vec<(f64, f64)>> = air
        .value
        .chunks(4)
        .map(|points| (points[0], points[2]))
        .collect::<Vec<_>>()
        .chunks(4)
        .map(<[(f64, f64)]>::to_vec)
        .collect();
    assert!(rounds.len() > 10);
    for round in rounds.iter().filter(|round| round.len() == 4) {
        for profile in [(21.0, -25.0), (-25.0, 40.0), (10.0, 60.0), (60.0, 28.0)] {
            assert!(round.contains(&profile), "{round:?}");
        }
    }
    let rest_s: Vec<f64> = air.time_s.chunks(4).map(|points| points[1] - points[0]).collect();
    let many: Vec<f64> = over(Climate::Chamber, 10, 30.0, |weather| {
        let air = weather.inside.as_ref().unwrap();
        air.time_s.chunks(4).map(|points| points[1] - points[0]).collect::<Vec<_>>()
    })
    .into_iter()
    .flatten()
    .collect();
    assert!(rest_s.iter().all(|rest| (2.0 * HOUR_S - 1e-6..=5.0 * HOUR_S).contains(rest)));
    assert_law("rest", &many, Law::Uniform(2.0 * HOUR_S, 5.0 * HOUR_S));
    assert!(air.time_s.windows(2).all(|pair| pair[1] > pair[0]));
    // Two of the four are fast.
    assert!((weather.jumps_s.len() as f64 / rounds.len() as f64 - 2.0).abs() < 0.2);
}

#[test]
fn showers_cool_the_air_raise_the_film_and_hide_the_sun() {
    assert_whole_numbers("showers a day", &a_day(Climate::Showers), 0, 4);
    let stays = stays(Climate::Showers);
    let colder = values(&stays, |stay| match stay.air {
        StayAir::Colder(by_k) => by_k,
        _ => f64::NAN,
    });
    assert_law("colder", &colder, Law::Uniform(2.0, 8.0));
    assert_law("film", &values(&stays, |stay| stay.flow.unwrap().0), Law::Uniform(60.0, 150.0));
    let weather = weather(Climate::Showers, 6, 60.0);
    for stay in weather.stays.iter().filter(|stay| stay.leave_s - stay.enter_s > 200.0) {
        let t = stay.leave_s;
        assert_eq!(weather.irradiance_w_m2(t), 0.0);
        assert!(weather.flow(t, 5.0) >= 60.0 - 1e-9);
        assert!(weather.outside.degc(t) - weather.air_degc(t) >= 2.0 - 1e-9);
    }
}

#[test]
fn sun_never_shines_at_night_and_never_beyond_its_peak() {
    for (climate, most_w_m2) in [
        (Climate::Railway, 500.0),
        (Climate::Switching, 500.0),
        (Climate::Metro, 300.0),
        (Climate::Desert, 1000.0),
        (Climate::Arctic, 100.0),
        (Climate::Parked, 700.0),
        (Climate::Hall, 0.0),
        (Climate::Workshop, 0.0),
        (Climate::Chamber, 0.0),
        (Climate::Showers, 800.0),
    ] {
        let weather = weather(climate, 1, 30.0);
        let (rise_s, set_s) = weather.daylight_s;
        let mut brightest: f64 = 0.0;
        for minute in 0..43_200 {
            let t = DAY_S + 60.0 * f64::from(minute);
            let light = weather.irradiance_w_m2(t);
            let of_day = t.rem_euclid(DAY_S);
            assert!(light >= 0.0 && light <= most_w_m2);
            assert!(light == 0.0 || (rise_s..=set_s).contains(&of_day), "{climate}: {light} at {of_day}");
            brightest = brightest.max(light);
        }
        assert!(brightest >= 0.7 * most_w_m2, "{climate}: {brightest} of {most_w_m2}");
    }
}

/// Nothing jumps, since the solver would have to start again: the air changes by 10 K/s at most.
#[test]
fn surroundings_are_finite_even_and_without_jumps_in_every_climate() {
    for &climate in Climate::ALL {
        for seed in 0..5 {
            let span = span(seed, 20.0);
            let drawn = super::surroundings(climate, &span, 1.2, 0.1).unwrap();
            let around = drawn.surroundings;
            let knots: Vec<f64> = around.air_k.edges_s().collect();
            assert!(knots[0] == 0.0 && knots[knots.len() - 1] >= span.duration_s, "{climate}");
            assert!(knots.windows(2).all(|pair| pair[1] - pair[0] >= 1e-3), "{climate}");
            for series in [around.film.signal(), around.radiation_k.as_ref().unwrap()] {
                assert_eq!(series.edges_s().count(), knots.len(), "{climate}");
                assert!(series.range().0 >= 0.0);
            }
            let (coldest_k, warmest_k) = around.air_k.range();
            assert!(coldest_k > 213.0 && warmest_k < 338.0, "{climate}: {coldest_k} to {warmest_k} K");
            for pair in knots.windows(2) {
                let change_k = (around.air_k.at(pair[1]) - around.air_k.at(pair[0])).abs();
                assert!(change_k < 10.0 * (pair[1] - pair[0]), "{climate}: {change_k} K within {pair:?}");
            }
            assert!(drawn.jumps_s.windows(2).all(|pair| pair[0] <= pair[1]));
            assert!(drawn.heated_s.windows(2).all(|pair| pair[0].1 <= pair[1].0));
        }
    }
}

#[test]
fn a_longer_climate_begins_like_a_shorter_one() {
    for &climate in Climate::ALL {
        let of = |days: f64| super::surroundings(climate, &span(8, days), 1.0, 0.0).unwrap();
        let (short, long) = (of(3.0), of(9.0));
        let knots: Vec<f64> = short.surroundings.air_k.edges_s().collect();
        let same: Vec<f64> = long.surroundings.air_k.edges_s().take(knots.len()).collect();
        assert_eq!(knots, same, "{climate}");
        for t in knots {
            assert_eq!(short.surroundings.air_k.at(t), long.surroundings.air_k.at(t), "{climate}");
            let flow = |drawn: &super::Drawn| drawn.surroundings.film.signal().at(t);
            assert_eq!(flow(&short), flow(&long), "{climate}");
        }
    }
}

#[test]
fn turbulence_and_the_difference_along_the_height_have_their_deviations() {
    // A workshop, in which nothing else moves within minutes.
    let (mut turbulence, mut difference) = (Vec::new(), Vec::new());
    for seed in 0..400 {
        let span = span(seed, 0.5);
        let weather = draw(Climate::Workshop, &span);
        let around = super::surroundings(Climate::Workshop, &span, 1.0, 0.0).unwrap().surroundings;
        let t = 3600.0;
        turbulence.push(around.air_k.at(t) - 273.15 - weather.air_degc(t + span.start_s));
        difference.push(around.axial.air_difference_k.unwrap().at(t));
    }
    // At a knot a process has the variance 3/(2 + r) of its mean over time, r the correlation of neighbours.
    let at_knots = |time_s: f64| (3.0 / (2.0 + (-300.0 / time_s).exp())).sqrt();
    assert_law("turbulence", &turbulence, Law::Normal(0.0, 0.05 * at_knots(120.0)));
    assert_law("difference", &difference, Law::Normal(0.0, 0.2 * at_knots(3600.0)));
}

#[test]
fn surroundings_radiate_with_the_lag_and_the_sky_of_their_climate() {
    let span = span(2, 2.0);
    let weather = draw(Climate::Desert, &span);
    let radiation =
        super::surroundings(Climate::Desert, &span, 1.0, 0.0).unwrap().surroundings.radiation_k.unwrap();
    // A sum of many straight pieces against the closed form of a lag: integrate with steps of a minute.
    let (mut lagged, mut before) = (weather.air_degc(span.start_s), weather.air_degc(span.start_s));
    for minute in 1..2880 {
        let t = 60.0 * f64::from(minute);
        let air = weather.air_degc(t + span.start_s);
        lagged += (0.5 * (air + before) - lagged) * (1.0 - (-60.0_f64 / 3600.0).exp());
        before = air;
        let expected = lagged + 273.15 - weather.sky_k;
        assert!((radiation.at(t) - expected).abs() < 0.02, "{t}: {} {expected}", radiation.at(t));
    }
}

#[test]
fn radiation_in_a_chamber_follows_at_once() {
    let span = span(2, 2.0);
    let weather = draw(Climate::Chamber, &span);
    let radiation =
        super::surroundings(Climate::Chamber, &span, 1.0, 0.0).unwrap().surroundings.radiation_k.unwrap();
    for t in radiation.edges_s() {
        assert!((radiation.at(t) - 273.15 - weather.air_degc(t + span.start_s)).abs() < 1e-9);
    }
}
