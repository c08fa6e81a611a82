//! The simplification with hulls keeps exactly what the one without keeps, on every kind of chain.

use nalgebra::Vector2;
use rand::RngExt;
use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::SeedableRng;
use wayfix_line_extract::{
    LineExtractionError, PointDistanceReference, PolylineSimplifier, douglas_peucker, simplify,
};

const SEED_SIMPLE: u64 = 31;
const SEED_WILD: u64 = 32;

type Chain = Vec<Vector2<f64>>;
type Point = Box<dyn Fn(usize) -> Vector2<f64>>;

/// Both variants, the one with hulls also from the first split on, against the plain one.
fn assert_same(chain: &Chain, epsilon: f64, what: &str) {
    let expected = douglas_peucker(chain, epsilon, PointDistanceReference::Line).expect("a valid chain");
    assert_eq!(simplify(chain, epsilon).expect("a valid chain"), expected, "{what}, patient");
    let mut kept = Vec::new();
    PolylineSimplifier::hull_tree_only().simplify_into(chain, epsilon, &mut kept).expect("a valid chain");
    assert_eq!(kept, expected, "{what}, {} points, epsilon {epsilon}, hull_tree_only", chain.len());
}

/// Simple chains: one y for each x (in any direction), or one radius for each angle.
fn random_simple(rng: &mut ChaCha8Rng) -> Chain {
    let n = if rng.random_bool(0.05) { rng.random_range(200..1500) } else { rng.random_range(2..200) };
    let grid: f64 = if rng.random_bool(0.4) { 1.0 } else { 0.0 };
    let height = 10f64.powf(rng.random_range(-2.0..2.0));
    let turn = rng.random_range(-3.0..3.0_f64);
    let star = rng.random_bool(0.5);
    let snap = |v: f64| if grid > 0.0 { (v / grid).round() * grid } else { v };
    (0..n)
        .map(|k| {
            let at = k as f64;
            if star && grid == 0.0 {
                let (sin, cos) = (6.2 * at / n as f64).sin_cos();
                Vector2::new(cos, sin) * rng.random_range(1.0..1.0 + height)
            } else if grid > 0.0 {
                Vector2::new(at, snap(rng.random_range(0.0..1.0 + height)))
            } else {
                let (x, y) = (at, rng.random_range(0.0..height));
                Vector2::new(turn.cos() * x - turn.sin() * y, turn.sin() * x + turn.cos() * y)
            }
        })
        .collect()
}

#[test]
fn a_hundred_thousand_random_simple_chains() {
    let mut rng = ChaCha8Rng::seed_from_u64(SEED_SIMPLE);
    for case in 0..100_000 {
        let chain = random_simple(&mut rng);
        let epsilon = if rng.random_bool(0.2) { 0.0 } else { 10f64.powf(rng.random_range(-3.0..1.0)) };
        assert_same(&chain, epsilon, &format!("simple chain {case}"));
    }
}

#[test]
fn chains_that_cross_themselves_repeat_points_or_close() {
    let mut rng = ChaCha8Rng::seed_from_u64(SEED_WILD);
    for case in 0..10_000 {
        let n = rng.random_range(1..700);
        let size = rng.random_range(1..30);
        let mut at = Vector2::zeros();
        // A walk on a small grid meets itself all the time, and every tie and collinearity there is.
        let mut chain: Chain = (0..n)
            .map(|_| {
                at += Vector2::new(rng.random_range(-size..=size), rng.random_range(-1..=1)).cast::<f64>();
                at
            })
            .collect();
        if rng.random_bool(0.3) {
            chain.push(chain[0]);
        }
        if rng.random_bool(0.3) {
            let (cos, sin) = (0.8, 0.6); // neither is a double: collinear points are so only nearly
            chain.iter_mut().for_each(|p| *p = Vector2::new(cos * p.x - sin * p.y, sin * p.x + cos * p.y));
        }
        let epsilon = [0.0, 0.5, 1.0, 3.0][rng.random_range(0..4)];
        assert_same(&chain, epsilon, &format!("wild chain {case}"));
    }
}

#[test]
fn spirals_combs_zigzags_and_lines() {
    for n in [63, 64, 65, 129, 1000, 3000] {
        let at = |k: usize| k as f64;
        let chains: [(&str, Point); 8] = [
            (
                "zigzag",
                Box::new(move |k| {
                    Vector2::new(at(k), if k % 2 == 0 { 0.0 } else { 1e3 * (1.0 - at(k) / at(n)) })
                }),
            ),
            (
                "comb of equal teeth",
                Box::new(move |k| Vector2::new(at(k), if k % 2 == 0 { 0.0 } else { 7.0 })),
            ),
            ("square comb", Box::new(move |k| Vector2::new(at(k / 2), if k % 4 < 2 { 0.0 } else { 7.0 }))),
            ("upright comb", Box::new(move |k| Vector2::new(if k % 2 == 0 { 0.0 } else { 7.0 }, -at(k)))),
            ("spiral", Box::new(move |k| Vector2::new((0.1 * at(k)).cos(), (0.1 * at(k)).sin()) * at(k))),
            (
                "tightening spiral",
                Box::new(move |k| Vector2::new((0.3 * at(k)).cos(), (0.3 * at(k)).sin()) / (1.0 + at(k))),
            ),
            ("line", Box::new(move |k| Vector2::new(0.1 * at(k), 0.3 * at(k)))),
            ("one place", Box::new(|_| Vector2::new(0.1, 0.2))),
        ];
        for (name, point) in &chains {
            let chain: Chain = (0..n).map(point).collect();
            for epsilon in [0.0, 1e-6, 0.5, 5.0] {
                assert_same(&chain, epsilon, name);
            }
        }
    }
}

