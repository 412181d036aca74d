//! What crosses the boundary of the gas: the flows of a scenario as they are open now, and the jets of refills.
use super::inputs::Moment;
use super::node::Node;
use super::supply::Supply;
use crate::ThermalError;
use crate::flow::orifice;
use crate::flow::{Flow, FlowKind, Opening, OpeningFlow};
use crate::fluid::{Fluid, Real, State};
use crate::transfer::inside::stirring_rate_per_s;

/// The flows of a scenario as they are open now.
#[derive(Clone, Copy, Debug)]
pub(super) struct Boundary<'a> {
    /// Flows of the scenario.
    pub flows: &'a [Flow],
    /// Which are open; same length.
    pub open: &'a [bool],
    /// Source of each refill; `None` for flows out; same length.
    pub supplies: &'a [Option<Supply>],
    /// When.
    pub moment: Moment,
    /// Mass drawn from each source vessel, kg.
    pub drawn_kg: &'a [f64],
}

/// Gas and enthalpy that cross the boundary, both positive inwards.
#[derive(Clone, Copy, Debug)]
pub(super) struct Exchange<D> {
    /// Net mass flow in, kg/s.
    pub mass_kg_s: D,
    /// Net enthalpy flow in, W.
    pub enthalpy_w: D,
}

/// How far a flow through an opening is from its changes of regime, Pa.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Margins {
    /// Pressure at which it chokes over the pressure behind it: positive while choked.
    pub choking_pa: f64,
    /// Pressure before it over the pressure behind it: positive while gas flows.
    pub driving_pa: f64,
}

