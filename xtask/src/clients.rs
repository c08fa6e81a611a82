//! `cargo xtask clients`: other programs read the output of the regression run, and we read theirs.
//!
//! Independent readers and writers verify the formats: Python's `mcap`, `rosbags` and `websockets`, the Rerun command line, a browser. If a program
//! is missing its check is skipped, except under `CI=true`, where it is required.

use std::path::{Path, PathBuf};
use std::process::{ExitCode, Stdio};

use anyhow::{Context, Result, bail, ensure};

use crate::regress;
use crate::shell::{self, available};

pub(crate) fn run(args: &[String]) -> Result<ExitCode> {
    let dir = match args {
        [] => regress::default_out(),
        [dir] => PathBuf::from(dir),
        _ => bail!("usage: cargo xtask clients [DIR]"),
    };
    let dir = shell::root().join(dir);
    let files =
        files_below(&dir).with_context(|| format!("{}: run `cargo xtask regress` first", dir.display()))?;
    let logs = with_extension(&files, "mcap");
    let pages = with_extension(&files, "html");
    ensure!(!logs.is_empty(), "no .mcap below {}", dir.display());
    ensure!(!pages.is_empty(), "no .html below {}", dir.display());

    if available(
        "Python's mcap",
        shell::python_has(&["mcap", "mcap_protobuf"]),
        ".ci/run, or pip install mcap mcap-protobuf-support",
    )? {
        read_with_python(&logs)?;
    }
    if available(
        "Python's rosbags",
        shell::python_has(&["rosbags", "mcap", "mcap_protobuf", "numpy"]),
        ".ci/run, or pip install rosbags mcap mcap-protobuf-support numpy",
    )? {
        convert_ros_bags()?;
    }
    if available(
        "Python's websockets",
        shell::python_has(&["websockets", "mcap", "mcap_protobuf"]),
        ".ci/run, or pip install websockets mcap mcap-protobuf-support",
    )? {
        watch_live()?;
    }
    let rerun = shell::python_tool("rerun");
    if available("Rerun", shell::have(&rerun), ".ci/run, or pip install rerun-sdk")? {
        logs.iter().try_for_each(|log| convert_with_rerun(&rerun, log))?;
    }
    let browser =
        ["chromium", "chromium-browser", "google-chrome"].into_iter().find(|name| shell::have(name));
    if available("a browser", browser.is_some(), ".ci/run, or apt-get install chromium")? {
        pages.iter().try_for_each(|page| open_in_browser(browser.unwrap_or_default(), page))?;
        if available("Python", shell::have("python3"), "apt-get install python3")? {
            // It opens each page as a desk and a telephone show it, light and dark.
            let check =
                |page| shell::check(shell::command("python3", &["tests/browser/check_report.py"]).arg(page));
            pages.iter().try_for_each(check)?;
        }
    }
    Ok(ExitCode::SUCCESS)
}

/// Bags of known numbers, in both byte orders: `info` must list their topics, and `convert` must keep every number.
fn convert_ros_bags() -> Result<()> {
    let folder = shell::target_dir().join("ros-bags");
    let python =
        |task: &str| shell::command(shell::python_tool("python3"), &["xtask/clients/ros_bags.py", task]);
    shell::check(python("write").arg(&folder))?;
    for order in ["little", "big"] {
        let bag = folder.join(order).join(order).with_extension("mcap");
        let converted = folder.join(format!("{order}-converted.mcap"));
        let info = shell::output(shell::wayfix(&["info"]).arg(&bag))?;
        for told in
            ["laser scan", "odometry", "true pose", "image", "choose it as laser scan", "not understood"]
        {
            ensure!(info.contains(&format!(" {told}")), "{}: {told:?} is missing in\n{info}", bag.display());
        }
        shell::output(shell::wayfix(&["convert"]).arg(&bag).arg(&converted))?;
        shell::check(python("check").arg(&bag).arg(&converted))?;
    }
    Ok(())
}

/// Tests the live view of a run with an independent WebSocket client.
fn watch_live() -> Result<()> {
    // Without a package, so that the features are those of the tests.
    let build = ["build", "--quiet", "--locked", "--features=wayfix/live", "--bin", "wayfix"];
    shell::check(&mut shell::command("cargo", &build))?;
    let wayfix = shell::target_dir().join("debug").join("wayfix");
    let out = shell::target_dir().join("live");
    // Twenty times as fast as it was recorded: some three seconds.
    let run = "run slam --log fixtures/loop_known.mcap --live 0 --pace 20 --json --out";
    let mut python = shell::command(shell::python_tool("python3"), &["xtask/clients/watch_live.py"]);
    shell::check(python.arg(out.join("estimates.mcap")).arg(wayfix).args(run.split(' ')).arg(out))
}

