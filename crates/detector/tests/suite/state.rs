//! The state of every statistic: saved and restored at any sample, untouched by samples that are none.
use cylwatch_detector::statistic::{
    AfterAlarm, Alarm, Cusum, Ewma, EwmaLimits, Shewhart, ShiryaevRoberts, Side, Sprt, Statistic,
    TwoSidedCusum, Watch,
};
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use rand_distr::StandardNormal;
use serde::Serialize;
use serde::de::DeserializeOwned;

/// Goes on bit for bit after a restart at every sample, ignores what is no sample, and forgets on reset.
fn keeps_its_state<S>(new: S)
where
    S: Statistic<Sample = f64> + Clone + PartialEq + std::fmt::Debug + Serialize + DeserializeOwned,
{
    let mut random = ChaCha8Rng::seed_from_u64(1);
    let (mut statistic, mut restarted) = (new.clone(), new.clone());
    for _ in 0..200 {
        restarted = serde_json::from_str(&serde_json::to_string(&restarted).unwrap()).unwrap();
        let value = random.sample(StandardNormal);
        assert_eq!(statistic.update(value).to_bits(), restarted.update(value).to_bits());
        assert_eq!(statistic, restarted);
        for none in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
            statistic.update(none);
        }
        assert_eq!(statistic, restarted);
        assert!(!statistic.value().is_nan());
    }
    statistic.reset();
    assert_eq!(statistic.update(1.3).to_bits(), new.clone().update(1.3).to_bits());
}

#[test]
fn statistics_go_on_bit_for_bit_after_a_restart_at_any_sample() {
    let cusum = Cusum::try_new(0.5).unwrap().with_head_start(2.5).unwrap();
    keeps_its_state(Shewhart::with_run(Side::Both, 3, 5).unwrap());
    keeps_its_state(cusum);
    keeps_its_state(TwoSidedCusum::new(cusum));
    keeps_its_state(Ewma::try_new(0.1, Side::Above, EwmaLimits::Exact).unwrap());
    keeps_its_state(ShiryaevRoberts::try_new(0.7).unwrap());
    keeps_its_state(Sprt::try_new(0.7, 1e3, 1e3).unwrap());
}

#[test]
fn a_watch_goes_on_bit_for_bit_after_a_restart_at_any_sample() {
    let mut random = ChaCha8Rng::seed_from_u64(2);
    for after in [AfterAlarm::Restart, AfterAlarm::Continue, AfterAlarm::Latch] {
        let mut watch = Watch::new(Cusum::try_new(0.2).unwrap(), Alarm::try_new(3.0, after).unwrap());
        let mut restarted = watch.clone();
        for _ in 0..500 {
            restarted = serde_json::from_str(&serde_json::to_string(&restarted).unwrap()).unwrap();
            let value = random.sample(StandardNormal);
            assert_eq!(watch.update(value), restarted.update(value));
        }
        assert!(watch.alarm.alarms() >= 1);
    }
}

#[test]
fn settings_out_of_bounds_are_refused() {
    assert!(Shewhart::with_run(Side::Both, 0, 3).is_err());
    assert!(Shewhart::with_run(Side::Both, 4, 3).is_err());
    assert!(Shewhart::with_run(Side::Both, 1, 1001).is_err());
    assert!(Cusum::try_new(f64::NAN).is_err());
    assert!(Cusum::try_new(0.5).unwrap().with_head_start(-1.0).is_err());
    for weight in [0.0, 1.1, f64::NAN] {
        assert!(Ewma::try_new(weight, Side::Both, EwmaLimits::Exact).is_err());
    }
    assert!(ShiryaevRoberts::try_new(0.0).is_err());
    assert!(Sprt::try_new(0.0, 1.0, 1.0).is_err());
    assert!(Sprt::try_new(1.0, 0.0, 1.0).is_err());
    assert!(Sprt::try_new(1.0, 1.0, f64::INFINITY).is_err());
    assert!(Alarm::try_new(f64::NAN, AfterAlarm::Latch).is_err());
}
