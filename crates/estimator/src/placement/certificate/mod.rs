//! What no layout can fall below.
//!
//! The relaxed value `V(z)` is convex on the polytope `Z` of weights that meet the constraints, which holds every layout that is
//! allowed. Three bounds:
//!
//! * *Frank-Wolfe*: the least of a tangent over `Z`, `V(z) + min_s grad V(z)^T (s - z)`, at any `z`; the best of those on the way.
//! * *Cuts*: the least over `Z` of the largest of all tangents so far, a linear program. Never below the first.
//! * *Window*: the filter begins with the covariance that all candidates together would have left, and sees `m` samples of the layout. No
//!   filter of it is better in the steady state, and what is left is a c-optimal design, a second-order cone program ([`window`]).
mod cuts;
mod program;
pub mod window;

use serde::{Deserialize, Serialize};

use self::cuts::Cuts;
use super::constraints::Constraints;
use super::objective::Objective;
use crate::EstimatorError;

/// Bounds of the best layout.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Certificate {
    /// By tangents one at a time.
    pub frank_wolfe: f64,
    /// By all tangents together.
    pub cuts: f64,
    /// Least relaxed value that was found: the bounds cannot rise above it.
    pub relaxed: f64,
    /// Weights there.
    pub weights: Vec<f64>,
    /// Tangents taken.
    pub tangents: usize,
}

impl Certificate {
    /// The larger bound.
    pub fn bound(&self) -> f64 {
        self.cuts.max(self.frank_wolfe)
    }
}

/// When a certificate is good enough.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct CertificateSettings {
    /// Distance of the relaxed value from its bound, relative.
    pub tolerance: f64,
    /// Most tangents.
    pub tangents: usize,
}

impl Default for CertificateSettings {
    fn default() -> Self {
        Self { tolerance: 1e-3, tangents: 200 }
    }
}

/// Halvings of a step until the value falls.
const HALVINGS: usize = 30;

/// Bounds for the layouts that are allowed.
///
/// # Errors
/// The constraints contradict each other, or not even all candidates together see what they should.
pub fn certify(
    objective: &impl Objective,
    constraints: &Constraints,
    settings: &CertificateSettings,
) -> Result<Certificate, EstimatorError> {
    constraints.validate(objective.candidates())?;
    let mut cuts = Cuts::new(constraints, objective.candidates());
    let mut at = cuts.inside()?;
    let mut certificate = Certificate {
        frank_wolfe: f64::NEG_INFINITY,
        cuts: f64::NEG_INFINITY,
        relaxed: f64::INFINITY,
        weights: at.clone(),
        tangents: 0,
    };
    while certificate.tangents < settings.tangents {
        let here = objective.relaxed(&at).ok_or(EstimatorError::NoSteadyState)?;
        certificate.tangents += 1;
        if here.value < certificate.relaxed {
            (certificate.relaxed, certificate.weights) = (here.value, at.clone());
        }
        let vertex = cuts.least_of(&here.gradient)?;
        certificate.frank_wolfe = certificate.frank_wolfe.max(here.tangent(&at, &vertex));
        cuts.add(&here, &at);
        let (bound, lowest) = cuts.least()?;
        certificate.cuts = certificate.cuts.max(bound);
        if certificate.relaxed - certificate.bound() <= settings.tolerance * certificate.relaxed.abs() {
            break;
        }
        // The cuts' own minimum jumps from side to side as long as they are few: go only as far as the value falls.
        let towards = |share: f64| -> Vec<f64> {
            certificate.weights.iter().zip(&lowest).map(|(from, to)| from + share * (to - from)).collect()
        };
        let mut share = 1.0;
        for _ in 0..HALVINGS {
            at = towards(share);
            if let Some(there) = objective.relaxed(&at) {
                certificate.tangents += 1;
                if there.value < certificate.relaxed {
                    break;
                }
                cuts.add(&there, &at);
            }
            share *= 0.5;
            if certificate.tangents >= settings.tangents {
                break;
            }
        }
    }
    Ok(certificate)
}
