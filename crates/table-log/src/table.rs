use std::{fs, path::Path};

use wayfix_sensor_log::{ReadReport, RowProblem, RowProblemKind};

use crate::{
    RecordingError,
    columns::{Column, Columns},
};

/// A text table: cells separated by comma, semicolon, tab or blanks; comments after `#`; the header row is optional.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Table {
    /// In lower case; the text in brackets is kept: `Time [s]` is `time s`.
    pub(super) names: Option<Vec<String>>,
    /// Cells of each row with its line number, from 1.
    pub(super) rows: Vec<(usize, Vec<String>)>,
    /// The file's name.
    file: String,
    /// Number of columns of the header, else of most rows.
    n_columns: usize,
}

/// Maximum size of a table file, in bytes; it bounds the memory used.
const MAX_BYTES: u64 = 256 << 20;

impl Table {
    pub(super) fn read(path: &Path, report: &mut ReadReport) -> Result<Self, RecordingError> {
        let io = |source| RecordingError::Io { path: path.to_owned(), source };
        let refused = |reason: String| RecordingError::Table { path: path.to_owned(), reason };
        if fs::metadata(path).map_err(io)?.len() > MAX_BYTES {
            return Err(refused(format!("more than {MAX_BYTES} bytes")));
        }
        let bytes = fs::read(path).map_err(io)?;
        let text = String::from_utf8(bytes).map_err(|_| refused("not a text".to_owned()))?;
        let mut table = Self::parse(&text).map_err(refused)?;
        table.file = path.file_name().unwrap_or_default().to_string_lossy().into_owned();
        report.rows_read += table.rows.len() as u64;
        Ok(table)
    }

    pub(super) fn parse(text: &str) -> Result<Self, String> {
        let mut rows: Vec<(usize, Vec<String>)> = Vec::new();
        let mut names = None;
        for (index, line) in text.lines().enumerate() {
            let line = line.trim_start_matches('\u{feff}').trim();
            let (is_remark, line) = match line.strip_prefix('#') {
                Some(remark) => (true, remark.trim()),
                None => (false, line),
            };
            if line.is_empty() {
                continue;
            }
            let cells = cells(line);
            let is_names = cells.iter().all(|cell| cell.parse::<f64>().is_err()) && cells.len() > 1;
            if rows.is_empty() && is_names && !has_file_name(&cells) {
                // The last header line wins, because files may begin with remarks.
                names = Some(cells.iter().map(|cell| plain(cell)).collect());
            } else if !is_remark {
                rows.push((index + 1, cells));
            }
        }
        if rows.is_empty() {
            return Err("no rows".to_owned());
        }
        let has_width = |n: usize| rows.iter().filter(|(_, row)| row.len() == n).count();
        let names = names.filter(|names: &Vec<String>| has_width(names.len()) > 0);
        let most = || rows.iter().map(|(_, row)| row.len()).max_by_key(|n| (has_width(*n), *n)).unwrap_or(0);
        let n_columns = names.as_ref().map_or_else(most, Vec::len);
        Ok(Self { names, rows, file: String::new(), n_columns })
    }

    pub(super) fn n_columns(&self) -> usize {
        self.n_columns
    }

    pub(super) fn check_width(&self, cells: &[String]) -> Result<(), String> {
        match cells.len() {
            n if n == self.n_columns => Ok(()),
            n => Err(format!("{n} columns, not {}", self.n_columns)),
        }
    }

    /// The value of a cell in SI units.
    pub(super) fn number(&self, cells: &[String], column: Column) -> Result<f64, String> {
        let cell = cells.get(column.index).map_or("", String::as_str);
        let value = cell.parse::<f64>().map(|value| value * column.factor);
        let value = value.ok().filter(|value| value.is_finite());
        value.ok_or_else(|| format!("{:?} is not a finite number", cell.chars().take(40).collect::<String>()))
    }

    /// Counts a row as unusable.
    pub(super) fn leave_out(&self, line: usize, reason: String, report: &mut ReadReport) {
        report.rows_read = report.rows_read.saturating_sub(1);
        let kind = if reason.contains("columns, not") {
            RowProblemKind::ColumnCount
        } else {
            RowProblemKind::NotANumber
        };
        report.add(RowProblem { file: self.file.clone(), row: line as u64, kind, reason });
    }

    /// The first skipped row of this table.
    pub(super) fn first_problem(&self, report: &ReadReport) -> String {
        let first = report.examples.iter().find(|problem| problem.file == self.file);
        first.map_or_else(String::new, |problem| format!("line {}: {}", problem.row, problem.reason))
    }

    /// Reports the units of the columns, stated or assumed.
    pub(super) fn say_units(
        &self,
        columns: &Columns,
        option: &str,
        report: &mut ReadReport,
        notes: &mut Vec<String>,
    ) {
        if let Some(units) = columns.units(false) {
            notes.push(format!("{}: {units}", self.file));
        }
        if let Some(units) = columns.units(true) {
            let text = format!(
                "{}: no unit is stated, taken are {units}; state it in the names, or by {option}",
                self.file
            );
            report.warn("column_unit_assumed", text);
        }
    }
}

fn cells(line: &str) -> Vec<String> {
    let separator = [',', ';', '\t'].into_iter().find(|separator| line.contains(*separator));
    let tidy = |cell: &str| cell.trim().trim_matches('"').trim().to_owned();
    match separator {
        Some(separator) => line.split(separator).map(tidy).collect(),
        None => line.split_whitespace().map(tidy).collect(),
    }
}

fn has_file_name(cells: &[String]) -> bool {
    let is_image = |cell: &String| {
        let lower = cell.to_ascii_lowercase();
        [".png", ".jpg", ".jpeg"].iter().any(|extension| lower.ends_with(extension))
    };
    cells.iter().any(is_image)
}

/// `Time [s]`, `time_s` and `TIME (s)` are the same name.
pub(super) fn plain(name: &str) -> String {
    let name = name.replace('°', " deg");
    let word = |c: char| if c.is_alphanumeric() { c.to_ascii_lowercase() } else { ' ' };
    name.chars().map(word).collect::<String>().split_whitespace().collect::<Vec<_>>().join(" ")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn separators_headers_and_remarks_are_recognized() {
        for text in [
            "x,y\n1,2\n3,4\n",
            "\u{feff}x,y\n1,2\n3,4\n",
            "# x y\n1 2\n3 4",
            "# made by hand\n\nX;Y\n1;2\n3;4\n",
            "x\ty\r\n1\t2\r\n3\t4\r\n",
        ] {
            let table = Table::parse(text).unwrap();
            assert_eq!(table.names, Some(vec!["x".to_owned(), "y".to_owned()]), "{text:?}");
            let rows: Vec<&[String]> = table.rows.iter().map(|(_, row)| &row[..]).collect();
            assert_eq!(rows, [["1", "2"], ["3", "4"]], "{text:?}");
        }
        assert_eq!(Table::parse("1,2\n3,4").unwrap().names, None);
        assert_eq!(plain("Heading [°]"), "heading deg");
        assert_eq!(Table::parse(""), Err("no rows".to_owned()));
    }

    #[test]
    fn the_width_is_that_of_the_header_or_of_most_rows() {
        assert_eq!(Table::parse("1\n1,2\n3,4").unwrap().n_columns(), 2);
        assert_eq!(Table::parse("x,y\n1\n3,4\n5").unwrap().n_columns(), 2);
    }
}
