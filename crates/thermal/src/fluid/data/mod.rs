//! Coefficients of the fluids, one file each. A further fluid or mixture is a further file and a line in [`ALL`].
mod air;
mod argon;
mod carbon_dioxide;
mod helium;
mod hydrogen;
mod inert;
mod mixture;
mod nitrogen;
mod oxygen;
pub(super) mod terms;

pub(super) use mixture::Mixture;
use terms::FluidData;

/// A fluid with an equation of its own, or a mixture of such.
pub(super) enum Entry {
    Pure(&'static FluidData),
    Mixture(&'static Mixture),
}

/// All fluids.
pub(super) static ALL: &[Entry] = &[
    Entry::Pure(&nitrogen::NITROGEN),
    Entry::Pure(&argon::ARGON),
    Entry::Pure(&air::AIR),
    Entry::Pure(&hydrogen::HYDROGEN),
    Entry::Pure(&helium::HELIUM),
    Entry::Pure(&oxygen::OXYGEN),
    Entry::Pure(&carbon_dioxide::CARBON_DIOXIDE),
    Entry::Mixture(&inert::ARGON_NITROGEN),
    Entry::Mixture(&inert::IG_541),
];

impl Entry {
    /// Name as files spell it.
    pub(super) fn name(&self) -> &'static str {
        match self {
            Self::Pure(data) => data.name,
            Self::Mixture(mixture) => mixture.name,
        }
    }

    /// Other names that people type.
    pub(super) fn also(&self) -> &'static [&'static str] {
        match self {
            Self::Pure(data) => data.also,
            Self::Mixture(mixture) => mixture.also,
        }
    }

    /// Its data; those of a mixture are made here.
    pub(super) fn data(&self) -> FluidData {
        match self {
            Self::Pure(data) => (*data).clone(),
            Self::Mixture(mixture) => mixture.data(),
        }
    }
}