#[test]
fn every_dropped_point_is_near_its_piece() {
    // The definition of the tolerance, by a formula of its own: the distance to a line by projection.
    let mut rng = ChaCha8Rng::seed_from_u64(SEED_WILD);
    for _ in 0..300 {
        let chain = random_simple(&mut rng);
        let kept = simplify(&chain, 0.5).expect("a valid chain");
        assert_eq!((kept[0], kept[kept.len() - 1]), (0, chain.len() - 1));
        for pair in kept.windows(2) {
            let a = chain[pair[0]];
            let along = (chain[pair[1]] - a).normalize();
            for p in &chain[pair[0]..pair[1]] {
                let off = (p - a) - along * along.dot(&(p - a));
                assert!(off.norm() <= 0.5 + 1e-9, "{} m off", off.norm());
            }
        }
    }
}

#[test]
fn the_first_of_equally_far_points_splits() {
    let chain = [(0.0, 0.0), (1.0, 1.0), (2.0, 1.0), (3.0, 0.0)].map(|(x, y)| Vector2::new(x, y));
    for kept in [douglas_peucker(&chain, 0.9, PointDistanceReference::Line), simplify(&chain, 0.9)] {
        // Split at 1; the line from there to the end leaves point 2 at 0.45 m.
        assert_eq!(kept, Ok(vec![0, 1, 3]));
    }
}

#[test]
fn a_closed_chain_is_split_farthest_from_its_end_point() {
    let square =
        [(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0), (0.0, 0.0)].map(|(x, y)| Vector2::new(x, y));
    assert_eq!(simplify(&square, 0.1), Ok(vec![0, 1, 2, 3, 4]));
    assert_eq!(simplify(&square, 1.0), Ok(vec![0, 2, 4]));
    assert_eq!(simplify(&square, 1.5), Ok(vec![0, 4]));
}

#[test]
fn bad_input_is_refused_and_leaves_the_result_alone() {
    let good = vec![Vector2::new(0.0, 0.0); 4];
    for epsilon in [-1e-300, -1.0, f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
        let refused = simplify(&good, epsilon);
        assert!(
            matches!(refused, Err(LineExtractionError::Epsilon { value }) if value.to_bits() == epsilon.to_bits())
        );
        assert!(douglas_peucker(&good, epsilon, PointDistanceReference::Segment).is_err());
    }
    for bad in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY, 1.1e150, -1e308] {
        for at in 0..4 {
            let mut chain = good.clone();
            chain[at].y = bad;
            let mut kept = vec![7, 8, 9];
            let refused = PolylineSimplifier::default().simplify_into(&chain, 0.1, &mut kept);
            assert!(
                matches!(refused, Err(LineExtractionError::Point { index, .. }) if index == at),
                "{refused:?}"
            );
            assert_eq!(kept, [7, 8, 9]);
            assert!(douglas_peucker(&chain, 0.1, PointDistanceReference::Segment).is_err());
        }
    }
}

#[test]
fn short_chains_and_extreme_sizes() {
    assert_eq!(simplify(&[], 0.1), Ok(vec![]));
    assert_eq!(simplify(&[Vector2::new(1.0, 2.0)], 0.1), Ok(vec![0]));
    assert_eq!(simplify(&[Vector2::new(1.0, 2.0); 2], 0.0), Ok(vec![0, 1]));
    for unit in [1e-300, 1e-150, 1e-20, 1e149] {
        let chain: Chain =
            (0..300).map(|k| Vector2::new(f64::from(k), f64::from(k * k % 17)) * (unit / 300.0)).collect();
        assert_same(&chain, 0.0, "a chain of extreme size");
        assert!(douglas_peucker(&chain, 0.0, PointDistanceReference::Segment).is_ok());
    }
}

#[test]
fn ten_million_points() {
    let zigzag: Chain = (0..10_000_000)
        .map(|k| Vector2::new(f64::from(k), if k % 2 == 0 { 0.0 } else { 1e3 * (1.0 - f64::from(k) / 1e7) }))
        .collect();
    assert_eq!(simplify(&zigzag, 1e-6).map(|kept| kept.len()), Ok(zigzag.len()));
}
