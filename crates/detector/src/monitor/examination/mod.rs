//! What a jump was: one bank of causes, for the transmitter and for the thermometers.
//!
//! What is examined is what is missing of a reading, as a part of the sensor's span,
//!
//! `y_k = h_k + x_k + n_k`.
//!
//! | subject | `y` | span |
//! |---|---|---|
//! | pressure | what a second observer, which goes on from before the jump without the pressure, expects, less what is read | the full cylinder's pressure |
//! | thermometer | how far both thermometers were apart before, less how far they are now | [`SPAN`] errors of a temperature on the surface |
//!
//! `n` is the sensor's noise, white. `x` is the model's error. It vanishes at equilibrium: its standard deviation `s_k` is what is
//! considered for what the surroundings lately did ([`Flow::considered_sd_kg`](crate::estimator::observer::Flow), [`Pair`](super::readings::thermometers::Pair)), and a floor;
//! it begins with what was missing before the jump, within what they may have done since, and forgets within a time `tau`,
//!
//! `x_k = rho min(1, s_k / s_{k-1}) x_{k-1} + v_k`, `rho = exp(-dt / tau)`, `var x -> s_k^2`.
//!
//! What was seen before a tunnel so counts in full, and what is seen in it counts little.
//! After a silence of more than a quarter of an hour nobody has seen what they did: all that was not expected of the first reading, `u`, may be theirs. Then `(u exp(-t / tau))^2` is added
//! to `s_k^2`, and it is nothing only once half of `u` has gone back.
//!
//! `h` is what each cause makes of it, the last two of a pressure alone:
//!
//! | cause | `h_k` | prior |
//! |---|---|---|
//! | nothing | 0 | |
//! | offset | `b` | `b` of 1.5 % as a rule, of 100 % where the sensor breaks |
//! | gas, at once | `a (1 + r exp(-t / T))` | `a` of 1 or 100 %, `r` of 0 or, each with `T` of 1 to 9 min, of 0.1 to 0.4 |
//! | gas that flows | `w_k`, a random walk | by 0.1, 1 or 100 % in a minute |
//!
//! An isentropic step of the pressure is 1.4 to 1.67 times the isothermal one that is left when gas and wall have one temperature again: gas that goes
//! at once comes back by a part `r`, and no transmitter does. Each cause is a linear Gaussian model with one unknown, so a Kalman filter of two states gives
//! its likelihood with the unknown integrated out. Any reading may be far off, by up to the span either way, under each cause: then it says nothing of it and costs
//! what it is worth in this sensor ([`FarOff`]). Spikes are "nothing" with readings far off, for less than [`REST_S`].
//!
//! An offset is as likely as gas; by the densities of their sizes small steps are the transmitter's and large ones are gas. The examination ends when nothing is left of the jump with
//! [`SURE`] odds, or when the error has stayed for [`REST_S`], as then gas and wall are at rest; what is not gas for sure waits until the surroundings no more make half of it. What is then not
//! [`LIKELY`] is unclear, and where the model is right again, what is missing by less than half of what the cause says has passed. A thermometer, which has another one beside it, is
//! examined for as long as only the surroundings hide what it did.
//!
//! Assumes that a jump is over within two hours; gas that takes longer is a flow.
//!
//! Source: the bank of Kalman filters is Magill's, IEEE Trans. Autom. Control 10 (1965) 434; Willsky, Jones, IEEE Trans. Autom. Control 21 (1976) 108 has jumps.
mod far;

use core::f64::consts::TAU;
use cylwatch_estimator::thermal::real::powi;

use serde::{Deserialize, Serialize};
use smallvec::SmallVec;

use super::restored;
use crate::DetectorError;

pub(super) use far::{FORGOTTEN_S, FarOff, kept};

