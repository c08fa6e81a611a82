//! The projector against rays cast one by one, which share no code with it: every pixel of every view must agree.
#![cfg(feature = "serde")]

mod support;

use std::sync::Arc;

use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use support::{cast_labels, field, random_pose};
use wayfix_color_map::{Camera, Projector};

#[test]
fn random_views_of_the_field() {
    let mut rng = ChaCha8Rng::seed_from_u64(41);
    let map = Arc::new(field());
    for i in 0..1000 {
        let (width, height) = (rng.random_range(1..140), rng.random_range(1..80));
        let camera = Camera::new(
            width,
            height,
            rng.random_range(20.0..200.0),
            rng.random_range(20.0..200.0),
            f64::from(width) * rng.random_range(-0.2..1.2),
            f64::from(height) * rng.random_range(-0.2..1.2),
        )
        .unwrap();
        let pose = random_pose(&mut rng, 3.0);
        let got = Projector::new(Arc::clone(&map), camera).labels(&pose).unwrap();
        let expected = cast_labels(&map, &camera, &pose);
        assert_eq!(support::first_difference(&got, &expected), None, "view {i}: {pose:?} {camera:?}");
    }
}
