use nalgebra::Vector3;
use rand::Rng;

use super::field::{HALF_LENGTH_M, HALF_WIDTH_M};
use super::{HallBackdrop, LampLight, LightField, LinearRgb, black_body};
use crate::random::deviate::uniform;

/// Illuminance of the everyday light, lux: competition in halls [EN 12193, class I].
const EVERYDAY_LUX: f64 = 750.0;
/// Illuminance by the sky indoors, lux: a daylight factor of 3 % [CIBSE LG10] of 15 klx under a clear sky.
const SKY_LUX: f64 = 450.0;
/// Illuminance by the sun outside the atmosphere, lux, and extinction by a clear one [IESNA RP-21].
const SUN_LUX: f64 = 128_000.0;
const EXTINCTION: f64 = 0.21;
/// Angular diameter of the sun, rad: the width of the edge of a patch over its distance from the window.
const SUN_RAD: f64 = 0.0093;
/// Height of the lower and the upper edge of the windows, metres. These and the next four are chosen.
const WINDOW_HEIGHTS_M: [f64; 2] = [1.0, 2.2];
/// Width of a pane, where the two panes of a pair begin, and width of the pillars between pairs, metres.
const PANE_M: f64 = 0.6;
const PANE_STARTS_M: [f64; 2] = [0.0, 0.68];
const PILLAR_M: f64 = 0.6;
const PAIR_PERIOD_M: f64 = PANE_STARTS_M[1] + PANE_M + PILLAR_M;

/// The sun, through windows in one wall of a hall: patches of sun and deep shade on one carpet.
///
/// A pane lets the beam of the sun pass, with edges as wide as the sun's disc makes them; outside it only the hall's own light is left. Things in the hall cast
/// no shadows.
#[derive(Clone, Debug, PartialEq)]
pub struct SunThroughWindows {
    /// Light of the hall beside the sun's beam: lamps, sky, and what the carpet reflects.
    pub hall: LampLight,
    /// Irradiance by the sun behind the glass, of a surface that faces it.
    pub beam: LinearRgb,
    /// Unit vector towards the sun.
    pub towards_sun: Vector3<f64>,
    /// Distance of the wall from the middle of the field, along y, metres.
    pub wall_y_m: f64,
    /// Position of the first pane along the wall, metres; all others repeat to both sides.
    pub first_pane_m: f64,
}

impl SunThroughWindows {
    /// Draws the sun for a hall with this everyday light and a carpet of this reflectance.
    ///
    /// The sun stands up to 40° from the normal of the wall, as high as puts the middle of the patches within 0.7 m of the middle of the field. Its colour is
    /// 4800 to 5600 K [Judd et al. 1964], that of the clear sky 9000 to 15 000 K; the glass lets 30 % (against heat) to 80 % (clear) pass [EN 410].
    pub(super) fn draw<R: Rng + ?Sized>(
        lamps: &LampLight,
        carpet: LinearRgb,
        hall: &HallBackdrop,
        rng: &mut R,
    ) -> Self {
        let (wall, aside) = (hall.half_width_m, uniform(-0.7, 0.7, rng));
        let (sin, cos) = libm::sincos(uniform(-40.0, 40.0, rng).to_radians());
        let middle = 0.5 * (WINDOW_HEIGHTS_M[0] + WINDOW_HEIGHTS_M[1]);
        let towards_sun = Vector3::new(sin, cos, middle * cos / (wall - aside)).normalize();
        let direct = SUN_LUX * libm::exp(-EXTINCTION / towards_sun.z) * uniform(0.3, 0.8, rng);
        let beam = black_body(uniform(4800.0, 5600.0, rng)) * (direct / EVERYDAY_LUX);
        let sky = black_body(uniform(9000.0, 15_000.0, rng)) * (SKY_LUX / EVERYDAY_LUX);
        let first_pane_m = uniform(0.0, PAIR_PERIOD_M, rng);
        let mut light = Self { hall: lamps.clone(), beam, towards_sun, wall_y_m: wall, first_pane_m };
        light.hall.ambient += sky;
        let direct = light.mean_on_field(|point| light.in_beam(point) * towards_sun.z);
        light.hall.bounce += carpet.component_mul(&(beam * direct + sky));
        light
    }

    /// The mean over the field of the irradiance of the carpet.
    pub(super) fn mean_irradiance(&self) -> LinearRgb {
        let share = |axis: usize| self.mean_on_field(|point| self.irradiance(point, &Vector3::z())[axis]);
        LinearRgb::new(share(0), share(1), share(2))
    }

    /// The mean over a grid of 10 cm.
    fn mean_on_field(&self, value: impl Fn(&Vector3<f64>) -> f64) -> f64 {
        let n = [HALF_LENGTH_M, HALF_WIDTH_M].map(|half| (20.0 * half) as usize);
        let at = |k: usize, n: usize, half: f64| ((2 * k + 1) as f64 / n as f64 - 1.0) * half;
        let points = (0..n[0] * n[1])
            .map(|k| Vector3::new(at(k % n[0], n[0], HALF_LENGTH_M), at(k / n[0], n[1], HALF_WIDTH_M), 0.0));
        points.map(|point| value(&point)).sum::<f64>() / (n[0] * n[1]) as f64
    }

    /// Share of the sun's disc that shows at a point of the hall.
    fn in_beam(&self, point: &Vector3<f64>) -> f64 {
        let distance = (self.wall_y_m - point.y) / self.towards_sun.y;
        if distance <= 0.0 {
            return 0.0;
        }
        let through = point + self.towards_sun * distance;
        let blur = SUN_RAD * distance;
        let within = |at: f64, from: f64, to: f64| (0.5 + (at - from).min(to - at) / blur).clamp(0.0, 1.0);
        let along = through.x - self.first_pane_m;
        // From the middle of one pillar to that of the next.
        let along = along - ((along + 0.5 * PILLAR_M) / PAIR_PERIOD_M).floor() * PAIR_PERIOD_M;
        let pane: f64 = PANE_STARTS_M.map(|start| within(along, start, start + PANE_M)).iter().sum();
        pane * within(through.z, WINDOW_HEIGHTS_M[0], WINDOW_HEIGHTS_M[1])
    }
}

impl LightField for SunThroughWindows {
    fn irradiance(&self, point: &Vector3<f64>, normal: &Vector3<f64>) -> LinearRgb {
        let facing = normal.dot(&self.towards_sun);
        let sun = if facing > 0.0 { facing * self.in_beam(point) } else { 0.0 };
        self.hall.irradiance(point, normal) + self.beam * sun
    }
}