/// Model's error at rest, as a part of the full pressure.
const FLOOR: f64 = 1e-4;
/// A thermometer's span, in errors of a temperature on the surface, one of which is the model's error at rest.
pub(in crate::monitor) const SPAN: f64 = 800.0;
/// Standard deviations of an offset, of a puff, and of gas that goes or an offset of a sensor that has broken, as parts of the span.
const OFFSET: f64 = 0.015;
const PUFF: f64 = 0.01;
const ANY: f64 = 1.0;
/// Part of the jumps by gas that are puffs.
const PUFFS: f64 = 0.2;
/// Chance that a sensor whose offset jumps has broken, and that gas that flows does so in jumps.
const BROKEN: f64 = 0.05;
/// Parts of a step of gas that come back after the first sample, and the time constants with which they do, s.
const REBOUNDS: [f64; 3] = [0.1, 0.2, 0.4];
const REBOUND_S: [f64; 3] = [60.0, 180.0, 540.0];
/// Standard deviations of the change by gas that flows, in a minute.
const FLOWS: [f64; 3] = [1e-3, 1e-2, ANY];
/// Courses of a pressure at most: none, two offsets, two sizes of gas at each rebound and at once, flows.
const COURSES: usize = 3 + 2 * (REBOUNDS.len() * REBOUND_S.len() + 1) + FLOWS.len();
/// Chance that a jump is none, before it is looked at.
const NOTHING: f64 = 0.7;
/// The same of an offset, and of gas.
const EITHER: f64 = (1.0 - NOTHING) / 2.0;
/// Probability from which a cause is told at once, and from which it is told at the end.
const SURE: f64 = 0.97;
const LIKELY: f64 = 0.9;
/// Time for which the error stays where gas and wall are at rest, s, and the longest examination, s.
const REST_S: f64 = 1500.0;
const LONGEST_S: f64 = 7200.0;
/// Relative growth of the error that moves the largest one, relative change that is none of rest, and standard deviations that are more than chance.
const GROWTH: f64 = 0.03;
const CHANGE: f64 = 0.2;
const DEVIATIONS: f64 = 5.0;
/// Part of the span that no jump of an offset makes.
pub(super) const NO_OFFSET: f64 = 0.1;

/// What the jump was.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Cause {
    /// Too early to say.
    Open,
    /// Gas is flowing, or went at once.
    Flowing,
    /// A reading or a few were far off.
    Spike,
    /// Nothing is left of it.
    Passed,
    /// The sensor's offset has changed by so much, as a part of the span.
    Offset(f64),
    /// Gas was exchanged and the flow is over; of a thermometer: no offset is that large, it reads something else.
    Gas,
    /// Either may be; gas is the safe assumption.
    Unclear,
}

/// What was before a jump, as parts of the span.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Before {
    /// What was missing.
    pub missing: f64,
    /// What the surroundings may have done to it since, sd.
    pub fresh: f64,
    /// The same while nothing was heard.
    pub unseen: f64,
}

/// A sample, as parts of the span.
#[derive(Clone, Copy, Debug)]
pub(super) struct Compared {
    /// Time, s.
    pub time_s: f64,
    /// What is expected without the sensor less what is read.
    pub missing: f64,
    /// Standard deviation of that by what is considered for the surroundings.
    pub considered: f64,
    /// Standard deviation of the noise.
    pub noise: f64,
}

/// What a cause makes of the error.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Course {
    Nothing,
    Offset { sd: f64 },
    Gas { sd: f64, rebound: f64, time_s: f64 },
    Flow { per_sqrt_minute: f64 },
}

/// What has jumped; see the module's head.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub(super) enum Subject {
    /// The pressure.
    Pressure,
    /// A thermometer.
    Thermometer,
}

impl Subject {
    /// Model's error at rest.
    fn floor(self) -> f64 {
        match self {
            Self::Pressure => FLOOR,
            Self::Thermometer => SPAN.recip(),
        }
    }

