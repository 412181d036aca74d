//! Inert gases of extinguishing systems that are mixtures: IG-55 and IG-541 of ISO 14520. IG-100 is nitrogen, IG-01 argon.
use crate::fluid::data::mixture::Mixture;
use crate::fluid::data::{argon::ARGON, carbon_dioxide::CARBON_DIOXIDE, nitrogen::NITROGEN};

/// IG-55, half argon and half nitrogen. Above the critical temperature of argon, 150.687 K, neither it nor any mixture of
/// the two condenses; its own dew points end at 138.5 K and 4.2 MPa (CoolProp 8.0.0 with these parameters).
pub(super) static ARGON_NITROGEN: Mixture = Mixture {
    name: "argon-nitrogen",
    also: &["ig-55", "ig55", "argonite", "nitrogen-argon"],
    reference: "Kunz, Wagner, J. Chem. Eng. Data 57 (2012) 3032, with the reference equations of nitrogen and argon",
    components: &[(&NITROGEN, 0.5), (&ARGON, 0.5)],
    lowest_temperature_k: 150.687,
};

/// IG-541: 52 % nitrogen, 40 % argon, 8 % carbon dioxide. Dry ice is the first to come out of it, at 205 K and 6 to 8 MPa, where the
/// fugacity of carbon dioxide (CoolProp 8.0.0 with these parameters) reaches that of the solid (sublimation line of Span and Wagner
/// 1996, 28.5 cm³/mol). At the triple temperature of carbon dioxide, 216.592 K, it is at most 0.55 of that of the solid and 0.53 of that of the liquid.
pub(super) static IG_541: Mixture = Mixture {
    name: "ig-541",
    also: &["ig541", "inergen"],
    reference: "Kunz, Wagner, J. Chem. Eng. Data 57 (2012) 3032, with the reference equations of nitrogen, argon and carbon dioxide",
    components: &[(&NITROGEN, 0.52), (&ARGON, 0.40), (&CARBON_DIOXIDE, 0.08)],
    lowest_temperature_k: 216.592,
};
