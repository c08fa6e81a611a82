//! Priors learned from small painted images, and every way to label them wrongly.
#![allow(clippy::unwrap_used, clippy::panic, reason = "helpers of tests fail like tests")]

use std::{fs, path::Path};

use approx::{assert_abs_diff_eq, assert_relative_eq};
use wayfix_color_map::ColorId;
use wayfix_color_model::{LightingPriors, YuvStandard};
use wayfix_sensor_log::EncodedImage;

use crate::common::{Outcome, Scratch, wayfix};

/// A stripe of 16 columns for each colour.
const STRIPE: u32 = 16;
const WIDTH: u32 = 5 * STRIPE;
const HEIGHT: u32 = 30;
/// Green, white, yellow, cyan and pink.
const PAINTS: [[f64; 3]; 5] = [
    [30.0, 90.0, 50.0],
    [180.0, 180.0, 175.0],
    [170.0, 140.0, 30.0],
    [60.0, 140.0, 180.0],
    [190.0, 90.0, 130.0],
];

/// Which stripe a pixel is in.
fn stripe(at: u32) -> usize {
    (at % WIDTH / STRIPE) as usize
}

fn rgb(light: f64, color: usize) -> [u8; 3] {
    PAINTS[color].map(|channel| (light * channel) as u8)
}

/// Stripes of all colours in a light.
fn image(light: f64) -> EncodedImage {
    let pixels: Vec<u8> = (0..WIDTH * HEIGHT).flat_map(|at| rgb(light, stripe(at))).collect();
    EncodedImage::png_rgb(WIDTH, HEIGHT, &pixels).unwrap()
}

/// Labels of the stripes; `number` turns a colour into its label.
fn labels(number: impl Fn(usize) -> u8) -> EncodedImage {
    let pixels: Vec<u8> = (0..WIDTH * HEIGHT).map(|at| number(stripe(at))).collect();
    EncodedImage::png_gray(WIDTH, HEIGHT, &pixels).unwrap()
}

fn right(color: usize) -> u8 {
    color as u8 + 1
}

fn save(scratch: &Scratch, name: &str, image: &EncodedImage) {
    fs::write(scratch.path(name), &image.bytes).unwrap();
}

/// Images a, b, … in these lights, with their labels.
fn painted(lights: &[f64]) -> Scratch {
    let scratch = Scratch::new();
    for (name, light) in ('a'..).zip(lights) {
        save(&scratch, &format!("{name}.png"), &image(*light));
        save(&scratch, &format!("{name}_labels.png"), &labels(right));
    }
    scratch
}

fn learn(scratch: &Scratch, more: &[&str]) -> Outcome {
    let folder = scratch.path("").display().to_string();
    let out = scratch.path("priors.json").display().to_string();
    let first = ["learn-priors", "--images", &folder, "--labels", &folder, "--out", &out];
    wayfix(first.iter().chain(more))
}

fn written(path: &Path) -> LightingPriors {
    serde_json::from_str(&fs::read_to_string(path).unwrap()).unwrap()
}

fn refused(outcome: &Outcome, what: &str) {
    assert_eq!(outcome.code, 1, "{outcome:?}");
    let error = outcome.stderr.lines().last().unwrap_or_default();
    assert!(error.starts_with("error: ") && error.contains(what), "{what}: {}", outcome.stderr);
}

#[test]
fn one_venue_gives_its_means_and_says_what_it_assumes() {
    let scratch = painted(&[1.0, 1.02]);
    let outcome = learn(&scratch, &[]);
    assert_eq!(outcome.code, 0, "{}", outcome.stderr);
    for told in ["all images are one venue", "cannot tell", "green, white, yellow"] {
        assert!(outcome.stderr.contains(told), "{told}: {}", outcome.stderr);
    }
    let priors = written(&scratch.path("priors.json"));
    assert_eq!((priors.colors()[4].as_str(), priors.members().len()), ("pink", 1));
    for color in 0..5 {
        let [a, b] = [1.0, 1.02].map(|light| YuvStandard::Bt601Full.from_rgb(rgb(light, color)));
        for channel in 0..3 {
            let mean = 0.5 * (f64::from(a[channel]) + f64::from(b[channel]));
            let learned = priors.members()[0].mean()[3 * color + channel];
            assert_abs_diff_eq!(learned, mean, epsilon = 0.5);
        }
    }
    // One venue adds no spread: three quarters of the assumed variance of 30² remain.
    assert_relative_eq!(priors.members()[0].covariance()[(0, 0)], 675.0, max_relative = 0.02);
    let picture = fs::read_to_string(scratch.path("priors.svg")).unwrap();
    assert!(picture.starts_with("<svg") && picture.contains("pink"));
}

