//! Output of a row: estimate, decision, outlook and alarms.
//!
//! The member of the observer's bank that gives mass and gas temperature depends on the state of the cylinder. At rest the members that hold the mass are
//! the most precise, and what one end that is warmed by itself hides is added to what they are uncertain by. While a leak is known, the mass comes from the freest member. While gas flows, and until it has come to rest, mass, gas
//! temperature and rate come from the flowing member.
use super::{Monitor, SETTLED_S};
use crate::DetectorError;
use crate::estimator::observer::{Estimate, Flow};
use crate::monitor::alarm::AlarmInputs;
use crate::monitor::gas::outlook::{self, Basis};
use crate::monitor::intake::Row;
use crate::monitor::{Event, EventKind, Interval, Known, LeakFinding, Output, decide};
use crate::prognosis::Reaction;
use crate::units::DAY_S;
use alloc::vec::Vec;

impl Monitor {
    /// Say what there is to say of a row, with the leak rate of the member that holds the mass, kg/s.
    pub(super) fn say(
        &mut self,
        row: &Row,
        (mut estimate, held_kg_s): (Estimate, f64),
        mut events: Vec<Event>,
    ) -> Result<(), DetectorError> {
        let time_s = row.time_s;
        let leak = self.state.leak.found().copied();
        let largest_kg_s = self.state.leak.largest_per_s() * self.filled_kg.0;
        if let Some(free) = leak.and_then(|_| self.observer.freest_mass_kg()) {
            (estimate.mass_kg, estimate.mass_sd_kg) = free;
        }
        let flow = self.observer.flow();
        if let Some(flow) = &flow {
            if self.state.is_flowing(time_s) {
                (estimate.mass_kg, estimate.mass_sd_kg) = (flow.mass_kg, flow.mass_sd_kg);
            }
            // Members that hold too much mass explain the pressure by gas that is too cold.
            if leak.is_some() || time_s - self.state.flowed_s < SETTLED_S {
                (estimate.gas_mean_k, estimate.gas_mean_sd_k) = (flow.gas_mean_k, flow.gas_mean_sd_k);
            }
        }
        let off_k = self.state.parity.doubt_k();
        estimate.gas_mean_sd_k = libm::hypot(estimate.gas_mean_sd_k, off_k);
        let off_kg = self.off_by_one_end(estimate.gas_mean_k) * estimate.mass_kg;
        estimate.mass_sd_kg = libm::hypot(estimate.mass_sd_kg, off_kg);
        estimate.p15_pa = self.state.p15.pressure_pa(&self.contents, estimate.mass_kg)?;
        let cold_pressure_pa = self.state.cold.pressure_pa(&self.contents, estimate.mass_kg)?;
        self.warn_of_the_cold(time_s, cold_pressure_pa, &mut events);
        let known = self.known(time_s, estimate.p15_pa);
        let verdict = decide(&known).verdict;
        let was = core::mem::replace(&mut self.state.verdict, verdict);
        if was != verdict {
            events.push(Event::new(time_s, time_s, EventKind::Verdict { from: was, to: verdict }));
        }
        let due = was != verdict
            || time_s >= self.state.outlook_due_s
            || self.state.outlook.is_none_or(|outlook| outlook.known != known.leak_probability.is_some());
        if due {
            self.state.outlook_due_s = time_s + outlook::interval_s(leak.is_some());
            let basis = Basis {
                mass_kg: (estimate.mass_kg, estimate.mass_sd_kg),
                finding: leak.as_ref(),
                largest_kg_s,
                leak_probability: known.leak_probability,
            };
            self.state.outlook = Some(self.limits.outlook(&self.settings, &basis)?);
        }
        let decision = decide(&Known { reaction: self.due_reaction(), ..known });
        let leak_rate_kg_s = self.leak_rate(time_s, leak.as_ref(), held_kg_s, flow.as_ref());
        let (mut health, alarms) =
            (core::mem::take(&mut self.said.health), core::mem::take(&mut self.said.alarms));
        health.clone_from(&self.state.health);
        let output = self.said.output.insert(Output {
            stamp_s: row.stamp_s,
            estimate,
            decision,
            leak,
            leak_rate_kg_s,
            cold_pressure_pa,
            health,
            outlook: self.state.outlook,
            events,
            alarms,
        });
        let inputs = AlarmInputs::of(output, self.full_pa);
        self.state.panel.step(&self.settings.alarms, time_s, &inputs, &mut output.alarms);
        Ok(())
    }

    /// Leak rate, kg/s: what the onsets say, and where they say nothing yet, gas was just exchanged or the flow is certainly
    /// another one, what the flow says, too.
    fn leak_rate(
        &self,
        time_s: f64,
        found: Option<&LeakFinding>,
        held_kg_s: f64,
        flow: Option<&Flow>,
    ) -> Interval {
        let high = self.state.leak.largest_per_s() * self.filled_kg.0;
        let unfound = Interval { value: held_kg_s.clamp(0.0, high), low: 0.0, high };
        let evident = found.map_or(unfound, |leak| leak.rate_kg_s);
        let Some(flow) = flow else { return evident };
        let (value, by) = (flow.rate_kg_s.max(0.0), 1.96 * flow.rate_sd_kg_s);
        let (low, high) = ((value - by).max(0.0), value + by);
        let known = found.is_some() || self.state.leak.probability().is_some();
        let agrees = low <= evident.high && evident.low <= high;
        if known && agrees && !self.state.is_flowing(time_s) {
            return evident;
        }
        Interval { value, low: low.min(evident.low), high: high.max(evident.high) }
    }

    /// What is due by the time left; `None`: nothing is known of a leak, and no limit is reached.
    fn due_reaction(&self) -> Option<Reaction> {
        let outlook = self.state.outlook?;
        let reaction = outlook.advice.reaction;
        (outlook.known || reaction > Reaction::None).then_some(reaction)
    }

    /// When the pressure of a tight cylinder will be below the limit on the coldest night, and was not a day ago: the estimate wanders.
    fn warn_of_the_cold(&mut self, time_s: f64, cold_pressure_pa: f64, events: &mut Vec<Event>) {
        if self.state.examined.is_some() || cold_pressure_pa >= self.settings.limits.operational_pa {
            return;
        }
        if time_s - core::mem::replace(&mut self.state.cold_s, time_s) > DAY_S {
            events.push(Event::new(time_s, time_s, EventKind::ColdNight(cold_pressure_pa)));
        }
    }
}
