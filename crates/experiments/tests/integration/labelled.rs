//! The experiment on labelled images, on small painted ones: are they read, classified and refused as it says?
#![allow(clippy::unwrap_used, clippy::expect_used, reason = "helpers of tests fail like tests")]

use std::{fs, path::Path};

use rand::RngExt;
use rand_chacha::{ChaCha8Rng, rand_core::SeedableRng};
use wayfix_evaluation::report::ReportRun;
use wayfix_experiments::labelled;
use wayfix_sensor_log::EncodedImage;
use wayfix_systems::color::ColorSystemParams;

const STRIPE: u32 = 32;
const WIDTH: u32 = 5 * STRIPE;
const HEIGHT: u32 = 96;
/// Green, white, yellow, cyan and pink.
const PAINTS: [[f64; 3]; 5] = [
    [30.0, 100.0, 50.0],
    [180.0, 180.0, 175.0],
    [170.0, 140.0, 30.0],
    [60.0, 140.0, 180.0],
    [190.0, 80.0, 130.0],
];

/// Stripes of all colours under a light, and from the middle row on in a shade of it; noise of ±8 levels.
fn paint(folder: &Path, name: &str, light: f64, shade: f64) {
    let stripe = |at: u32| (at % WIDTH / STRIPE) as usize;
    let light = |at: u32| if at / WIDTH < HEIGHT / 2 { light } else { light * shade };
    let mut rng = ChaCha8Rng::seed_from_u64(6);
    let mut rgb = |at: u32| {
        let noise = rng.random_range(-8.0..8.0);
        PAINTS[stripe(at)].map(|channel| (light(at) * channel + noise) as u8)
    };
    let pixels: Vec<u8> = (0..WIDTH * HEIGHT).flat_map(&mut rgb).collect();
    let labels: Vec<u8> = (0..WIDTH * HEIGHT).map(|at| stripe(at) as u8 + 1).collect();
    let images = folder.join("images");
    fs::create_dir_all(&images).unwrap();
    let save = |name: String, image: EncodedImage| fs::write(images.join(name), &image.bytes).unwrap();
    save(format!("{name}.png"), EncodedImage::png_rgb(WIDTH, HEIGHT, &pixels).unwrap());
    save(format!("{name}_labels.png"), EncodedImage::png_gray(WIDTH, HEIGHT, &labels).unwrap());
}

fn field() -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    let map = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../fixtures/four-legged-field.toml");
    fs::copy(map, folder.path().join("field.toml")).unwrap();
    folder
}

fn metric(run: &ReportRun, name: &str) -> f64 {
    run.metrics.iter().find(|metric| metric.name == name).expect(name).value
}

#[test]
fn clean_paints_are_told_apart_in_sun_and_shade() {
    let folder = field();
    for (name, light, shade) in [("a", 1.0, 1.0), ("b", 0.9, 1.0), ("c", 1.1, 1.0), ("d", 1.0, 0.4)] {
        paint(folder.path(), name, light, shade);
    }
    let run = labelled::run(folder.path(), &["d".to_owned()], &ColorSystemParams::default()).unwrap();
    assert_eq!(metric(&run, "n_labelled_images"), 4.0);
    // Paints lie at least 30 levels apart, noise scatters them by less than 8: what is seen in even light is told without error.
    for name in ["a", "b", "c"] {
        assert_eq!(metric(&run, &format!("{name}_sun_or_shade_classification_rate")), 1.0, "{name}");
    }
    let [sun, both] =
        ["sun", "sun_or_shade"].map(|what| metric(&run, &format!("d_{what}_classification_rate")));
    assert!(both >= sun && both > 0.95, "{sun} {both}"); // paints this far apart may be told by the sun's light alone
    assert_eq!(metric(&run, "withheld_pink_n_images"), 4.0);
    assert_eq!(run.figures.len(), 2, "ellipses and film of d");
    assert!(run.figures[0].svg.contains("pink"));
}

#[test]
fn one_image_or_no_map_is_an_error() {
    let folder = field();
    paint(folder.path(), "a", 1.0, 1.0);
    let run = |folder: &Path| labelled::run(folder, &[], &ColorSystemParams::default()).unwrap_err();
    assert!(run(folder.path()).to_string().contains("1 labelled images, two are needed"));
    fs::remove_file(folder.path().join("field.toml")).unwrap();
    assert!(format!("{:#}", run(folder.path())).contains("field.toml"));
}
