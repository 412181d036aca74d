//! What a jump was; the rules stand in [`super`].
use std::collections::VecDeque;

use serde::{Deserialize, Serialize};

use crate::monitor::median::median;

/// Samples within which a spike comes back.
const SPIKE_SAMPLES: usize = 5;
/// Samples whose median tells spikes among good ones, within so many, and what is left of the largest in it at most, beside the model's error, Pa.
const AMONG: usize = 5;
const AMONG_FIRST: usize = 12;
const LEFT_OF_SPIKES: f64 = 0.05;
/// Change of the thermometers beyond which the surroundings move, [`CALM_K`] and on, from which a jump is one in a tunnel, K.
const STILL_K: f64 = 0.6;
/// Error that no tunnel makes in a few samples, Pa.
const BEYOND_TUNNEL_PA: f64 = 2e5;
/// Least height of such spikes, Pa.
const SPIKE_PA: f64 = 1e5;
const BESIDE_SPIKES_PA: f64 = 0.1e5;
/// Jump that no offset makes, and gain that no filling stops at, Pa.
const NO_OFFSET_PA: f64 = 20e5;
const NO_FILLING_PA: f64 = 10e5;
/// Loss that counts as gas at once, Pa: a transmitter whose offset falls so far is less likely, and gas that is lost must be told within
/// minutes. It must have lasted for so many samples, or for two and so long, s.
const LOSS_PA: f64 = 8e5;
const LOSS_SAMPLES: usize = 3;
const LOSS_S: f64 = 120.0;
/// Samples over which a flow grows, where a transmitter's jump takes one.
const FLOW_SAMPLES: usize = 3;
/// Time after the largest error until the examination ends, s, and the part at its end that counts.
const REST_S: f64 = 1500.0;
const LAST_S: f64 = 600.0;
/// Growth of the error that moves the largest one, relative and absolute, Pa.
const GROWTH: f64 = 0.03;
const GROWTH_PA: f64 = 0.05e5;
/// Part that comes back which divides gas from transmitter.
const DIVISION: f64 = 0.1;
/// Part of the largest error that gas leaves at least, unless the model wanders less.
const LEFT_OF_GAS: f64 = 0.4;
/// How the model wanders meanwhile, Pa and Pa/K.
const WANDER_PA: f64 = 0.04e5;
const WANDER_PA_K: f64 = 0.05e5;
/// Change of the thermometers from one sample to the next, K and as a multiple of that at the jump, from which the surroundings move, and
/// fewest samples that can be judged then.
const CALM_K: f64 = 0.15;
const CALM_PER_FIRST: f64 = 1.5;
const FEWEST: usize = 6;
/// Error beyond which gas that flows is no puff, Pa.
const PUFF_PA: f64 = 3e5;
/// Longest examination, s.
const LONGEST_S: f64 = 7200.0;

/// What the jump was.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Cause {
    /// Too early to say.
    Open,
    /// Gas is flowing: the error grows over several samples.
    Flowing,
    /// A reading or a few were far off.
    Spike,
    /// Nothing is left of it.
    Passed,
    /// The transmitter's offset has changed by so much, Pa.
    Offset(f64),
    /// Gas was exchanged and the flow is over.
    Gas,
    /// Either may be; gas is the safe assumption.
    Unclear,
}

/// The examination of a jump.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Examination {
    onset_s: f64,
    /// Expected less read before the jump, Pa.
    before_pa: f64,
    /// Errors of the last while: time, s, and error, Pa.
    recent: VecDeque<(f64, f64)>,
    samples: usize,
    peak_pa: f64,
    peak_s: f64,
    /// Least of the medians of five since the largest error, as its part of the same sign, Pa.
    least_pa: f64,
    /// Samples at which the error grew.
    grew: usize,
    back: usize,
    /// Change of the thermometers beyond which the surroundings move, K; `None`: they have.
    calm_k: Option<f64>,
    /// What the surroundings may have done to it just before, Pa.
    doubt_pa: f64,
    warmest_k: f64,
    coldest_k: f64,
}

