//! The model's surfaces: films, radiation and sun on both sides of the wall and on the valve.
use super::Model;
use super::gas::GasPoint;
use super::inputs::{FilmInput, Inputs};
use crate::transfer::outside::{Body, convection_w_m2_k, radiation_w_m2};
use crate::transfer::{FilmSeries, HalfCell, SurfaceBalance, solve_surface};
use crate::vessel::Valve;
use crate::wall::mesh::TOP;

/// Air and film at one height.
struct Exposure {
    air_k: f64,
    /// Film relative to what the scenario says.
    film_factor: f64,
}

impl Model {
    /// Wall cell that the valve sits on.
    pub(super) fn contact_cell(&self) -> usize {
        self.mesh.outer_cell(self.mesh.columns.len() - 1)
    }

    pub(super) fn half_cell(&self, cell: usize, shape_m: f64, node_k: f64) -> HalfCell {
        let material = &self.mesh.materials[self.mesh.material[cell]];
        HalfCell {
            node_k,
            conductance_w_k: shape_m * material.conductivity_at_w_m_k(node_k),
            conductance_slope_w_k2: shape_m * material.conductivity_w_m_k * material.conductivity_slope_per_k,
        }
    }

    pub(super) fn inner_face(
        &self,
        column: usize,
        temperature_k: &[f64],
        points: &[GasPoint],
        jet_w_m2_k: f64,
    ) -> SurfaceBalance {
        let cell = self.mesh.inner_cell(column);
        let half = self.half_cell(cell, self.mesh.columns[column].inner_shape_m, temperature_k[cell]);
        solve_surface(&half, |surface_k| {
            let mut sum = FilmSeries::linear(0.0, 0.0);
            for contact in &self.grid.contacts[column] {
                sum.add(contact.area_m2, &self.contact_series(contact, surface_k, points, jet_w_m2_k));
            }
            sum
        })
    }

    pub(super) fn outer_face(&self, column: usize, temperature_k: &[f64], inputs: &Inputs) -> SurfaceBalance {
        let geometry = &self.mesh.columns[column];
        let cell = self.mesh.outer_cell(column);
        let half = self.half_cell(cell, geometry.outer_shape_m, temperature_k[cell]);
        let sun = self.absorbing_m2[column] * inputs.irradiance_w_m2;
        solve_surface(&half, |surface_k| {
            let place = self.exposure(self.above_middle[column], inputs);
            let (heat, slope) = self.loss(&self.body, 1.0, &place, surface_k, inputs);
            let (heat_w, slope_w_k) = (geometry.outer_area_m2 * heat - sun, geometry.outer_area_m2 * slope);
            match (inputs.film, inputs.radiation_k) {
                (FilmInput::Coefficient(_), None) => FilmSeries::linear(heat_w, slope_w_k),
                _ => FilmSeries::first_order(heat_w, slope_w_k),
            }
        })
    }

    /// What surrounds a place so far above the middle of the height.
    fn exposure(&self, above_middle: f64, inputs: &Inputs) -> Exposure {
        Exposure {
            air_k: inputs.air_k + above_middle * inputs.air_difference_k,
            film_factor: self.surface.film_factor * (1.0 + self.film_slope * above_middle),
        }
    }

    /// Heat flux from a surface to the surroundings without sun, W/m², and its derivative with the surface temperature.
    fn loss(
        &self,
        body: &Body,
        film_factor: f64,
        place: &Exposure,
        surface_k: f64,
        inputs: &Inputs,
    ) -> (f64, f64) {
        let difference = surface_k - place.air_k;
        let (mut heat, mut slope) = match inputs.film {
            FilmInput::Coefficient(film) => {
                let film = place.film_factor * film_factor * film;
                (film * difference, film)
            }
            FilmInput::Convection { wind_m_s, multiplier } => {
                let surface = crate::real::Dual::<1>::variable(surface_k, 0);
                let flux = convection_w_m2_k(body, surface, place.air_k, wind_m_s)
                    * (surface - place.air_k)
                    * (place.film_factor * multiplier);
                (flux.re, flux.eps[0])
            }
        };
        if let Some(enclosure_k) = inputs.radiation_k {
            let surface = crate::real::Dual::<1>::variable(surface_k, 0);
            let flux = radiation_w_m2(self.surface.emissivity, surface, enclosure_k);
            heat += flux.re;
            slope += flux.eps[0];
        }
        (heat, slope)
    }

    /// Heat flow from the valve to the surroundings, W, and its derivative with the valve's temperature.
    pub(super) fn valve_loss(&self, valve: &Valve, valve_k: f64, inputs: &Inputs) -> (f64, f64) {
        let place = self.exposure(TOP, inputs);
        let (heat, slope) = self.loss(&self.valve_body, valve.film_factor, &place, valve_k, inputs);
        let sun = self.valve_absorbing_m2 * inputs.irradiance_w_m2;
        (valve.area_m2 * heat - sun, valve.area_m2 * slope)
    }
}
