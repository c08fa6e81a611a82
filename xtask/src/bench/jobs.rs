//! The measurements: benches of our crates, and peers if installed.

use std::path::Path;
use std::process::Command;

use anyhow::Result;

use super::Options;
use super::table::{Measurement, parse_line};
use crate::shell;

/// Log and association: logs that other programs read too.
type SlamCase = (&'static str, &'static str);
const KNOWN: [SlamCase; 3] = [("slam_100", "known"), ("slam_200", "known"), ("slam_400", "known")];
const UNKNOWN: [SlamCase; 1] = [("slam_100", "nn")];

/// Finds the measurement in a line of output.
type Reader = Box<dyn Fn(&str) -> Option<Measurement>>;

pub(super) struct Job {
    pub(super) name: String,
    pub(super) command: Command,
    /// A missing program or input, if any.
    pub(super) missing: Option<String>,
    pub(super) read: Reader,
}

pub(super) fn all(options: &Options) -> Result<Vec<Job>> {
    let mut jobs = crate_benches(options)?;
    jobs.extend(slam_ours(options));
    if options.peers {
        jobs.extend(rust_peers()?);
        jobs.extend(python_peers(options));
        jobs.extend(mrpt(options));
    }
    Ok(jobs)
}

fn job(name: impl Into<String>, command: Command) -> Job {
    Job { name: name.into(), command, missing: None, read: Box::new(parse_line) }
}

/// `benches/` of every crate; those with peers are measured by the peers' program, in the same run.
fn crate_benches(options: &Options) -> Result<Vec<Job>> {
    let with_peers = if options.peers { crates_with("peers/Cargo.toml")? } else { Vec::new() };
    let mut crates = crates_with("benches")?;
    crates.retain(|folder| !with_peers.contains(folder));
    Ok(crates
        .iter()
        .map(|folder| {
            let manifest = format!("crates/{folder}/Cargo.toml");
            job(
                folder,
                shell::command("cargo", &["bench", "--quiet", "--benches", "--manifest-path", &manifest]),
            )
        })
        .collect())
}

/// Separate packages, so that no crate of ours depends on a peer.
fn rust_peers() -> Result<Vec<Job>> {
    let crates = crates_with("peers/Cargo.toml")?;
    Ok(crates
        .iter()
        .map(|folder| {
            let manifest = format!("crates/{folder}/peers/Cargo.toml");
            let command =
                shell::command("cargo", &["run", "--quiet", "--release", "--manifest-path", &manifest]);
            job(format!("{folder} peers"), command)
        })
        .collect())
}

fn crates_with(path: &str) -> Result<Vec<String>> {
    let mut found = Vec::new();
    for entry in std::fs::read_dir(shell::root().join("crates"))? {
        let entry = entry?;
        if entry.path().join(path).exists() {
            found.push(entry.file_name().to_string_lossy().into_owned());
        }
    }
    found.sort();
    Ok(found)
}

fn slam_ours(options: &Options) -> Vec<Job> {
    let mut jobs = slam_form(options, "wayfix", &[&KNOWN[..], &UNKNOWN].concat(), &[]);
    jobs.extend(slam_form(options, "wayfix compressed", &KNOWN, &["--params", "params/compressed.toml"]));
    jobs
}

fn slam_form(options: &Options, program: &'static str, cases: &[SlamCase], args: &[&str]) -> Vec<Job> {
    slam_jobs(options, program, cases, |log, association, job| {
        job.command = shell::wayfix(&["run", "slam", "--format", "range-bearing", "--json"]);
        job.command.args(args).args(["--association", association, "--log"]).arg(log);
        let name = job_name(log, association);
        job.read = Box::new(move |line| {
            let nanoseconds = 1e3 * json_number(line, "step_mean_us")?;
            Some(Measurement { job: name.clone(), program: program.into(), nanoseconds })
        });
    })
}

