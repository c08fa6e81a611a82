use std::{
    env,
    path::Path,
    process::{Command, ExitCode, Stdio},
};

use anyhow::Result;
use wayfix_evaluation::{report::MachineInfo, terminal::print};

/// Show which optional parts are available: features of this program, recordings, other programs.
///
/// No part is required. For each missing part, the output gives its purpose.
#[derive(clap::Args)]
pub(in crate::cli) struct Arguments {}

/// An optional part, whether it is there, and what it is for or how to get it.
struct OptionalPart {
    name: &'static str,
    is_there: bool,
    remark: String,
}

pub(in crate::cli) fn main(_: &Arguments) -> Result<ExitCode> {
    let mut text = format!("wayfix {} on {}\n", env!("CARGO_PKG_VERSION"), MachineInfo::detect());
    for OptionalPart { name, is_there, remark } in parts() {
        text += &format!("{:<4} {name:<16} {remark}\n", if is_there { "yes" } else { "no" });
    }
    print(text)?;
    Ok(ExitCode::SUCCESS)
}

fn parts() -> Vec<OptionalPart> {
    let part = |name, is_there, remark: &str| OptionalPart { name, is_there, remark: remark.to_owned() };
    vec![
        part(
            "live view",
            cfg!(feature = "live"),
            "`run … --live` for Foxglove; build with `--features live`",
        ),
        recordings(env::var_os("WAYFIX_DATA").as_deref().map(Path::new)),
        part("wayfix-node", is_program("wayfix-node"), "the same systems live, on ROS 2"),
        part(
            "foxglove-studio",
            is_program("foxglove-studio"),
            "shows estimates.mcap; so does app.foxglove.dev",
        ),
        part("rerun", is_program("rerun"), "shows estimates.mcap"),
        part("git", is_program("git"), "the revision in reports of the regression"),
    ]
}

fn recordings(folder: Option<&Path>) -> OptionalPart {
    let (is_there, remark) = match folder {
        None => (false, "set WAYFIX_DATA to a folder of public recordings for `regress --all`".to_owned()),
        Some(folder) if folder.is_dir() => (true, format!("WAYFIX_DATA is {}", folder.display())),
        Some(folder) => (false, format!("WAYFIX_DATA is {}, which is no folder", folder.display())),
    };
    OptionalPart { name: "recordings", is_there, remark }
}

/// Whether a program of this name starts.
fn is_program(name: &str) -> bool {
    let mut probe = Command::new(name);
    probe.arg("--version").stdin(Stdio::null()).stdout(Stdio::null()).stderr(Stdio::null());
    probe.status().is_ok_and(|status| status.success())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_missing_part_says_how_to_get_it() {
        assert!(!recordings(None).is_there && recordings(None).remark.contains("WAYFIX_DATA"));
        assert!(!recordings(Some(Path::new("/nowhere/at/all"))).is_there);
        assert!(recordings(Some(&env::temp_dir())).is_there);
        assert!(!is_program("no-such-program-here"));
    }
}
