//! The index answers as the linear scan does, to the bit, whatever was inserted and removed before.
#![expect(clippy::unwrap_used, reason = "a panic is the verdict of a test, in its helpers too")]

use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use wayfix_appearance_cml::{
    AppearanceIndex, AppearanceMapError, LinearSearch, LowerBoundTable, LowerBoundedDistance,
    PanoramaDescriptor, PanoramaLowerBoundTable, ReferenceId, ReferenceSearch, ViewDescriptor,
};

const QUERY_SEED: u64 = 17;
const N_RINGS: usize = 9;
const N_HARMONICS: usize = 12;

/// Views along random ways: each a step from the one before, as a robot's are, now and then somewhere else.
struct Walk {
    rng: ChaCha8Rng,
    spectrum: Vec<f64>,
}

impl Walk {
    fn new(seed: u64) -> Self {
        Self { rng: ChaCha8Rng::seed_from_u64(seed), spectrum: vec![0.0; N_RINGS * (2 * N_HARMONICS - 1)] }
    }

    fn next(&mut self) -> PanoramaDescriptor {
        let jump = self.rng.random_bool(0.03);
        let step = if jump { 1.0 } else { 0.15 };
        for (index, value) in self.spectrum.iter_mut().enumerate() {
            // Slow harmonics are stronger, as in views.
            let harmonic = (index / N_RINGS).div_ceil(2);
            let strength = 1.0 / (1.0 + harmonic as f64);
            let fresh: f64 = strength * self.rng.random_range(-1.0..1.0);
            *value = (1.0 - step) * *value + step * fresh;
        }
        let largest = self.spectrum.iter().fold(1e-6_f64, |largest, value| largest.max(value.abs()));
        let bytes = self.spectrum.iter().map(|value| (127.0 * value / largest).round() as i8).collect();
        let energy: f64 = self.spectrum.iter().map(|value| value * value).sum();
        // Of energy 1, as normalized views have about.
        let scale = largest / 127.0 / energy.sqrt().max(1e-6);
        PanoramaDescriptor::from_parts(scale as f32, N_RINGS as u8, bytes).unwrap()
    }
}

/// Returns how many references all queries found.
fn check(n_references: u32, n_queries: usize, seed: u64) -> usize {
    let mut walk = Walk::new(seed);
    let (mut index, mut linear) = (AppearanceIndex::default(), LinearSearch::default());
    let mut seen: Vec<PanoramaDescriptor> = Vec::new();
    let mut rng = ChaCha8Rng::seed_from_u64(seed + 1);
    for id in 0..n_references {
        // Now and then the same view again: equally near references are told by their numbers.
        let again = !seen.is_empty() && rng.random_bool(0.05);
        let view = if again { seen[rng.random_range(0..seen.len())].clone() } else { walk.next() };
        seen.push(view.clone());
        index.insert(ReferenceId(id), view.clone()).unwrap();
        linear.insert(ReferenceId(id), view).unwrap();
        if rng.random_bool(0.3) {
            let gone = ReferenceId(rng.random_range(0..=id));
            assert_eq!(index.remove(gone), linear.remove(gone));
        }
        assert_eq!(index.len(), linear.len());
    }
    let mut n_found = 0;
    for query in 0..n_queries {
        let view = if query % 2 == 0 { walk.next() } else { seen[rng.random_range(0..seen.len())].clone() };
        let radius = rng.random_range(0.0..1.1);
        let n = rng.random_range(1..8);
        let within = index.within(&view, radius);
        n_found += within.len();
        assert_eq!(within, linear.within(&view, radius), "query {query}");
        assert_eq!(index.nearest(&view, n), linear.nearest(&view, n), "query {query}");
        assert_eq!(
            index.nearest_within(&view, n, radius),
            linear.nearest_within(&view, n, radius),
            "query {query}"
        );
        let some: Vec<ReferenceId> = (0..n_references + 3).step_by(3).map(ReferenceId).collect();
        assert_eq!(
            index.within_among(&view, &some, radius),
            linear.within_among(&view, &some, radius),
            "query {query}"
        );
    }
    n_found
}

#[test]
fn answers_are_those_of_the_linear_scan() {
    let sizes = [1, 5, 40, 300, 1500].into_iter().enumerate();
    let n_found: usize = sizes.map(|(seed, size)| check(size, 150, QUERY_SEED + 100 * seed as u64)).sum();
    assert!(n_found > 1000, "the radii find something: {n_found}");
}

/// A minute or two; run with `--ignored`.
#[test]
#[ignore = "100 000 queries take minutes"]
fn answers_are_those_of_the_linear_scan_100_000_times() {
    for seed in 0..50 {
        assert!(check(600, 2000, 1000 + seed) > 1000);
    }
}

#[test]
fn bounds_keep_their_order() {
    let mut walk = Walk::new(QUERY_SEED);
    let views: Vec<PanoramaDescriptor> = (0..120).map(|_| walk.next()).collect();
    let mut table = PanoramaLowerBoundTable::default();
    views.iter().enumerate().for_each(|(slot, view)| table.put(slot, view));
    for (a, b) in (0..120 * 120).map(|pair| (pair / 120, pair % 120)) {
        let bound = views[b].bound(&views[a].probe(), f64::INFINITY);
        let comparison = views[a].compare(&views[b]);
        assert_eq!(views[b].compare_with(&views[a].probe()), comparison);
        let distance = comparison.distance;
        // Single precision of sums near 1, and the root of their difference: 1e-6, near 0 its root.
        assert!(bound <= distance + 1e-7, "{bound} {distance}");
        let rough = table.may_be_within(b, &views[a].probe(), f64::INFINITY).unwrap();
        assert!(rough <= bound + 2e-3 && rough <= distance, "{rough} {bound} {distance}");
        assert!(table.may_be_within(b, &views[a].probe(), distance).is_some());
        let early = views[b].bound(&views[a].probe(), 0.3);
        assert!(early <= bound + 1e-5 && (early > 0.3) == (bound > 0.3), "{early} {bound}");
    }
}

#[test]
fn numbers_and_shapes_that_do_not_fit_are_refused() {
    let mut index = AppearanceIndex::default();
    let view = Walk::new(1).next();
    let other = PanoramaDescriptor::from_parts(0.01, 1, vec![1; 3]).unwrap();
    assert!(index.nearest(&view, 3).is_empty() && index.within(&view, f64::INFINITY).is_empty());
    index.insert(ReferenceId(7), view.clone()).unwrap();
    assert_eq!(
        index.insert(ReferenceId(7), view.clone()),
        Err(AppearanceMapError::DuplicateReference { id: 7 })
    );
    assert_eq!(index.insert(ReferenceId(8), other.clone()), Err(AppearanceMapError::Incomparable { id: 8 }));
    assert!(index.nearest(&other, 1).is_empty() && index.nearest(&view, 0).is_empty());
    for radius in [f64::NAN, -1.0, 0.0, f64::NEG_INFINITY] {
        assert!(index.within(&view, radius).is_empty(), "{radius}");
        assert!(index.nearest_within(&view, 3, radius).is_empty(), "{radius}");
    }
    assert_eq!(index.within(&view, f64::INFINITY).len(), 1);
    assert_eq!(index.remove(ReferenceId(8)), None);
    assert_eq!(index.remove(ReferenceId(7)), Some(view));
    assert!(index.is_empty() && index.get(ReferenceId(7)).is_none());
    index.insert(ReferenceId(8), other).unwrap();
}