fn python_peers(options: &Options) -> Vec<Job> {
    let python = shell::python_tool("python3");
    let pypi = |modules: &[&str], packages: &str| {
        (!shell::python_has(modules)).then(|| format!("PyPI package missing: pip install {packages}"))
    };
    let mut kalman = job(
        "kalman numpy OpenCV filterpy Stone Soup",
        shell::command(&python, &["peers/opencv_filterpy_kalman.py"]),
    );
    kalman.missing = pypi(&["numpy", "cv2", "filterpy"], "numpy opencv-python-headless filterpy");
    let mut resampling =
        job("particle particles", shell::command(&python, &["peers/particles_resampling.py"]));
    resampling.missing = pypi(&["particles"], "particles");
    let mut simplify =
        job("line-extract shapely OpenCV", shell::command(&python, &["peers/shapely_opencv_simplify.py"]));
    simplify.missing = pypi(&["numpy", "cv2", "shapely"], "numpy opencv-python-headless shapely");
    let mut tracking = job("visual-tracking OpenCV", shell::command(&python, &["peers/opencv_tracking.py"]));
    tracking.missing = pypi(&["numpy", "cv2"], "numpy opencv-python-headless");
    let mut jobs = vec![kalman, resampling, simplify, tracking];
    jobs.extend(slam_jobs(options, "numpy", &KNOWN, |log, _, job| {
        job.command = shell::command(&python, &["peers/numpy_ekf_slam.py"]);
        job.command.arg(log);
        job.missing = pypi(&["numpy"], "numpy");
    }));
    jobs.extend(slam_jobs(options, "GTSAM", &KNOWN, |log, _, job| {
        job.command = shell::command(&python, &["peers/gtsam_isam2.py"]);
        job.command.arg(log);
        job.missing = pypi(&["numpy", "gtsam"], "numpy gtsam");
    }));
    jobs
}

fn mrpt(options: &Options) -> Vec<Job> {
    let build = shell::target_dir().join("peers");
    let missing = (!build_mrpt(&build)).then(|| {
        let packages = "libmrpt-slam-dev libmrpt-apps-dev cmake libeigen3-dev";
        format!("Debian packages missing: apt-get install --no-install-recommends {packages}")
    });
    slam_jobs(options, "MRPT", &[&KNOWN[..], &UNKNOWN].concat(), |log, association, job| {
        job.command = shell::command(build.join("mrpt_ekf_slam"), &[]);
        job.command.arg(log).arg(association);
        job.missing.clone_from(&missing);
    })
}

/// Without MRPT the configuration fails; its output is suppressed in favour of the package name.
fn build_mrpt(build: &Path) -> bool {
    let steps: [&[&str]; 2] = [&["-S", "peers", "-B"], &["--build"]];
    steps.iter().all(|args| {
        let step = shell::command("cmake", args).arg(build).output();
        step.is_ok_and(|output| output.status.success())
    })
}

/// One job per case, completed by `finish`; a single skipped one if there are no logs.
fn slam_jobs(
    options: &Options,
    program: &str,
    cases: &[SlamCase],
    mut finish: impl FnMut(&Path, &str, &mut Job),
) -> Vec<Job> {
    let Some(folder) = options.data.as_ref().map(|data| shell::root().join(data).join("range_bearing"))
    else {
        let mut skipped = job(format!("ekf_slam_step {program}"), Command::new("true"));
        skipped.missing =
            Some("no logs: give --data DIR or WAYFIX_DATA, with range_bearing/slam_*.txt in it".into());
        return vec![skipped];
    };
    let complete = |(name, association): &SlamCase| {
        let log = folder.join(name).with_extension("txt");
        let mut job = job(format!("{} {program}", job_name(&log, association)), Command::new("true"));
        finish(&log, association, &mut job);
        if !log.is_file() {
            job.missing = Some(format!("{} is not there", log.display()));
        }
        job
    };
    cases.iter().map(complete).collect()
}

fn job_name(log: &Path, association: &str) -> String {
    let name = format!("ekf_slam_step/{}", log.file_stem().unwrap_or_default().to_string_lossy());
    if association == "known" { name } else { format!("{name}/{association}") }
}

/// The number behind `"key":` in a line of JSON.
fn json_number(line: &str, key: &str) -> Option<f64> {
    let (_, rest) = line.split_once(&format!("\"{key}\""))?;
    let rest = rest.trim_start().strip_prefix(':')?.trim_start();
    rest.split([',', '}', ' ', '\n']).next()?.parse().ok()
}

#[cfg(test)]
mod tests {
    use std::path::PathBuf;

    use super::*;

    #[test]
    fn a_number_is_read_from_json_in_one_line_or_many() {
        assert_eq!(json_number("{\"metrics\":{\"step_mean_us\":12.5,\"x\":1}}", "step_mean_us"), Some(12.5));
        assert_eq!(json_number("    \"step_mean_us\": 3e1", "step_mean_us"), Some(30.0));
        assert_eq!(json_number("\"step_mean\": 1", "step_mean_us"), None);
    }

    #[test]
    fn without_logs_the_slam_jobs_say_what_to_give() {
        let options =
            Options { peers: false, data: Some(PathBuf::from("no-such-folder")), filter: String::new() };
        let jobs = slam_ours(&options);
        assert_eq!(jobs.len(), 2 * KNOWN.len() + UNKNOWN.len());
        assert!(
            jobs.iter().all(|job| job.missing.as_deref().is_some_and(|text| text.ends_with("is not there")))
        );
        let nowhere = slam_ours(&Options { data: None, ..options });
        assert!(nowhere[0].missing.as_deref().is_some_and(|text| text.contains("WAYFIX_DATA")));
    }
}
