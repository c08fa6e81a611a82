//! Whatever a log, a file of parameters or a command line holds: no panic, and either one line that says what to do or figures of
//! the rest with everything that was left out counted and named.

use std::{fs, path::Path};

use crate::common::{Outcome, Scratch, run_slam, utias_walk, walk, walk_without_truth, wayfix};

fn refused(outcome: &Outcome, what_to_do: &str) {
    assert_eq!(outcome.code, 1, "{outcome:?}");
    assert_eq!(outcome.stdout, "");
    assert!(outcome.stderr.starts_with("error: "), "{}", outcome.stderr);
    assert_eq!(outcome.stderr.lines().count(), 1, "{}", outcome.stderr);
    assert!(outcome.stderr.contains(what_to_do), "{}", outcome.stderr);
}

/// A walk with one more line after those of its tenth step.
fn walk_with(line: &str) -> (String, usize) {
    let text = walk(40);
    let tenth_pose = text.lines().enumerate().filter(|(_, line)| line.starts_with('P')).nth(10);
    let (before, _) = tenth_pose.expect("forty poses");
    let mut lines: Vec<&str> = text.lines().collect();
    lines.insert(before, line);
    (lines.join("\n"), before + 1)
}

#[test]
fn non_numeric_rows_are_named_and_figures_stay() {
    let scratch = Scratch::new();
    let clean = run_slam(&scratch.file("walk.txt", walk(40)), &[]).figures();
    for line in
        ["O nan 0 0", "O 0.1 inf 0", "O 0 0 -inf", "Z 11 nan 0.1", "Z 11 2 inf", "Z 11 far 0", "P 1 NaN 0"]
    {
        let (text, number) = walk_with(line);
        let outcome = run_slam(&scratch.file("bad.txt", text), &[]);
        assert_eq!(outcome.event("log_problem"), 1, "{line}");
        assert!(outcome.stderr.contains(&format!("bad.txt:{number}: ")), "{line}: {}", outcome.stderr);
        assert_eq!(outcome.figures(), clean, "{line}");
    }
}

#[test]
fn invalid_detections_and_motions_leave_the_filter_unchanged() {
    let scratch = Scratch::new();
    let clean = run_slam(&scratch.file("walk.txt", walk(40)), &[]).figures();
    for (line, event) in [
        ("Z 99 0 0.1", "observation_unusable"),
        ("Z 99 -2 0.1", "observation_unusable"),
        ("Z 99 1e200 0.1", "observation_unusable"),
        ("O 1e300 0 0", "record_refused"),
        ("O 1e30 0 0", "record_refused"),
    ] {
        let outcome = run_slam(&scratch.file("bad.txt", walk_with(line).0), &[]);
        assert_eq!((outcome.event(event), outcome.metric("n_rejected")), (1, 1.0), "{line}");
        assert!(outcome.stderr.contains("refused record "), "{line}: {}", outcome.stderr);
        let rest = |figures: Vec<(String, f64)>| {
            figures.into_iter().filter(|(name, _)| name != "n_rejected").collect::<Vec<_>>()
        };
        assert_eq!(rest(outcome.figures()), rest(clean.clone()), "{line}");
    }
}

#[test]
fn ranges_beyond_reason_do_not_carry_the_map_away() {
    let scratch = Scratch::new();
    for line in ["Z 99 1e15 0.1", "Z 99 1e100 0.1", "Z 11 1e15 0.1", "Z 11 1e100 0.1", "Z 11 1e308 0.1"] {
        let outcome = run_slam(&scratch.file("bad.txt", walk_with(line).0), &[]);
        // The walk has no noise; an error of 1 cm would be the line's doing.
        assert!(outcome.metric("ate_rmse_m") < 0.01, "{line}: {outcome:?}");
    }
}

#[test]
fn an_identity_seen_twice_in_one_look_counts_once() {
    let scratch = Scratch::new();
    let text = walk(40);
    let clean = run_slam(&scratch.file("walk.txt", &text), &[]);
    let doubled: String = text
        .lines()
        .flat_map(|line| std::iter::repeat_n(line, if line.starts_with('Z') { 2 } else { 1 }))
        .flat_map(|line| [line, "\n"])
        .collect();
    let outcome = run_slam(&scratch.file("doubled.txt", doubled), &[]);
    let n_detections = text.lines().filter(|line| line.starts_with('Z')).count();
    assert_eq!(outcome.event("observation_duplicate"), n_detections as u64);
    assert_eq!(outcome.metric("n_rejected"), n_detections as f64);
    assert!(outcome.stderr.contains("a second time in one scan"), "{}", outcome.stderr);
    assert!(outcome.stderr.contains(&format!("and {} more", n_detections - 20)), "{}", outcome.stderr);
    assert_eq!(outcome.metric("ate_rmse_m"), clean.metric("ate_rmse_m"));
}

