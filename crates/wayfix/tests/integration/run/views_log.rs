//! `wayfix run views --log`: pictures with actions, on a painted scene.

use std::{
    ffi::OsStr,
    fmt::Write as _,
    fs,
    path::{Path, PathBuf},
};

use image::imageops::crop_imm;
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;

use super::views::{painting, png};
use crate::common::{Outcome, Scratch, wayfix};

const VIEW: u32 = 64;
const STEP: u32 = 16;
/// Columns and rows of places in the painting.
const GRID: [u32; 2] = [13, 9];
/// Share of the moves that stay where they are.
const SLIP: f64 = 0.25;

/// A folder with a picture of each place and their table.
fn learned(scratch: &Scratch) -> PathBuf {
    let places = (0..GRID[1]).flat_map(|row| (0..GRID[0]).map(move |column| ([0, 0], [column, row])));
    folder(scratch, "learned", &places.collect::<Vec<_>>())
}

/// A random drive: commanded moves, some of which do not happen, and the places after them.
fn drive(seed: u64, n: usize) -> Vec<([i32; 2], [u32; 2])> {
    let mut rng = ChaCha8Rng::seed_from_u64(seed);
    let mut at = [6_u32, 4];
    let mut next = |_| {
        let action = [rng.random_range(-1..=1), rng.random_range(-1..=1)];
        if rng.random::<f64>() >= SLIP {
            at = [0, 1].map(|axis| at[axis].saturating_add_signed(action[axis]).min(GRID[axis] - 1));
        }
        (action, at)
    };
    (0..n).map(&mut next).collect()
}

fn table(moves: &[([i32; 2], [u32; 2])]) -> String {
    let mut text = "file,dx,dy,column,row\n".to_owned();
    for (i, ([dx, dy], [column, row])) in moves.iter().enumerate() {
        writeln!(text, "view_{i}.png,{dx},{dy},{column},{row}").expect("a string");
    }
    text
}

fn folder(scratch: &Scratch, name: &str, moves: &[([i32; 2], [u32; 2])]) -> PathBuf {
    let folder = scratch.path(name);
    fs::create_dir(&folder).expect("a new folder");
    let scene = painting();
    for (i, (_, [column, row])) in moves.iter().enumerate() {
        let view = crop_imm(&scene, column * STEP, row * STEP, VIEW, VIEW).to_image();
        fs::write(folder.join(format!("view_{i}.png")), png(view)).expect("a file");
    }
    fs::write(folder.join("moves.csv"), table(moves)).expect("a file");
    folder
}

fn run(log: &Path, learned: &Path, more: &[&OsStr]) -> Outcome {
    let first = ["run", "views", "--json", "--log"].map(OsStr::new);
    let paths = [log.as_os_str(), OsStr::new("--learn-from"), learned.as_os_str()];
    wayfix(first.into_iter().chain(paths).chain(more.iter().copied()))
}

#[test]
fn slip_is_learned_from_a_logged_drive() {
    let scratch = Scratch::new();
    let (learned, log) = (learned(&scratch), folder(&scratch, "drive", &drive(3, 60)));
    let moves = scratch.file("moves.csv", table(&drive(4, 400)));
    let [with, without] =
        [vec![OsStr::new("--moves"), moves.as_os_str()], Vec::new()].map(|more| run(&log, &learned, &more));
    assert_eq!(with.metric("n_logged_moves"), 399.0, "the first row has no place before it");
    assert!(with.metric("diffusion_sigma_columns") > 0.0 && with.metric("diffusion_sigma_rows") > 0.0);
    for (outcome, name) in [(&with, "learned"), (&without, "as commanded")] {
        assert_eq!((outcome.metric("n_frames"), outcome.metric("n_places")), (60.0, 117.0));
        let share = outcome.metric("localized_frame_share");
        println!("{name}: {share}, mean error {} places", outcome.metric("place_error_mean"));
    }
    assert!(with.metric("localized_frame_share") >= without.metric("localized_frame_share"));
    assert!(with.metric("place_error_mean") < without.metric("place_error_mean"));
}

#[test]
fn bad_rows_and_pictures_are_counted_and_the_drive_goes_on() {
    let scratch = Scratch::new();
    let (learned, made) = (learned(&scratch), drive(5, 30));
    let log = folder(&scratch, "drive", &made);
    let clean = run(&log, &learned, &[]);
    let far = table(&made).replacen("view_9.png,", "view_9.png,7", 1);
    fs::write(log.join("moves.csv"), far).expect("a file");
    fs::write(log.join("view_12.png"), "no picture").expect("a file");
    fs::write(log.join("view_14.png"), png(painting())).expect("a file");
    let outcome = run(&log, &learned, &[]);
    assert_eq!(outcome.code, 0);
    for event in ["frame_without_action", "frame_unreadable", "frame_of_another_size"] {
        assert_eq!((clean.event(event), outcome.event(event)), (0, 1), "{event}");
    }
    assert_eq!(outcome.metric("n_frames"), 30.0);
    assert!(outcome.stderr.contains("is no move"), "{}", outcome.stderr);
}

#[test]
fn logs_that_cannot_be_localized_are_refused_with_numbers() {
    let scratch = Scratch::new();
    let learned = learned(&scratch);
    let log = folder(&scratch, "drive", &drive(5, 3));
    let hole = folder(&scratch, "hole", &[([0, 0], [0, 0]), ([1, 0], [2, 0])]);
    let refused = |outcome: Outcome, why: &str| {
        assert!(outcome.code == 1 && outcome.stderr.contains(why), "{}: {}", outcome.code, outcome.stderr);
    };
    refused(run(&log, &hole, &[]), "1 of 3 places have no picture");
    let moves = scratch.file("moves.csv", "dx,dy,column,row\n1,0,90,0\n1,0,91,0");
    refused(
        run(&log, &learned, &[OsStr::new("--moves"), moves.as_os_str()]),
        "none of 2 rows tells a move between two places of a grid of 13 × 9",
    );
    let nothing = scratch.file("nothing.csv", "a,b\n1,2");
    refused(run(&log, &learned, &[OsStr::new("--actions"), nothing.as_os_str()]), "no column dx");
    let usage = wayfix(["run", "views", "--log", "drive"].map(OsStr::new));
    assert_eq!(usage.code, 2, "no --learn-from");
}

#[test]
fn a_drive_without_a_table_is_a_route() {
    let scratch = Scratch::new();
    let row: Vec<_> = (0..13).map(|column| ([1, 0], [column, 4])).collect();
    let log = folder(&scratch, "route", &row);
    fs::remove_file(log.join("moves.csv")).expect("it was written");
    let outcome = run(&log, &log, &[]);
    assert_eq!((outcome.metric("n_places"), outcome.metric("n_frames")), (13.0, 13.0));
    assert!(outcome.stderr.contains("each picture is one place on"));
    assert!(outcome.metric("confidence_mean") > 1.0 / 13.0);
}

#[test]
fn a_long_drive_is_judged_by_all_frames_and_pictures_by_some() {
    let scratch = Scratch::new();
    let (learned, long) = (learned(&scratch), folder(&scratch, "drive", &drive(6, 1300)));
    let out = scratch.path("out");
    let outcome = run(&long, &learned, &[OsStr::new("--out"), out.as_os_str()]);
    assert_eq!(["n_frames", "n_frames_with_truth"].map(|name| outcome.metric(name)), [1300.0; 2]);
    let report = fs::read_to_string(out.join("report.json")).expect("a report");
    assert!(report.contains("pictures are of one in 2 of 1300"), "{report}");
}