    /// All causes with their prior probabilities.
    fn courses(self) -> impl Iterator<Item = (Course, f64)> {
        let gas = (self == Self::Pressure).then(of_gas).into_iter().flatten();
        let offsets = [(OFFSET, 1.0 - BROKEN), (ANY, BROKEN)]
            .map(|(sd, share)| (Course::Offset { sd }, EITHER * share));
        [(Course::Nothing, NOTHING)].into_iter().chain(offsets).chain(gas)
    }
}

/// Gas that came or went, at once or by a flow.
fn of_gas() -> impl Iterator<Item = (Course, f64)> {
    let gas = EITHER / (REBOUNDS.len() * REBOUND_S.len() + FLOWS.len() + 1) as f64;
    let sizes = [(PUFF, PUFFS), (ANY, 1.0 - PUFFS)].into_iter();
    let rebounds = REBOUNDS.into_iter().flat_map(|rebound| REBOUND_S.map(|time_s| (rebound, time_s)));
    // All of it may have come back before the first sample.
    let at_once = rebounds.chain([(0.0, REST_S)]).flat_map(move |(rebound, time_s)| {
        sizes.clone().map(move |(sd, share)| (Course::Gas { sd, rebound, time_s }, gas * share))
    });
    // One that jumps again and again is as rare as a transmitter that has broken.
    let rarely = |per_sqrt_minute: f64| if per_sqrt_minute < ANY { 1.0 } else { BROKEN };
    let flows =
        FLOWS.map(|per_sqrt_minute| (Course::Flow { per_sqrt_minute }, gas * rarely(per_sqrt_minute)));
    at_once.chain(flows)
}

/// Filter of one cause: the model's error and the unknown.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
struct Member {
    ln_odds: f64,
    mean: [f64; 2],
    /// Variances of both, and their covariance.
    variance: [f64; 2],
    covariance: f64,
    /// Whether the last reading was far off, and whether the first one was.
    far: bool,
    spiked: bool,
}

impl Member {
    /// Of a cause with its prior probability, where so much was missing before, and the surroundings may have done so much since, sd.
    fn new(course: Course, prior: f64, before: f64, fresh: f64) -> Self {
        let unknown = match course {
            Course::Nothing => 0.0,
            Course::Offset { sd } => sd,
            Course::Gas { sd, .. } => sd,
            Course::Flow { .. } => ANY,
        };
        let variance = [fresh * fresh, unknown * unknown];
        Self {
            ln_odds: libm::log(prior),
            mean: [before, 0.0],
            variance,
            covariance: 0.0,
            far: false,
            spiked: false,
        }
    }

    /// After so long, s: the part of the model's error that is left, and the variance that comes to it.
    fn predict(&mut self, course: Course, interval_s: f64, (kept, fresh): (f64, f64)) {
        self.mean[0] *= kept;
        self.variance[0] = kept * kept * self.variance[0] + fresh;
        self.covariance *= kept;
        if let Course::Flow { per_sqrt_minute } = course {
            self.variance[1] += per_sqrt_minute * per_sqrt_minute * interval_s / 60.0;
        }
    }

    /// Take in an error, so long after the jump, s, with the variance of the noise.
    fn update(&mut self, course: Course, since_s: f64, (error, noise): (f64, f64), far_off: &FarOff) {
        let by = match course {
            Course::Nothing => 0.0,
            Course::Offset { .. } | Course::Flow { .. } => 1.0,
            Course::Gas { rebound, time_s, .. } => 1.0 + rebound * libm::exp(-since_s / time_s),
        };
        let gain = [self.variance[0] + by * self.covariance, self.covariance + by * self.variance[1]];
        let variance = gain[0] + by * gain[1] + noise;
        let innovation = error - self.mean[0] - by * self.mean[1];
        let ln_density = -0.5 * (innovation * innovation / variance + libm::log(TAU * variance));
        let chance = far_off.chance(self.far);
        let (near, far) = (libm::log(1.0 - chance) + ln_density, libm::log(chance / 2.0));
        self.ln_odds += near.max(far);
        self.far = near < far;
        if self.far {
            self.spiked |= since_s == 0.0;
            return;
        }
        for (mean, gain) in self.mean.iter_mut().zip(gain) {
            *mean += gain / variance * innovation;
        }
        for (own, gain) in self.variance.iter_mut().zip(gain) {
            *own -= gain * gain / variance;
        }
        self.covariance -= gain[0] * gain[1] / variance;
    }
}