impl Examination {
    /// Of a jump at `onset_s`, s, before which the pressure read `innovation_pa`, Pa, more than expected, and to which the surroundings
    /// may have done `doubt_pa`, Pa.
    pub fn new(onset_s: f64, innovation_pa: f64, doubt_pa: f64) -> Self {
        Self {
            onset_s,
            before_pa: -innovation_pa,
            recent: VecDeque::new(),
            samples: 0,
            peak_pa: 0.0,
            peak_s: onset_s,
            least_pa: f64::INFINITY,
            grew: 0,
            back: 0,
            calm_k: Some(f64::INFINITY),
            doubt_pa,
            warmest_k: f64::NEG_INFINITY,
            coldest_k: f64::INFINITY,
        }
    }

    /// When it began, s.
    pub fn onset_s(&self) -> f64 {
        self.onset_s
    }

    /// Pressure lost since before the jump at the last sample, Pa; negative: gained.
    pub fn error_pa(&self) -> f64 {
        self.recent.back().map_or(0.0, |(_, error)| *error)
    }

    /// Take in what is expected without the pressure, Pa, and read, Pa, at a gas temperature, K, with how far both thermometers
    /// moved since the sample before, K.
    pub fn push(
        &mut self,
        time_s: f64,
        (expected_pa, reading_pa): (f64, f64),
        gas_k: f64,
        moved_k: f64,
    ) -> Cause {
        if !(expected_pa.is_finite() && reading_pa.is_finite()) {
            return if time_s - self.onset_s > LONGEST_S { Cause::Unclear } else { Cause::Open };
        }
        if let Some(decided) = self.decide_before_it_moves(moved_k) {
            return decided;
        }
        let error_pa = expected_pa - reading_pa - self.before_pa;
        (self.warmest_k, self.coldest_k) = (self.warmest_k.max(gas_k), self.coldest_k.min(gas_k));
        self.samples += 1;
        self.recent.push_back((time_s, error_pa));
        while self.recent.front().is_some_and(|(first_s, _)| *first_s < time_s - LAST_S) {
            self.recent.pop_front();
        }
        if error_pa.abs() > (1.0 + GROWTH) * self.peak_pa.abs() + GROWTH_PA {
            (self.peak_pa, self.peak_s, self.least_pa) = (error_pa, time_s, f64::INFINITY);
            self.grew += 1;
        }
        if self.samples >= AMONG {
            self.least_pa = self.least_pa.min(self.recent_median_pa(AMONG) * self.peak_pa.signum());
        }
        self.back = if error_pa.abs() < 0.4 * self.peak_pa.abs() { self.back + 1 } else { 0 };
        self.judge(time_s)
    }

    /// The surroundings begin to move: what is known until then, if it tells gas from transmitter.
    fn decide_before_it_moves(&mut self, moved_k: f64) -> Option<Cause> {
        if self.samples == 0 {
            self.calm_k = Some(CALM_K + CALM_PER_FIRST * moved_k);
        }
        if moved_k <= self.calm_k? {
            return None;
        }
        self.calm_k = None;
        let flowing = self.grew >= FLOW_SAMPLES && self.error_pa().abs() > PUFF_PA;
        let settled = self.samples >= FEWEST && !flowing;
        Some(self.conclude()).filter(|cause| settled && matches!(cause, Cause::Gas | Cause::Offset(_)))
    }

    fn judge(&self, time_s: f64) -> Cause {
        let peak_pa = self.peak_pa.abs();
        let among = self.recent.len() >= AMONG
            && self.samples <= AMONG_FIRST
            && self.recent_median_pa(AMONG).abs() < LEFT_OF_SPIKES * peak_pa + BESIDE_SPIKES_PA
            && peak_pa > SPIKE_PA
            && self.grew < FLOW_SAMPLES;
        // What a tunnel does to the shadow is no spike that has gone.
        let tellable = self.calm_k.is_some_and(|calm_k| calm_k < STILL_K) || peak_pa > BEYOND_TUNNEL_PA;
        if tellable && (among || self.samples <= SPIKE_SAMPLES && self.back >= 2) {
            return Cause::Spike;
        }
        if time_s - self.peak_s < REST_S && time_s - self.onset_s < LONGEST_S {
            let lasted =
                self.samples >= LOSS_SAMPLES || (self.samples >= 2 && time_s - self.onset_s >= LOSS_S);
            let large = self.error_pa() > LOSS_PA || self.error_pa() < -NO_OFFSET_PA;
            return if (lasted && large) || self.grew >= FLOW_SAMPLES { Cause::Flowing } else { Cause::Open };
        }
        self.conclude()
    }

