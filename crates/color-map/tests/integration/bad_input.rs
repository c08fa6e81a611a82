//! What is refused, and how.

use std::sync::Arc;

use wayfix_color_map::{
    ColorId, ColorMap, ColorMapError, ColoredShape, LabelImage, MapRenderer, PinholeCamera, PostBand,
    RenderError,
    nalgebra::{Quaternion, UnitQuaternion, Vector3},
};
use wayfix_estimation_traits::{LieGroup, Pose3};

fn polygon(corners: &[[f64; 3]]) -> ColoredShape {
    ColoredShape::Polygon { color: ColorId(0), vertices: corners.iter().map(|&c| Vector3::from(c)).collect() }
}

fn post(x: f64, radius: f64, heights: &[[f64; 2]]) -> ColoredShape {
    let bands = heights.iter().map(|&[from, to]| PostBand { color: ColorId(0), from, to }).collect();
    ColoredShape::Post { x, y: 0.0, radius, bands }
}

fn map(shapes: Vec<ColoredShape>) -> Result<ColorMap, ColorMapError> {
    ColorMap::new(vec!["green".into()], shapes)
}

fn refused(shape: ColoredShape) -> ColorMapError {
    // In second place, so that the error has to name the right one.
    map(vec![post(50.0, 0.1, &[[0.0, 1.0]]), shape]).expect_err("the second shape is impossible")
}

#[test]
fn colors() {
    let same = ColorMap::new(vec!["a".into(), "b".into(), "a".into()], Vec::new()).unwrap_err();
    assert_eq!(same, ColorMapError::DuplicateColor { name: "a".into() });
    let many = ColorMap::new((0..256).map(|i| i.to_string()).collect(), Vec::new()).unwrap_err();
    assert_eq!(many, ColorMapError::TooManyColors { limit: 255, got: 256 });
    let bands = vec![PostBand { color: ColorId(1), from: 0.0, to: 1.0 }];
    let unknown = refused(ColoredShape::Post { x: 0.0, y: 0.0, radius: 1.0, bands });
    assert_eq!(unknown, ColorMapError::UnknownColor { shape: 1, color: 1, n_colors: 1 });
    let vertices = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]].map(Vector3::from).to_vec();
    let unknown = refused(ColoredShape::Polygon { color: ColorId(9), vertices });
    assert_eq!(unknown, ColorMapError::UnknownColor { shape: 1, color: 9, n_colors: 1 });
}

#[test]
fn polygons() {
    assert_eq!(refused(polygon(&[])), ColorMapError::TooFewVertices { shape: 1, got: 0 });
    assert_eq!(
        refused(polygon(&[[0.0, 0.0, 0.0], [1.0, 0.0, 0.0]])),
        ColorMapError::TooFewVertices { shape: 1, got: 2 }
    );
    let line = refused(polygon(&[[0.0, 0.0, 0.0], [1.0, 1.0, 0.0], [2.0, 2.0, 0.0]]));
    assert!(matches!(line, ColorMapError::Degenerate { shape: 1, .. }), "{line}");
    let point = refused(polygon(&[[1.0, 1.0, 0.0]; 4]));
    assert!(
        matches!(point, ColorMapError::Degenerate { shape: 1, area_m2: 0.0, perimeter_m: 0.0 }),
        "{point}"
    );
    let twice = refused(polygon(&[[0.0, 0.0, 0.0], [0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]]));
    assert!(matches!(twice, ColorMapError::Value { shape: 1, what: "edge, m", value: 0.0, .. }), "{twice}");
    let bent = refused(polygon(&[[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 1.0, 0.01], [0.0, 1.0, 0.0]]));
    assert!(
        matches!(bent, ColorMapError::NotPlanar { shape: 1, distance_m, .. } if distance_m > 1e-3),
        "{bent}"
    );
    let arrow = refused(polygon(&[[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.2, 0.2, 0.0], [0.0, 1.0, 0.0]]));
    assert!(matches!(arrow, ColorMapError::NotConvex { shape: 1, .. }), "{arrow}");
    // Every corner of a five-pointed star turns the same way; it goes round twice.
    let star: Vec<_> = (0..5).map(|k| (f64::from(k) * 2.0 * std::f64::consts::TAU / 5.0).sin_cos()).collect();
    let star = refused(polygon(&star.iter().map(|&(y, x)| [x, y, 0.0]).collect::<Vec<_>>()));
    assert!(matches!(star, ColorMapError::NotConvex { shape: 1, .. }), "{star}");
}

