use std::{
    collections::BTreeMap,
    fs,
    path::{Path, PathBuf},
};

use super::{RecordingError, poses::time_unit, table::Table};

/// When each frame was taken, s, by the name of its file.
pub(super) type Stamps = BTreeMap<String, f64>;

/// A table of `t, file`, in either order; the first column of numbers is the time.
pub(super) fn read(path: &Path) -> Result<Stamps, RecordingError> {
    let table = Table::read(path)?;
    parse(&table).map_err(|reason| RecordingError::Table { path: path.to_owned(), reason })
}

/// The table of stamps beside the frames: the only file of text there, but `poses`, that names the first frame.
pub(super) fn find(folder: &Path, poses: &Path, a_frame: &str) -> Option<PathBuf> {
    let mut candidates: Vec<PathBuf> =
        fs::read_dir(folder).ok()?.flatten().map(|entry| entry.path()).collect();
    let is_text = |path: &PathBuf| {
        let extension = path.extension().unwrap_or_default().to_string_lossy().to_ascii_lowercase();
        ["csv", "txt", "tsv", "dat"].contains(&&*extension)
    };
    let same = |path: &PathBuf| fs::canonicalize(path).ok() == fs::canonicalize(poses).ok();
    candidates.retain(|path| is_text(path) && !same(path));
    candidates.sort();
    candidates.into_iter().find(|path| read(path).is_ok_and(|stamps| stamps.contains_key(a_frame)))
}

fn parse(table: &Table) -> Result<Stamps, String> {
    let n = table.n_columns();
    let file = (0..n).find(|column| !table.is_numeric(*column)).ok_or("no column of file names")?;
    let time = (0..n).find(|column| table.is_numeric(*column)).ok_or("no column of times")?;
    let name = table.names.as_ref().map_or("", |names| &names[time]);
    let numbers = table.numbers(time)?;
    let unit = match name.rsplit(' ').next() {
        Some("ms") => 0.001,
        Some("s") => 1.0,
        _ => time_unit(&numbers),
    };
    let names = table.rows.iter().map(|(_, row)| file_name(&row[file]));
    Ok(names.zip(numbers.into_iter().map(|value| value * unit)).collect())
}

/// Without the folders that a table may name.
pub(super) fn file_name(path: &str) -> String {
    path.rsplit(['/', '\\']).next().unwrap_or(path).to_owned()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn stamps_come_in_either_order_with_or_without_folders() {
        for text in [
            "Time [s], Filename\n0.5, outdoor/a.png\n1.0, outdoor/b.png",
            "a.png 0.5\nb.png 1",
            "file,t_ms\nx\\a.png,500\nx\\b.png,1000",
        ] {
            let stamps = parse(&Table::parse(text).unwrap()).unwrap();
            assert_eq!(
                stamps,
                Stamps::from([("a.png".to_owned(), 0.5), ("b.png".to_owned(), 1.0)]),
                "{text:?}"
            );
        }
        assert!(parse(&Table::parse("1,2\n3,4").unwrap()).is_err());
    }
}
