//! The command as its users call it, and logs to call it on.

#![expect(
    clippy::unwrap_used,
    clippy::panic,
    reason = "a panic is the verdict of a test, in its helpers too"
)]

use std::{
    ffi::OsStr,
    fmt::Write,
    fs,
    path::{Path, PathBuf},
    time::Duration,
};

use serde_json::Value;

/// What the command said and how it ended.
#[derive(Debug)]
pub(crate) struct Outcome {
    pub(crate) code: i32,
    pub(crate) stdout: String,
    pub(crate) stderr: String,
}

/// Far more than any call on a log of these tests takes.
const LONGEST: Duration = Duration::from_secs(120);

/// Calls `wayfix`; whatever it is given, it must end and not panic.
pub(crate) fn wayfix(arguments: impl IntoIterator<Item = impl AsRef<OsStr>>) -> Outcome {
    let mut command = assert_cmd::Command::new(env!("CARGO_BIN_EXE_wayfix"));
    let output = command.args(arguments).env_remove("WAYFIX_DATA").timeout(LONGEST).output().unwrap();
    let text = |bytes| String::from_utf8(bytes).unwrap();
    let outcome = Outcome {
        code: output.status.code().expect("ended by itself"),
        stdout: text(output.stdout),
        stderr: text(output.stderr),
    };
    assert!(!outcome.stderr.contains("panicked"), "{}", outcome.stderr);
    outcome
}

/// `wayfix run slam --log LOG --json …`.
pub(crate) fn run_slam(log: &Path, more: &[&str]) -> Outcome {
    let first = ["run", "slam", "--json", "--log"].map(OsStr::new);
    wayfix(first.into_iter().chain([log.as_os_str()]).chain(more.iter().map(OsStr::new)))
}

impl Outcome {
    /// The one JSON object on standard output of a call that went well, in which every figure is a number.
    pub(crate) fn json(&self) -> Value {
        assert_eq!(self.code, 0, "{}", self.stderr);
        let object: Value = serde_json::from_str(&self.stdout).expect("exactly one JSON object");
        let figures = object["metrics"].as_object().expect("metrics by name");
        assert!(figures.values().all(|figure| figure.as_f64().is_some_and(f64::is_finite)), "{object}");
        object
    }

    /// One figure.
    pub(crate) fn metric(&self, name: &str) -> f64 {
        let object = self.json();
        object["metrics"][name].as_f64().unwrap_or_else(|| panic!("no {name} in {object}"))
    }

    /// How often an event happened.
    pub(crate) fn event(&self, name: &str) -> u64 {
        self.json()["events"][name].as_u64().unwrap_or(0)
    }

    /// Every figure but times, which no two calls share.
    pub(crate) fn figures(&self) -> Vec<(String, f64)> {
        let object = self.json();
        let figures = object["metrics"].as_object().unwrap().iter();
        figures
            .filter(|(name, _)| !name.starts_with("step_"))
            .map(|(name, value)| (name.clone(), value.as_f64().unwrap()))
            .collect()
    }
}

/// A folder with files in it, gone after the test.
pub(crate) struct Scratch(tempfile::TempDir);

impl Scratch {
    pub(crate) fn new() -> Self {
        Self(tempfile::tempdir().unwrap())
    }
    pub(crate) fn path(&self, name: &str) -> PathBuf {
        self.0.path().join(name)
    }
    pub(crate) fn file(&self, name: &str, content: impl AsRef<[u8]>) -> PathBuf {
        let path = self.path(name);
        fs::create_dir_all(path.parent().unwrap()).unwrap();
        fs::write(&path, content).unwrap();
        path
    }
}

/// A robot on a circle of 2 m radius about (0, 2), among eight landmarks on one of 4 m.
struct Walk;

impl Walk {
    const STEP: f64 = 0.1;

    fn pose(step: usize) -> (f64, f64, f64) {
        let turned = Self::STEP * step as f64;
        let heading =
            (turned + std::f64::consts::PI).rem_euclid(std::f64::consts::TAU) - std::f64::consts::PI;
        (2.0 * turned.sin(), 2.0 - 2.0 * turned.cos(), heading)
    }
    fn landmarks() -> impl Iterator<Item = (u32, f64, f64)> {
        (0..8).map(|k| {
            let (sin, cos) = (f64::from(k) * std::f64::consts::FRAC_PI_4).sin_cos();
            (k + 10, 4.0 * cos, 2.0 + 4.0 * sin)
        })
    }
    /// Landmarks within 4.5 m: identity, range, bearing.
    fn seen(step: usize) -> impl Iterator<Item = (u32, f64, f64)> {
        let (x, y, heading) = Self::pose(step);
        Self::landmarks()
            .map(move |(id, lx, ly)| (id, (lx - x).hypot(ly - y), (ly - y).atan2(lx - x) - heading))
            .filter(|(_, range, _)| *range < 4.5)
    }
}

/// The walk as range-bearing lines, with truth.
pub(crate) fn walk(n_steps: usize) -> String {
    let mut text = String::new();
    for (id, x, y) in Walk::landmarks() {
        writeln!(text, "L {id} {x} {y}").unwrap();
    }
    for step in 0..n_steps {
        let (x, y, heading) = Walk::pose(step);
        writeln!(text, "P {x} {y} {heading}").unwrap();
        let (forward, left) = match step {
            0 => (0.0, 0.0),
            _ => (2.0 * Walk::STEP.sin(), 2.0 - 2.0 * Walk::STEP.cos()),
        };
        let turn = if step == 0 { 0.0 } else { Walk::STEP };
        writeln!(text, "O {forward} {left} {turn}").unwrap();
        for (id, range, bearing) in Walk::seen(step) {
            writeln!(text, "Z {id} {range} {bearing}").unwrap();
        }
    }
    text
}

/// The same without what only the simulator knows.
pub(crate) fn walk_without_truth(n_steps: usize) -> String {
    let is_measured = |line: &&str| line.starts_with(['O', 'Z']);
    walk(n_steps).lines().filter(is_measured).flat_map(|line| [line, "\n"]).collect()
}

/// The walk as a folder of the UTIAS set, ten commands and two looks a second.
pub(crate) fn utias_walk(scratch: &Scratch, folder: &str, robot: u32, n_steps: usize) -> PathBuf {
    let [mut odometry, mut measurement, mut truth] = ["# header\n"; 3].map(str::to_owned);
    for step in 0..n_steps {
        let time = 1000.0 + 0.1 * step as f64;
        let (x, y, heading) = Walk::pose(step);
        writeln!(odometry, "{time:.3} 2.0 1.0").unwrap();
        writeln!(truth, "{time:.3} {x} {y} {heading}").unwrap();
        if step % 5 == 2 {
            for (id, range, bearing) in Walk::seen(step) {
                writeln!(measurement, "{time:.3} {} {range} {bearing}", 50 + id).unwrap();
            }
        }
    }
    let barcodes: String = Walk::landmarks().map(|(id, ..)| format!("{id} {}\n", 50 + id)).collect();
    let landmarks: String = Walk::landmarks().map(|(id, x, y)| format!("{id} {x} {y} 0 0\n")).collect();
    scratch.file(&format!("{folder}/Barcodes.dat"), format!("# header\n2 14\n{barcodes}"));
    scratch.file(&format!("{folder}/Landmark_Groundtruth.dat"), landmarks);
    for (kind, text) in [("Odometry", odometry), ("Measurement", measurement), ("Groundtruth", truth)] {
        scratch.file(&format!("{folder}/Robot{robot}_{kind}.dat"), text);
    }
    scratch.path(folder)
}
