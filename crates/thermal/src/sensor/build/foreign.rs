//! Keys that do not belong to a kind of sensor.
use super::Table;
use crate::ThermalError;
use crate::document::check;
use crate::sensor::spec::KindChoice;

/// Which kinds of sensor a key belongs to.
#[derive(Clone, Copy)]
enum Group {
    Temperature,
    Surface,
    Pressure,
    GasCell,
    Height,
}

impl Group {
    fn belongs_to(self, choice: KindChoice) -> bool {
        match choice {
            KindChoice::Surface => matches!(self, Self::Temperature | Self::Surface | Self::Height),
            KindChoice::Pressure => matches!(self, Self::Pressure),
            KindChoice::Gas => matches!(self, Self::Temperature | Self::GasCell | Self::Height),
            KindChoice::Ambient => matches!(self, Self::Temperature),
        }
    }

    fn remedy(self) -> &'static str {
        match self {
            Self::Temperature => {
                "a pressure takes bar or another unit of pressure, and no class or range of temperature"
            }
            Self::Surface => "it belongs to surface sensors",
            Self::Pressure => "it belongs to pressure transmitters; a temperature takes _k",
            Self::GasCell => "it belongs to sensors in the gas",
            Self::Height => "it belongs to sensors on the surface and in the gas",
        }
    }
}

fn name_of(choice: KindChoice) -> &'static str {
    match choice {
        KindChoice::Surface => "kind = surface",
        KindChoice::Pressure => "kind = pressure",
        KindChoice::Gas => "kind = gas",
        KindChoice::Ambient => "kind = ambient",
    }
}

impl Table<'_> {
    /// Keys of other kinds mean nothing here; a silent one would look as if it did.
    pub(super) fn refuse_foreign(&self, choice: KindChoice) -> Result<(), ThermalError> {
        for (field, group) in self.stated_fields() {
            if !group.belongs_to(choice) {
                return Err(check::conflict(&self.at(field), name_of(choice), group.remedy()));
            }
        }
        Ok(())
    }

    /// The stated keys that do not belong to every kind.
    fn stated_fields(&self) -> impl Iterator<Item = (&'static str, Group)> {
        use Group::{GasCell, Height, Pressure, Surface, Temperature};
        let s = self.spec;
        [
            ("place", s.place.is_some(), Surface),
            ("height_m", s.height_m.is_some(), Height),
            ("cell", s.cell.is_some(), GasCell),
            ("air_coupling", s.air_coupling.is_some(), Surface),
            ("air_coupling_sd", s.air_coupling_sd.is_some(), Surface),
            ("offset_k", s.offset_k.is_some(), Temperature),
            ("offset_sd_k", s.offset_sd_k.is_some(), Temperature),
            ("offset_tolerance_k", s.offset_tolerance_k.is_some(), Temperature),
            ("class", s.class.is_some(), Temperature),
            ("noise_k", s.noise_k.is_some(), Temperature),
            ("correlated_noise_k", s.correlated_noise_k.is_some(), Temperature),
            ("resolution_k", s.resolution_k.is_some(), Temperature),
            ("drift_k_s", s.drift_k_s.is_some(), Temperature),
            ("walk_sd_k", s.walk_sd_k.is_some(), Temperature),
            ("lowest_k", s.lowest_k.is_some(), Temperature),
            ("highest_k", s.highest_k.is_some(), Temperature),
            ("offset_pa", s.offset_pa.is_some(), Pressure),
            ("offset_sd_pa", s.offset_sd_pa.is_some(), Pressure),
            ("offset_tolerance_pa", s.offset_tolerance_pa.is_some(), Pressure),
            ("span_ratio", s.span_ratio.is_some(), Pressure),
            ("span_sd_ratio", s.span_sd_ratio.is_some(), Pressure),
            ("temperature_coefficient_pa_k", s.temperature_coefficient_pa_k.is_some(), Pressure),
            ("temperature_coefficient_sd_pa_k", s.temperature_coefficient_sd_pa_k.is_some(), Pressure),
            ("noise_pa", s.noise_pa.is_some(), Pressure),
            ("correlated_noise_pa", s.correlated_noise_pa.is_some(), Pressure),
            ("resolution_pa", s.resolution_pa.is_some(), Pressure),
            ("drift_pa_s", s.drift_pa_s.is_some(), Pressure),
            ("walk_sd_pa", s.walk_sd_pa.is_some(), Pressure),
            ("full_scale_pa", s.full_scale_pa.is_some(), Pressure),
            ("gauge", s.gauge.is_some(), Pressure),
            ("altitude_m", s.altitude_m.is_some(), Pressure),
        ]
        .into_iter()
        .filter_map(|(field, stated, group)| stated.then_some((field, group)))
    }
}
