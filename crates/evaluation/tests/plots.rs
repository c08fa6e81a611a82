//! What the SVG of a plot shows, measured in the SVG itself.

use approx::abs_diff_eq;
use wayfix_evaluation::plot::{
    AxisScale, ConsistencyPlot, CovarianceEllipsesPlot, EstimatedLandmark, LinePlot, MapPlot, NamedEllipse,
    PlotSeries, PoseErrorPlot, PoseErrorSample, StepTimesPlot, SvgPlot,
};

/// The backend draws in tenths of a pixel.
const UNITS_PER_PIXEL: f64 = 10.0;

/// The vertices, in pixels, of every element `tag` drawn with `colour`.
fn shapes(picture: &SvgPlot, tag: &str, colour: &str) -> Vec<Vec<(f64, f64)>> {
    let elements = picture
        .svg
        .split('<')
        .filter(|element| element.starts_with(tag) && element.contains(&format!("var(--{colour})")));
    let points = elements.filter_map(|element| element.split("points=\"").nth(1)?.split('"').next());
    let pixels = |number: &str| number.parse::<f64>().expect("a coordinate") / UNITS_PER_PIXEL;
    let vertex = |pair: &str| pair.split_once(',').map(|(x, y)| (pixels(x), pixels(y)));
    points.map(|list| list.split_whitespace().filter_map(vertex).collect()).collect()
}

/// Width and height of a shape.
fn size(shape: &[(f64, f64)]) -> (f64, f64) {
    let span = |values: Vec<f64>| {
        values.iter().copied().fold(f64::MIN, f64::max) - values.iter().copied().fold(f64::MAX, f64::min)
    };
    (span(shape.iter().map(|p| p.0).collect()), span(shape.iter().map(|p| p.1).collect()))
}

/// Pixels per metre on both axes, from true landmarks at `(0, 0)` and `(corner.0, corner.1)`: each is a cross of two strokes.
fn pixels_per_meter(picture: &SvgPlot, corner: (f64, f64)) -> (f64, f64) {
    let strokes = shapes(picture, "polyline", "text");
    let centers: Vec<(f64, f64)> =
        strokes.iter().map(|s| (0.5 * (s[0].0 + s[1].0), 0.5 * (s[0].1 + s[1].1))).collect();
    // The legend comes first and has a cross as well: two strokes each.
    let (origin, other) = (centers[2], centers[4]);
    ((other.0 - origin.0) / corner.0, (origin.1 - other.1) / corner.1)
}

fn map_with(corner: (f64, f64), covariance: [[f64; 2]; 2]) -> MapPlot {
    let landmarks = vec![EstimatedLandmark { position: (0.5 * corner.0, 0.5 * corner.1), covariance }];
    MapPlot { landmarks, true_landmarks: vec![(0.0, 0.0), corner], ..MapPlot::default() }
}

#[test]
fn isotropic_covariance_draws_a_two_sigma_circle() {
    // Wide, square, tall, and far from square on both sides.
    for corner in [(10.0, 7.0), (5.0, 5.0), (6.0, 9.0), (200.0, 3.0), (3.0, 400.0)] {
        let sigma = 0.08 * f64::max(corner.0, corner.1);
        let picture = map_with(corner, [[sigma * sigma, 0.0], [0.0, sigma * sigma]]).draw().unwrap();
        let (scale_x, scale_y) = pixels_per_meter(&picture, corner);
        // Positions are rounded to a tenth of a pixel at both ends of each side.
        let rounding = 0.2 / f64::min(corner.0, corner.1);
        assert!(
            abs_diff_eq!(scale_x, scale_y, epsilon = rounding),
            "{corner:?}: {scale_x} and {scale_y} px per metre"
        );
        let (width, height) = size(&shapes(&picture, "polygon", "ink-3")[0]);
        assert!(abs_diff_eq!(width, height, epsilon = 0.3), "{corner:?}: {width} by {height} px");
        // The longer side gives the scale with fewer rounding errors.
        let scale = if corner.0 > corner.1 { scale_x } else { scale_y };
        assert!(
            abs_diff_eq!(width, 4.0 * sigma * scale, epsilon = 0.4),
            "{corner:?}: {width} px for {} m",
            4.0 * sigma
        );
    }
}

