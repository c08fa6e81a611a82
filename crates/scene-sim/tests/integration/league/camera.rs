//! What lens and electronics do, on a blank wall.

use approx::{abs_diff_eq, assert_abs_diff_eq};
use wayfix_scene_sim::league::{CameraParams, ChromaSubsampling, ExposureMode, LinearRgb};

use super::support::{Blank, channel, even_light, field_in, honest, looking, of_blank, take};

/// Half a grey level of rounding, and one of the 4096 steps of the response.
const ROUNDING: f64 = 0.5 + 255.0 / 4096.0;

#[test]
fn an_honest_camera_gives_back_what_it_sees() {
    let picture = of_blank(honest(), LinearRgb::new(0.2, 0.5, 0.8));
    for (pixel, wanted) in picture.rgb.iter().zip([0.2, 0.5, 0.8].into_iter().cycle()) {
        assert!(
            abs_diff_eq!(f64::from(*pixel), 255.0 * wanted, epsilon = ROUNDING + 1e-9),
            "{pixel} for {wanted}"
        );
    }
}

#[test]
fn vignetting_darkens_corners_and_makes_them_bluish() {
    let vignetting = LinearRgb::new(0.4, 0.3, 0.1);
    let picture = of_blank(CameraParams { vignetting, ..honest() }, LinearRgb::repeat(0.8));
    for (k, lost) in vignetting.iter().enumerate() {
        let (corner, middle) = (channel(&picture, 0, 0, k), channel(&picture, 104, 80, k));
        // The outermost pixel's centre is at 0.992 of the squared half diagonal.
        let wanted = 255.0 * 0.8 * (1.0 - 0.992 * lost);
        assert_abs_diff_eq!(corner, wanted, epsilon = ROUNDING + 0.2);
        assert_abs_diff_eq!(middle, 204.0, epsilon = ROUNDING + 0.1);
    }
}

#[test]
fn too_much_light_saturates() {
    let picture = of_blank(CameraParams { gain: 3.0, ..honest() }, LinearRgb::new(0.9, 0.5, 0.1));
    assert_eq!(picture.rgb[..2], [255, 255]);
    assert_abs_diff_eq!(f64::from(picture.rgb[2]), 76.5, epsilon = ROUNDING);
}

#[test]
fn gamma_crosstalk_and_stray_light_are_as_asked_for() {
    let bent = of_blank(CameraParams { gamma: 0.5, ..honest() }, LinearRgb::repeat(0.25));
    assert_abs_diff_eq!(f64::from(bent.rgb[0]), 127.5, epsilon = 1.0);
    let mixed = of_blank(CameraParams { crosstalk: 0.1, ..honest() }, LinearRgb::new(1.0, 0.0, 0.0));
    for (got, wanted) in mixed.rgb.iter().zip([204.0, 25.5, 25.5]) {
        assert_abs_diff_eq!(f64::from(*got), wanted, epsilon = ROUNDING);
    }
    let hazy = of_blank(CameraParams { stray_light: 0.1, ..honest() }, LinearRgb::repeat(0.5));
    assert_abs_diff_eq!(f64::from(hazy.rgb[0]), 255.0 * 0.55, epsilon = ROUNDING);
}

/// U of BT.601, as far as bytes say.
fn u(rgb: &[u8]) -> f64 {
    let [r, g, b] = [0, 1, 2].map(|k| f64::from(rgb[k]));
    (b - (0.299 * r + 0.587 * g + 0.114 * b)) / 1.772
}

#[test]
fn shared_chroma_is_the_same_for_all_that_share_it() {
    let noisy = |chroma| CameraParams { chroma_subsampling: chroma, read_noise_sigma: 0.05, ..honest() };
    let furthest = |chroma, offset: usize| -> f64 {
        let picture = of_blank(noisy(chroma), LinearRgb::repeat(0.5));
        let pixels: Vec<&[u8]> = picture.rgb.chunks_exact(3).collect();
        let apart = |row: usize, column: usize| {
            let pixel = row * 208 + column;
            (u(pixels[pixel]) - u(pixels[pixel + offset])).abs()
        };
        (0..160)
            .step_by(2)
            .flat_map(|row| (0..208).step_by(2).map(move |column| apart(row, column)))
            .fold(0.0, f64::max)
    };
    // Each byte is rounded by half a level: U by (0.5 · 0.886 + 0.5 · 0.587 + 0.5 · 0.299)/1.772 = 0.5, twice.
    assert!(furthest(ChromaSubsampling::Pairs, 1) <= 1.0);
    assert!(
        furthest(ChromaSubsampling::Each, 1) > 5.0 && furthest(ChromaSubsampling::Pairs, 208) > 5.0,
        "others have their own"
    );
}

#[test]
fn motion_blur_leaves_fewer_pixels_of_a_single_colour() {
    let (light, backdrop, paints) =
        (even_light(), Blank(LinearRgb::zeros()), [0.1, 0.9, 0.5, 0.6, 0.7].map(LinearRgb::repeat));
    let scene = field_in(&light, &backdrop, &paints);
    let from = looking([0.0, 0.0, 0.25], 0.0, 0.2);
    // 2 rad/s for 10 ms is 0.02 rad: four pixels.
    let still = take(honest(), &scene, [&from, &from]);
    let moved = take(honest(), &scene, [&from, &looking([0.0, 0.0, 0.25], 0.0, 0.22)]);
    let labelled = |labels: &[u8]| labels.iter().filter(|&&label| label > 0).count();
    assert!(labelled(&moved.labels) + 200 < labelled(&still.labels));
    let steepest = |picture: &wayfix_scene_sim::league::LeaguePicture| {
        let step = |row: u32| (channel(picture, 60, row, 0) - channel(picture, 60, row - 1, 0)).abs();
        (1..160).map(step).fold(0.0, f64::max)
    };
    assert!(steepest(&moved) < steepest(&still), "edges are softer");
}

#[test]
fn automatic_exposure_makes_every_picture_grey() {
    // Whatever the wall's colour and brightness, the mean becomes 18 % grey.
    for wall in [LinearRgb::repeat(0.02), LinearRgb::new(0.6, 0.3, 0.1)] {
        let camera = CameraParams { exposure_mode: ExposureMode::Automatic, ..honest() };
        let picture = of_blank(camera, wall);
        assert!(picture.rgb.iter().all(|&byte| (f64::from(byte) - 255.0 * 0.18).abs() <= ROUNDING));
    }
}
