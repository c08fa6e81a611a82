//! The light: colour temperature, fall-off, shading by the angle, and what a venue makes of it.

use approx::{abs_diff_eq, assert_abs_diff_eq};
use wayfix_estimation_traits::nalgebra::Vector3;
use wayfix_scene_sim::league::{Lamp, LampLight, LeagueVenue, LightField, LinearRgb, N_COLORS, black_body};

use super::support::{Blank, channel, field_in, honest, looking, streams, take};

#[test]
fn a_black_body_has_the_tabulated_color() {
    // Linear sRGB of the Planckian locus (CIE 1931, 2°), scaled to luminance 1, from the chromaticities of CIE 15: 2856 K (illuminant A,
    // x 0.44757, y 0.40745) and 5000 K (0.34510, 0.35160). The splines are good to 0.001 in x and y.
    for (kelvin, x, y) in [(2856.0, 0.447_57, 0.407_45), (5000.0, 0.345_10, 0.351_60)] {
        let rgb = black_body(kelvin);
        let sum = |row: [f64; 3]| row[0] * rgb.x + row[1] * rgb.y + row[2] * rgb.z;
        let xyz =
            [sum([0.4124, 0.3576, 0.1805]), sum([0.2126, 0.7152, 0.0722]), sum([0.0193, 0.1192, 0.9505])];
        let total: f64 = xyz.iter().sum();
        assert!(
            abs_diff_eq!(xyz[0] / total, x, epsilon = 2e-3)
                && abs_diff_eq!(xyz[1] / total, y, epsilon = 2e-3),
            "{kelvin} K: {rgb}"
        );
    }
}

#[test]
fn light_falls_off_over_the_carpet_as_in_the_picture() {
    let lamp = Lamp { position: Vector3::new(-1.0, 0.0, 2.5), strength: LinearRgb::repeat(5.0) };
    let light = LampLight { lamps: vec![lamp], ..LampLight::default() };
    let (backdrop, paints) = (Blank(LinearRgb::zeros()), [LinearRgb::repeat(0.5); N_COLORS]);
    let scene = field_in(&light, &backdrop, &paints);
    let below = |x: f64| {
        let pose = looking([x, 0.7, 0.5], 0.0, std::f64::consts::FRAC_PI_2);
        channel(&take(honest(), &scene, [&pose, &pose]), 104, 80, 0)
    };
    let falls: Vec<f64> = [-1.0, 0.0, 1.0].map(below).to_vec();
    assert!(falls[0] > 1.3 * falls[1] && falls[1] > 1.3 * falls[2], "{falls:?}");
    for (x, got) in [-1.0, 0.0, 1.0].into_iter().zip(falls) {
        let wanted = 255.0 * 0.5 * light.irradiance(&Vector3::new(x, 0.7, 0.0), &Vector3::z()).x;
        assert_abs_diff_eq!(got, wanted, epsilon = 1.0); // half a level, and half a pixel to the side
    }
}

#[test]
fn surfaces_are_shaded_by_the_angle_to_the_lamp() {
    let lamp = Lamp { position: Vector3::new(0.0, 0.0, 2.0), strength: LinearRgb::repeat(1.0) };
    let light = LampLight { lamps: vec![lamp], ..LampLight::default() };
    let at = Vector3::new(1.0, 0.0, 0.0);
    let towards = light.irradiance(&at, &-Vector3::x());
    assert!(towards.x > 0.0 && light.irradiance(&at, &Vector3::x()) == LinearRgb::zeros());
    // Direction to the lamp is (−1, 0, 2)/√5: upright faces get half of what the ground gets.
    assert_abs_diff_eq!(towards.x / light.irradiance(&at, &Vector3::z()).x, 0.5, epsilon = 1e-15);
}

#[test]
fn in_the_dark_one_lamp_of_the_same_hall_is_left() {
    for seed in 0..20 {
        let venue = LeagueVenue::draw(streams(seed).of(wayfix_scene_sim::random::RandomStreamPurpose::Venue))
            .expect("a venue");
        let left_on = venue.dark.lamps[0];
        assert!(venue.bright.lamps.contains(&left_on));
        let middle = |light: &LampLight| light.irradiance(&Vector3::zeros(), &Vector3::z()).y;
        let share = middle(&venue.dark) / middle(&venue.bright);
        assert!((0.05..0.5).contains(&share), "one of four or six, nearer or further: {share}");
    }
}

#[test]
fn sun_lies_in_patches_on_the_carpet_of_every_hall() {
    for seed in 0..20 {
        let venue = LeagueVenue::draw(streams(seed).of(wayfix_scene_sim::random::RandomStreamPurpose::Venue))
            .expect("a venue");
        let on_carpet = |x: i32, y: i32, light: &dyn LightField| {
            light.irradiance(&Vector3::new(0.05 * f64::from(x), 0.05 * f64::from(y), 0.0), &Vector3::z()).y
        };
        let points: Vec<(i32, i32)> = (-42..=42).flat_map(|x| (-27..=27).map(move |y| (x, y))).collect();
        let sun = |&&(x, y): &&(i32, i32)| {
            on_carpet(x, y, &venue.sunny) - on_carpet(x, y, &venue.sunny.hall)
                > 0.5 * venue.sunny.beam.y * venue.sunny.towards_sun.z
        };
        let share = points.iter().filter(sun).count() as f64 / points.len() as f64;
        // Panes are 64 % of the wall; the grid is 5 cm wide and a pane 60 cm.
        assert!((0.1..0.7).contains(&share), "seed {seed}: {share}");
        let direct = venue.sunny.beam.y * venue.sunny.towards_sun.z;
        let ratio = direct / on_carpet(0, 0, &venue.sunny.hall);
        assert!(ratio > 2.0, "seed {seed}: more than lamps differ over a field, {ratio}");
    }
}

#[test]
fn edges_of_the_sun_are_as_wide_as_its_disc() {
    let venue = LeagueVenue::draw(streams(1).of(wayfix_scene_sim::random::RandomStreamPurpose::Venue))
        .expect("a venue");
    let sun = &venue.sunny;
    let in_beam = |millimetres: i32| {
        let point = Vector3::new(0.001 * f64::from(millimetres), 0.0, 0.0);
        let direct = sun.irradiance(&point, &Vector3::z()) - sun.hall.irradiance(&point, &Vector3::z());
        direct.y / (sun.beam.y * sun.towards_sun.z)
    };
    // Two panes and their period of 1.88 m: four edges. The sun's diameter is 32 minutes of arc.
    let n_in_edges = (0..1880).filter(|x| (0.001..0.999).contains(&in_beam(*x))).count();
    let width = (32.0_f64 / 60.0).to_radians() * sun.wall_y_m / sun.towards_sun.y;
    assert_abs_diff_eq!(n_in_edges as f64, 4000.0 * width, epsilon = 8.0); // a pixel of 1 mm at either end
}