#[test]
fn rows_that_go_back_in_time_are_sorted_and_named() {
    let scratch = Scratch::new();
    let folder = utias_walk(&scratch, "set", 1, 100);
    let clean = run_slam(&folder, &[]);
    let path = folder.join("Robot1_Odometry.dat");
    let text = fs::read_to_string(&path).expect("written above");
    let mut lines: Vec<&str> = text.lines().collect();
    lines.swap(10, 20);
    scratch.file("set/Robot1_Odometry.dat", lines.join("\n"));
    let outcome = run_slam(&folder, &[]);
    assert!(outcome.stderr.contains("Robot1_Odometry.dat:12: "), "{}", outcome.stderr);
    assert_eq!(outcome.event("log_problem"), 2);
    assert_eq!(outcome.figures(), clean.figures());
}

#[test]
fn log_without_usable_records_is_refused_with_a_reason() {
    let scratch = Scratch::new();
    let walk = walk(20);
    let only = |kinds: &[char]| -> String {
        walk.lines().filter(|line| line.starts_with(kinds)).flat_map(|line| [line, "\n"]).collect()
    };
    let zero_ranges: String = (0..9).map(|step| format!("O 0.1 0 0\nZ {step} 0 0.1\n")).collect();
    for (text, what_to_do) in [
        (String::new(), "holds no record"),
        ("# nothing\n\n".to_owned(), "holds no record"),
        ("Dear sir,\n".to_owned(), "name the format: utias, range-bearing"),
        (only(&['L', 'P', 'Z']), "no odometry"),
        (only(&['L', 'P', 'O']), "no range-bearing detections of landmarks"),
        (only(&['L', 'P']), "no odometry"),
        (zero_ranges, "a range of 0 m"),
        ("1 0 0 0 0 0 0 1\n2 0 0 0 0 0 0 1\n".to_owned(), "no odometry"),
    ] {
        refused(&run_slam(&scratch.file("log.txt", text), &[]), what_to_do);
    }
    let unlabelled = scratch.file("unlabelled.txt", "O 1 0 0\nZ ? 2 0.1\nO 1 0 0\nZ ? 1 0.2\n");
    refused(&run_slam(&unlabelled, &["--association", "known"]), "--association nn");
    assert_eq!(run_slam(&unlabelled, &[]).code, 0);

    let folder = utias_walk(&scratch, "set", 1, 50);
    let barcodes: String = (1..=5).map(|robot| format!("{robot} {}\n", 59 + robot)).collect();
    scratch.file("set/Barcodes.dat", barcodes);
    refused(&run_slam(&folder, &[]), "no range-bearing detections of landmarks");
}

#[test]
fn paths_that_are_no_logs_are_refused_with_what_to_give_instead() {
    let scratch = Scratch::new();
    refused(&run_slam(&scratch.path("absent.mcap"), &[]), "no such file or folder");
    refused(&run_slam(&scratch.path(""), &[]), "give a log file, the folder of a UTIAS set or of images");
    fs::create_dir(scratch.path("folder.mcap")).expect("a new folder");
    refused(&run_slam(&scratch.path("folder.mcap"), &["--format", "mcap"]), "is a folder");

    utias_walk(&scratch, "set", 1, 50);
    let set = utias_walk(&scratch, "set", 3, 50);
    refused(&run_slam(&set, &[]), "holds the robots [1, 3]; choose one (--robot N)");
    refused(&run_slam(&set, &["--robot", "2"]), "holds the robots [1, 3]");
    fs::remove_file(set.join("Robot3_Odometry.dat")).expect("written above");
    refused(&run_slam(&set, &["--robot", "3"]), "Robot3_Odometry.dat: no such file");
}

#[test]
fn garbage_with_an_mcap_name_is_refused() {
    let scratch = Scratch::new();
    // xorshift64 [Marsaglia 2003]: bytes that mean nothing, the same in every run
    let mut state = 88_172_645_463_325_252_u64;
    let mut garbage: Vec<u8> = std::iter::repeat_with(|| {
        state ^= state << 13;
        state ^= state >> 7;
        state ^= state << 17;
        state as u8
    })
    .take(1 << 20)
    .collect();
    refused(&run_slam(&scratch.file("noise.mcap", &garbage), &[]), "no log of the format mcap");
    garbage.splice(..8, *b"\x89MCAP0\r\n");
    refused(&run_slam(&scratch.file("noise.mcap", &garbage), &[]), "before the first record");
    refused(&run_slam(&scratch.file("empty.mcap", ""), &[]), "holds no record");
}

