//! The light: colour temperature, fall-off, shading by the angle, and what a venue makes of it.

use approx::{abs_diff_eq, assert_abs_diff_eq};
use wayfix_estimation_traits::nalgebra::Vector3;
use wayfix_scene_sim::league::{
    Lamp, LampLight, LampSetting, LeagueVenue, LightField, LinearRgb, N_COLORS, black_body,
};

use crate::support::{Blank, channel, field_in, honest, looking, streams, take};

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
        let left_on = venue.light(LampSetting::Dark).lamps[0];
        assert!(venue.light(LampSetting::Bright).lamps.contains(&left_on));
        let middle = |light: &LampLight| light.irradiance(&Vector3::zeros(), &Vector3::z()).y;
        let share = middle(&venue.dark) / middle(&venue.bright);
        assert!((0.05..0.5).contains(&share), "one of four or six, nearer or further: {share}");
    }
}
