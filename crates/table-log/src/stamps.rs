use std::{
    collections::BTreeMap,
    fs,
    path::{Path, PathBuf},
};

use wayfix_sensor_log::{ReadReport, is_hidden};

use crate::{
    RecordingError,
    columns::{Columns, PoseTableColumns, Quantity},
    table::Table,
};

/// Time of each frame, s, by file name.
pub(super) type Stamps = BTreeMap<String, f64>;

/// Reads a table with a named column of times and one of file names.
pub(crate) fn read(
    path: &Path,
    names: Option<&PoseTableColumns>,
    report: &mut ReadReport,
    notes: &mut Vec<String>,
) -> Result<Stamps, RecordingError> {
    let table = Table::read(path, report)?;
    let refused = |reason| RecordingError::Table { path: path.to_owned(), reason };
    let columns = Columns::of(&table, names, "--stamp-columns").map_err(refused)?;
    let stamps = parse(&table, &columns, report).map_err(refused)?;
    table.say_units(&columns, "--stamp-columns", report, notes);
    Ok(stamps)
}

/// Finds the table of stamps beside the frames: the first text file, except `poses`, that names the first frame.
pub(super) fn find(folder: &Path, poses: &Path, a_frame: &str) -> Option<PathBuf> {
    let mut candidates: Vec<PathBuf> =
        fs::read_dir(folder).ok()?.flatten().map(|entry| entry.path()).collect();
    let is_text = |path: &PathBuf| {
        let extension = path.extension().unwrap_or_default().to_string_lossy().to_ascii_lowercase();
        ["csv", "txt", "tsv", "dat"].contains(&&*extension)
    };
    let same = |path: &PathBuf| fs::canonicalize(path).ok() == fs::canonicalize(poses).ok();
    candidates.retain(|path| is_text(path) && !is_hidden(path) && !same(path));
    candidates.sort();
    let names_it = |path: &PathBuf| {
        let table = Table::read(path, &mut ReadReport::default());
        table.is_ok_and(|table| {
            table.rows.iter().any(|(_, row)| row.iter().any(|cell| file_name(cell) == a_frame))
        })
    };
    candidates.into_iter().find(names_it)
}

fn parse(table: &Table, columns: &Columns, report: &mut ReadReport) -> Result<Stamps, String> {
    let (file, time) = (columns.need(Quantity::File, "file")?, columns.need(Quantity::Time, "t")?);
    let mut stamps = Stamps::new();
    for (line, cells) in &table.rows {
        let row = || -> Result<(String, f64), String> {
            table.check_width(cells)?;
            let name = cells.get(file.index).map(|cell| file_name(cell));
            Ok((name.ok_or("no file")?, table.number(cells, time)?))
        };
        match row() {
            Ok((name, seconds)) => drop(stamps.insert(name, seconds)),
            Err(reason) => table.leave_out(*line, reason, report),
        }
    }
    match stamps.is_empty() {
        true => Err(format!("no row has a time; {}", table.first_problem(report))),
        false => Ok(stamps),
    }
}

/// The file name without folders.
pub(super) fn file_name(path: &str) -> String {
    path.rsplit(['/', '\\']).next().unwrap_or(path).to_owned()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn stamps(text: &str) -> Result<Stamps, String> {
        let table = Table::parse(text)?;
        let columns = Columns::of(&table, None, "--stamp-columns")?;
        parse(&table, &columns, &mut ReadReport::default())
    }

    #[test]
    fn stamps_are_read_by_the_names_of_their_columns() {
        for text in [
            "Time [s], Filename\n0.5, outdoor/a.png\n1.0, outdoor/b.png",
            "file,t_ms\nx\\a.png,500\nx\\b.png,1000",
            "Best heading [degrees], Time [s], Lowest difference, Filename\n9,0.5,3,a.png\n8,1,4,b.png",
            "Time [s]; Filename\nnan; c.png\n0.5; a.png\n1; b.png\n2",
        ] {
            let expected = Stamps::from([("a.png".to_owned(), 0.5), ("b.png".to_owned(), 1.0)]);
            assert_eq!(stamps(text).unwrap(), expected, "{text:?}");
        }
        assert!(stamps("1,a.png\n3,b.png").unwrap_err().contains("--stamp-columns"));
        assert!(stamps("t_s,value\n1,2").unwrap_err().contains("no column file among t s, value"));
    }
}
