//! What to know before a model is used, in words.
use super::Study;
use super::summary::probability;
use crate::estimator::identify::Caution;

/// Cautions of an identification as sentences.
pub(crate) fn cautions(study: &Study) -> Vec<String> {
    study.identified.cautions.iter().map(|caution| sentence(study, caution)).collect()
}

fn sentence(study: &Study, caution: &Caution) -> String {
    let (input, output) = (&study.input.name, &study.output.name);
    match *caution {
        Caution::ColouredErrors { whiteness } => format!(
            "the errors are not white (white ones would be as correlated with a probability {}): the \
             intervals are those of correlated errors",
            probability(whiteness)
        ),
        Caution::DynamicsLeft { lag, correlation, bound } => format!(
            "the errors follow {input} {lag} samples later (correlation {correlation:+.2}, bound {bound:.2}): the \
             structure does not hold all of the dynamics; try a higher order or a dead time"
        ),
        Caution::Feedback { lead, correlation, bound } => format!(
            "the errors foretell {input} {lead} samples ahead (correlation {correlation:+.2}, bound {bound:.2}): \
             {output} acts back on {input}, or the times do not fit, or the structure is too simple"
        ),
        Caution::SamplesLeftOut { rows: 1 } => {
            format!("1 row has no {output}, or lies outside of what is known of {input}: left out")
        }
        Caution::SamplesLeftOut { rows } => {
            format!("{rows} rows have no {output}, or lie outside of what is known of {input}: left out")
        }
    }
}
