//! The distribution against closed forms, double integrals and draws; intervals against leaks that go on.
use crate::units::{DAY_S, HOUR_S};
use approx::assert_relative_eq;
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use rand_distr::StandardNormal;

use super::*;

/// 1 g/h.
const G_H: f64 = 1e-3 / HOUR_S;
const LIMIT_KG: f64 = 3.66;

/// Mass 4.46 kg, known to 8 g; leak rate and standard deviation in g/h.
fn state(leak_g_h: f64, sd_g_h: f64, correlation: f64) -> MassAndLeak {
    let (mass_sd_kg, leak_sd_kg_s) = (8e-3, sd_g_h * G_H);
    let leak_kg_s = leak_g_h * G_H;
    MassAndLeak { mass_kg: 4.46, leak_kg_s, mass_sd_kg, leak_sd_kg_s, correlation }
}

fn prognosis(state: MassAndLeak, law: LossLaw) -> Prognosis {
    Prognosis::try_new(state, LIMIT_KG, law).unwrap()
}

fn seconds(passage: Passage) -> f64 {
    match passage {
        Passage::In(time_s) => time_s,
        Passage::Reached => 0.0,
        Passage::BeyondHorizon | Passage::Unknown => f64::INFINITY,
    }
}

/// Times until the limit of masses and rates drawn from the distribution, `r < 0` rejected; sorted.
fn drawn(prognosis: &Prognosis, state: MassAndLeak, law: LossLaw, count: usize, seed: u64) -> Vec<f64> {
    let mut random = ChaCha8Rng::seed_from_u64(seed);
    let mut times = Vec::with_capacity(count);
    while times.len() < count {
        let (a, b): (f64, f64) = (random.sample(StandardNormal), random.sample(StandardNormal));
        let leak_kg_s = state.leak_kg_s + state.leak_sd_kg_s * a;
        let across = state.correlation * a + (1.0 - state.correlation.powi(2)).sqrt() * b;
        if leak_kg_s >= 0.0 {
            times.push(law.time_s(state.mass_kg + state.mass_sd_kg * across, leak_kg_s, prognosis.limit_kg));
        }
    }
    times.sort_by(f64::total_cmp);
    times
}

#[test]
fn probabilities_are_those_of_draws() {
    let count = 200_000;
    for (seed, (leak, sd, correlation)) in
        [(10.0, 1.0, 0.3), (1.0, 2.0, -0.8), (-3.0, 1.0, 0.5), (0.05, 0.03, 0.99), (300.0, 1.0, 0.0)]
            .into_iter()
            .enumerate()
    {
        for law in [LossLaw::Choked, LossLaw::Linear] {
            let state = state(leak, sd, correlation);
            let prognosis = prognosis(state, law);
            let times = drawn(&prognosis, state, law, count, seed as u64);
            for part in [1, 5, 25, 50, 75, 95, 99] {
                let probability = prognosis.probability_within(times[count * part / 100]);
                let expected = part as f64 / 100.0;
                // Five standard deviations of an order statistic.
                let margin = 5.0 * (expected * (1.0 - expected) / count as f64).sqrt();
                assert!(
                    (probability - expected).abs() < margin,
                    "{leak} g/h, {law:?}: {probability} at {expected}"
                );
            }
        }
    }
}

#[test]
fn a_straight_loss_at_a_surely_positive_rate_is_a_ratio_of_normal_variables() {
    // Geary's approximation is exact where the denominator is surely positive: P(D/r <= t) = P(D - r t <= 0).
    let state = state(10.0, 0.5, -0.6);
    let prognosis = prognosis(state, LossLaw::Linear);
    for time_d in [2.5, 3.0, 3.3, 3.5, 4.0, 5.0] {
        let time_s = time_d * DAY_S;
        let mean_kg = state.mass_kg - LIMIT_KG - state.leak_kg_s * time_s;
        let (a, b) = (state.mass_sd_kg, state.leak_sd_kg_s * time_s);
        let sd_kg = (a * a + b * b - 2.0 * state.correlation * a * b).sqrt();
        let expected = normal_probability(-mean_kg / sd_kg);
        assert!((prognosis.probability_within(time_s) - expected).abs() < 1e-9, "{time_d} d");
    }
}

