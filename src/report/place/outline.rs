//! The outline of a vessel to scale: wall, gas and valve, in mm.
use super::MILLIMETRES;
use crate::report::figure::{Shape, style};
use crate::thermal::vessel::Vessel;
use crate::thermal::wall::geometry::{EndShape, Geometry};

/// Corners along a contour.
const CORNERS: usize = 160;
/// Length of the drawn valve, in its diameters, at least and at most.
const VALVE: (f64, f64) = (0.8, 3.0);

/// A vessel with what sits above its wall.
pub(super) struct Outline<'a> {
    vessel: &'a Vessel,
    /// Height of the wall, mm.
    wall_mm: f64,
    /// Radius and length of the valve, mm.
    valve: Option<(f64, f64)>,
}

impl<'a> Outline<'a> {
    pub(super) fn of(vessel: &'a Vessel) -> Self {
        let valve = vessel.valve.as_ref().map(|valve| {
            let diameter_m = valve.diameter_m;
            // A cylinder with two flat ends of the same area.
            let length_m = valve.area_m2 / (std::f64::consts::PI * diameter_m) - 0.5 * diameter_m;
            let length_m = length_m.clamp(VALVE.0 * diameter_m, VALVE.1 * diameter_m);
            (0.5 * MILLIMETRES * diameter_m, MILLIMETRES * length_m)
        });
        Self { vessel, wall_mm: MILLIMETRES * vessel.geometry.outer_height_m(), valve }
    }

    /// Middle of the valve, or the top of the wall, mm.
    pub(super) fn valve_mm(&self) -> f64 {
        self.wall_mm + self.valve.map_or(0.0, |(_, length_mm)| 0.5 * length_mm)
    }

    /// Highest point, mm.
    pub(super) fn top_mm(&self) -> f64 {
        self.wall_mm + self.valve.map_or(0.0, |(_, length_mm)| length_mm)
    }

    /// Radius of the valve, mm.
    pub(super) fn valve_radius_mm(&self) -> f64 {
        self.valve.map_or(0.0, |(radius_mm, _)| radius_mm)
    }

    /// Outer radius at a height of the wall, mm.
    pub(super) fn radius_mm(&self, height_mm: f64) -> f64 {
        MILLIMETRES * outer_radius_m(&self.vessel.geometry, height_mm / MILLIMETRES)
    }

    /// Wall, gas, valve, from the back to the front.
    pub(super) fn shapes(&self) -> Vec<Shape> {
        let geometry = &self.vessel.geometry;
        let bottom_mm = MILLIMETRES * geometry.bottom.thickness_m;
        let inner_mm = MILLIMETRES * geometry.inner_height_m();
        let wall = contour(0.0, self.wall_mm, |height_mm| self.radius_mm(height_mm));
        let gas = contour(bottom_mm, inner_mm, |height_mm| {
            MILLIMETRES * geometry.inner_radius_at_m((height_mm - bottom_mm) / MILLIMETRES)
        });
        let mut shapes =
            vec![Shape { contour: wall, fill: style::STEEL }, Shape { contour: gas, fill: style::Rgb::BAND }];
        if let Some((radius_mm, length_mm)) = self.valve {
            let contour = vec![(radius_mm, self.wall_mm), (radius_mm, self.wall_mm + length_mm)];
            shapes.push(Shape { contour, fill: style::BRASS });
        }
        shapes
    }
}

/// Corners from a height over a length, mm; closer at the ends, where domes are flat.
fn contour(from_mm: f64, length_mm: f64, radius_mm: impl Fn(f64) -> f64) -> Vec<(f64, f64)> {
    let share = |corner: usize| 0.5 - 0.5 * (std::f64::consts::PI * corner as f64 / CORNERS as f64).cos();
    let height_mm = |corner: usize| from_mm + length_mm * share(corner);
    (0..=CORNERS).map(|corner| (radius_mm(height_mm(corner)), height_mm(corner))).collect()
}

/// Outer radius at a height above the outer bottom, m: each end's spheroid is a thickness larger than its inner one.
fn outer_radius_m(geometry: &Geometry, height_m: f64) -> f64 {
    let radius_m = 0.5 * geometry.inner_diameter_m;
    let full_m = radius_m + geometry.thickness_m();
    let spheroid = |thickness_m: f64, depth_m: f64, from_middle_m: f64| {
        let share = from_middle_m / (depth_m + thickness_m);
        (radius_m + thickness_m) * (1.0 - share * share).max(0.0).sqrt()
    };
    let bottom = geometry.bottom;
    let depth_m = |shape: EndShape| match shape {
        EndShape::Flat => 0.0,
        EndShape::Dome { depth_m } => depth_m,
    };
    let cylinder_m = bottom.thickness_m + depth_m(bottom.shape);
    let shoulder_m = cylinder_m + geometry.cylinder_length_m;
    let neck_m = geometry.neck.map_or(0.0, |neck| 0.5 * neck.inner_diameter_m + neck.thickness_m);
    match (bottom.shape, geometry.shoulder.shape) {
        (EndShape::Dome { depth_m }, _) if height_m < cylinder_m => {
            spheroid(bottom.thickness_m, depth_m, cylinder_m - height_m).min(full_m)
        }
        (_, EndShape::Dome { depth_m }) if height_m > shoulder_m => {
            spheroid(geometry.shoulder.thickness_m, depth_m, height_m - shoulder_m)
                .clamp(neck_m, full_m.max(neck_m))
        }
        (_, EndShape::Flat) if height_m > shoulder_m + geometry.shoulder.thickness_m => neck_m,
        _ => full_m,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::thermal::vessel::presets;

    #[test]
    fn the_outline_of_the_20_l_cylinder_is_as_wide_and_high_as_the_cylinder() {
        let vessel = presets::load("nitrogen-20l").unwrap();
        let outline = Outline::of(&vessel);
        // 192 mm and two walls of 5.8 mm.
        assert!((outline.radius_mm(400.0) - 101.8).abs() < 1e-9);
        assert!(outline.radius_mm(0.0) < 1.0 && (outline.radius_mm(outline.wall_mm) - 22.5).abs() < 1e-9);
        let [wall, gas, valve] = &outline.shapes()[..] else { panic!("wall, gas and valve") };
        for (inside, outside) in gas.contour.iter().map(|at| (at.0, outline.radius_mm(at.1))) {
            assert!(inside < outside, "{inside} {outside}");
        }
        let top = |shape: &Shape| shape.contour.iter().map(|at| at.1).fold(0.0, f64::max);
        assert!(top(gas) <= top(wall) + 1e-9 && top(wall) < top(valve) && top(valve) == outline.top_mm());
    }
}
