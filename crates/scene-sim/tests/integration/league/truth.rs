//! Labels against the map's own ray casting.

use wayfix_color_map::PinholeCamera;
use wayfix_estimation_traits::nalgebra::Vector3;
use wayfix_estimation_traits::{Pose3, nalgebra::Vector2};
use wayfix_scene_sim::league::{
    LeagueDrive, LeagueParams, LeaguePicture, LinearRgb, Material, N_COLORS, SceneSurface, SurfaceShape,
    field_map,
};

use super::support::{Blank, even_light, field_in, honest, looking, streams, take};

/// What the map's own casts say at a point of the picture: 0 or the colour's number plus 1.
fn cast(map: &wayfix_color_map::ColorMap, camera: &PinholeCamera, pose: &Pose3<f64>, at: Vector2<f64>) -> u8 {
    let direction = pose.rotation * camera.ray(at.x, at.y);
    map.cast(&pose.translation, &direction).map_or(0, |hit| hit.color.0 + 1)
}

fn poses() -> impl Iterator<Item = Pose3<f64>> {
    (0..24).map(|k| {
        let k = f64::from(k);
        looking([1.6 * (k * 0.7).sin(), 0.9 * (k * 1.3).cos(), 0.2 + 0.004 * k], 0.6 * k, 0.05 + 0.015 * k)
    })
}

/// A fine grid over what the rays of a pixel cover (0.6 pixels to either side) and a little more: a beacon of the map has 16 sides, which are
/// 0.65 mm off the true cylinder, and lines far away are a quarter of a pixel high.
fn footprint(middle: Vector2<f64>) -> impl Iterator<Item = Vector2<f64>> {
    let down = (-9..=9).map(|k| 0.1 * f64::from(k));
    down.flat_map(move |dy| [-0.9, -0.45, 0.0, 0.45, 0.9].map(|dx| middle + Vector2::new(dx, dy)))
}

#[test]
fn pixel_of_a_single_map_colour_has_that_label() {
    let map = field_map().expect("a sound map");
    let (light, backdrop, paints) = (even_light(), Blank(LinearRgb::zeros()), [LinearRgb::zeros(); N_COLORS]);
    let scene = field_in(&light, &backdrop, &paints);
    let camera = honest().camera;
    let (mut n_labelled, mut n_off, mut n_uniform) = (0, 0, 0);
    for pose in poses() {
        let LeaguePicture { labels, .. } = take(honest(), &scene, [&pose, &pose]);
        for (pixel, &label) in labels.iter().enumerate() {
            let middle = Vector2::new((pixel % 208) as f64 + 0.5, (pixel / 208) as f64 + 0.5);
            let here = cast(&map, &camera, &pose, middle);
            if label > 0 {
                n_labelled += 1;
                if label != here {
                    n_off += 1;
                    let found = footprint(middle).any(|at| cast(&map, &camera, &pose, at) == label);
                    assert!(found, "pixel {middle:?} from {pose:?}");
                }
            }
            if pixel % 61 == 0 && footprint(middle).all(|at| cast(&map, &camera, &pose, at) == here) {
                n_uniform += 1;
                assert_eq!(label, here, "pixel {middle:?} from {pose:?}");
            }
        }
    }
    // Only a line that is thinner than a pixel fits between all four rays and through the middle.
    assert!(n_off * 1000 < n_labelled, "{n_off} of {n_labelled}");
    assert!(n_labelled > 300_000 && n_uniform > 8_000, "{n_labelled} {n_uniform}");
}

#[test]
fn unmapped_object_occludes_and_has_no_label() {
    let (light, backdrop, paints) = (even_light(), Blank(LinearRgb::zeros()), [LinearRgb::zeros(); N_COLORS]);
    let mut scene = field_in(&light, &backdrop, &paints);
    let pose = looking([0.0, 0.0, 0.25], 0.0, 0.2);
    let label = |picture: &LeaguePicture| picture.labels[120 * 208 + 104];
    assert_eq!(label(&take(honest(), &scene, [&pose, &pose])), 1, "carpet");
    // The ray of that pixel falls by tan(0.2 + 0.21) a metre.
    let centre = Vector3::new(0.4, 0.0, 0.08);
    scene.surfaces.push(SceneSurface {
        form: SurfaceShape::Ball { centre, radius: 0.06 },
        material: Material::Unmapped(LinearRgb::repeat(0.5)),
    });
    let hidden = take(honest(), &scene, [&pose, &pose]);
    assert_eq!(label(&hidden), 0);
    assert_eq!(hidden.rgb[3 * (120 * 208 + 104)], 127, "and its own looks");
}

#[test]
fn every_color_comes_into_view_and_varies_over_the_field() {
    let params = LeagueParams { n_frames: 60, period_ms: 1000, ..LeagueParams::default() };
    let mut brightness: Vec<Vec<f64>> = vec![vec![]; N_COLORS];
    for frame in LeagueDrive::new(&params, streams(1)).expect("sound parameters") {
        for (rgb, &label) in frame.picture.rgb.chunks_exact(3).zip(&frame.picture.labels) {
            if label > 0 {
                brightness[usize::from(label) - 1].push(rgb.iter().map(|&c| f64::from(c)).sum::<f64>() / 3.0);
            }
        }
    }
    for (color, values) in brightness.iter().enumerate() {
        let sigma = super::support::deviation(values);
        println!("colour {color}: {} pixels, σ of the brightness {sigma:.1}", values.len());
        assert!(values.len() > 500, "colour {color}: {}", values.len());
        // The chip alone gives 255 · 0.5/√3000 = 2.3 at most.
        assert!(sigma > 3.5, "colour {color}: {sigma}");
    }
}