#[test]
fn cut_off_at_no_leak_it_is_the_double_integral() {
    // Trapezoidal sums over both variables, which converge exponentially for a density; the cut is on the grid.
    let state = state(0.4, 0.5, 0.7);
    let prognosis = prognosis(state, LossLaw::Choked);
    let time_s = 60.0 * DAY_S;
    let (mut hit, mut all) = (0.0, 0.0);
    let steps = 20_000;
    let width = 9.8 / f64::from(steps);
    for n in 0..=steps {
        let z = -0.8 + width * f64::from(n);
        let ends = if n == 0 || n == steps { 0.5 } else { 1.0 };
        let weight = ends * (-0.5 * z * z).exp();
        let leak_kg_s = state.leak_kg_s + state.leak_sd_kg_s * z;
        // The mass whose time is up, by halving its own time.
        let (mut low, mut high) = (LIMIT_KG, 10.0 * LIMIT_KG);
        for _ in 0..60 {
            let middle = 0.5 * (low + high);
            let later = LossLaw::Choked.time_s(middle, leak_kg_s.max(1e-300), LIMIT_KG) > time_s;
            (low, high) = if later { (low, middle) } else { (middle, high) };
        }
        let sd_kg = state.mass_sd_kg * (1.0 - 0.7_f64.powi(2)).sqrt();
        hit += weight * normal_probability((low - state.mass_kg - 0.7 * state.mass_sd_kg * z) / sd_kg);
        all += weight;
    }
    assert!((prognosis.probability_within(time_s) - hit / all).abs() < 1e-7, "{}", hit / all);
}

#[test]
fn known_mass_or_known_rate_have_quantiles_in_closed_form() {
    let horizon_s = 3650.0 * DAY_S;
    let known_mass = MassAndLeak { mass_sd_kg: 0.0, ..state(10.0, 1.0, 0.0) };
    // r = 10 -+ 1.6449 g/h; 800 g at it, or 4460 g ln(4460/3660).
    for (law, grams) in [(LossLaw::Linear, 800.0), (LossLaw::Choked, 881.6779)] {
        let left = prognosis(known_mass, law).quantiles(horizon_s);
        for (passage, rate) in [(left.p5, 11.644_854), (left.p50, 10.0), (left.p95, 8.355_146)] {
            assert_relative_eq!(seconds(passage) / HOUR_S, grams / rate, max_relative = 1e-6);
        }
    }
    let known_rate = state(10.0, 0.0, 0.0);
    let left = prognosis(known_rate, LossLaw::Linear).quantiles(horizon_s);
    assert_relative_eq!(seconds(left.p5) / HOUR_S, (800.0 - 1.644_854 * 8.0) / 10.0, max_relative = 1e-6);
    assert_relative_eq!(seconds(left.p50) / HOUR_S, 80.0, max_relative = 1e-8);
    let all_known = MassAndLeak { mass_sd_kg: 0.0, leak_sd_kg_s: 0.0, ..known_rate };
    let left = prognosis(all_known, LossLaw::Choked).quantiles(horizon_s);
    assert_relative_eq!(seconds(left.p5) / HOUR_S, 88.167786, max_relative = 1e-6);
    assert_relative_eq!(seconds(left.p95), seconds(left.p5), max_relative = 1e-8);
}

#[test]
fn little_uncertainty_is_the_limit_of_none() {
    let near = |leak_sd: f64, mass_sd_kg: f64| {
        let state = MassAndLeak { mass_sd_kg, ..state(10.0, leak_sd, 0.0) };
        prognosis(state, LossLaw::Choked).quantiles(1e9)
    };
    for (small, none) in [(near(1.0, 1e-12), near(1.0, 0.0)), (near(1e-12, 8e-3), near(0.0, 8e-3))] {
        for (small, none) in [(small.p5, none.p5), (small.p50, none.p50), (small.p95, none.p95)] {
            assert_relative_eq!(seconds(small), seconds(none), max_relative = 1e-6);
        }
    }
    // Fully correlated, the conditional mass has no spread left.
    let full = prognosis(state(10.0, 1.0, 1.0), LossLaw::Linear);
    let almost = prognosis(state(10.0, 1.0, 1.0 - 1e-12), LossLaw::Linear);
    assert!((full.probability_within(3.3 * DAY_S) - almost.probability_within(3.3 * DAY_S)).abs() < 1e-5);
}

