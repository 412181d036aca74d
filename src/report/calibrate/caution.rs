//! What to know before a calibrated vessel is used, in words.
use super::Study;
use crate::estimator::calibrate::{ApparentLeak, ChannelResiduals, Combination, ParameterKind};
use crate::report::{GRAM_PER_HOUR, number};

/// Ratio of residuals and noise from which on the model is said to miss something.
const MISSES: f64 = 2.0;
/// Probability from which on residuals count as white.
const WHITE: f64 = 0.05;
/// Movement by a finer wall, in standard deviations, with which an estimate leaves its interval of 95 %.
const COARSE_SD: f64 = 1.96;
/// The same as a part of what such parameters are usually off: smaller deviations do not matter.
const COARSE_PART: f64 = 0.1;
/// Share of the prior's variance from which on the logs say nothing of a parameter.
const UNLEARNT: f64 = 0.9;

/// Cautions of a calibration as sentences.
pub(crate) fn cautions(study: &Study) -> Vec<String> {
    let found = &study.calibrated.identifiability;
    let mut cautions: Vec<String> = found.inseparable.iter().map(inseparable).collect();
    cautions.extend(misfits(study));
    cautions.extend(study.apparent_leaks.iter().map(leak));
    cautions.extend(coarse(study));
    let of_vessel = |kind: &ParameterKind| kind.sensor().is_none() && !kind.is_of_experiment();
    for line in
        study.lines().iter().filter(|line| of_vessel(&line.spec.kind) && 1.0 - line.learnt() > UNLEARNT)
    {
        cautions.push(format!("the logs say little of {}: its value is that of the prior", study.name(line)));
    }
    for score in study.scores.iter().filter(|score| score.rms_after > score.rms_before) {
        cautions.push(format!(
            "{} of {} is predicted worse than before: the fit does not hold for the held-out data",
            score.channel, score.experiment
        ));
    }
    cautions
}

fn inseparable(combination: &Combination) -> String {
    let names: Vec<String> = combination.names.iter().map(ParameterKind::name).collect();
    match &names[..] {
        [one] => format!(
            "the logs hardly show {one}: give it a prior, hold it, or record what it acts on (a larger or faster change of \
             the air, a pressure, a sensor nearer to it)"
        ),
        _ => format!(
            "the logs do not separate {}: together they are known to {:.1} times what such parameters are usually off; \
             {}, or record an experiment that tells them apart",
            names.join(" and "),
            combination.deviation,
            remedy(&names)
        ),
    }
}

/// Options that part parameters which the logs do not: what a drawing or a data sheet knows gets a prior, what is fitted beside the
/// vessel is held, and of two that nobody knows one is not fitted.
pub(crate) fn remedy(names: &[impl AsRef<str>]) -> String {
    let find = |known: &dyn Fn(&str) -> bool| names.iter().map(AsRef::as_ref).find(|name| known(name));
    if let Some((name, prior)) =
        PRIORS.iter().find(|(name, _)| names.iter().any(|other| other.as_ref() == *name))
    {
        return format!("where the drawing is right, add --prior {name}={prior}");
    }
    match (find(&is_beside), names.last()) {
        (Some(name), _) => format!("add --hold {name} if that is known"),
        (None, Some(name)) => format!("leave {} out of --fit", name.as_ref()),
        (None, None) => String::new(),
    }
}

/// How well drawings and data sheets know factors: mean and standard deviation.
const PRIORS: [(&str, &str); 3] =
    [("wall-capacity", "1,0.05"), ("volume", "1,0.02"), ("valve-capacity", "1,0.2")];

/// Whether a parameter is fitted without being asked for: of a sensor, or of the beginning of a log.
fn is_beside(name: &str) -> bool {
    name.contains(':') && !name.starts_with("discharge")
        || ["fill-mass", "initial-temperature", "air-offset"].contains(&name)
}

fn leak(found: &ApparentLeak) -> String {
    format!(
        "what is left of {} looks like a leak of about {} g/h: does it leak? `monitor` tells; the parameters are wrong by what they took up of it",
        found.experiment,
        number(GRAM_PER_HOUR * found.rate_kg_s, 2)
    )
}

/// What a coarse wall does to the estimates.
fn coarse(study: &Study) -> Option<String> {
    let lines = study.lines();
    let shift = |line: &super::Line<'_>| study.mesh_shift_sd.get(line.place).copied().unwrap_or(0.0);
    let is_felt = |line: &&super::Line<'_>| {
        let (kind, found) = (&line.spec.kind, line.estimate);
        let usual = kind.usual_width(study.calibrated.is_of_pressure(found));
        // A contact contains half of the cell that it is on: it belongs to its mesh by nature.
        *kind != ParameterKind::ValveContact
            && shift(line).abs() * found.coordinate_sd() > COARSE_PART * usual
    };
    let moved: Vec<String> = lines
        .iter()
        .filter(|line| shift(line).abs() > COARSE_SD && is_felt(line))
        .map(|line| format!("{} by {:+.1}", study.name(line), shift(line)))
        .collect();
    (!moved.is_empty()).then(|| {
        format!(
            "the wall has few cells: with twice as many along it and through it these would leave their intervals, in standard \
             deviations: {}; give the vessel more cells",
            moved.join(", ")
        )
    })
}

fn misfits(study: &Study) -> impl Iterator<Item = String> + '_ {
    let missed = |channel: &&ChannelResiduals| channel.rms_over_noise > MISSES;
    study.calibrated.channels.iter().filter(missed).map(|channel| {
        let ChannelResiduals { experiment, channel: name, rms_over_noise, .. } = channel;
        let widened = channel.variance_factor.sqrt();
        if channel.whiteness_p_value.is_some_and(|p_value| p_value > WHITE) {
            let (noise, unit) = study.shown_noise(channel);
            return format!(
                "{name} of {experiment} scatters {rms_over_noise:.1} times as much as its stated noise, and without any pattern: \
                 the model fits, and its noise is rather {} {unit}: state it with --sensors",
                number(noise, 2)
            );
        }
        format!(
            "{name} of {experiment} misses the model by {rms_over_noise:.1} times its noise: something is not in the model; the \
             intervals are widened by up to {widened:.1}"
        )
    })
}

impl Study {
    /// Noise that the residuals have, in the unit that a sensor's file states it in.
    fn shown_noise(&self, channel: &ChannelResiduals) -> (f64, &'static str) {
        if self.is_pressure(&channel.experiment, &channel.channel) {
            (1e-2 * channel.rms, "mbar")
        } else {
            (channel.rms, "K")
        }
    }
}