#[test]
fn kinds_of_light_come_from_the_table_or_from_brightness() {
    let scratch = painted(&[0.5, 1.0, 0.52, 1.04]);
    let table = |text: &str| scratch.file("venues.csv", text).display().to_string();
    let named = "image,venue,light\na,cellar,lamp\nb.png,roof,sun\nc,cellar,lamp\nd,roof,sun\n";
    let plain = "image,venue\na,cellar\nb,roof\nc,cellar\nd,roof\n";
    let mut means = Vec::new();
    for (text, more) in [(named, ["--seed", "1"]), (plain, ["--lights", "2"])] {
        let outcome = learn(&scratch, &[&["--groups", &table(text)], &more[..]].concat());
        assert_eq!(outcome.code, 0, "{}", outcome.stderr);
        assert!(outcome.stderr.contains("the one venue roof cannot tell"), "{}", outcome.stderr);
        let priors = written(&scratch.path("priors.json"));
        means.push([0, 1].map(|light| priors.members()[light].mean()[3 * ColorId(1).index()]));
    }
    assert_eq!(means[0], means[1]);
    // White has Y 179 in the light 1.
    for (mean, light) in means[0].into_iter().zip([0.51, 1.02]) {
        assert_abs_diff_eq!(mean, light * 179.0, epsilon = 2.0);
    }
    refused(&learn(&scratch, &["--groups", &table(named), "--lights", "2"]), "names the kinds of light");
    refused(&learn(&scratch, &["--groups", &table(plain), "--lights", "3"]), "--lights 3");
    refused(&learn(&scratch, &["--groups", &table("image,venue\nz,roof\n")]), "the name z");
    let some = learn(&scratch, &["--groups", &table("image,venue\na,cellar\nb,roof\n")]);
    assert!(some.stderr.contains("does not name, left out: 2 (c, d)"), "{}", some.stderr);
    assert!(some.stderr.contains("no colour is in two images of a venue"), "{}", some.stderr);
}

#[test]
fn images_without_labels_and_small_colours_are_counted() {
    let scratch = painted(&[1.0, 1.02]);
    save(&scratch, "unlabelled.png", &image(1.0));
    save(&scratch, "gone_labels.png", &labels(right));
    // Two columns of pink: none is inside.
    let narrow = (0..WIDTH * HEIGHT).map(|at| match (stripe(at), at % WIDTH) {
        (4, column) if column == 4 * STRIPE + 8 => 5,
        (4, _) => 0,
        (color, _) => right(color),
    });
    let narrow = EncodedImage::png_gray(WIDTH, HEIGHT, &narrow.collect::<Vec<u8>>()).unwrap();
    save(&scratch, "b_labels.png", &narrow);
    let outcome = learn(&scratch, &[]);
    assert_eq!(outcome.code, 0, "{}", outcome.stderr);
    for told in [
        "images without labels: 1 (unlabelled)",
        "labels without an image: 1 (gone)",
        "next to another label",
    ] {
        assert!(outcome.stderr.contains(told), "{told}: {}", outcome.stderr);
    }
    let row = outcome.stdout.lines().find(|line| line.starts_with("pink")).unwrap();
    assert_eq!(row.split_whitespace().nth(1), Some("1"), "{row}");
}

#[test]
fn wrong_labels_are_refused_by_name() {
    let scratch = painted(&[1.0, 1.02]);
    let spoil = |labels: &EncodedImage, what: &str| {
        save(&scratch, "b_labels.png", labels);
        let outcome = learn(&scratch, &[]);
        refused(&outcome, what);
        assert!(outcome.stderr.contains("b_labels.png"), "{}", outcome.stderr);
        assert!(!scratch.path("priors.json").exists());
    };
    let small = EncodedImage::png_gray(WIDTH, 3, &[1; 3 * WIDTH as usize]).unwrap();
    spoil(&small, "the image has 80 × 30 pixels, its labels 80 × 3");
    spoil(&labels(|color| if color == 4 { 9 } else { right(color) }), "480 pixels have the label 9");
    spoil(&image(1.0), "grey");
    let text = EncodedImage { bytes: b"pink".to_vec().into(), ..small.clone() };
    spoil(&text, "is no JPEG, PNG or PNM");
}

#[test]
fn a_colour_or_a_venue_without_pixels_is_named() {
    let scratch = painted(&[1.0, 1.02]);
    for name in ["a_labels.png", "b_labels.png"] {
        save(&scratch, name, &labels(|color| if color == 4 { 0 } else { right(color) }));
    }
    refused(&learn(&scratch, &[]), "shows pink");
    save(&scratch, "b_labels.png", &labels(|_| 0));
    let table = scratch.file("venues.csv", "image,venue\na,lab\nb,hall\n").display().to_string();
    refused(&learn(&scratch, &["--groups", &table]), "no image of the venue hall shows a colour");
    let empty = Scratch::new();
    refused(&learn(&empty, &[]), "no image in");
    let nowhere = empty.path("nowhere").display().to_string();
    let out = empty.path("priors.json").display().to_string();
    refused(&wayfix(["learn-priors", "--images", &nowhere, "--labels", &nowhere, "--out", &out]), "nowhere");
}