#[test]
fn a_log_cut_short_still_runs_and_says_how_much_is_missing() {
    let scratch = Scratch::new();
    let (text, mcap) = (scratch.file("walk.txt", walk(60)), scratch.path("walk.mcap"));
    assert_eq!(wayfix([Path::new("convert"), &text, &mcap]).code, 0);
    let bytes = fs::read(&mcap).expect("written by convert");
    let cut = scratch.file("cut.mcap", &bytes[..bytes.len() / 2]);
    let outcome = run_slam(&cut, &[]);
    assert!(outcome.stderr.contains("breaks off after"), "{}", outcome.stderr);
    assert!(outcome.stderr.contains("are missing"), "{}", outcome.stderr);
    assert_eq!(outcome.event("log_incomplete"), 1);
    assert!(outcome.metric("n_landmarks") >= 1.0);
}

#[test]
fn parameters_that_make_no_sense_are_refused_by_name() {
    let scratch = Scratch::new();
    let log = scratch.file("walk.txt", walk_without_truth(20));
    for (text, key) in [
        ("[filter]\ngate_probability = 2", "gate_probability"),
        ("[filter]\ngate_probability = nan", "gate_probability"),
        ("[sensor]\nbearing_sigma = -0.1", "sensor.bearing_sigma"),
        ("[sensor]\nrange_sigma = nan", "sensor.range_sigma"),
        ("[sensor]\nrange_sigma = 0", "sensor.range_sigma"),
        ("[increment_noise]\nheading_variance_per_step = inf", "increment_noise.heading_variance_per_step"),
        ("[robot]\ncommand_delay = 1e300", "robot.command_delay"),
        ("[nearest_neighbour]\ngate_nis = -1", "gate_nis"),
        ("[sensor]\nrange_sgima = 1", "line 2, column 1"),
        ("colour = 1", "line 1, column 1"),
        ("[sensor]\nrange_sigma = 'small'", "line 2, column 15"),
        ("[sensor]\nrange_sigma = 'small'", "2 | range_sigma = 'small'"),
        ("association = 'icp'", "association"),
        ("[sensor", "line 1"),
    ] {
        let file = scratch.file("params.toml", text);
        let outcome = run_slam(&log, &["--params", file.to_str().expect("a plain path")]);
        assert_eq!((outcome.code, outcome.stdout.as_str()), (1, ""), "{text}");
        assert!(outcome.stderr.starts_with("error: "), "{text}: {}", outcome.stderr);
        assert!(outcome.stderr.contains(key), "{text}: {}", outcome.stderr);
    }
    refused(&run_slam(&log, &["--params", "nowhere.toml"]), "nowhere.toml");
}

#[test]
fn a_wrong_command_line_ends_with_2_and_lists_what_is_right() {
    let scratch = Scratch::new();
    let log = scratch.file("walk.txt", walk(5));
    for (arguments, what_is_right) in [
        (["--association", "icp"], "[possible values: known, nn, jcbb]"),
        (["--profile", "submarine"], "[possible values: generic, range-bearing, victoria-park, utias]"),
        (["--format", "rosbag"], "[possible values: utias, range-bearing, tum, mcap"),
        (["--format", "carmn"], "a similar value exists: 'carmen'"),
        (["--robot", "two"], "--robot <N>"),
    ] {
        let outcome = run_slam(&log, &arguments);
        assert_eq!((outcome.code, outcome.stdout.as_str()), (2, ""), "{arguments:?}");
        assert!(outcome.stderr.contains(what_is_right), "{}", outcome.stderr);
    }
}

#[test]
fn output_that_cannot_be_written_is_told() {
    let scratch = Scratch::new();
    let log = scratch.file("walk.txt", walk(20));
    let in_the_way = scratch.file("taken", "a file where a folder belongs");
    refused(&run_slam(&log, &["--out", in_the_way.to_str().expect("a plain path")]), "needs a folder");
    let below = in_the_way.join("walk.mcap");
    refused(&wayfix([Path::new("convert"), &log, &below]), "cannot be written");
    refused(&wayfix([Path::new("convert"), &log, &scratch.path("walk.xyz")]), "--to mcap");
    refused(&wayfix([Path::new("convert"), &log, &log]), "write to another file");
}

#[test]
fn options_without_effect_are_refused() {
    let scratch = Scratch::new();
    let log = scratch.file("walk.txt", walk(40));
    refused(&run_slam(&log, &["--robot", "3"]), "UTIAS");
    refused(&run_slam(&log, &["--relations", "nothere"]), "scans");
}
