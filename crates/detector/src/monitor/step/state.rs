//! All that a row changes, but for the observers: what is saved.
use alloc::boxed::Box;
use alloc::vec::Vec;
use serde::Serialize;

use super::disturbance::Undisturbed;
use super::exchange::{Examined, Exchanged};
use super::{EXCHANGED_S, SETTLED_S};
use crate::DetectorError;
use crate::estimator::observer::{Commissioning, Observer};
use crate::estimator::sensor::Sensor;
use crate::estimator::thermal::vessel::Vessel;
use crate::evidence::Evidence;
use crate::monitor::alarm::AlarmPanel;
use crate::monitor::gas::bounds::GasBounds;
use crate::monitor::gas::contents::Tangent;
use crate::monitor::gas::filling::FillingCheck;
use crate::monitor::gas::gain::GainWatch;
use crate::monitor::gas::jump::JumpWatch;
use crate::monitor::gas::leak::{LeakState, LostUnheard};
use crate::monitor::intake::{Intake, Taken};
use crate::monitor::readings::health::SensorWatch;
use crate::monitor::readings::lateness::DelayLine;
use crate::monitor::readings::parity::Parity;
use crate::monitor::readings::thermometers::Pair;
use crate::monitor::readings::wiring::WiringCheck;
use crate::monitor::restored::Restored;
use crate::monitor::{Health, MonitorSettings, Outlook, Reason, Verdict};
use crate::sealed::{Payload, SealError};
use crate::units::QUOTED_K;

/// All that a row changes, but for the observers.
#[derive(Debug, Serialize)]
pub(super) struct State {
    pub(super) intake: Intake,
    pub(super) watches: Vec<SensorWatch>,
    pub(super) health: Vec<Health>,
    pub(super) pair: Pair,
    pub(super) parity: Parity,
    pub(super) undisturbed: Undisturbed,
    pub(super) wiring: WiringCheck,
    pub(super) delays: DelayLine,
    /// Whether the two thermometers are in each other's place.
    pub(super) swapped: bool,
    /// What was known when the observer began.
    pub(super) begun_with: Commissioning,
    pub(super) filling: FillingCheck,
    pub(super) jumps: JumpWatch,
    pub(super) bounds: GasBounds,
    pub(super) gains: GainWatch,
    pub(super) examined: Option<Examined>,
    pub(super) leak: LeakState,
    pub(super) evidence: Evidence,
    /// Until the next look.
    pub(super) lost_across: Option<LostUnheard>,
    /// Rows that wait to be told of, and events that wait for a row.
    pub(super) ready: Taken,
    pub(super) panel: AlarmPanel,
    pub(super) verdict: Verdict,
    pub(super) start_s: Option<f64>,
    pub(super) last_s: f64,
    /// Until then nothing can be told, and why.
    pub(super) look: (f64, Reason),
    pub(super) exchanged: Option<Exchanged>,
    /// When gas flowed for certain last, s.
    pub(super) flowed_s: f64,
    /// When exchanges of gas were announced: from, until, s, as rows are stamped.
    pub(super) announced: Vec<(f64, f64)>,
    pub(super) outlook: Option<Outlook>,
    pub(super) outlook_due_s: f64,
    pub(super) p15: Tangent,
    pub(super) cold: Tangent,
    /// When the pressure of the coldest night was below the limit last, s.
    pub(super) cold_s: f64,
}

