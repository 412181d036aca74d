//! A climatic chamber that repeats four profiles, in an order drawn for each round.
//!
//! They are [`Chamber::SCENARIOS`]. Before each the chamber goes to its first temperature within an hour and rests there for 2 to 5 h;
//! what they change at once takes 60 to 240 s here.
//! Film 16 W/(m² K) by its fan; the walls have the temperature of the air.
use super::Span;
use super::part::Polyline;
use super::unrest::Unrest;
use super::weather::Weather;
use super::workshop::any_season;
use crate::random::{Purpose, Random};
use crate::world::chamber::Chamber;
use cylwatch_thermal::units::{HOUR_S, MINUTE_S};

const FAST_S: (f64, f64) = (60.0, 240.0);
const TRANSFER_S: f64 = HOUR_S;
const REST_S: (f64, f64) = (2.0 * HOUR_S, 5.0 * HOUR_S);

/// Air of the chamber, and the times at which fast changes begin.
fn programme(span: &Span) -> (Polyline, Vec<f64>) {
    let random = &mut Random::new(span.seed, Purpose::WorldHeater);
    let (mut air, mut jumps_s) = (Polyline { time_s: Vec::new(), value: Vec::new() }, Vec::new());
    let (mut t, mut round) = (0.0, Vec::new());
    while t <= span.clock_end_s() {
        if round.is_empty() {
            round = Chamber::SCENARIOS.to_vec();
        }
        let Chamber { start_degc, end_degc, ramp_s, after_s, .. } =
            round.remove(random.whole((0, round.len() - 1)));
        let is_fast = ramp_s == 0.0;
        let change_s = if is_fast { random.uniform(FAST_S) } else { ramp_s };
        let change_at_s = t + TRANSFER_S + random.uniform(REST_S);
        for (at_s, degc) in
            [(t + TRANSFER_S, start_degc), (change_at_s, start_degc), (change_at_s + change_s, end_degc)]
        {
            air.time_s.push(at_s);
            air.value.push(degc);
        }
        t = change_at_s + after_s.max(change_s + MINUTE_S);
        air.time_s.push(t);
        air.value.push(end_degc);
        jumps_s.extend(is_fast.then_some(change_at_s));
    }
    (air, jumps_s)
}

pub(super) fn draw(span: &Span) -> Weather {
    let (air, jumps_s) = programme(span);
    let unrest = Unrest { turbulence_k: 0.2, gust: 0.05, difference_k: 0.5 };
    Weather { inside: Some(air), jumps_s, ..Weather::sheltered(any_season().draw(span), 16.0, unrest) }
}
