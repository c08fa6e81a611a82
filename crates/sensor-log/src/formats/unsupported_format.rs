//! Formats that are not read, known by their first bytes.

use std::fs::{self, File};
use std::io::Read;
use std::path::Path;

use crate::LogError;

struct UnsupportedFormat {
    magic: &'static [u8],
    what: &'static str,
    remedy: &'static str,
}

const UNSUPPORTED_FORMATS: [UnsupportedFormat; 8] = [
    UnsupportedFormat {
        magic: b"#ROSBAG V",
        what: "a ROS 1 bag",
        remedy: "convert it with `mcap convert IN.bag OUT.mcap` or `rosbags-convert --src IN.bag --dst OUT --dst-storage mcap`",
    },
    UnsupportedFormat {
        magic: b"SQLite format 3\0",
        what: "a ROS 2 bag in SQLite (db3)",
        remedy: "convert it with `rosbags-convert --src FOLDER --dst OUT --dst-storage mcap` or `ros2 bag convert`",
    },
    UnsupportedFormat {
        magic: &[0x28, 0xb5, 0x2f, 0xfd],
        what: "compressed with Zstandard",
        remedy: "unpack it with `zstd -d`",
    },
    UnsupportedFormat {
        magic: b"version https://git-lfs",
        what: "a Git LFS pointer and not the file itself",
        remedy: "fetch the file with `git lfs pull`",
    },
    UnsupportedFormat { magic: b"PK\x03\x04", what: "a ZIP archive", remedy: "unpack it with `unzip`" },
    UnsupportedFormat {
        magic: &[0xfd, b'7', b'z', b'X', b'Z', 0],
        what: "compressed with xz",
        remedy: "unpack it with `xz -d`",
    },
    UnsupportedFormat { magic: b"BZh", what: "compressed with bzip2", remedy: "unpack it with `bzip2 -d`" },
    UnsupportedFormat {
        magic: &[b'7', b'z', 0xbc, 0xaf],
        what: "a 7z archive",
        remedy: "unpack it with `7z x`",
    },
];

/// Returns an error with the format and a remedy if a file has a known format that is not supported.
pub(crate) fn check(path: &Path) -> Result<(), LogError> {
    let longest = UNSUPPORTED_FORMATS.iter().map(|foreign| foreign.magic.len()).max().unwrap_or(0);
    let mut head = Vec::new();
    let file = File::open(path).map_err(|source| LogError::io(path, source))?;
    file.take(longest as u64).read_to_end(&mut head).map_err(|source| LogError::io(path, source))?;
    match UNSUPPORTED_FORMATS.iter().find(|foreign| head.starts_with(foreign.magic)) {
        Some(UnsupportedFormat { what, remedy, .. }) => {
            Err(LogError::UnsupportedFormat { path: path.into(), what, remedy })
        }
        None => Ok(()),
    }
}

/// The same for the files of a folder without a readable log.
pub(crate) fn check_folder(folder: &Path) -> Result<(), LogError> {
    let entries = fs::read_dir(folder).map_err(|source| LogError::io(folder, source))?;
    let mut files: Vec<_> = entries.filter_map(|entry| Some(entry.ok()?.path())).collect();
    files.sort();
    files.iter().filter(|path| path.is_file()).try_for_each(|path| check(path))
}

#[cfg(test)]
mod tests {
    use crate::{LogError, LogOpenOptions, open};

    #[test]
    fn foreign_formats_are_named_with_the_way_out() {
        let folder = tempfile::tempdir().unwrap();
        for (name, head, words) in [
            ("a.bag", &b"#ROSBAG V2.0\nE\0\0\0"[..], "ROS 1 bag"),
            ("a.db3", b"SQLite format 3\0\x10", "rosbags-convert"),
            ("a.mcap.zstd", &[0x28, 0xb5, 0x2f, 0xfd, 0], "zstd -d"),
            ("a.mcap", b"version https://git-lfs.github.com/spec/v1\n", "git lfs pull"),
            ("a.zip", b"PK\x03\x04abc", "unzip"),
        ] {
            let inside = folder.path().join(name.replace('.', "_"));
            std::fs::create_dir(&inside).unwrap();
            let file = inside.join(name);
            std::fs::write(&file, head).unwrap();
            for path in [&file, &inside] {
                let error = open(path, &LogOpenOptions::default()).unwrap_err();
                assert!(matches!(error, LogError::UnsupportedFormat { .. }), "{error}");
                assert!(error.to_string().contains(words), "{error}");
            }
        }
    }
}
