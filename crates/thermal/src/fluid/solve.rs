//! States from other pairs than density and temperature.
//!
//! Every solve is Newton's method inside a bracket that shrinks with each evaluation; where Newton leaves
//! the bracket it is halved. The functions are monotone on their brackets (`dp/drho > 0` on a stable branch, `cv > 0`,
//! `cp > 0`), so the root is unique. Solves that carry derivatives converge in plain numbers first; one more
//! Newton step in dual numbers then gives the exact derivatives.
use super::root::bracketed_newton;
use super::saturation::CRITICAL_MARGIN;
use super::{Description, Fluid, Real, State};
use crate::ThermalError;

/// Up to this part of the critical pressure a gas above 0.8 critical temperatures is not near its saturation line.
const DILUTE_REDUCED_PRESSURE: f64 = 0.15;

impl Fluid {
    /// Density, kg/m³, at a pressure, Pa, and temperature, K.
    ///
    /// # Errors
    /// Outside the domain; on the saturation line; too near the critical point to tell the phase.
    pub fn density_from_pressure_temperature(
        &self,
        pressure_pa: f64,
        temperature_k: f64,
    ) -> Result<f64, ThermalError> {
        self.check_temperature(temperature_k)?;
        self.check_pressure(pressure_pa, temperature_k)?;
        self.check_mixture(pressure_pa, temperature_k)?;
        let rt = self.specific_gas_constant_j_kg_k() * temperature_k;
        let ideal = pressure_pa / rt;
        if let Description::IdealGas(_) = self.description {
            return self.dense_enough(ideal, pressure_pa);
        }
        let densest = self.domain().highest_density_kg_m3;
        let (mut low, mut high) = (0.0, densest);
        let critical_k = self.data().critical_temperature_k;
        if temperature_k < critical_k
            && pressure_pa > DILUTE_REDUCED_PRESSURE * self.data().critical_pressure_pa
            || temperature_k < 0.8 * critical_k
        {
            // Near and above saturation the branch must be known.
            match self.saturation_not_above(temperature_k) {
                Some(known) if pressure_pa < known.pressure_pa => high = known.vapour_kg_m3,
                _ => (low, high) = self.branch(pressure_pa, temperature_k, densest)?,
            }
        } else if temperature_k < critical_k {
            // Thin gas below the critical temperature: stay on the vapour branch.
            high = 0.5 * self.data().reducing_density_mol_m3 * self.data().molar_mass_kg_mol;
        }
        let start = if low > 0.0 { low } else { ideal.min(0.5 * densest) };
        let isotherm = self.pressure_along_isotherm(temperature_k);
        let found = bracketed_newton(low, high, start, |rho| {
            let (pressure, slope) = isotherm(rho);
            (pressure - pressure_pa, slope)
        });
        match found {
            Some(rho) if rho < densest * (1.0 - 1e-9) => Ok(rho),
            _ => self.dense_enough(f64::INFINITY, pressure_pa),
        }
    }

    /// Densities between which the phase of a pressure and temperature below the critical one lies.
    fn branch(&self, pressure_pa: f64, temperature_k: f64, densest: f64) -> Result<(f64, f64), ThermalError> {
        let near_critical = || ThermalError::NearCritical {
            fluid: self.name(),
            temperature_k,
            critical_k: self.data().critical_temperature_k,
        };
        let saturation = self.saturation_or_edge(temperature_k)?.ok_or_else(near_critical)?;
        let distance = pressure_pa / saturation.pressure_pa - 1.0;
        if distance <= -1e-9 {
            return Ok((0.0, saturation.vapour_kg_m3));
        }
        if temperature_k > self.edge_k() {
            return Err(near_critical());
        }
        if self.liquefies() {
            return Err(self.condensed(temperature_k, saturation.pressure_pa));
        }
        if distance < 1e-9 {
            return Err(ThermalError::OnSaturation {
                fluid: self.name(),
                pressure_pa,
                temperature_k,
                saturation_pa: saturation.pressure_pa,
            });
        }
        Ok((saturation.liquid_kg_m3, densest))
    }

    /// Pressure, Pa, and its slope in density as functions of the density, the equation prepared for the temperature.
    #[inline]
    pub(super) fn pressure_along_isotherm(&self, temperature_k: f64) -> impl Fn(f64) -> (f64, f64) {
        let rt = self.specific_gas_constant_j_kg_k() * temperature_k;
        let prepared = match &self.description {
            Description::Reference => Some(self.reference.isotherm(temperature_k)),
            _ => None,
        };
        move |rho| {
            let (d, dd) = match &prepared {
                Some(isotherm) => isotherm.slopes(rho),
                None => self.density_slopes(rho, temperature_k),
            };
            (rho * rt * (1.0 + d), rt * (1.0 + 2.0 * d + dd))
        }
    }

