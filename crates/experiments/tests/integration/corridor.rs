//! The corridor that is driven twice, on small painted ones: is it read, counted and refused as it says?
#![allow(clippy::unwrap_used, clippy::expect_used, reason = "helpers of tests fail like tests")]

use std::{fs, path::Path};

use wayfix_evaluation::report::ReportRun;
use wayfix_experiments::corridor;
use wayfix_sensor_log::EncodedImage;

const WIDTH: u32 = 40;
const HEIGHT: u32 = 30;

/// Walls whose colours change along the way, seen through a window that moves on.
fn paint(traverse: &Path, n_frames: usize, light: f64) {
    fs::create_dir_all(traverse).unwrap();
    for k in 0..n_frames {
        let mut rgb = Vec::new();
        for i in 0..WIDTH * HEIGHT {
            let (x, y) = (f64::from(i % WIDTH) + 8.0 * k as f64, f64::from(i / WIDTH));
            let walls =
                [(x / 31.0).sin() + (y / 9.0).cos(), (x / 47.0 + 1.0).sin(), (x / 83.0 + y / 13.0).cos()];
            rgb.extend(walls.map(|wall| (light * (128.0 + 50.0 * wall)) as u8));
        }
        let png = EncodedImage::png_rgb(WIDTH, HEIGHT, &rgb).unwrap();
        fs::write(traverse.join(format!("{k:03}.png")), &png.bytes).unwrap();
    }
}

fn metric(run: &ReportRun, name: &str) -> f64 {
    run.metrics.iter().find(|metric| metric.name == name).expect(name).value
}

#[test]
fn a_corridor_that_did_not_change_is_found_again() {
    let folder = tempfile::tempdir().unwrap();
    paint(&folder.path().join("ref"), 50, 1.0);
    paint(&folder.path().join("query"), 50, 1.0);
    let run = corridor::run(folder.path()).unwrap();
    assert_eq!((run.events["place"], run.events["frame"]), (50, 50));
    // The features of a frame are exactly those of its place, and places more than two apart look different.
    for feature in ["mean_std", "fourier6", "dominant_grays", "joined"] {
        assert_eq!(metric(&run, &format!("{feature}_localized_frame_share_single_frame")), 1.0, "{feature}");
    }
    assert_eq!(metric(&run, "joined_localized_frame_share"), 1.0);
    assert_eq!(
        metric(&run, "joined_localized_frame_share"),
        metric(&run, "joined_localized_frame_share_swapped"),
        "both are the same"
    );
    assert!(metric(&run, "joined_neighbour_frame_correlation_length") > 1.0, "neighbouring frames overlap");
    assert_eq!(run.figures.len(), 3);
}

#[test]
fn folder_without_two_traverses_is_refused_with_a_reason() {
    let folder = tempfile::tempdir().unwrap();
    let why = || format!("{:#}", corridor::run(folder.path()).unwrap_err());
    assert!(why().contains("ref"), "{}", why());
    paint(&folder.path().join("ref"), 12, 1.0);
    paint(&folder.path().join("query"), 9, 1.0);
    assert!(why().contains("12 pictures learned and 9 seen"), "{}", why());
    paint(&folder.path().join("query"), 12, 1.0);
    let frame = folder.path().join("query/003.png");
    let bytes = fs::read(&frame).unwrap();
    fs::write(&frame, &bytes[..bytes.len() / 2]).unwrap();
    assert!(why().contains("query") && why().contains("003.png"), "{}", why());
}