impl State {
    /// Before the first row. In a box of its own making: on a controller's stack there is room for one.
    #[inline(never)]
    pub(super) fn new(
        sensors: &[Sensor],
        commissioning: &Commissioning,
        settings: &MonitorSettings,
        pair: Pair,
    ) -> Result<Box<Self>, DetectorError> {
        let watches: Vec<SensorWatch> = sensors.iter().map(SensorWatch::new).collect();
        let parity = Parity::new(pair.error_k());
        Ok(Box::new(Self {
            intake: Intake::new(settings.intake, sensors.len())?,
            health: watches.iter().map(SensorWatch::health).collect(),
            watches,
            pair,
            parity,
            undisturbed: Undisturbed::default(),
            wiring: WiringCheck::of_all(),
            delays: DelayLine::default(),
            swapped: false,
            begun_with: *commissioning,
            filling: FillingCheck::default(),
            jumps: JumpWatch::default(),
            bounds: GasBounds::default(),
            gains: GainWatch::default(),
            examined: None,
            leak: LeakState::default(),
            evidence: Evidence::new(&settings.observer),
            lost_across: None,
            ready: Taken::default(),
            panel: AlarmPanel::default(),
            verdict: Verdict::Unknown(Reason::Learning),
            start_s: None,
            last_s: f64::NEG_INFINITY,
            look: (f64::NEG_INFINITY, Reason::Gap),
            exchanged: None,
            flowed_s: f64::NEG_INFINITY,
            announced: Vec::new(),
            outlook: None,
            outlook_due_s: f64::NEG_INFINITY,
            p15: Tangent::at(QUOTED_K),
            cold: Tangent::at(settings.limits.coldest_k),
            cold_s: f64::NEG_INFINITY,
        }))
    }

    /// Read what was saved, each part into its place: all at once takes thrice as much stack.
    #[inline(never)]
    pub(super) fn read(&mut self, from: &mut Payload<'_>) -> Result<(), SealError> {
        macro_rules! read {
            ($($part:ident)*) => {
                let Self { $($part),* } = self;
                $(from.read($part)?;)*
            };
        }
        // As they are written: in the order of their declaration.
        read! {
            intake watches health pair parity undisturbed wiring delays
            swapped begun_with filling jumps bounds gains examined leak
            evidence lost_across ready panel verdict start_s last_s look
            exchanged flowed_s announced outlook outlook_due_s p15 cold cold_s
        }
        Ok(())
    }

    /// Checks what a monitor is to go on from that has just been made with this observer.
    #[inline(never)]
    pub(super) fn validate(
        &self,
        (vessel, sensors, settings): (&Vessel, &[Sensor], &MonitorSettings),
        observer: &mut Observer,
        of: &Restored,
    ) -> Result<(), DetectorError> {
        self.intake.validate(&settings.intake, of)?;
        of.each("watches", self.watches.len())?;
        of.each("health", self.health.len())?;
        for (watch, sensor) in self.watches.iter().zip(sensors) {
            watch.validate(sensor)?;
        }
        self.pair.validate()?;
        self.parity.validate()?;
        self.undisturbed.validate(observer)?;
        self.wiring.validate()?;
        self.delays.validate(of)?;
        self.begun_with.mass_kg(vessel, QUOTED_K)?;
        self.filling.validate()?;
        self.bounds.validate()?;
        self.gains.validate()?;
        self.examined.as_ref().map_or(Ok(()), Examined::validate)?;
        self.leak.validate()?;
        self.ready.rows.iter().try_for_each(|row| row.validate("ready", of))?;
        self.ready.events.iter().try_for_each(|event| event.validate(of))?;
        of.any_time("last_s", Some(self.last_s).filter(|last_s| *last_s != f64::NEG_INFINITY))
    }

    /// Memory for all that comes, so that no row needs any.
    pub(super) fn make_room(&mut self, observer: &Observer) {
        self.intake.make_room();
        self.ready.make_room();
        self.parity.make_room();
        self.undisturbed.make_room(observer);
    }

    /// Whether gas flows, or did a while ago.
    pub(super) fn is_flowing(&self, time_s: f64) -> bool {
        time_s - self.flowed_s < EXCHANGED_S
    }

    /// Whether gas may be being exchanged, or has been and has not settled.
    pub(super) fn is_exchanging(&self, time_s: f64) -> bool {
        self.examined.is_some() || self.exchanged.is_some_and(|of| time_s - of.at_s < SETTLED_S)
    }
}