#[test]
fn coordinates() {
    for bad in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY, 1e300, -1.1e6] {
        let corner = refused(polygon(&[[0.0, 0.0, bad], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]]));
        assert!(matches!(corner, ColorMapError::Value { shape: 1, .. }), "{corner}");
        let center = refused(post(bad, 1.0, &[[0.0, 1.0]]));
        assert!(matches!(center, ColorMapError::Value { shape: 1, .. }), "{center}");
        let end = refused(post(0.0, 1.0, &[[0.0, bad]]));
        assert!(matches!(end, ColorMapError::Value { shape: 1, .. }), "{end}");
    }
}

#[test]
fn posts() {
    for radius in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        let error = refused(post(0.0, radius, &[[0.0, 1.0]]));
        assert!(matches!(error, ColorMapError::Value { shape: 1, what: "radius, m", .. }), "{error}");
    }
    assert_eq!(refused(post(0.0, 1.0, &[])), ColorMapError::NoBands { shape: 1 });
    for heights in [[[0.0, 0.5], [0.4, 1.0]], [[0.0, 0.5], [0.5, 0.5]], [[1.0, 2.0], [0.0, 0.5]]] {
        let error = refused(post(0.0, 1.0, &heights));
        assert!(matches!(error, ColorMapError::BandOrder { shape: 1, band: 1, .. }), "{error}");
    }
    let overlap = map(vec![post(0.0, 0.3, &[[0.0, 1.0]]), post(0.5, 0.25, &[[2.0, 3.0]])]).unwrap_err();
    assert!(
        matches!(overlap, ColorMapError::PostsOverlap { first: 0, second: 1, distance_m, .. } if distance_m == 0.5)
    );
}

#[test]
fn cameras() {
    let camera = |width, height, fx, fy, cx, cy| PinholeCamera::new(width, height, fx, fy, cx, cy);
    assert!(camera(1, 16384, 1e-3, 1e6, -1e6, 1e6).is_ok());
    let bad = [
        camera(0, 10, 1.0, 1.0, 0.0, 0.0),
        camera(10, 16385, 1.0, 1.0, 0.0, 0.0),
        camera(10, 10, 0.0, 1.0, 0.0, 0.0),
        camera(10, 10, 1.0, -1.0, 0.0, 0.0),
        camera(10, 10, f64::NAN, 1.0, 0.0, 0.0),
        camera(10, 10, 1.0, f64::INFINITY, 0.0, 0.0),
        camera(10, 10, 1.0, 1.0, f64::NAN, 0.0),
        camera(10, 10, 1.0, 1.0, 0.0, -2e6),
        PinholeCamera::from_field_of_view(10, 10, 0.0, 1.0),
        PinholeCamera::from_field_of_view(10, 10, 1.0, std::f64::consts::PI),
        PinholeCamera::from_field_of_view(10, 10, f64::NAN, 1.0),
        PinholeCamera::from_field_of_view(10, 10, 1e-300, 1.0),
    ];
    for error in bad.map(Result::unwrap_err) {
        assert!(matches!(error, RenderError::Camera { .. }), "{error}");
    }
}

#[test]
fn poses() {
    let map = map(vec![polygon(&[[1.0, -9.0, -9.0], [1.0, 9.0, -9.0], [1.0, 0.0, 9.0]])]).unwrap();
    let mut renderer =
        MapRenderer::new(Arc::new(map), PinholeCamera::from_field_of_view(20, 20, 1.0, 1.0).unwrap());
    let good = Pose3::identity();
    let quaternion = |w, i| UnitQuaternion::new_unchecked(Quaternion::new(w, i, 0.0, 0.0));
    let mut bad = Vec::new();
    for value in [f64::NAN, f64::INFINITY, -1e300, 1.1e6] {
        for axis in 0..3 {
            let mut pose = good;
            pose.translation[axis] = value;
            bad.push(pose);
        }
        bad.push(Pose3 { rotation: quaternion(value, 0.0), ..good });
        bad.push(Pose3 { rotation: quaternion(1.0, value), ..good });
    }
    bad.push(Pose3 { rotation: quaternion(0.0, 0.0), ..good });
    for pose in bad {
        let mut n = 0;
        let error = renderer.spans(&pose, &mut |_| n += 1).unwrap_err();
        assert!(matches!(error, RenderError::Pose { .. }), "{error}");
        let inner = renderer.inner_spans(&pose, 2, &mut |_| n += 1).unwrap_err();
        assert!(matches!(inner, RenderError::Pose { .. }), "{inner}");
        assert_eq!(n, 0);
    }
    assert_eq!(renderer.labels(&good).unwrap().count(ColorId(0)), 400);
}