#[test]
fn ellipse_spans_two_sigma_of_each_axis_when_correlated() {
    let (xx, xy, yy) = (0.36, 0.30, 0.49);
    let picture = map_with((8.0, 8.0), [[xx, xy], [xy, yy]]).draw().unwrap();
    let (scale_x, scale_y) = pixels_per_meter(&picture, (8.0, 8.0));
    let (width, height) = size(&shapes(&picture, "polygon", "ink-3")[0]);
    // 48 vertices miss the extreme by at most 1 - cos(π/48), 0.2 %.
    assert!(abs_diff_eq!(width / (4.0 * xx.sqrt() * scale_x), 1.0, epsilon = 0.005), "{width}");
    assert!(abs_diff_eq!(height / (4.0 * yy.sqrt() * scale_y), 1.0, epsilon = 0.005), "{height}");
}

#[test]
fn dead_reckoning_that_runs_away_does_not_shrink_the_map() {
    let calm = map_with((8.0, 6.0), [[0.01, 0.0], [0.0, 0.01]]);
    let lost = MapPlot { dead_reckoning: (0..1000).map(|k| (f64::from(k), 0.0)).collect(), ..calm.clone() };
    let (before, _) = pixels_per_meter(&calm.draw().unwrap(), (8.0, 6.0));
    let (after, _) = pixels_per_meter(&lost.draw().unwrap(), (8.0, 6.0));
    assert!(after > 0.5 * before, "{before} to {after} px per metre");
}

#[test]
fn one_sample_among_many_stays_visible() {
    let mut points: Vec<(f64, f64)> =
        (0..200_000).map(|k| (f64::from(k), (f64::from(k) * 0.3).sin())).collect();
    points[123_456].1 = 9.0;
    let picture =
        LinePlot { series: vec![PlotSeries::new("s", points)], ..LinePlot::default() }.draw().unwrap();
    let lines = shapes(&picture, "polyline", "ink-0");
    let (_, height) = size(lines.iter().max_by_key(|line| line.len()).unwrap());
    // From −1 to 9 with 5 % of room above and below, in a panel of 220 px.
    assert!(abs_diff_eq!(height, 220.0 / 1.1, epsilon = 0.5), "{height} px");
}

/// Every kind of plot with the same numbers in every place.
fn all_plots(values: &[f64]) -> Vec<SvgPlot> {
    let pairs: Vec<(f64, f64)> = values.iter().enumerate().map(|(k, value)| (k as f64, *value)).collect();
    let places: Vec<(f64, f64)> = values.iter().zip(values.iter().skip(1)).map(|(x, y)| (*x, *y)).collect();
    let landmark = |place: &(f64, f64)| EstimatedLandmark {
        position: *place,
        covariance: [[place.0, place.1], [place.1, place.0]],
    };
    let sample = |(t, value): &(f64, f64)| PoseErrorSample { t: *t, error: [*value; 3], sigma: [*value; 3] };
    let scales = [AxisScale::Linear, AxisScale::Log10];
    let mut plots = vec![
        MapPlot {
            truth: places.clone(),
            estimate: places.clone(),
            dead_reckoning: places.clone(),
            landmarks: places.iter().take(200).map(landmark).collect(),
            true_landmarks: places.iter().take(100).copied().collect(),
            ..MapPlot::default()
        }
        .draw(),
        PoseErrorPlot { samples: pairs.iter().map(sample).collect(), ..PoseErrorPlot::default() }.draw(),
    ];
    for scale in scales {
        let consistency = ConsistencyPlot {
            samples: pairs.clone(),
            expected: 3.0,
            band: (0.2, 9.3),
            window: 20,
            scale,
            ..Default::default()
        };
        plots.push(consistency.draw());
        plots.push(
            StepTimesPlot {
                points: pairs.clone(),
                x_scale: scale,
                y_scale: scale,
                ..StepTimesPlot::default()
            }
            .draw(),
        );
        let series = vec![PlotSeries::new("a", pairs.clone()), PlotSeries::new("b", places.clone())];
        plots.push(LinePlot { series, x_scale: scale, y_scale: scale, ..LinePlot::default() }.draw());
    }
    plots.into_iter().map(|picture| picture.expect("no input is an error")).collect()
}