    /// What the errors so far say.
    fn conclude(&self) -> Cause {
        let peak_pa = self.peak_pa.abs();
        let end_pa = self.recent_median_pa(self.recent.len());
        let wander_pa = WANDER_PA + WANDER_PA_K * (self.warmest_k - self.coldest_k) + self.doubt_pa;
        // Where the shadow wanders as far as that, it says nothing.
        let tellable = 2.0 * wander_pa < peak_pa;
        let left_pa = end_pa * self.peak_pa.signum();
        // In a cylinder that leaks, what came back is lost again by the end.
        let back_pa = peak_pa - if self.peak_pa > 0.0 { self.least_pa.min(left_pa) } else { left_pa };
        match () {
            () if tellable && end_pa.abs() < WANDER_PA.max((LEFT_OF_GAS * peak_pa).min(2.0 * wander_pa)) => {
                Cause::Passed
            }
            // The surroundings may have done all of it. Gas that went shows in the masses.
            () if end_pa.abs() < 2.0 * self.doubt_pa => Cause::Passed,
            () if self.grew >= FLOW_SAMPLES || end_pa.abs() > NO_OFFSET_PA => Cause::Gas,
            () if back_pa > DIVISION * peak_pa + 0.5 * wander_pa => Cause::Gas,
            () if back_pa < DIVISION * peak_pa - 0.5 * wander_pa => Cause::Offset(-end_pa),
            () if -NO_FILLING_PA < end_pa && end_pa < 0.0 => Cause::Offset(-end_pa),
            () => Cause::Unclear,
        }
    }