    /// The density if the domain holds it.
    fn dense_enough(&self, density_kg_m3: f64, pressure_pa: f64) -> Result<f64, ThermalError> {
        let highest_kg_m3 = self.domain().highest_density_kg_m3;
        if density_kg_m3 <= highest_kg_m3 {
            return Ok(density_kg_m3);
        }
        Err(ThermalError::TooDense { fluid: self.name(), pressure_pa, highest_kg_m3 })
    }

    /// Temperature, K, at a density, kg/m³, and internal energy, J/kg; `guess_k` speeds it up and has no other effect.
    /// The phase is not checked.
    ///
    /// # Errors
    /// The density is outside the domain, or no temperature between nine tenths of the lowest and twice the highest of the domain has this energy.
    pub fn temperature_from_density_energy(
        &self,
        density_kg_m3: f64,
        energy_j_kg: f64,
        guess_k: Option<f64>,
    ) -> Result<f64, ThermalError> {
        let domain = self.domain();
        let (low, high) = (0.9 * domain.lowest_temperature_k, 2.0 * domain.highest_temperature_k);
        let none = ThermalError::NoTemperature { fluid: self.name(), density_kg_m3, energy_j_kg };
        self.check_density(density_kg_m3)?;
        if !energy_j_kg.is_finite() {
            return Err(none);
        }
        let energy = |t: f64| {
            let state = self.state(density_kg_m3, t);
            (state.internal_energy_j_kg - energy_j_kg, state.cv_j_kg_k)
        };
        let start = guess_k.filter(|guess| guess.is_finite()).unwrap_or(300.0);
        let inside = |t: &f64| *t > low * 1.000_001 && *t < high * 0.999_999;
        match bracketed_newton(low, high, start, energy).filter(inside) {
            Some(t)
                if t >= self.data().critical_temperature_k || self.check_phase(density_kg_m3, t).is_ok() =>
            {
                Ok(t)
            }
            Some(t) => Ok(self.warmest_root(t, energy).unwrap_or(t)),
            None => self.warmest_root(low, energy).filter(inside).ok_or(none),
        }
    }

    /// Between the phases the energy along an isochore need not increase, so that none is found or one that has a warmer
    /// one above it that is single-phase: the warmest one, if there is any.
    fn warmest_root(&self, above_k: f64, energy: impl Fn(f64) -> (f64, f64)) -> Option<f64> {
        const STEPS: i32 = 80;
        let top_k = self.data().critical_temperature_k * 1.01;
        if energy(top_k).0 <= 0.0 {
            return bracketed_newton(top_k, 2.0 * self.data().highest_temperature_k, 1.5 * top_k, energy);
        }
        let at = |k: i32| above_k + (top_k - above_k) * f64::from(k) / f64::from(STEPS);
        let below = (0..STEPS).rev().find(|&k| energy(at(k)).0 <= 0.0)?;
        bracketed_newton(at(below), at(below + 1), at(below + 1), energy)
    }

    /// State from density and internal energy, with derivatives.
    ///
    /// # Errors
    /// As [`Fluid::temperature_from_density_energy`].
    pub fn state_from_density_energy<D: Real>(
        &self,
        density_kg_m3: D,
        energy_j_kg: D,
        guess_k: Option<f64>,
    ) -> Result<State<D>, ThermalError> {
        let t = self.temperature_from_density_energy(density_kg_m3.re(), energy_j_kg.re(), guess_k)?;
        let fixed = self.state(density_kg_m3, D::from(t));
        let step = (fixed.internal_energy_j_kg - energy_j_kg) / fixed.cv_j_kg_k.re();
        Ok(self.state(density_kg_m3, -step + t))
    }

    /// State at a pressure, Pa, and specific enthalpy, J/kg.
    ///
    /// # Errors
    /// Outside the domain, or two-phase.
    pub fn state_from_pressure_enthalpy(
        &self,
        pressure_pa: f64,
        enthalpy_j_kg: f64,
    ) -> Result<State, ThermalError> {
        self.state_along_isobar(pressure_pa, enthalpy_j_kg, "enthalpy", |s| (s.enthalpy_j_kg, s.cp_j_kg_k))
    }

    /// State at a pressure, Pa, and specific entropy, J/(kg K).
    ///
    /// # Errors
    /// Outside the domain, or two-phase.
    pub fn state_from_pressure_entropy(
        &self,
        pressure_pa: f64,
        entropy_j_kg_k: f64,
    ) -> Result<State, ThermalError> {
        self.state_along_isobar(pressure_pa, entropy_j_kg_k, "entropy", |s| {
            (s.entropy_j_kg_k, s.cp_j_kg_k / s.temperature_k)
        })
    }

