//! Options of `commission` that fit each other.
use super::*;
use crate::thermal::units::Dimension;
use crate::thermal::units::QUOTED_K;
use crate::thermal::vessel::Vessel;

/// Usual fill, Pa.
const FILL_PA: f64 = 200.0 * BAR_PA;
/// Stretches of a rehearsal, of the usual ones: none is longer than an hour.
const REHEARSAL_PART: f64 = 1e-3;

/// Options that passed all checks that need no vessel.
pub(super) struct Options {
    pub vessel: String,
    pub data: Target,
    pub campaign: Campaign,
    pub fit: FitSettings,
    fill_pa: f64,
    full_scale_pa: Option<f64>,
}

impl Options {
    /// Checks places and numbers.
    pub(super) fn checked(arguments: CommissionArguments) -> anyhow::Result<Self> {
        let CommissionArguments { vessel, output, pressures, climates, gases, sensors, rows, .. } = arguments;
        let data = Target::checked(Some(&output), &[Path::new(&vessel)])?;
        let CommissionArguments { cylinders, days, seed, .. } = arguments;
        let mean_time_s = arguments.false_alarms.mean_time_s();
        let stretch = if arguments.rehearsal { REHEARSAL_PART } else { 1.0 };
        let length_s = days * DAY_S;
        let campaign = Campaign { climates, gases, sensors, rows, cylinders, length_s, seed };
        check(&campaign, stretch)?;
        let pressure = |option: &str| pressures.si(option, Dimension::Pressure);
        Ok(Self {
            fill_pa: pressure("fill-pressure")?.unwrap_or(FILL_PA),
            full_scale_pa: pressure("full-scale")?,
            fit: FitSettings { mean_time_s, stretch, seed },
            vessel,
            data,
            campaign,
        })
    }

    /// The vessel that cylinders are drawn around.
    pub(super) fn nominal(&self, vessel: Vessel) -> anyhow::Result<NominalVessel> {
        let bar = |pressure_pa: f64| pressure_pa / BAR_PA;
        let state = vessel.fluid.density_from_pressure_temperature(self.fill_pa, QUOTED_K);
        state.with_context(|| {
            format!("--fill-pressure-bar {}: the gas has no such state", bar(self.fill_pa))
        })?;
        let nominal = NominalVessel::own(vessel, self.fill_pa);
        let full_scale_pa = self.full_scale_pa.unwrap_or(nominal.full_scale_pa);
        if full_scale_pa <= self.fill_pa {
            let [full_scale, fill] = [full_scale_pa, self.fill_pa].map(bar);
            bail!("--full-scale-bar {full_scale}: it must be above the fill of {fill} bar");
        }
        Ok(NominalVessel { full_scale_pa, ..nominal })
    }
}

/// Refuses too short logs, too few cylinders, and what cannot be simulated.
fn check(campaign: &Campaign, stretch: f64) -> anyhow::Result<()> {
    let (days, cylinders) = (campaign.length_s / DAY_S, campaign.cylinders);
    let Some(needed) = campaign.needed(stretch) else {
        let shortest = Campaign::shortest_s(stretch) / DAY_S;
        bail!("--days {days}: the slowest statistic needs logs of {shortest:.2} d and longer");
    };
    if cylinders < needed {
        bail!(
            "--cylinders {cylinders}: {needed} are needed with logs of {days} d, so that the slowest statistic can be fitted to either half"
        );
    }
    if let Some(request) = campaign.requests().first() {
        request.validate().context("--days or --row-interval")?;
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use clap::Parser;

    #[derive(Parser)]
    struct Program {
        #[command(flatten)]
        arguments: CommissionArguments,
    }

    #[test]
    fn the_seed_is_that_of_the_cylinders_and_of_the_fit() {
        let of = |seed: &str| {
            let words = ["commission", "nitrogen-20l", "-o", "-", "--seed", seed];
            let options = Options::checked(Program::parse_from(words).arguments).unwrap();
            assert_eq!(options.fit.seed.to_string(), seed);
            options.campaign.requests()[0].seed
        };
        assert_ne!(of("1"), of("2"));
    }
}
