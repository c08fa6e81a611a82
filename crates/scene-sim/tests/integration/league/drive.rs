//! A whole drive: reproducible, one sin at a time, kidnap_frames that nobody notices.

use approx::{abs_diff_eq, assert_abs_diff_eq};
use wayfix_estimation_traits::Pose2;
use wayfix_scene_sim::league::{
    CameraParams, LampSetting, LeagueDrive, LeagueFrame, LeagueParams, LeagueVenue,
};
use wayfix_scene_sim::random::RandomStreamPurpose;
use wayfix_sensor_log::RecordData;

use super::support::{deviation, honest, mean, streams};

fn frames(params: &LeagueParams, seed: u64) -> Vec<LeagueFrame> {
    LeagueDrive::new(params, streams(seed)).expect("sound parameters").collect()
}

fn with_camera(params: &LeagueParams, change: impl Fn(CameraParams) -> CameraParams) -> Vec<LeagueFrame> {
    let mut streams = streams(1);
    let venue = LeagueVenue::draw(streams.of(RandomStreamPurpose::Venue)).expect("a venue");
    let venue = LeagueVenue { camera: change(venue.camera), ..venue };
    LeagueDrive::in_venue(params, venue, streams).expect("sound parameters").collect()
}

#[test]
fn the_same_seed_gives_the_same_bits_and_another_seed_does_not() {
    let params = LeagueParams { n_frames: 5, ..LeagueParams::default() };
    assert_eq!(frames(&params, 1), frames(&params, 1));
    assert_ne!(frames(&params, 1), frames(&params, 2));
}

#[test]
fn more_frames_begin_with_the_same() {
    let params = |n_frames| LeagueParams { n_frames, ..LeagueParams::default() };
    assert_eq!(frames(&params(6), 1)[..4], frames(&params(4), 1));
}

#[test]
fn the_light_changes_the_pictures_and_nothing_else() {
    let bright = LeagueParams { n_frames: 6, ..LeagueParams::default() };
    let switched = LeagueParams {
        lamp_settings: vec![(2, LampSetting::Dark), (4, LampSetting::Bright)],
        ..bright.clone()
    };
    for (idx, (a, b)) in frames(&bright, 1).into_iter().zip(frames(&switched, 1)).enumerate() {
        assert_eq!(
            (a.pose, a.mount, a.odometry, &a.picture.labels),
            (b.pose, b.mount, b.odometry, &b.picture.labels)
        );
        let grey =
            |frame: &LeagueFrame| mean(&frame.picture.rgb.iter().map(|&c| f64::from(c)).collect::<Vec<_>>());
        let is_dark = b.lighting == LampSetting::Dark;
        assert_eq!(is_dark, (2..4).contains(&idx));
        assert_eq!(is_dark, grey(&b) < 0.7 * grey(&a), "{} {}", grey(&b), grey(&a));
        assert_eq!(is_dark, a.picture != b.picture, "same noise in the same light");
    }
}

#[test]
fn the_white_balance_drifts_as_asked_for() {
    let params = LeagueParams { n_frames: 60, period_ms: 500, ..LeagueParams::default() };
    let linear = |drift| {
        move |own: CameraParams| CameraParams {
            white_balance: own.white_balance,
            gain: 0.3 * own.gain, // far from saturation
            white_balance_drift_sigma: drift,
            white_balance_correlation_s: 0.1,
            ..honest()
        }
    };
    let sums = |frames: Vec<LeagueFrame>, channel: usize| -> Vec<f64> {
        let sum = |frame: &LeagueFrame| {
            frame.picture.rgb.iter().skip(channel).step_by(3).map(|&c| f64::from(c)).sum()
        };
        frames.iter().map(sum).collect()
    };
    for (channel, sigma) in [(0, 0.1), (1, 0.0), (2, 0.1)] {
        let (steady, drifting) = (
            sums(with_camera(&params, linear(0.0)), channel),
            sums(with_camera(&params, linear(0.1)), channel),
        );
        let logs: Vec<f64> = drifting.iter().zip(steady).map(|(d, s)| (d / s).ln()).collect();
        // 60 nearly independent draws; rounding to levels of about 30 is worth some thousandths.
        assert_abs_diff_eq!(deviation(&logs), sigma, epsilon = 4.0 * sigma / 120.0_f64.sqrt() + 0.005);
    }
}

#[test]
fn sins_of_the_camera_leave_the_drive_as_it_was() {
    let params = LeagueParams { n_frames: 4, ..LeagueParams::default() };
    let but_looks = |frames: Vec<LeagueFrame>| -> Vec<_> {
        frames.into_iter().map(|f| (f.pose, f.odometry, f.camera_pose, f.picture.labels)).collect()
    };
    let sinful = with_camera(&params, |own| own);
    let clean = with_camera(&params, |_| honest());
    assert_ne!(sinful, clean);
    assert_eq!(but_looks(sinful), but_looks(clean));
}

#[test]
fn kidnapped_robot_moves_without_odometry() {
    let params = LeagueParams { n_frames: 9, kidnap_frames: vec![3, 6], ..LeagueParams::default() };
    for seed in 1..6 {
        let frames = frames(&params, seed);
        for (idx, pair) in frames.windows(2).enumerate() {
            let moved = (pair[1].pose.translation - pair[0].pose.translation).norm();
            let said = pair[1].odometry.expect("after the first").1.translation.norm();
            assert_eq!(moved > 1.0, [3, 6].contains(&(idx + 1)), "moved {moved} before frame {}", idx + 1);
            assert!(said < 0.2, "{said} in 0.1 s");
        }
    }
}

#[test]
fn odometry_comes_between_the_frames() {
    let start = Pose2::new(0.3, -0.2, 1.0);
    let frames = frames(&LeagueParams { n_frames: 5, start: Some(start), ..LeagueParams::default() }, 1);
    assert_eq!(frames[0].odometry, None);
    assert!(
        abs_diff_eq!(frames[0].pose.translation, start.translation, epsilon = 1e-12),
        "it rests at first"
    );
    for pair in frames.windows(2) {
        let when = pair[1].odometry.expect("after the first").0;
        assert!(pair[0].milliseconds < when && when < pair[1].milliseconds);
    }
}

#[test]
fn the_log_has_its_records_in_order_and_labels_where_asked_for() {
    let params = LeagueParams { n_frames: 9, n_labelled_frames: 3, ..LeagueParams::default() };
    let records = params.simulate(streams(1)).expect("sound parameters");
    assert!(records.is_sorted_by_key(|record| record.stamp));
    let kinds: Vec<&str> = records.iter().map(|record| record.data.kind()).collect();
    assert_eq!(kinds[..3], ["camera info", "true pose", "camera mount"]);
    let count = |kind| kinds.iter().filter(|&&k| k == kind).count();
    assert_eq!((count("image"), count("true labels"), count("odometry increment")), (9, 3, 8));
    for pair in records.windows(2) {
        if let (RecordData::TrueLabels(labels), RecordData::Image(image)) = (&pair[0].data, &pair[1].data) {
            let (labels, image) = (labels.decode_gray().expect("PNG"), image.decode_rgb().expect("JPEG"));
            assert_eq!((labels.width, labels.height), (image.width, image.height));
            assert_eq!(pair[0].stamp, pair[1].stamp);
            assert!(labels.pixels.iter().all(|&label| label <= 5));
        }
    }
}
