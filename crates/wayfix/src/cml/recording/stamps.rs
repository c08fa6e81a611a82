use std::{
    collections::BTreeMap,
    fs,
    path::{Path, PathBuf},
};

use super::{
    RecordingError,
    poses::{FILE, TIME, TIMES, unit_of},
    table::{Table, number},
};

/// When each frame was taken, s, by the name of its file.
pub(super) type Stamps = BTreeMap<String, f64>;

/// A table with the columns `t` and `file`; rows without a time are left out.
pub(super) fn read(path: &Path, names: Option<&[String]>) -> Result<Stamps, RecordingError> {
    let table = Table::read(path, names)?;
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
    candidates.into_iter().find(|path| read(path, None).is_ok_and(|stamps| stamps.contains_key(a_frame)))
}

fn parse(table: &Table) -> Result<Stamps, String> {
    let (Some(file), Some(time)) = (table.column(&FILE), table.column(&TIME)) else {
        return Err(format!("no columns t and file among {:?}", table.names));
    };
    let ((_, unit), _) = unit_of(time, &TIMES);
    let stamp =
        |(_, row): &(usize, Vec<String>)| Some((file_name(&row[file.index]), number(row, time).ok()? * unit));
    Ok(table.rows.iter().filter_map(stamp).collect())
}

/// Without the folders that a table may name.
pub(super) fn file_name(path: &str) -> String {
    path.rsplit(['/', '\\']).next().unwrap_or(path).to_owned()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn stamps_are_read_by_name_in_either_order() {
        for text in [
            "Time [s], Filename\n0.5, outdoor/a.png\n1.0, outdoor/b.png",
            "file,t_ms\nx\\a.png,500\nx\\b.png,1000",
            "Time [s], Best heading [degrees], Lowest difference, Filename\n0.5,90,7,a.png\n1.0,80,6,b.png",
        ] {
            let stamps = parse(&Table::parse(text, None).unwrap()).unwrap();
            let expected = Stamps::from([("a.png".to_owned(), 0.5), ("b.png".to_owned(), 1.0)]);
            assert_eq!(stamps, expected, "{text:?}");
        }
        let error = parse(&Table::parse("x,y\n3,4", None).unwrap()).unwrap_err();
        assert!(error.contains("no columns t and file"), "{error}");
    }
}
