//! A map comes back from its bytes as it was; bytes that were changed, cut short or written elsewhere are refused with their reason.
#![expect(clippy::unwrap_used, reason = "a panic is the verdict of a test, in its helpers too")]

use nalgebra::Vector3;
use wayfix_appearance_cml::{
    AppearanceIndex, AppearanceMap, ArchivedDescriptorFormat, IntensityScale, MapArchive, MapArchiveAppender,
    MapArchiveCompleteness, MapArchiveError, PanoramaDescriptor, PanoramaDescriptorParams, ReferenceSearch,
    ViewDifferenceSample,
};
use wayfix_estimation_traits::Pose2;
use wayfix_gaussian_core::{Gaussian, GaussianMixture};

type Map = AppearanceMap<PanoramaDescriptor, AppearanceIndex<PanoramaDescriptor>>;
type Parts = (Map, Option<GaussianMixture<Pose2<f64>>>);

fn params() -> ArchivedDescriptorFormat {
    ArchivedDescriptorFormat { views: PanoramaDescriptorParams::default(), size: (120, 3) }
}

fn pose(step: usize) -> Gaussian<Pose2<f64>> {
    let mean = Pose2::new(0.3 * step as f64, -1.0, 0.1 * step as f64);
    Gaussian::from_sigmas(mean, &Vector3::new(0.1, 0.2, 0.05)).unwrap()
}

fn view(step: usize) -> PanoramaDescriptor {
    let coefficients = (0..9).map(|i| ((step * 37 + i * 11) % 250) as i64 - 125).map(|value| value as i8);
    PanoramaDescriptor::from_parts(0.01, 3, coefficients.collect()).unwrap()
}

fn learn(map: &mut Map, steps: std::ops::Range<usize>) {
    for step in steps {
        map.teach(view(step), &pose(step)).unwrap();
        map.scale_mut().add_near(ViewDifferenceSample { lag: 0.3, distance: 0.2 + 0.001 * step as f64 });
        map.scale_mut().add_far(1.0 + 0.001 * step as f64);
    }
}

fn map() -> Map {
    let mut map = Map::default();
    learn(&mut map, 0..6);
    map
}

fn state() -> GaussianMixture<Pose2<f64>> {
    GaussianMixture::from_weights(vec![(0.75, pose(2)), (0.25, pose(5))]).unwrap()
}

fn assert_same(parts: &Parts, map: &Map, state: Option<&GaussianMixture<Pose2<f64>>>) {
    assert_eq!(parts.0.references(), map.references());
    assert_eq!(parts.0.scale(), map.scale());
    assert_eq!(parts.0.next_id(), map.next_id());
    for id in map.references().keys() {
        assert_eq!(parts.0.search().get(*id), map.search().get(*id));
    }
    let components = |state: &GaussianMixture<Pose2<f64>>| state.components().to_vec();
    assert_eq!(parts.1.as_ref().map(components), state.map(components));
}

fn bytes() -> Vec<u8> {
    MapArchive::to_bytes(&params(), &map(), Some(&state()))
}

#[test]
fn what_was_saved_comes_back() {
    let archive = MapArchive::from_bytes(&bytes()).unwrap();
    assert_eq!(
        (archive.end(), archive.len(), archive.params()),
        (MapArchiveCompleteness::Whole, 6, &params())
    );
    assert_same(&archive.into_map(&params()).unwrap(), &map(), Some(&state()));
}

#[test]
fn a_journal_brings_the_map_up_to_date() {
    let mut map = map();
    let mut bytes = MapArchive::to_bytes(&params(), &map, None);
    let mut journal = MapArchiveAppender::after(&map);
    let before = bytes.len();
    learn(&mut map, 6..9);
    bytes.extend(journal.changes(&map, Some(&state())));
    assert!(bytes.len() - before < before, "only what is new is appended");
    let unchanged = journal.changes(&map, None);
    bytes.extend(&unchanged);
    let parts: Parts = MapArchive::from_bytes(&bytes).unwrap().into_map(&params()).unwrap();
    assert_same(&parts, &map, None);
    // The scale and the state come with every call, the references do not.
    assert!(unchanged.len() < 8 + 5 + 16 + 9 * (16 + 8) + 8 + 5 + 16, "{}", unchanged.len());
}

