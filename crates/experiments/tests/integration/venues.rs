//! The experiment on real fields, on small painted ones: is it read, counted and refused as it says?
#![allow(clippy::unwrap_used, clippy::expect_used, reason = "helpers of tests fail like tests")]

use std::{fs, path::Path};

use rand::RngExt;
use rand_chacha::{ChaCha8Rng, rand_core::SeedableRng};
use wayfix_evaluation::report::ReportRun;
use wayfix_experiments::venues;
use wayfix_sensor_log::EncodedImage;

const WIDTH: u32 = 120;
const HEIGHT: u32 = 160;

/// A dark hall above a green floor with a white line, and a yellow ball of 30 pixels, under a light of its own; noise of ±8 levels.
fn paint(light: f64, rng: &mut ChaCha8Rng) -> Vec<u8> {
    let mut rgb = Vec::new();
    for y in 0..HEIGHT {
        for x in 0..WIDTH {
            let (dx, dy) = (f64::from(x) - 59.5, f64::from(y) - 119.5);
            let color = match (dx * dx + dy * dy < 225.0, y < HEIGHT / 2, x % 40 < 2) {
                (true, _, _) => [190.0, 170.0, 40.0],
                (_, true, _) => [40.0, 40.0, 40.0],
                (_, _, true) => [200.0, 200.0, 200.0],
                _ => [40.0, 130.0, 60.0],
            };
            let noise = rng.random_range(-8.0..8.0);
            rgb.extend(color.map(|channel| (light * channel + noise) as u8));
        }
    }
    rgb
}

fn paint_venues(folder: &Path, n: u64) {
    let mut rng = ChaCha8Rng::seed_from_u64(5);
    for k in 0..n {
        let robot = folder.join(format!("2001010{k}/r1"));
        fs::create_dir_all(&robot).unwrap();
        for image in 0..2 {
            let light = 0.6 + 0.1 * k as f64 + 0.02 * f64::from(image);
            let jpeg = EncodedImage::jpeg(WIDTH, HEIGHT, &paint(light, &mut rng), 95).unwrap();
            fs::write(robot.join(format!("{image}.jpg")), &jpeg.bytes).unwrap();
            fs::write(robot.join(format!("{image}.txt")), "0 0.5 0.75 0.25 0.1875\n").unwrap();
        }
    }
}

fn metric(run: &ReportRun, name: &str) -> f64 {
    run.metrics.iter().find(|metric| metric.name == name).expect(name).value
}

#[test]
fn painted_balls_are_told_from_painted_carpets() {
    let folder = tempfile::tempdir().unwrap();
    paint_venues(folder.path(), 5);
    let run = venues::run(folder.path()).unwrap();
    assert_eq!((run.events["image"], run.events["image_without_carpet"]), (10, 0));
    // Ball and carpet lie some 50 levels of U and V apart, noise scatters them by less than 8: nothing to confuse.
    for name in [
        "joint_prior_classification_rate_worst",
        "independent_classification_rate_worst",
        "oracle_classification_rate_worst",
    ] {
        assert!(metric(&run, name) > 0.999, "{name}: {}", metric(&run, name));
    }
    // Light scales both colours, so carpets do foretell balls here.
    assert!(metric(&run, "joint_gain_nats") > 0.0, "{}", run.notes[0]);
    assert_eq!(run.figures.len(), 2);
}

#[test]
fn folder_without_experiment_is_refused_with_a_reason() {
    let folder = tempfile::tempdir().unwrap();
    let why = || format!("{:#}", venues::run(folder.path()).unwrap_err());
    assert!(why().contains("0 venues"), "{}", why());
    paint_venues(folder.path(), 4);
    for image in 0..2 {
        fs::write(folder.path().join(format!("20010103/r1/{image}.txt")), "").unwrap();
    }
    assert!(why().contains("20010103") && why().contains("ball"), "{}", why());
}

#[test]
fn an_image_without_usable_boxes_is_left_out_and_named() {
    let folder = tempfile::tempdir().unwrap();
    paint_venues(folder.path(), 6); // two venues are whole: scatter is learned from them
    let file = |name: &str| folder.path().join(name);
    fs::remove_file(file("20010101/r1/1.txt")).unwrap();
    fs::write(file("20010102/r1/1.txt"), "0 0.5 0.75 0.25\n").unwrap();
    let bytes = fs::read(file("20010103/r1/1.jpg")).unwrap();
    fs::write(file("20010103/r1/1.jpg"), &bytes[..bytes.len() / 2]).unwrap();
    fs::write(file("20010103/r1/._0.jpg"), "AppleDouble").unwrap();
    let run = venues::run(folder.path()).unwrap();
    assert_eq!((run.events["image"], run.events["image_unusable"]), (9, 3));
    for named in ["3 images", "1.txt", "1.jpg"] {
        assert!(run.warnings[0].contains(named), "{named}: {}", run.warnings[0]);
    }
}