#[test]
fn numbers_that_cannot_be_drawn_are_gaps() {
    let hostile = [
        0.0,
        f64::NAN,
        1.0,
        -3.0,
        f64::INFINITY,
        2.0,
        f64::NEG_INFINITY,
        f64::MAX,
        -f64::MAX,
        1e-320,
        5.0,
        -0.0,
        0.3,
        0.7,
    ];
    for picture in all_plots(&hostile) {
        assert!(!picture.svg.contains("NaN") && !picture.svg.contains("inf"), "{}", picture.svg);
        assert!(picture.svg.contains("<polyline"), "the good numbers are drawn");
    }
}

#[test]
fn nothing_to_draw_says_so() {
    for values in [&[][..], &[f64::NAN, f64::INFINITY, f64::NAN]] {
        for picture in all_plots(values) {
            assert!(picture.svg.contains("no data") && picture.alt.contains("no data"), "{}", picture.svg);
        }
    }
}

#[test]
fn long_noisy_runs_stay_small() {
    // A linear congruence: nothing smooth to thin.
    let noise: Vec<f64> = (0..20_000u64)
        .map(|k| (k.wrapping_mul(6_364_136_223_846_793_005) >> 40) as f64 / 2f64.powi(24))
        .collect();
    for picture in all_plots(&noise) {
        assert!(picture.svg.len() <= 60_000, "{} has {} bytes", picture.alt, picture.svg.len());
    }
}

#[test]
fn a_class_named_after_a_colour_has_that_colour() {
    let class = |name: &str| NamedEllipse {
        name: name.to_owned(),
        center: (120.0, 130.0),
        covariance: [[9.0, 0.0], [0.0, 4.0]],
    };
    let groups = vec![("prior".to_owned(), ["ball", "green", "white"].map(class).to_vec())];
    let plot = CovarianceEllipsesPlot { groups, sigmas: 1.0, ..Default::default() }.draw().expect("a plot");
    for ink in ["var(--ink-0)", "var(--green)", "var(--white)"] {
        assert!(plot.svg.contains(ink), "{ink}");
    }
    assert!(!plot.svg.contains("#F00D"));
    assert!(plot.standalone().contains("--green:#"));
}

#[test]
fn scan_points_in_one_pixel_are_one_dot() {
    let crowd = (0..10_000).map(|k| (5.0 + 1e-6 * f64::from(k), 5.0));
    let echoes = [(0.0, 0.0), (10.0, 10.0)].into_iter().chain(crowd).collect();
    let band = vec![(1.0, 1.0), (2.0, 1.0), (2.0, 1.2), (1.0, 1.2), (1.0, 1.0)];
    let map = MapPlot { echoes, bands: vec![band], ..MapPlot::default() }.draw().expect("a plot");
    assert!(map.svg.matches("<circle").count() <= 6, "three places, two of the legend");
    assert!(map.svg.contains("2σ of a wall") && map.svg.contains("scan point"));
}

#[test]
fn exact_start_leaves_the_band_visible() {
    let drawn = |start: f64| {
        let plot = ConsistencyPlot {
            samples: vec![(0.0, start), (1.0, 2.0), (2.0, 4.0)],
            expected: 3.0,
            band: (0.216, 9.348),
            window: 2,
            scale: AxisScale::Log10,
            ..Default::default()
        };
        shapes(&plot.draw().expect("a picture"), "polyline", "ink-0")
    };
    // 0.216² / 3 is as far below the band as the band begins below the mean.
    let lowest = 0.216 * 0.216 / 3.0;
    assert_eq!(drawn(1e-30), drawn(lowest));
    assert_ne!(drawn(1e-30), drawn(2.0 * lowest));
}
