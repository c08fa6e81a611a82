//! Films: the same every time, the target in sight and where the truth says, and what makes each of them hard.

#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

use wayfix_scene_sim::SimulationError;
use wayfix_scene_sim::film::{FilmFrame, OcclusionEvent, Silhouette, SyntheticFilm};

fn shown(name: &str, occlusion: OcclusionEvent) -> impl Iterator<Item = FilmFrame> {
    SyntheticFilm { occlusion, ..SyntheticFilm::named(name).unwrap() }.frames().unwrap()
}

/// Mean red, green and blue where a silhouette is.
fn mean_color(frame: &FilmFrame, part: &Silhouette) -> [f64; 3] {
    let pixels = frame.picture.rgb.chunks_exact(3).zip(part.pixels()).filter(|(_, inside)| **inside);
    let sum = pixels.fold([0.0; 3], |sum, (rgb, _)| [0, 1, 2].map(|c| sum[c] + f64::from(rgb[c])));
    sum.map(|value| value / part.area() as f64)
}

fn apart(one: [f64; 3], other: [f64; 3]) -> f64 {
    (0..3).map(|c| (one[c] - other[c]).powi(2)).sum::<f64>().sqrt()
}

/// Within one pixel of the sides no target is whole.
fn touches_the_edge(part: &Silhouette) -> bool {
    let [x, y, width, height] = part.bounding_box().unwrap();
    x == 0.0 || y == 0.0 || x + width == part.width() as f64 || y + height == part.height() as f64
}

fn is_in_sight_all_the_time(name: &str) {
    let mut n_frames = 0;
    for frame in shown(name, OcclusionEvent::None) {
        n_frames += 1;
        assert_eq!(frame.picture.rgb.len(), 3 * 320 * 240);
        assert!((1000..12_000).contains(&frame.target.area()), "{} pixels", frame.target.area());
        assert!(!touches_the_edge(&frame.target));
        assert_eq!(frame.visible, frame.target);
    }
    assert_eq!(n_frames, 175);
}

#[test]
fn circles_are_in_sight() {
    is_in_sight_all_the_time("circles");
}

#[test]
fn rectangle_is_in_sight() {
    is_in_sight_all_the_time("rectangle");
}

#[test]
fn beetle_is_in_sight() {
    is_in_sight_all_the_time("beetle");
}

#[test]
fn snail_is_in_sight() {
    is_in_sight_all_the_time("snail");
}

#[test]
fn head_is_in_sight() {
    is_in_sight_all_the_time("head");
}

#[test]
fn films_are_the_same_every_time_and_differ_by_their_seed() {
    for film in SyntheticFilm::ALL {
        let first =
            |film: SyntheticFilm| SyntheticFilm { n_frames: 2, ..film }.frames().unwrap().collect::<Vec<_>>();
        assert_eq!(first(film), first(film));
        let other = first(SyntheticFilm { seed: film.seed + 1, ..film });
        assert_ne!(first(film)[1].picture, other[1].picture);
        assert_ne!(first(film)[1].target, other[1].target);
    }
}

/// A circle has one colour: inside, pixels differ by noise alone. In the dark, where the response is steepest, 0.3 % of full scale are
/// some 3 grey levels a channel; 30 levels over three channels are more than 5σ. Three pixels off the edge the lens blurs nothing.
#[test]
fn the_silhouette_is_where_the_circle_is() {
    for frame in shown("circles", OcclusionEvent::None).step_by(25) {
        let [x, y, width, height] = frame.target.bounding_box().unwrap();
        let (u, v, radius) = (x + width / 2.0, y + height / 2.0, width / 2.0);
        let inner = mean_color(&frame, &frame.target);
        let mut around = [0.0; 3];
        for step in 0..32 {
            let (sin, cos) = (f64::from(step) * std::f64::consts::TAU / 32.0).sin_cos();
            let at = |r: f64| 3 * ((v + r * sin) as usize * 320 + (u + r * cos) as usize);
            let pixel = |i: usize| [0, 1, 2].map(|c| f64::from(frame.picture.rgb[i + c]));
            assert!(apart(pixel(at(radius - 3.0)), inner) < 30.0);
            let outer = pixel(at(radius + 3.0));
            around = [0, 1, 2].map(|c| around[c] + outer[c] / 32.0);
        }
        assert!(apart(around, inner) > 20.0, "{around:?} {inner:?}");
    }
}

#[test]
fn rectangle_is_brighter_beyond_the_lamp() {
    let brightness = |frame: FilmFrame| mean_color(&frame, &frame.target)[0];
    let levels: Vec<f64> = shown("rectangle", OcclusionEvent::None).map(brightness).collect();
    let (low, high) =
        levels.iter().fold((f64::INFINITY, 0.0_f64), |(low, high), &v| (low.min(v), high.max(v)));
    assert!(high > 2.0 * low, "{low} to {high}");
}

/// The neck has a colour that lies nearer to the shell's than the ground's does, reaches out and goes in.
#[test]
fn the_neck_goes_in_and_out_and_looks_like_the_shell() {
    let (mut least, mut most) = (usize::MAX, 0);
    for frame in shown("snail", OcclusionEvent::None) {
        let overlap = frame.target.pixels().iter().zip(frame.distractor.pixels()).filter(|(a, b)| **a && **b);
        assert_eq!(overlap.count(), 0);
        (least, most) = (least.min(frame.distractor.area()), most.max(frame.distractor.area()));
        if frame.distractor.area() > 300 {
            let pixels = frame.picture.rgb.chunks_exact(3);
            let all =
                pixels.fold([0.0; 3], |sum, rgb| [0, 1, 2].map(|c| sum[c] + f64::from(rgb[c]) / 76_800.0));
            let [shell, neck] = [&frame.target, &frame.distractor].map(|part| mean_color(&frame, part));
            assert!(apart(neck, shell) < apart(all, shell), "{neck:?} {shell:?} {all:?}");
        }
    }
    assert!(least < 100 && most > 400, "{least} to {most} pixels");
}

#[test]
fn incidents_hide_the_target_or_take_it_away_and_end() {
    for name in ["circles", "beetle"] {
        let seen = |occlusion| -> Vec<(usize, usize)> {
            shown(name, occlusion).map(|frame| (frame.visible.area(), frame.target.area())).collect()
        };
        let share = |&(visible, target): &(usize, usize)| visible as f64 / target as f64;
        let partly = seen(OcclusionEvent::PartlyHidden);
        let least = partly.iter().map(share).fold(1.0, f64::min);
        assert!((0.3..0.85).contains(&least), "{least}");
        let hidden = seen(OcclusionEvent::Hidden);
        assert!(hidden.iter().filter(|(visible, _)| *visible == 0).count() >= 5);
        let away = seen(OcclusionEvent::Away);
        assert!(away.iter().filter(|(_, target)| *target == 0).count() >= 13);
        for (visible, target) in [partly[174], hidden[174], away[174]] {
            assert!(visible == target && target > 1000, "it is back");
        }
    }
}

#[test]
fn what_is_no_film_is_refused() {
    assert!(matches!(SyntheticFilm::named("goldfish"), Err(SimulationError::UnknownScenario { .. })));
    let film = SyntheticFilm::ALL[0];
    assert!(SyntheticFilm { name: "goldfish", ..film }.frames().is_err());
    assert!(matches!(
        SyntheticFilm { n_frames: usize::MAX, ..film }.frames(),
        Err(SimulationError::TooMany { .. })
    ));
    assert_eq!(SyntheticFilm { n_frames: 0, ..film }.frames().unwrap().count(), 0);
}
