//! The program as its users call it.

#![expect(clippy::unwrap_used, reason = "a panic is the verdict of a test, in its helpers too")]

use std::{
    ffi::OsStr,
    fs,
    path::{Path, PathBuf},
    time::Duration,
};

/// What the program said and how it ended.
#[derive(Debug)]
pub(crate) struct Outcome {
    pub(crate) code: i32,
    pub(crate) stdout: String,
    pub(crate) stderr: String,
}

/// Far more than any call on a log of these tests takes.
const LONGEST: Duration = Duration::from_secs(120);

/// Calls `wayfix-experiments`; whatever it is given, it must end and not panic.
pub(crate) fn experiments(arguments: impl IntoIterator<Item = impl AsRef<OsStr>>) -> Outcome {
    let mut command = assert_cmd::Command::new(env!("CARGO_BIN_EXE_wayfix-experiments"));
    let output = command.args(arguments).env_remove("WAYFIX_DATA").timeout(LONGEST).output().unwrap();
    let stderr = String::from_utf8(output.stderr).unwrap();
    assert!(!stderr.contains("panicked"), "{stderr}");
    let stdout = String::from_utf8(output.stdout).unwrap();
    Outcome { code: output.status.code().expect("ended by itself"), stdout, stderr }
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
        fs::create_dir_all(path.parent().unwrap_or(Path::new("."))).unwrap();
        fs::write(&path, content).unwrap();
        path
    }
}
