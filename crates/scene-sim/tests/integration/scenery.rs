//! Flat scenes: their sizes, that they are the same everywhere, and what another visit does to them.

#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

use approx::abs_diff_eq;
use wayfix_scene_sim::SimulationError;
use wayfix_scene_sim::scenery::{ImagingConditions, RgbPicture, Scenery};

fn lab() -> (Scenery, RgbPicture) {
    let lab = Scenery::named("lab").unwrap();
    (lab, lab.compose())
}

/// Nothing but a change of place: every other step of a visit does as little as it can.
fn aside(shift_px: (f64, f64)) -> ImagingConditions {
    ImagingConditions {
        shift_px,
        gamma: 1.0,
        levels: (0.0, 255.0),
        noise: 0.0,
        ..ImagingConditions::dimmed()
    }
}

fn grey(picture: &RgbPicture, x: usize, y: usize) -> [u8; 3] {
    let at = 3 * (y * picture.width + x);
    [picture.rgb[at], picture.rgb[at + 1], picture.rgb[at + 2]]
}

#[test]
fn scenes_have_room_for_the_states_of_the_paper() {
    let states: Vec<_> = Scenery::ALL.iter().map(|scenery| (scenery.name, scenery.n_states())).collect();
    assert_eq!(states, [("lift", 352), ("map", 234), ("all", 594), ("lab", 150)]);
    for scenery in Scenery::ALL {
        let ((width, height), picture) = (scenery.size_px(), scenery.compose());
        assert_eq!((picture.width, picture.height, picture.rgb.len()), (width, height, 3 * width * height));
        // One view more would not fit.
        assert_eq!((width - Scenery::VIEW_PX) / scenery.step_px + 1, scenery.columns);
        assert_eq!((height - Scenery::VIEW_PX) / scenery.step_px + 1, scenery.rows);
    }
    assert!(matches!(Scenery::named("attic"), Err(SimulationError::UnknownScenario { .. })));
}

#[test]
fn scenes_and_visits_are_the_same_every_time() {
    let (lab, learned) = lab();
    assert_eq!(lab.compose(), learned);
    let visit = |seed| ImagingConditions::default().picture_of(&learned, seed).unwrap();
    assert_eq!(visit(3), visit(3));
    assert_ne!(visit(3), visit(4), "noise comes from the seed");
    assert_ne!(Scenery { seed: lab.seed + 1, ..lab }.compose(), learned);
}

/// A logistic curve of steepness 0.001 is a straight line to 1e-8 of the range, so that a visit that only shifts gives the bytes moved.
#[test]
fn a_shift_alone_moves_the_picture() {
    let (_, learned) = lab();
    let moved = aside((3.0, -2.0)).picture_of(&learned, 1).unwrap();
    assert_eq!(grey(&moved, 10, 20), grey(&learned, 13, 18));
    assert_eq!(grey(&moved, 10, 0), grey(&learned, 13, 0), "the edge repeats");
    assert_eq!(aside((0.0, 0.0)).picture_of(&learned, 1).unwrap(), learned);
}

/// No table of grey values, one a channel, leads from the scene to the visit: pixels that were equal differ by more than noise makes them.
#[test]
fn light_is_not_the_same_everywhere() {
    let white = RgbPicture { width: 300, height: 200, rgb: vec![150; 3 * 300 * 200] };
    let seen =
        ImagingConditions { noise: 0.0, ..ImagingConditions::default() }.picture_of(&white, 1).unwrap();
    let (middle, corner) = (grey(&seen, 150, 100), grey(&seen, 0, 0));
    assert!((0..3).all(|c| middle[c] >= corner[c] + 3), "{middle:?} {corner:?}");
    assert!(middle[0] > middle[1] && middle[1] > middle[2], "a warm cast");
}

/// 20 + 0.7 · 255 (v / 255)^1.3, which is how the photographs of `wayfix run views` are made darker.
#[test]
fn a_dimmed_visit_is_gain_offset_and_gamma() {
    for value in [0_u8, 64, 150, 255] {
        let flat = RgbPicture { width: 4, height: 4, rgb: vec![value; 48] };
        let seen =
            ImagingConditions { noise: 0.0, ..ImagingConditions::dimmed() }.picture_of(&flat, 1).unwrap();
        let expected = 20.0 + 0.7 * 255.0 * (f64::from(value) / 255.0).powf(1.3);
        assert!(
            abs_diff_eq!(f64::from(seen.rgb[0]), expected, epsilon = 0.51),
            "{value}: {} {expected}",
            seen.rgb[0]
        );
    }
}

#[test]
fn meaningless_visits_are_refused() {
    let (_, learned) = lab();
    let bad = [
        ImagingConditions { shift_px: (f64::NAN, 0.0), ..ImagingConditions::default() },
        ImagingConditions { cast: [1.0, 0.0, 1.0], ..ImagingConditions::default() },
        ImagingConditions { falloff: 1.1, ..ImagingConditions::default() },
        ImagingConditions { exposure: -1.0, ..ImagingConditions::default() },
        ImagingConditions { gamma: 0.0, ..ImagingConditions::default() },
        ImagingConditions { steepness: 0.0, ..ImagingConditions::default() },
        ImagingConditions { levels: (100.0, 90.0), ..ImagingConditions::default() },
        ImagingConditions { noise: f64::INFINITY, ..ImagingConditions::default() },
    ];
    for visit in bad {
        assert!(matches!(visit.picture_of(&learned, 1), Err(SimulationError::Parameter { .. })), "{visit:?}");
    }
    let torn = RgbPicture { rgb: vec![0; 5], ..learned };
    assert!(ImagingConditions::default().picture_of(&torn, 1).is_err());
}
