//! What a summary says.
#![allow(clippy::unwrap_used, reason = "a test that cannot read its log has failed")]

use wayfix_sensor_log::{LogOpenOptions, LogSummary, open};

#[test]
fn a_person_reads_what_the_log_holds_and_where_it_errs() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("walk.txt");
    std::fs::write(&path, "L 7 1 1\nO 1 0 0\nZ 7 2 0.1\nZ 8 2 0.1\nO 1 0 0\nZ ? 3 0.2\nZ 7 far 0\n").unwrap();
    let text = LogSummary::of(open(&path, &LogOpenOptions::default()).unwrap()).to_string();
    let lines: Vec<&str> = text.lines().map(str::trim).collect();
    assert!(lines[0].ends_with("walk.txt: range-bearing, 0.1 s"), "{text}");
    assert!(lines[1..4].contains(&"odometry increment         2 records     10.0 Hz"), "{text}");
    let seen = "seen 3 times: 2 landmarks with identity, 1 of them with true position; 1 times something without identity";
    assert_eq!(lines[4], seen);
    assert_eq!(
        lines[5..],
        ["6 rows read, 1 problems", "not a number: 1", "walk.txt:7: \"far\" is not a number"]
    );
}

#[test]
fn scans_are_told_with_their_beams_and_what_did_not_come_back() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("walk.log");
    let (near, far) = ("1 ".repeat(90), "81.91 ".repeat(90));
    std::fs::write(&path, format!("FLASER 180 {near}{far}0 0 0 0 0 0 1 host 1\nNEFF 30\n")).unwrap();
    let text = LogSummary::of(open(&path, &LogOpenOptions::default()).unwrap()).to_string();
    assert!(text.contains("walk.log: carmen, 0.0 s\n"), "{text}");
    assert!(text.contains("laser scans: 1 of 180 beams; 50.0 % of the beams without echo\n"), "{text}");
    assert!(text.contains("ignored NEFF: 1 messages\n"), "{text}");
}