#[test]
fn rays_and_labels() {
    let map = map(vec![polygon(&[[1.0, -9.0, -9.0], [1.0, 9.0, -9.0], [1.0, 0.0, 9.0]])]).unwrap();
    assert!(map.cast(&Vector3::zeros(), &Vector3::x()).is_some());
    for bad in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
        assert_eq!(map.cast(&Vector3::new(bad, 0.0, 0.0), &Vector3::x()), None);
        assert_eq!(map.cast(&Vector3::zeros(), &Vector3::new(1.0, bad, 0.0)), None);
    }
    assert_eq!(map.cast(&Vector3::zeros(), &Vector3::zeros()), None);
    let error = LabelImage::from_codes(3, 2, &[0; 5]).unwrap_err();
    assert_eq!(error, RenderError::Size { width: 3, height: 2, expected: 6, got: 5 });
    assert_eq!(LabelImage::from_codes(3, 2, &[1; 6]).unwrap().get(3, 0), None);
}

/// The far corners of what is allowed: nothing may overflow into nonsense.
#[test]
fn extremes() {
    let far = 1e6;
    let map = map(vec![
        polygon(&[[far, -far, -far], [far, far, -far], [far, far, far], [far, -far, far]]),
        polygon(&[[-far, -far, -1.0], [far, -far, -1.0], [far, far, -1.0], [-far, far, -1.0]]),
        post(0.5, 1e-5, &[[-far, far]]),
    ])
    .unwrap();
    let map = Arc::new(map);
    for camera in [
        PinholeCamera::new(7, 5, 1e6, 1e6, 1e6, -1e6).unwrap(),
        PinholeCamera::new(7, 5, 1e-6, 1e-6, 3.5, 2.5).unwrap(),
        PinholeCamera::new(7, 5, 1e6, 1e-6, 3.5, 2.5).unwrap(),
    ] {
        for translation in [Vector3::zeros(), Vector3::repeat(far), Vector3::new(0.5, 0.0, 0.0)] {
            let pose = Pose3 { translation, ..Pose3::identity() };
            let mut n = 0;
            let mut seen = |span: wayfix_color_map::PixelSpan| n += usize::from(span.end - span.start);
            MapRenderer::new(Arc::clone(&map), camera).spans(&pose, &mut seen).unwrap();
            assert!(n <= 35, "a pixel was emitted twice: {n}");
        }
    }
    // Straight ahead, the wall fills the image.
    let camera = PinholeCamera::from_field_of_view(7, 5, 1.0, 1.0).unwrap();
    let pose = Pose3 { translation: Vector3::new(1.0, 0.0, 0.0), ..Pose3::identity() };
    assert_eq!(MapRenderer::new(map, camera).labels(&pose).unwrap().count(ColorId(0)), 35);
}

/// Many planes that all cut each other have too many pieces; many that do not are no trouble.
#[test]
fn thousands_of_shapes() {
    let sheet = |i: u32| {
        // Each in its own direction, all through the middle.
        let (sin, cos) = (f64::from(i) * 0.37).sin_cos();
        let (tilt_sin, tilt_cos) = (f64::from(i) * 0.61).sin_cos();
        let (along, up) =
            (Vector3::new(cos, sin, 0.0), Vector3::new(-sin * tilt_sin, cos * tilt_sin, tilt_cos));
        let corners = [[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]].map(|[a, b]| along * a + up * b);
        ColoredShape::Polygon { color: ColorId(0), vertices: corners.to_vec() }
    };
    assert_eq!(
        map((0..600).map(sheet).collect()).unwrap_err(),
        ColorMapError::TooManyPieces { limit: 200_000 }
    );

    let tile = |i: u32| {
        let (x, y) = (f64::from(i % 64), f64::from(i / 64));
        let z = f64::from(i * 7 % 64); // on planes of their own
        polygon(&[[x, y, z], [x + 0.9, y, z + 0.1], [x + 0.9, y + 0.9, z + 0.1], [x, y + 0.9, z]])
    };
    let map = map((0..4096).map(tile).collect()).unwrap();
    let camera = PinholeCamera::from_field_of_view(64, 48, 1.0, 0.8).unwrap();
    let labels = MapRenderer::new(Arc::new(map), camera)
        .labels(&Pose3 { translation: Vector3::new(-20.0, 32.0, 30.0), ..Pose3::identity() })
        .unwrap();
    assert!(labels.count(ColorId(0)) > 0);
}
