//! A light of one's own: the sun comes in by a window and draws a bright stripe across the field.
//! `cargo run -p wayfix-scene-sim --features league --example 03_custom_light`

use rand_chacha::{ChaCha8Rng, rand_core::SeedableRng};
use wayfix_estimation_traits::{Pose3, nalgebra::Vector3};
use wayfix_scene_sim::league::{
    CameraSimulator, LampSetting, LeagueScene, LeagueVenue, LightField, LinearRgb, SceneSurface, black_body,
    field_map,
};
use wayfix_scene_sim::{SimulationError, space};
use wayfix_sensor_log::EncodedImage;

/// The lamps of a hall, and the sun low in the west, let in by one window.
struct Sunset<'a> {
    lamps: &'a dyn LightField,
    towards_sun: Vector3<f64>,
}

impl LightField for Sunset<'_> {
    fn irradiance(&self, point: &Vector3<f64>, normal: &Vector3<f64>) -> LinearRgb {
        // Where the ray to the sun meets the wall with the window, at x = −6 m.
        let at_wall = point + self.towards_sun * ((-6.0 - point.x) / self.towards_sun.x);
        let by_window = (at_wall.y - 0.2).abs() < 0.15 && (1.0..6.0).contains(&at_wall.z);
        let facing = normal.dot(&self.towards_sun).max(0.0);
        let sun = if by_window { black_body(3500.0) * (2.0 * facing) } else { LinearRgb::zeros() };
        self.lamps.irradiance(point, normal) + sun
    }
}

fn main() -> Result<(), SimulationError> {
    let venue = LeagueVenue::draw(&mut ChaCha8Rng::seed_from_u64(1))?;
    let towards_sun = Vector3::new(-1.0, 0.0, 0.5).normalize();
    let sunset = Sunset { lamps: venue.light(LampSetting::Dark), towards_sun };
    let camera = Pose3 { translation: Vector3::new(-1.5, 0.0, 0.25), rotation: space::pitch(0.25) };
    let mut camera_simulator = CameraSimulator::new(venue.camera)?;
    let mut photograph = |light: &dyn LightField| {
        let surfaces = SceneSurface::of_map(&field_map()?);
        let scene = LeagueScene { surfaces, paints: &venue.paints, light, backdrop: &venue.hall };
        let steady = LinearRgb::repeat(1.0);
        Ok::<_, SimulationError>(camera_simulator.take(
            &scene,
            [&camera; 2],
            &steady,
            &mut ChaCha8Rng::seed_from_u64(2),
        ))
    };
    let (plain, sunny) = (photograph(venue.light(LampSetting::Dark))?, photograph(&sunset)?);
    assert_eq!(plain.labels, sunny.labels, "light moves nothing");
    let n_brighter = plain.rgb.iter().zip(&sunny.rgb).filter(|(plain, sunny)| **sunny > **plain + 20).count();
    assert!(n_brighter > 5_000 && n_brighter < plain.rgb.len() / 2, "a stripe, not everything: {n_brighter}");
    let png = EncodedImage::png_rgb(sunny.width, sunny.height, &sunny.rgb)?;
    println!("{n_brighter} of {} values are brighter; {} bytes of PNG", sunny.rgb.len(), png.bytes.len());
    Ok(())
}