/// The examination of a jump.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub(super) struct Examination {
    subject: Subject,
    onset_s: f64,
    /// Model's error at the last sample, sd.
    model: f64,
    /// What the surroundings may have done in a silence before it, sd.
    unseen: f64,
    memory_s: f64,
    last_s: f64,
    error: f64,
    /// Largest error and when it came to it, s.
    largest: f64,
    largest_s: f64,
    /// Error that it has stayed near, and since when, s.
    rest: f64,
    rest_s: f64,
    members: SmallVec<[Member; COURSES]>,
    /// How often readings are far off, and how often they were, if it is nothing.
    far_off: FarOff,
    seen: FarOff,
}

impl Examination {
    /// Checks one that was saved.
    pub(super) fn validate(&self) -> Result<(), DetectorError> {
        let (members, courses) = (self.members.len(), self.subject.courses().count());
        let all = members == courses;
        restored::require(all, "examination.members", members as f64, "one for each course")
    }

    /// Of a jump at `onset_s`, s. What the surroundings do is forgotten within `memory_s`, s.
    pub(super) fn new(
        subject: Subject,
        onset_s: f64,
        before: Before,
        memory_s: f64,
        far_off: FarOff,
    ) -> Self {
        let Before { missing, fresh, unseen } = before;
        let model = libm::hypot(unseen, subject.floor());
        let members = subject
            .courses()
            .map(|(course, prior)| Member::new(course, prior, missing, libm::hypot(fresh, model)));
        Self {
            subject,
            onset_s,
            model,
            unseen,
            memory_s,
            last_s: onset_s,
            error: 0.0,
            largest: 0.0,
            largest_s: onset_s,
            rest: 0.0,
            rest_s: onset_s,
            members: members.collect(),
            far_off,
            seen: FarOff::default(),
        }
    }

    /// When it began, s.
    pub(super) fn onset_s(&self) -> f64 {
        self.onset_s
    }

    /// What is missing at the last sample, as a part of the span; negative: gained.
    pub(super) fn error(&self) -> f64 {
        self.error
    }

    /// Take in a sample.
    pub(super) fn push(&mut self, now: Compared) -> Cause {
        let since_s = now.time_s - self.onset_s;
        if !now.missing.is_finite() {
            return if since_s > LONGEST_S { Cause::Unclear } else { Cause::Open };
        }
        let interval_s = now.time_s - core::mem::replace(&mut self.last_s, now.time_s);
        let unseen = self.unseen * libm::exp(-since_s / self.memory_s);
        let model = libm::hypot(libm::hypot(now.considered, unseen), self.subject.floor());
        let kept = libm::exp(-interval_s / self.memory_s) * (model / self.model).min(1.0);
        let fresh = model * model - powi(kept * self.model, 2);
        self.model = model;
        self.error = now.missing;
        let noise = now.noise * now.noise;
        let was_far = self.members[0].far;
        for ((course, _), member) in self.subject.courses().zip(&mut self.members) {
            if since_s > 0.0 {
                member.predict(course, interval_s, (kept, fresh));
            }
            member.update(course, since_s, (self.error, noise), &self.far_off);
        }
        if self.members[0].far {
            self.seen.saw_one_far_off(was_far);
        }
        let chance = DEVIATIONS * now.noise;
        if self.error.abs() > (1.0 + GROWTH) * self.largest.abs() + chance {
            (self.largest, self.largest_s) = (self.error, now.time_s);
        }
        if (self.error - self.rest).abs() > CHANGE * self.rest.abs() + chance {
            (self.rest, self.rest_s) = (self.error, now.time_s);
        }
        self.judge(now.time_s)
    }