impl Boundary<'_> {
    fn opened(&self) -> impl Iterator<Item = usize> + '_ {
        (0..self.flows.len()).filter(|&index| self.open[index])
    }

    /// Sum over the open flows; gas leaves with the enthalpy of `outlet`.
    ///
    /// # Errors
    /// An orifice without a throat state, or a source without a state.
    pub(super) fn exchange<D: Real>(
        &self,
        fluid: &Fluid,
        outlet: &State<D>,
    ) -> Result<Exchange<D>, ThermalError> {
        let mut sum = Exchange { mass_kg_s: D::from(0.0), enthalpy_w: D::from(0.0) };
        for index in self.opened() {
            let one = self.of_flow(index, fluid, outlet, self.drawn(index))?;
            sum.mass_kg_s += one.mass_kg_s;
            sum.enthalpy_w += one.enthalpy_w;
        }
        Ok(sum)
    }

    /// What a flow has drawn from its source vessel, kg; 0 without one.
    fn drawn<D: Real>(&self, index: usize) -> D {
        match &self.supplies[index] {
            Some(Supply::Vessel(vessel)) => D::from(self.drawn_kg[vessel.place]),
            _ => D::from(0.0),
        }
    }

    /// What one flow carries if it is open, with so much drawn from its source vessel, kg.
    ///
    /// # Errors
    /// As [`Boundary::exchange`].
    pub(super) fn of_flow<D: Real>(
        &self,
        index: usize,
        fluid: &Fluid,
        outlet: &State<D>,
        drawn_kg: D,
    ) -> Result<Exchange<D>, ThermalError> {
        let out = |mass_flow_kg_s: D| (-mass_flow_kg_s, outlet.enthalpy_j_kg);
        let enthalpy = || match &self.supplies[index] {
            Some(supply) => supply.enthalpy_j_kg(fluid, &self.moment, drawn_kg),
            None => Ok(D::from(0.0)),
        };
        let (mass, enthalpy) = match &self.flows[index].kind {
            FlowKind::Leak { mass_flow_kg_s } => out(D::from(*mass_flow_kg_s)),
            FlowKind::LeakSeries { mass_flow_kg_s } => out(D::from(self.moment.value(mass_flow_kg_s))),
            FlowKind::Orifice { diameter_m, discharge_coefficient, back_pressure_pa } => {
                let flux = orifice::mass_flux(fluid, outlet, *back_pressure_pa)?.mass_flux_kg_m2_s;
                let area = 0.25 * std::f64::consts::PI * diameter_m * diameter_m;
                (flux * (-discharge_coefficient * area), outlet.enthalpy_j_kg)
            }
            FlowKind::Release { opening, back_pressure_pa } => {
                out(opening.flow(fluid, outlet, D::from(*back_pressure_pa))?.mass_flow_kg_s)
            }
            FlowKind::Refill { mass_flow_kg_s, .. } => (D::from(*mass_flow_kg_s), enthalpy()?),
            FlowKind::RefillSeries { mass_flow_kg_s, .. } => {
                (D::from(self.moment.value(mass_flow_kg_s)), enthalpy()?)
            }
            FlowKind::Supply { opening, .. } => {
                let (source, flow) = self.supplied(index, opening, fluid, outlet, drawn_kg)?;
                (flow.mass_flow_kg_s, source.enthalpy_j_kg)
            }
        };
        Ok(Exchange { mass_kg_s: mass, enthalpy_w: mass * enthalpy })
    }

    /// State of the source of a refill through an opening, and what passes.
    ///
    /// # Errors
    /// As [`Boundary::exchange`], with the refill's name.
    fn supplied<D: Real>(
        &self,
        index: usize,
        opening: &Opening,
        fluid: &Fluid,
        outlet: &State<D>,
        drawn_kg: D,
    ) -> Result<(State<D>, OpeningFlow<D>), ThermalError> {
        let Some(supply) = &self.supplies[index] else { unreachable!("every refill has a source") };
        let source = supply.state(fluid, &self.moment, drawn_kg);
        let both = source.and_then(|source| Ok((source, opening.flow(fluid, &source, outlet.pressure_pa)?)));
        both.map_err(|cause| ThermalError::Source {
            flow: self.flows[index].name.clone(),
            cause: Box::new(cause),
        })
    }

    /// How far a flow through an opening is from its changes of regime; `None` for other flows.
    ///
    /// # Errors
    /// As [`Boundary::exchange`].
    pub(super) fn margins(
        &self,
        index: usize,
        fluid: &Fluid,
        outlet: &State,
    ) -> Result<Option<Margins>, ThermalError> {
        let margins = |upstream: &State, downstream_pa: f64, choking_pressure_pa: f64| Margins {
            choking_pa: choking_pressure_pa - downstream_pa,
            driving_pa: upstream.pressure_pa - downstream_pa,
        };
        Ok(match &self.flows[index].kind {
            FlowKind::Orifice { back_pressure_pa: back, .. } => {
                let critical_pa = orifice::mass_flux(fluid, outlet, *back)?.critical_pressure_pa;
                Some(margins(outlet, *back, critical_pa))
            }
            FlowKind::Release { opening, back_pressure_pa: back } => {
                Some(margins(outlet, *back, opening.flow(fluid, outlet, *back)?.choking_pressure_pa))
            }
            FlowKind::Supply { opening, .. } => {
                let (source, flow) = self.supplied(index, opening, fluid, outlet, self.drawn(index))?;
                Some(margins(&source, outlet.pressure_pa, flow.choking_pressure_pa))
            }
            _ => None,
        })
    }

    /// Open refills with an inlet, and its bore, m.
    fn jets(&self) -> impl Iterator<Item = (usize, f64)> + '_ {
        self.opened().filter_map(|index| Some((index, self.flows[index].kind.inlet_diameter_m()?)))
    }

    /// Rate of the Reynolds number that stands for the motion of the gas, 1/s. `drawn_kg` is what the flow of an index has drawn from its
    /// source vessel; `None`: what the state says. Momenta of jets add, and so do squares.
    ///
    /// # Errors
    /// As [`Boundary::exchange`].
    pub(super) fn stirring_per_s<D: Real>(
        &self,
        fluid: &Fluid,
        node: &Node<D>,
        vessel_diameter_m: f64,
        reynolds: f64,
        drawn_kg: Option<(usize, D)>,
    ) -> Result<D, ThermalError> {
        let (rho, t) = (node.state.density_kg_m3, node.state.temperature_k);
        let mu = fluid.viscosity_pa_s(rho, t);
        // Odd, so that a trial below zero comes back.
        let mut sum = D::from(-reynolds * reynolds.abs());
        for (index, inlet_m) in self.jets() {
            let drawn = match drawn_kg {
                Some((of, drawn)) if of == index => drawn,
                _ => self.drawn(index),
            };
            let mass_flow = self.of_flow(index, fluid, &node.state, drawn)?.mass_kg_s;
            let inlet = mass_flow / mu * (4.0 / (std::f64::consts::PI * inlet_m));
            sum += inlet * inlet;
        }
        Ok(sum * stirring_rate_per_s(mu, rho, vessel_diameter_m))
    }
}
