//! Allowed dependencies between crates: the table of `docs/architecture.md`.

use super::manifest::{entries, member};
use super::{Finding, Source};

/// Crate folder, and the crates of ours that it may depend on.
const ALLOWED_DEPENDENCIES: [(&str, &[&str]); 23] = [
    ("estimation-traits", &[]),
    ("gaussian-core", &["estimation-traits"]),
    ("kalman", &["estimation-traits", "gaussian-core"]),
    ("particle", &["estimation-traits", "gaussian-core"]),
    ("integrity", &[]),
    ("line-extract", &[]),
    ("scan-match", &["estimation-traits"]),
    ("smoother", &["estimation-traits"]),
    ("slam-smoother", &["estimation-traits", "gaussian-core", "smoother"]),
    ("slam-ekf", &["estimation-traits", "gaussian-core", "line-extract"]),
    ("color-map", &["estimation-traits"]),
    ("color-model", &["estimation-traits", "gaussian-core", "integrity", "kalman", "particle", "color-map"]),
    ("condensation", &["estimation-traits", "gaussian-core", "integrity", "particle"]),
    ("visual-tracking", &["gaussian-core", "particle"]),
    ("appearance-cml", &["estimation-traits", "gaussian-core", "integrity", "kalman"]),
    ("encoded-image", &[]),
    ("sensor-log", &["encoded-image", "estimation-traits"]),
    ("scene-sim", &["estimation-traits", "sensor-log", "color-map"]),
    ("evaluation", &["estimation-traits", "sensor-log"]),
    ("table-log", &["estimation-traits", "evaluation", "sensor-log"]),
    (
        "system-core",
        &["estimation-traits", "evaluation", "gaussian-core", "integrity", "sensor-log", "slam-ekf"],
    ),
    (
        "slam-system",
        &[
            "estimation-traits",
            "evaluation",
            "gaussian-core",
            "line-extract",
            "scan-match",
            "sensor-log",
            "slam-ekf",
            "slam-smoother",
            "smoother",
            "system-core",
            "table-log",
        ],
    ),
    (
        "systems",
        &[
            "appearance-cml",
            "color-map",
            "color-model",
            "condensation",
            "estimation-traits",
            "evaluation",
            "gaussian-core",
            "kalman",
            "line-extract",
            "scene-sim",
            "sensor-log",
            "slam-ekf",
            "system-core",
            "table-log",
            "visual-tracking",
        ],
    ),
];

/// The application, the experiments and the tasks may depend on every library.
const UNRESTRICTED: [&str; 3] = ["wayfix", "experiments", "xtask"];

/// Crates that must not depend on images.
const IMAGE_FREE: [&str; 10] = [
    "estimation-traits",
    "integrity",
    "gaussian-core",
    "kalman",
    "particle",
    "line-extract",
    "scan-match",
    "slam-ekf",
    "slam-smoother",
    "smoother",
];

const WHY_TABLE: &str = "see the direction table in docs/architecture.md and xtask/src/tidy/direction.rs";

pub(super) fn check(sources: &[Source]) -> Vec<Finding> {
    sources
        .iter()
        .filter_map(|source| Some((member(&source.path)?, source)))
        .flat_map(|(name, source)| check_member(name, source))
        .collect()
}

fn check_member(name: &str, source: &Source) -> Vec<Finding> {
    let allowed = ALLOWED_DEPENDENCIES.iter().find(|(known, _)| *known == name).map(|(_, allowed)| *allowed);
    if allowed.is_none() && !UNRESTRICTED.contains(&name) {
        return vec![Finding::new(
            &source.path,
            0,
            format!("`{name}` is not in the direction table"),
            WHY_TABLE,
        )];
    }
    let mut findings = Vec::new();
    for entry in entries(&source.text).iter().filter(|entry| entry.section.ends_with("dependencies")) {
        let mut found = |what: String, why| findings.push(Finding::new(&source.path, entry.line, what, why));
        if entry.key == "wayfix" {
            found(format!("`{name}` depends on `wayfix`"), "nothing knows the application");
        }
        // Tests may use any library of ours (a simulator, say), but not the application.
        if entry.section.ends_with("dev-dependencies") {
            continue;
        }
        let ours = entry.key.strip_prefix("wayfix-");
        if let (Some(allowed), Some(other)) =
            (allowed, ours.filter(|other| !allowed.is_some_and(|a| a.contains(other))))
        {
            found(format!("`{name}` depends on `{other}`, may know only {allowed:?}"), WHY_TABLE);
        }
        if IMAGE_FREE.contains(&name) && entry.key.starts_with("image") {
            found(format!("`{name}` depends on `{}`", entry.key), "this crate knows no images");
        }
    }
    findings
}

#[cfg(test)]
mod tests {
    use super::super::source;
    use super::*;

    fn complaint(path: &str, text: &str) -> Option<String> {
        check(&[source(path, text)]).first().map(|finding| format!("{}: {}", finding.line, finding.what))
    }

    #[test]
    fn a_filter_that_learns_of_slam_is_found() {
        let complaint =
            complaint("crates/kalman/Cargo.toml", "[dependencies]\nwayfix-slam-ekf.workspace = true\n");
        assert!(complaint.is_some_and(|text| text.starts_with("2: `kalman` depends on `slam-ekf`")));
    }

    #[test]
    fn what_points_downwards_or_serves_tests_is_fine() {
        let text = "[dependencies]\nwayfix-gaussian-core.workspace = true\n[dev-dependencies]\nwayfix-scene-sim.workspace = true\n";
        assert_eq!(complaint("crates/kalman/Cargo.toml", text), None);
        assert_eq!(
            complaint("crates/wayfix/Cargo.toml", "[dependencies]\nwayfix-slam-ekf.workspace = true\n"),
            None
        );
    }

    #[test]
    fn nobody_knows_the_application_not_even_in_tests() {
        assert!(
            complaint("crates/kalman/Cargo.toml", "[dev-dependencies]\nwayfix = { path = \"\" }\n").is_some()
        );
    }

    #[test]
    fn particles_with_eyes_and_strangers_are_found() {
        assert!(complaint("crates/particle/Cargo.toml", "[dependencies]\nimage = \"0.25\"\n").is_some());
        assert!(complaint("crates/sonar/Cargo.toml", "[dependencies]\n").is_some());
    }
}
