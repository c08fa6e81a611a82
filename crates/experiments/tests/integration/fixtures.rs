//! The stored logs are what their seeds give, and whatever is not is named.

use std::fs;
use std::path::Path;

use wayfix_experiments::fixtures::{
    StoredFixture, StoredFixtureDifference, StoredFixtureError, build, check,
};
use wayfix_scene_sim::Scenario;
use wayfix_sensor_log::{LogOpenOptions, open};

const STORED: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../../fixtures");

fn differences(folder: &Path) -> Vec<StoredFixtureDifference> {
    match check(folder) {
        Err(StoredFixtureError::Differ(differences)) => differences,
        other => unreachable!("expected differences, got {other:?}"),
    }
}

#[test]
fn a_stored_log_reads_back_as_simulated() {
    use rand_chacha::{ChaCha8Rng, rand_core::SeedableRng};
    let with_camera = Scenario::in_color().into_iter().chain(Scenario::in_store());
    for scenario in Scenario::all().into_iter().chain(with_camera) {
        let simulated =
            scenario.simulate(ChaCha8Rng::seed_from_u64(scenario.seed)).expect("valid parameters");
        let path = Path::new(STORED).join(scenario.name).with_extension("mcap");
        let (records, report) = open(path, &LogOpenOptions::default()).expect("a log").read_all();
        assert_eq!(report.n_problems(), 0, "{}", scenario.name);
        assert_eq!(records, simulated, "{}", scenario.name);
    }
}

/// A copy of the stored logs: simulating them again costs seconds.
fn copied(folder: &Path) {
    for entry in fs::read_dir(STORED).expect("the stored logs") {
        let path = entry.expect("an entry").path();
        fs::copy(&path, folder.join(path.file_name().expect("a name"))).expect("copied");
    }
}

#[test]
fn what_differs_is_named() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    copied(folder.path());
    let stored = ["loop_known.mcap", "loop_unlabelled.mcap", "office_velocity.mcap"];
    let stored = stored.map(|name| folder.path().join(name));

    let mut bytes = fs::read(&stored[0]).expect("readable");
    bytes[100] ^= 1;
    fs::write(&stored[0], &bytes).expect("writable");
    fs::write(&stored[1], &fs::read(&stored[1]).expect("readable")[..50]).expect("writable");
    fs::remove_file(&stored[2]).expect("there");
    fs::write(folder.path().join("retired.mcap"), b"").expect("writable");

    let found = differences(folder.path());
    assert_eq!(found.len(), 4, "{found:?}");
    assert!(matches!(found[0], StoredFixtureDifference::Content { first_byte: 100, .. }), "{}", found[0]);
    assert!(
        matches!(found[1], StoredFixtureDifference::Content { first_byte: 50, stored_bytes: 50, .. }),
        "{}",
        found[1]
    );
    assert_eq!(found[2], StoredFixtureDifference::Missing { path: stored[2].clone() });
    assert_eq!(found[3], StoredFixtureDifference::Stray { path: folder.path().join("retired.mcap") });
}

#[test]
fn building_gives_the_stored_bytes_which_are_few() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let nowhere = folder.path().join("not").join("yet");
    assert!(differences(&nowhere).iter().all(|d| matches!(d, StoredFixtureDifference::Missing { .. })));
    let built = build(&nowhere).expect("built");
    assert!(built.len() > 10);
    for StoredFixture { path, n_bytes, .. } in &built {
        let bytes = fs::read(path).expect("written");
        let stored = fs::read(Path::new(STORED).join(path.file_name().expect("a name"))).expect("stored");
        assert!(bytes.len() == *n_bytes && bytes == stored, "{}", path.display());
    }
    // Logs without a camera or a laser stay below 1 MB, that with a laser below 3 MB, all together below 20 MB.
    let with_camera = |log: &StoredFixture| {
        ["color_", "store_", "film_", "scene_"].iter().any(|kind| log.name.starts_with(kind))
    };
    let most = |log: &StoredFixture| if log.name == "office_laser" { 3_000_000 } else { 1_000_000 };
    assert!(built.iter().all(|log| with_camera(log) || log.n_bytes < most(log)), "{built:?}");
    assert!(built.iter().map(|log| log.n_bytes).sum::<usize>() < 20_000_000, "{built:?}");
    let a_file = folder.path().join("file");
    fs::write(&a_file, b"").expect("writable");
    assert!(matches!(build(&a_file), Err(StoredFixtureError::Io { .. })));
}