    /// Readings that were far off, if there was nothing.
    pub(super) fn seen_far_off(&self) -> FarOff {
        self.seen
    }

    /// Whether it is more likely than not that there was nothing.
    pub(super) fn is_likely_nothing(&self) -> bool {
        self.probability()(Course::is_nothing) > 0.5
    }

    fn judge(&self, time_s: f64) -> Cause {
        let probability = self.probability();
        let [nothing, offset, gas] = [Course::is_nothing, Course::is_offset, Course::is_gas].map(probability);
        let over = time_s - self.onset_s >= LONGEST_S;
        let at_rest = over || time_s - self.rest_s >= REST_S;
        let level = if at_rest { LIKELY } else { SURE };
        // A reading that is far off may be the first of some, and what the surroundings did unseen goes back.
        let goes_back = self.unseen == 0.0 || self.error.abs() < self.unseen / 2.0;
        if nothing > level && !self.members[0].far && (goes_back || over) {
            let brief = time_s - self.onset_s < REST_S;
            return if self.members[0].spiked && brief { Cause::Spike } else { Cause::Passed };
        }
        if !at_rest {
            let grows = time_s - self.largest_s < REST_S;
            return if gas > SURE && grows { Cause::Flowing } else { Cause::Open };
        }
        let Some(some) = self.likeliest() else { return Cause::Passed };
        if some.far && !over {
            return Cause::Open;
        }
        let (left, sd) = (some.mean[1], libm::sqrt(some.variance[1].max(0.0)));
        let half = left.abs() / 2.0;
        let floor = self.subject.floor();
        let unknown = left.abs() < DEVIATIONS * libm::hypot(sd, floor);
        let hidden = unknown && left.abs() > DEVIATIONS * floor && self.subject == Subject::Thermometer;
        // What the surroundings may still do is told to be the transmitter's when they do it no more.
        if (gas <= LIKELY && self.model > half || unknown && !goes_back || hidden) && !over {
            return Cause::Open;
        }
        // Where the model's error has gone, what is not missing now was its.
        let still = self.model.max(self.error * left.signum()) > half;
        match () {
            () if !still || unknown => Cause::Passed,
            () if gas > LIKELY || left.abs() > NO_OFFSET => Cause::Gas,
            // Of a gain the transmitter is the safe assumption: it leaves the mass as low as it was.
            () if offset > LIKELY || left < 0.0 && self.subject == Subject::Pressure => Cause::Offset(-left),
            () => Cause::Unclear,
        }
    }

    /// Probability of the causes of a kind.
    fn probability(&self) -> impl Fn(fn(&Course) -> bool) -> f64 {
        let most = self.members.iter().map(|of| of.ln_odds).fold(f64::NEG_INFINITY, f64::max);
        let weights = move |of: &Member| libm::exp(of.ln_odds - most);
        let all: f64 = self.members.iter().map(weights).sum();
        move |is: fn(&Course) -> bool| {
            let of_kind = self.subject.courses().zip(&self.members).filter(|((course, _), _)| is(course));
            of_kind.map(|(_, member)| weights(member)).sum::<f64>() / all
        }
    }

    /// The likeliest cause but nothing.
    fn likeliest(&self) -> Option<&Member> {
        self.members.iter().skip(1).max_by(|a, b| a.ln_odds.total_cmp(&b.ln_odds))
    }
}

impl Course {
    fn is_nothing(&self) -> bool {
        matches!(self, Self::Nothing)
    }

    fn is_offset(&self) -> bool {
        matches!(self, Self::Offset { .. })
    }

    fn is_gas(&self) -> bool {
        matches!(self, Self::Gas { .. } | Self::Flow { .. })
    }
}

#[cfg(test)]
mod tests;
