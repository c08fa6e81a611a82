//! Same seed, same log; another seed, another log; one sin more, the same draws for all others.

use crate::support::{looks, run, streams, world};
use wayfix_scene_sim::random::NoiseShape;
use wayfix_scene_sim::sensor::RangeBearingParams;
use wayfix_scene_sim::sensor::range_bearing::{
    Clutter, ClutterIdentity, CorrelatedErrorParams, RangeDependentSigma,
};
use wayfix_scene_sim::{Scenario, ScenarioParams};
use wayfix_sensor_log::{Detection, DetectionTarget, Record, RecordData};

#[test]
fn the_same_seed_gives_the_same_bits_and_another_seed_does_not() {
    for scenario in Scenario::all() {
        let first = run(scenario.name, scenario.seed);
        assert_eq!(first, run(scenario.name, scenario.seed), "{}", scenario.name);
        assert_ne!(first, run(scenario.name, scenario.seed + 1), "{}", scenario.name);
        assert!(first.is_sorted_by_key(|record| record.stamp), "{}", scenario.name);
    }
}

/// Detections of the one landmark, look by look, with whatever sins.
fn of_the_landmark(params: RangeBearingParams) -> Vec<Option<Detection>> {
    let two = world(&[(5.0, 0.0), (0.0, 5.0)]);
    let of_it = |look: Vec<Detection>| look.into_iter().find(|s| s.target == DetectionTarget::Landmark(0));
    looks(params, &two, 500, &mut streams(3)).into_iter().map(|look| look.and_then(of_it)).collect()
}

#[test]
fn switching_one_sin_on_leaves_the_draws_of_the_others() {
    let honest = RangeBearingParams::default();
    let plain = of_the_landmark(honest);
    for (what, sinful) in [
        ("drop-outs", RangeBearingParams { scan_dropout_share: 0.3, ..honest }),
        ("misses", RangeBearingParams { missed_target_share: 0.3, ..honest }),
        (
            "clutter",
            RangeBearingParams {
                clutter: Clutter { mean: 2.0, label: ClutterIdentity::Unlabelled },
                ..honest
            },
        ),
        ("outliers", RangeBearingParams { outlier_share: 0.3, ..honest }),
        ("mislabelling", RangeBearingParams { mislabelled_share: 0.3, ..honest }),
    ] {
        let pairs: Vec<_> = plain.iter().zip(of_the_landmark(sinful)).collect();
        let same = pairs.iter().filter(|(plain, sinful)| **plain == *sinful).count();
        // Binomial with share 0.7 (for mislabelling a little less: the other landmark may lend its detection).
        assert!(same >= 280, "{what} disturbed {} of 500 looks", 500 - same);
        assert!(same < 500 || what == "clutter", "{what} did nothing");
    }
}

#[test]
fn drift_and_tails_leave_the_other_draws_too() {
    let honest = RangeBearingParams::default();
    let bearings =
        |params| -> Vec<f64> { of_the_landmark(params).iter().flatten().map(|s| s.bearing).collect() };
    let range = RangeDependentSigma { constant_m: 0.3, per_meter: 0.0 };
    let drift = CorrelatedErrorParams { range_sigma: range, ..CorrelatedErrorParams::default() };
    assert_eq!(bearings(honest), bearings(RangeBearingParams { drift, ..honest }));
    let missed = |params| -> Vec<bool> { of_the_landmark(params).iter().map(Option::is_none).collect() };
    let missing = RangeBearingParams { missed_target_share: 0.3, ..honest };
    assert_eq!(missed(missing), missed(RangeBearingParams { noise_shape: NoiseShape::Laplace, ..missing }));
}

#[test]
fn sensor_sins_leave_the_drive_as_it_was() {
    let mut scenario = Scenario::named("rough_known").expect("a known name");
    let simulate = |scenario: &Scenario| {
        use rand_chacha::{ChaCha8Rng, rand_core::SeedableRng};
        scenario.simulate(ChaCha8Rng::seed_from_u64(4)).expect("valid parameters")
    };
    let but_sightings = |records: Vec<Record>| -> Vec<Record> {
        records.into_iter().filter(|r| !matches!(r.data, RecordData::Detections(_))).collect()
    };
    let sinful = simulate(&scenario);
    let ScenarioParams::Planar(params) = &mut scenario.params else { panic!("planar") };
    params.sensor = RangeBearingParams::default();
    params.n_unknown_codes = 0;
    let honest = simulate(&scenario);
    assert_ne!(sinful, honest);
    assert_eq!(but_sightings(sinful), but_sightings(honest));
}