    /// Median of the last errors, Pa: spikes among them count for nothing.
    fn recent_median_pa(&self, samples: usize) -> f64 {
        median(self.recent.iter().rev().take(samples).map(|(_, error)| *error))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const MINUTE_S: f64 = 60.0;

    /// Causes of the courses `e(minutes)` until there is one.
    fn cause(error_bar: impl Fn(f64) -> f64) -> Cause {
        let mut examination = Examination::new(0.0, 0.02e5, 0.0);
        for minute in 0..200 {
            let minutes = f64::from(minute);
            let expected_pa = 180e5;
            let reading_pa = expected_pa + 0.02e5 - 1e5 * error_bar(minutes);
            match examination.push(MINUTE_S * minutes, (expected_pa, reading_pa), 280.0, 0.0) {
                Cause::Open | Cause::Flowing => {}
                cause => return cause,
            }
        }
        Cause::Open
    }

    #[test]
    fn what_jumps_is_told_by_what_comes_back() {
        assert_eq!(cause(|minutes| if minutes < 2.0 { 50.0 } else { 0.0 }), Cause::Spike);
        let Cause::Offset(by_pa) = cause(|_| 0.5) else { panic!("a step that stays is the transmitter's") };
        assert!((by_pa + 0.5e5).abs() < 1.0, "{by_pa} Pa");
        assert!(matches!(cause(|_| -2.0), Cause::Offset(by_pa) if (by_pa - 2e5).abs() < 1.0));
        // Half of the rebound of 38 % was over at the first sample.
        assert_eq!(cause(|minutes| 1.0 + 0.25 * (-minutes / 4.0).exp()), Cause::Gas);
        assert_eq!(cause(|minutes| -20.0 * (1.0 + 0.4 * (-minutes / 4.0).exp())), Cause::Gas);
        // A refill of ten minutes.
        assert_eq!(cause(|minutes| -4.0 * (minutes + 1.0).min(10.0)), Cause::Gas);
        assert_eq!(cause(|minutes| 0.5 * (-minutes / 10.0).exp()), Cause::Passed);
        assert_eq!(cause(|minutes| 0.4 + 0.05 * (-minutes / 4.0).exp()), Cause::Unclear);
        // The same upwards is no filling; a bottle that is let go to 20 bar in a minute is no offset.
        assert!(
            matches!(cause(|minutes| -0.4 - 0.05 * (-minutes / 4.0).exp()), Cause::Offset(by) if by > 0.0)
        );
        assert_eq!(cause(|minutes| 150.0 + 10.0 * (-minutes / 4.0).exp()), Cause::Gas);
    }

    #[test]
    fn gas_let_out_of_a_cylinder_that_leaks_is_gas() {
        let leaks = |minutes: f64| 0.017 * minutes;
        assert_eq!(cause(|minutes| 0.8 + 0.4 * (-minutes / 4.0).exp() + leaks(minutes)), Cause::Gas);
        // An offset on top of a leak grows like a flow: gas is the safe assumption.
        assert_eq!(cause(|minutes| 2.0 + leaks(minutes)), Cause::Gas);
    }

    #[test]
    fn spikes_among_good_readings_are_spikes() {
        let one_of_three = |minutes: f64| match minutes as u32 % 3 {
            0 if (minutes as u32).is_multiple_of(2) => 50.0,
            0 => -50.0,
            _ => 0.0,
        };
        assert_eq!(cause(one_of_three), Cause::Spike);
        assert_eq!(
            cause(|minutes| if [0.0, 1.0, 2.0, 4.0].contains(&minutes) { 50.0 } else { 0.0 }),
            Cause::Spike
        );
    }

    #[test]
    fn a_flow_is_told_after_three_samples() {
        let mut examination = Examination::new(0.0, 0.0, 0.0);
        let causes: Vec<Cause> = (0..4)
            .map(|n| {
                let read = (180e5, 180e5 - 1e5 * f64::from(n + 1));
                examination.push(MINUTE_S * f64::from(n), read, 280.0, 0.0)
            })
            .collect();
        assert_eq!(causes, [Cause::Open, Cause::Open, Cause::Flowing, Cause::Flowing]);
    }

    #[test]
    fn a_step_that_the_surroundings_may_have_made_is_no_offset() {
        let told = |doubt_pa: f64, step_pa: f64| {
            let mut examination = Examination::new(0.0, 0.0, doubt_pa);
            let mut causes = (0..200).map(|minute| {
                examination.push(MINUTE_S * f64::from(minute), (200e5, 200e5 + step_pa), 280.0, 0.0)
            });
            causes.find(|cause| *cause != Cause::Open)
        };
        for step_pa in [2e5, -2e5] {
            assert_eq!(told(0.0, step_pa), Some(Cause::Offset(step_pa)));
            assert_eq!(told(1.5e5, step_pa), Some(Cause::Passed));
        }
    }

    #[test]
    fn what_was_seen_before_the_surroundings_moved_decides() {
        // Gas let out nine minutes before a tunnel that throws the shadow off.
        let course = |minute: f64| {
            if minute < 9.0 { 0.76 + 0.3 * (-minute / 4.0).exp() } else { 0.3 }
        };
        let until = |tunnel_at: f64| {
            let mut examination = Examination::new(0.0, 0.0, 0.0);
            (0..120).find_map(|minute| {
                let minute = f64::from(minute);
                let moved_k = if minute < tunnel_at { 0.05 } else { 2.0 };
                let read = (180e5, 180e5 - 1e5 * course(minute));
                let gas_k = 280.0 + (minute - tunnel_at).clamp(0.0, 8.0);
                let cause = examination.push(MINUTE_S * minute, read, gas_k, moved_k);
                (cause != Cause::Open).then_some((minute, cause))
            })
        };
        assert_eq!(until(9.0), Some((9.0, Cause::Gas)));
        let (later, cause) = until(3.0).expect("it ends");
        assert!(later > 20.0 && cause == Cause::Passed, "too early to tell: {cause:?} after {later} min");
    }
}
