use std::fmt;
use std::path::Path;
use std::process::Command;

use serde::{Deserialize, Serialize};

/// The machine of a report: enough to judge its times.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(default)]
pub struct MachineInfo {
    /// Name of the processor.
    pub cpu: String,
    /// Logical cores available to this process; 0 if unknown.
    pub cores: usize,
    /// Operating system and architecture.
    pub platform: String,
}

impl MachineInfo {
    /// Describes this machine; unavailable properties are "unknown".
    /// ```
    /// assert!(wayfix_evaluation::report::MachineInfo::detect().platform.contains(std::env::consts::OS));
    /// ```
    pub fn detect() -> Self {
        let cpu_info = std::fs::read_to_string("/proc/cpuinfo").unwrap_or_default();
        Self {
            cpu: model_name(&cpu_info).unwrap_or("unknown processor").to_owned(),
            cores: std::thread::available_parallelism().map_or(0, usize::from),
            platform: format!("{} {}", std::env::consts::OS, std::env::consts::ARCH),
        }
    }
}

impl fmt::Display for MachineInfo {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { cpu, cores, platform } = self;
        let plural = if *cores == 1 { "" } else { "s" };
        write!(f, "{cpu}, {cores} core{plural}, {platform}")
    }
}

/// The revision checked out in `folder`; `None` without git, outside a repository or before the first commit.
pub fn commit(folder: &Path) -> Option<String> {
    let output =
        Command::new("git").arg("-C").arg(folder).args(["rev-parse", "--verify", "HEAD"]).output().ok()?;
    let revision = String::from_utf8(output.stdout).ok()?.trim().to_owned();
    (output.status.success() && !revision.is_empty()).then_some(revision)
}

/// x86 calls it "model name", some ARM kernels "Model" or "Hardware".
fn model_name(cpu_info: &str) -> Option<&str> {
    ["model name", "Model", "Hardware"].into_iter().find_map(|wanted| {
        let mut fields = cpu_info.lines().filter_map(|line| line.split_once(':'));
        fields.find(|(key, _)| key.trim() == wanted).map(|(_, value)| value.trim())
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn finds_the_processor_or_says_so() {
        assert_eq!(model_name("processor\t: 0\nmodel name\t: Some CPU @ 2 GHz\n"), Some("Some CPU @ 2 GHz"));
        assert_eq!(model_name("processor\t: 0\nHardware\t: BCM2711\n"), Some("BCM2711"));
        assert_eq!(model_name(""), None);
    }

    #[test]
    fn a_folder_without_repository_has_no_commit() {
        assert_eq!(commit(Path::new("/nonexistent/folder")), None);
    }
}