fn read_with_python(logs: &[PathBuf]) -> Result<()> {
    let mut command = shell::command(shell::python_tool("python3"), &["xtask/clients/read_mcap.py"]);
    shell::check(command.args(logs))
}

/// `convert` exits with 0 for files that it does not understand, so list the content of the recording.
fn convert_with_rerun(rerun: &Path, log: &Path) -> Result<()> {
    let recording = log.with_extension("rrd");
    let rerun = |args: &[&str]| {
        let mut command = shell::command(rerun, args);
        command.env("RUST_LOG", "error").stdout(Stdio::null());
        command
    };
    shell::check(rerun(&["mcap", "check"]).arg(log))?;
    shell::check(rerun(&["mcap", "convert"]).arg(log).arg("-o").arg(&recording))?;
    let listing = shell::output(rerun(&["rrd", "print"]).arg(&recording).stdout(Stdio::piped()))?;
    std::fs::remove_file(&recording)?;
    let topics = topics_in(&listing);
    ensure!(!topics.is_empty(), "Rerun found no message in {}", log.display());
    println!("rerun: {}: {}", name(log), topics.join(" "));
    Ok(())
}

/// Entities listed by `rerun rrd print`, without those that describe the file.
fn topics_in(listing: &str) -> Vec<&str> {
    let chunks = listing.lines().filter(|line| line.starts_with("Chunk("));
    let mut topics: Vec<_> = chunks.filter_map(|line| line.split(" - ").nth(1)).collect();
    topics.retain(|topic| *topic != "/__mcap_properties");
    topics.sort_unstable();
    topics.dedup();
    topics
}

/// The page must draw something and raise no error.
fn open_in_browser(browser: &str, page: &Path) -> Result<()> {
    let profile = shell::target_dir().join("browser");
    let picture = page.with_extension("png");
    let flags = [
        "--headless",
        "--no-sandbox",
        "--disable-gpu",
        "--no-first-run",
        "--disable-background-networking",
        "--disable-component-update",
        "--disable-sync",
        "--enable-logging=stderr",
        "--window-size=1200,1600",
        "--virtual-time-budget=5000",
    ];
    let mut command = shell::command(browser, &flags);
    command
        .arg(format!("--user-data-dir={}", profile.display()))
        .arg(format!("--screenshot={}", picture.display()))
        .arg(format!("file://{}", page.display()));
    let output = command.output().with_context(|| format!("cannot start {browser}"))?;
    let log = String::from_utf8_lossy(&output.stderr);
    ensure!(output.status.success(), "{browser} failed on {}:\n{log}", page.display());
    if let Some(error) =
        log.lines().find(|line| line.contains("CONSOLE") && line.to_lowercase().contains("error"))
    {
        bail!("{}: {error}", page.display());
    }
    ensure!(picture.is_file(), "{browser} drew nothing of {}", page.display());
    println!("browser: {}: {}", name(page), picture.display());
    Ok(())
}

fn name(path: &Path) -> String {
    path.file_name().unwrap_or_default().to_string_lossy().into_owned()
}

fn files_below(dir: &Path) -> Result<Vec<PathBuf>> {
    let mut files = Vec::new();
    for entry in std::fs::read_dir(dir)? {
        let path = entry?.path();
        if path.is_dir() {
            files.extend(files_below(&path)?);
        } else {
            files.push(path);
        }
    }
    files.sort();
    Ok(files)
}

fn with_extension(files: &[PathBuf], extension: &str) -> Vec<PathBuf> {
    files.iter().filter(|file| file.extension().is_some_and(|found| found == extension)).cloned().collect()
}

#[cfg(test)]
mod tests {
    use super::topics_in;

    #[test]
    fn a_recording_that_only_describes_itself_has_no_topics() {
        let header = "Chunk(chunk_1) with 1 rows (1.4 KiB) - /__mcap_properties - data columns: [RecordingInfo:start_time]\n";
        assert!(topics_in(header).is_empty());
        let pose =
            "Chunk(chunk_2) with 5 rows (2.4 KiB) - /robot/pose - data columns: [Transform3D:translation]\n";
        assert_eq!(topics_in(&[header, pose, pose].concat()), ["/robot/pose"]);
    }
}