    /// Temperature on an isobar where an increasing property (with its slope in temperature) has a value.
    fn state_along_isobar(
        &self,
        pressure_pa: f64,
        target: f64,
        property: &'static str,
        value: impl Fn(&State) -> (f64, f64),
    ) -> Result<State, ThermalError> {
        self.check_pressure(pressure_pa, self.data().highest_temperature_k)?;
        let none = || ThermalError::NoState { fluid: self.name(), pressure_pa, property, target };
        if !target.is_finite() {
            return Err(none());
        }
        let at = |t: f64| -> Result<State, ThermalError> {
            Ok(self.state(self.density_from_pressure_temperature(pressure_pa, t)?, t))
        };
        let domain = self.domain();
        let critical_k = domain.critical_temperature_k;
        let mut low = domain.lowest_temperature_k * (1.0 + 1e-12);
        let mut high = domain.highest_temperature_k;
        if !matches!(self.description, Description::IdealGas(_)) {
            // Too dense at the critical temperature: the states are above it.
            if at(critical_k).map_or(true, |state| value(&state).0 <= target) {
                low = critical_k;
            } else {
                (low, high) = self.below_critical(pressure_pa, target, low, &value)?;
            }
        }
        // The liquid below its melting line, what is too dense and the mixture below its dew line are not in the domain: raise the lower
        // end until they are not in it. Lower the upper one until the mixture above its bubble line is not.
        let inside = |mut outside: f64, mut inside: f64| {
            for _ in 0..50 {
                let middle = 0.5 * (outside + inside);
                if at(middle).is_ok() { inside = middle } else { outside = middle }
            }
            inside
        };
        match (at(low).is_ok(), at(high).is_ok()) {
            (false, true) => low = inside(low, high),
            (true, false) => high = inside(high, low),
            _ => {}
        }
        let start = if (low..high).contains(&300.0) { 300.0 } else { 0.5 * (low + high) };
        let t = bracketed_newton(low, high, start, |t| {
            at(t).map_or((f64::NAN, f64::NAN), |state| {
                let (value, slope) = value(&state);
                (value - target, slope)
            })
        })
        .ok_or_else(none)?;
        let state = at(t)?;
        // At an end of the bracket the target is not reached.
        let (reached, slope) = value(&state);
        if (reached - target).abs() > 1e-8 * (slope * t).abs() {
            return Err(none());
        }
        Ok(state)
    }

    /// Part of an isobar below the critical temperature on which a property's value lies, given that it is below that at
    /// the critical temperature.
    fn below_critical(
        &self,
        pressure_pa: f64,
        target: f64,
        lowest_k: f64,
        value: &impl Fn(&State) -> (f64, f64),
    ) -> Result<(f64, f64), ThermalError> {
        let critical_k = self.data().critical_temperature_k;
        // The equation of air, a mixture taken as one substance, has its own critical point a little lower.
        let mut highest_k = critical_k * (1.0 - CRITICAL_MARGIN) * (1.0 - 1e-12);
        while self.saturation(highest_k).is_err() && highest_k > 0.95 * critical_k {
            highest_k *= 1.0 - CRITICAL_MARGIN;
        }
        let near_critical = || ThermalError::NearCritical {
            fluid: self.name(),
            temperature_k: 0.5 * (highest_k + critical_k),
            critical_k,
        };
        let pressure_at =
            |t: f64| Ok::<f64, ThermalError>(self.saturation(t)?.map_or(0.0, |s| s.pressure_pa));
        let (mut low, mut high) = (lowest_k, highest_k);
        if pressure_at(high)? < pressure_pa {
            if self.liquefies() {
                return Err(self.condensed(highest_k, pressure_at(highest_k)?));
            }
            // Up to where the phase is told apart; thin gas is never in doubt.
            return match self.density_from_pressure_temperature(pressure_pa, highest_k) {
                _ if pressure_pa <= DILUTE_REDUCED_PRESSURE * self.data().critical_pressure_pa => {
                    Ok((lowest_k, critical_k))
                }
                Ok(density) if value(&self.state(density, highest_k)).0 < target => Err(near_critical()),
                _ => Ok((lowest_k, highest_k)),
            };
        }
        if pressure_at(low)? > pressure_pa {
            return Ok((lowest_k, critical_k));
        }
        for _ in 0..45 {
            let middle = 0.5 * (low + high);
            if pressure_at(middle)? < pressure_pa { low = middle } else { high = middle }
        }
        let saturation_k = 0.5 * (low + high);
        let Some(saturation) = self.saturation(saturation_k)? else { return Err(near_critical()) };
        let vapour = value(&self.state(saturation.vapour_kg_m3, saturation_k)).0;
        let liquid = value(&self.state(saturation.liquid_kg_m3, saturation_k)).0;
        if target >= vapour {
            return Ok((saturation_k * (1.0 + 1e-9), critical_k));
        }
        if self.liquefies() {
            return Err(self.condensed(saturation_k, pressure_pa));
        }
        if target <= liquid {
            return Ok((lowest_k, saturation_k * (1.0 - 1e-9)));
        }
        Err(ThermalError::TwoPhaseIsobar { fluid: self.name(), pressure_pa, saturation_k })
    }
}