#[test]
fn a_limit_that_is_reached_and_one_beyond_the_horizon_are_said_so() {
    let tight = prognosis(state(0.0, 0.01, 0.0), LossLaw::Choked).quantiles(30.0 * DAY_S);
    assert_eq!([tight.p5, tight.p50, tight.p95], [Passage::BeyondHorizon; 3]);
    let empty = MassAndLeak { mass_kg: 3.6, ..state(10.0, 1.0, 0.0) };
    let empty = prognosis(empty, LossLaw::Choked).quantiles(30.0 * DAY_S);
    assert_eq!([empty.p5, empty.p50, empty.p95], [Passage::Reached; 3]);
    // One standard deviation above the limit: reached already with 16 %; 8 g at 1 g/h in the median.
    let at_limit = MassAndLeak { mass_kg: LIMIT_KG + 8e-3, ..state(1.0, 0.01, 0.0) };
    let at_limit = prognosis(at_limit, LossLaw::Linear);
    assert!((at_limit.probability_within(0.0) - 0.158_655).abs() < 1e-6);
    assert_eq!(at_limit.quantile(0.05, DAY_S), Passage::Reached);
    assert!((seconds(at_limit.quantile(0.5, DAY_S)) / HOUR_S - 8.0).abs() < 0.01);
    // No rate but zero: nothing is lost.
    assert_eq!(
        prognosis(state(10.0, 1.0, 0.0), LossLaw::Choked).quantile(0.5, f64::NAN),
        Passage::BeyondHorizon
    );
    assert!(
        seconds(prognosis(state(10.0, 1.0, 0.0), LossLaw::Choked).quantile(0.5, f64::INFINITY)).is_finite()
    );
    let none = MassAndLeak { leak_sd_kg_s: 0.0, ..state(-1.0, 0.0, 0.0) };
    assert_eq!(prognosis(none, LossLaw::Choked).quantile(0.5, 1e12), Passage::BeyondHorizon);
}

#[test]
fn a_leak_that_may_not_be_there_never_passes_with_more_than_its_probability() {
    let doubted = prognosis(state(10.0, 1.0, 0.0), LossLaw::Choked).with_leak_probability(0.3).unwrap();
    assert!((doubted.probability_within(3650.0 * DAY_S) - 0.3).abs() < 1e-9);
    assert_eq!(doubted.quantile(0.5, 3650.0 * DAY_S), Passage::BeyondHorizon);
    let sure = prognosis(state(10.0, 1.0, 0.0), LossLaw::Choked);
    assert_relative_eq!(
        seconds(doubted.quantile(0.15, 1e9)),
        seconds(sure.quantile(0.5, 1e9)),
        max_relative = 1e-6
    );
    assert!(sure.with_leak_probability(1.1).is_err() && sure.with_leak_probability(f64::NAN).is_err());
}

#[test]
fn a_rate_far_below_zero_is_an_exponential_rate() {
    // Of N(-a sd, sd^2) beyond 0, large a: exponential of mean sd/a, to 1/a^2. P(r >= x) is exp(-a x/sd).
    let state = MassAndLeak { mass_sd_kg: 0.0, ..state(-60.0, 1.0, 0.0) };
    let time_s = 800.0 / (1.0 / 60.0) * HOUR_S;
    let known = prognosis(state, LossLaw::Linear).probability_within(time_s);
    assert_relative_eq!(known, (-1.0_f64).exp(), max_relative = 1e-3);
    let spread =
        prognosis(MassAndLeak { mass_sd_kg: 1e-6, ..state }, LossLaw::Linear).probability_within(time_s);
    assert_relative_eq!(spread, known, max_relative = 1e-8);
}

/// Least squares on logarithms of masses that a choked leak takes (a straight line): state at the last reading as an observer would give
/// it, and the true time left.
fn fitted(leak_kg_s: f64, random: &mut ChaCha8Rng) -> (MassAndLeak, f64) {
    let (count, interval_s, sd) = (48, HOUR_S, 1.1e-3);
    let (now_s, start_kg) = (f64::from(count - 1) * interval_s, 4.46);
    let mass_at = |time_s: f64| start_kg * (-leak_kg_s * time_s / start_kg).exp();
    let (mut s, mut st, mut stt, mut sy, mut sty) = (0.0, 0.0, 0.0, 0.0, 0.0);
    for n in 0..count {
        let time_s = f64::from(n) * interval_s - now_s;
        let noise: f64 = random.sample(StandardNormal);
        let y = mass_at(time_s + now_s).ln() + sd * noise;
        (s, st, stt) = (s + 1.0, st + time_s, stt + time_s * time_s);
        (sy, sty) = (sy + y, sty + time_s * y);
    }
    let det = s * stt - st * st;
    let (mass_kg, slope) = (((stt * sy - st * sty) / det).exp(), (s * sty - st * sy) / det);
    let unit = sd * sd / det * mass_kg * mass_kg;
    // m = exp(a), r = -b m, to first order.
    let across = unit * (st - slope * stt);
    let leak = unit * (s + slope * slope * stt - 2.0 * slope * st);
    let state =
        MassAndLeak::try_new(mass_kg, -slope * mass_kg, [[unit * stt, across], [across, leak]]).unwrap();
    let true_kg = mass_at(now_s);
    (state, LossLaw::Choked.time_s(true_kg, leak_kg_s * true_kg / start_kg, LIMIT_KG))
}