#[test]
fn a_cut_anywhere_in_an_entry_leaves_what_is_before_it() {
    let whole = bytes();
    let mut lengths = std::collections::BTreeSet::new();
    for length in 0..whole.len() {
        match MapArchive::from_bytes(&whole[..length]) {
            Ok(archive) => {
                if let MapArchiveCompleteness::Interrupted { whole_bytes } = archive.end() {
                    let again = MapArchive::from_bytes(&whole[..whole_bytes]).unwrap();
                    assert_eq!((again.end(), again.len()), (MapArchiveCompleteness::Whole, archive.len()));
                }
                let n = archive.len();
                let parts: Parts = archive.into_map(&params()).unwrap();
                assert_eq!(parts.0.len(), n);
                lengths.insert(n);
            }
            Err(error) => {
                let early = matches!(error, MapArchiveError::NotAMap | MapArchiveError::Header);
                assert!(early && length < 70, "{length}: {error}");
            }
        }
    }
    assert_eq!(lengths, (0..=6).collect());
}

#[test]
fn zeros_at_the_end_are_what_was_not_written() {
    let whole = bytes();
    let longer = [&whole[..], &[0; 100]].concat();
    let archive = MapArchive::from_bytes(&longer).unwrap();
    assert_eq!(archive.end(), MapArchiveCompleteness::Interrupted { whole_bytes: whole.len() });
    assert_eq!(archive.len(), 6);
}

#[test]
fn every_flipped_bit_is_found() {
    let whole = bytes();
    for bit in 0..8 * whole.len() {
        let mut flipped = whole.clone();
        flipped[bit / 8] ^= 1 << (bit % 8);
        match MapArchive::from_bytes(&flipped) {
            Err(error) => match bit / 64 {
                0 => assert_eq!(error, MapArchiveError::NotAMap),
                _ => assert!(
                    !matches!(error, MapArchiveError::NotAMap | MapArchiveError::Content { .. }),
                    "{bit}: {error}"
                ),
            },
            // The length of the last entry, made larger, is an entry cut short: nothing can follow it.
            Ok(archive) => {
                assert!(matches!(archive.end(), MapArchiveCompleteness::Interrupted { .. }), "bit {bit}");
            }
        }
    }
}

#[test]
fn another_version_and_other_parameters_are_named() {
    let mut newer = bytes();
    newer[8] = 9;
    assert_eq!(MapArchive::from_bytes(&newer).unwrap_err(), MapArchiveError::Version { found: 9, known: 3 });
    let good = params();
    for (params, named) in [
        (ArchivedDescriptorFormat { size: (240, 3), ..good }, "size of the panorama"),
        (
            ArchivedDescriptorFormat {
                views: PanoramaDescriptorParams { intensity_scale: IntensityScale::Linear, ..good.views },
                ..good
            },
            "intensity_scale",
        ),
        (
            ArchivedDescriptorFormat {
                views: PanoramaDescriptorParams { n_harmonics: 8, ..good.views },
                ..good
            },
            "n_harmonics",
        ),
        (
            ArchivedDescriptorFormat {
                views: PanoramaDescriptorParams { smoothing_sigma: 0.0, ..good.views },
                ..good
            },
            "smoothing_sigma",
        ),
    ] {
        let refused = MapArchive::from_bytes(&bytes()).unwrap().into_map::<AppearanceIndex<_>>(&params);
        assert!(matches!(refused, Err(MapArchiveError::Parameters { what, .. }) if what == named), "{named}");
    }
}

/// With recomputed checksums, the checks of the parts decide: an error or a map, never a panic.
#[test]
fn forged_entries_never_panic() {
    let whole = bytes();
    let header = 8 + 4 + 4 + 47 + 4;
    let mut n_refused = 0;
    for place in header..whole.len() {
        let mut forged = whole.clone();
        forged[place] ^= 0x80;
        let mut at = header;
        while let Some(length) = forged.get(at..at + 4) {
            let length = u32::from_le_bytes(length.try_into().unwrap()) as usize;
            let Some(content) = forged.get(at + 8..(at + 8).saturating_add(length)) else { break };
            let sum = crc32fast::hash(content).to_le_bytes();
            forged[at + 4..at + 8].copy_from_slice(&sum);
            at += 8 + length;
        }
        let loaded = MapArchive::from_bytes(&forged)
            .and_then(|archive| archive.into_map::<AppearanceIndex<_>>(&params()));
        n_refused += usize::from(loaded.is_err());
    }
    assert!(n_refused > 0, "some forgeries must be found");
}