#[test]
fn intervals_hold_the_true_time_of_simulated_leaks() {
    let mut random = ChaCha8Rng::seed_from_u64(11);
    for leak_g_h in [0.3, 1.0, 5.0] {
        // Where the true time lies in the distribution: uniform between 0 and 1 if that is right.
        let places: Vec<f64> = (0..2000)
            .map(|_| {
                let (state, true_s) = fitted(leak_g_h * G_H, &mut random);
                prognosis(state, LossLaw::Choked).probability_within(true_s)
            })
            .collect();
        let share = |low: f64, high: f64| {
            places.iter().filter(|place| (low..=high).contains(*place)).count() as f64 / places.len() as f64
        };
        let (inside, early) = (share(0.05, 0.95), share(0.0, 0.5));
        println!(
            "{leak_g_h} g/h: {:.1} % of the 90 % intervals hold the time, {:.1} % before the median",
            100.0 * inside,
            100.0 * early
        );
        // 3.3 standard deviations of a binomial share.
        assert!(
            (inside - 0.9).abs() < 0.022 && (early - 0.5).abs() < 0.037,
            "{leak_g_h} g/h: {inside} {early}"
        );
    }
}

#[test]
fn reactions_follow_the_probabilities() {
    let settings = ReactionSettings::default();
    let maintenance_kg = 4.27;
    let react = |state: MassAndLeak, leak_probability: f64| {
        let to = |limit_kg: f64| {
            let prognosis = Prognosis::try_new(state, limit_kg, LossLaw::Choked).unwrap();
            prognosis.with_leak_probability(leak_probability).unwrap()
        };
        settings.decide(&[to(LIMIT_KG), to(3.5)], &to(maintenance_kg)).unwrap()
    };
    // 800 g in an hour; in 3.7 d; 190 g in 7 months, 800 g not in one; a tight cylinder.
    assert_eq!(react(state(1000.0, 10.0, 0.0), 1.0).reaction, Reaction::Shutdown);
    assert_eq!(react(state(10.0, 1.0, 0.0), 1.0).reaction, Reaction::AsSoonAsPossible);
    assert_eq!(react(state(0.05, 0.005, 0.0), 1.0).reaction, Reaction::NextInterval);
    assert_eq!(react(state(0.0, 0.005, 0.0), 1.0).reaction, Reaction::None);
    // A leak that is hardly believed does not stop a train.
    assert_eq!(react(state(1000.0, 10.0, 0.0), 0.2).reaction, Reaction::AsSoonAsPossible);
    assert_eq!(react(state(1000.0, 10.0, 0.0), 0.01).reaction, Reaction::None);
    // Below the limit without a leak.
    let low = MassAndLeak { mass_kg: 3.6, ..state(0.0, 0.005, 0.0) };
    assert_eq!(react(low, 0.0).reaction, Reaction::Shutdown);
    let advice = react(state(10.0, 1.0, 0.0), 1.0);
    assert!(advice.before_safe_state < 1e-6 && advice.before_next_service > 0.999);
    let bad = ReactionSettings { soon_probability: 0.0, ..settings };
    assert!(bad.decide(&[], &Prognosis::try_new(low, 1.0, LossLaw::Linear).unwrap()).is_err());
}

#[test]
fn what_cannot_be_a_state_is_refused() {
    let ok = |covariance| MassAndLeak::try_new(4.0, 0.0, covariance).is_ok();
    assert!(ok([[1e-6, 1e-9], [1e-9, 1e-12]]));
    assert!(!ok([[1e-6, 1.1e-9], [1.1e-9, 1e-12]]));
    assert!(!ok([[1e-6, 1e-10], [2e-10, 1e-12]]));
    assert!(!ok([[-1e-6, 0.0], [0.0, 1e-12]]) && !ok([[1e-6, f64::NAN], [f64::NAN, 1e-12]]));
    assert!(!ok([[1e-6, 0.0], [0.0, f64::INFINITY]]) && !ok([[0.0, 1e-9], [1e-9, 1e-12]]));
    assert!(MassAndLeak::try_new(f64::NAN, 0.0, [[0.0; 2]; 2]).is_err());
    assert!(MassAndLeak::try_new(4.0, f64::INFINITY, [[0.0; 2]; 2]).is_err());
    assert!(Prognosis::try_new(state(1.0, 1.0, 0.0), 0.0, LossLaw::Linear).is_err());
}
