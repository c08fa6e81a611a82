use std::{fs, path::Path};

use super::RecordingError;

/// A text of rows and columns: comma, semicolon, tab or blanks between them, `#` before remarks, a row of names first.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Table {
    /// Lower case, without punctuation: `Time [s]` and `time_s` are `time s`.
    pub(super) names: Vec<String>,
    /// Each with the number of its line, from 1, and as many cells as there are names.
    pub(super) rows: Vec<(usize, Vec<String>)>,
    /// Lines that are no rows, and why.
    pub(super) problems: Vec<(usize, String)>,
}

/// A column, and what its name says after the first word: `ms` of `time_ms`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Column<'a> {
    pub(super) index: usize,
    pub(super) unit: &'a str,
}

/// No table of poses is larger; a file that is something else must not fill the memory.
const MAX_BYTES: u64 = 256 << 20;

impl Table {
    /// Reads a table whose columns its first row names, or `names` where it has no such row.
    pub(super) fn read(path: &Path, names: Option<&[String]>) -> Result<Self, RecordingError> {
        let io = |source| RecordingError::Io { path: path.to_owned(), source };
        let refused = |reason: String| RecordingError::Table { path: path.to_owned(), reason };
        if fs::metadata(path).map_err(io)?.len() > MAX_BYTES {
            return Err(refused(format!("more than {MAX_BYTES} bytes")));
        }
        let bytes = fs::read(path).map_err(io)?;
        let text = String::from_utf8(bytes).map_err(|_| refused("not a text in UTF-8".to_owned()))?;
        Self::parse(&text, names).map_err(refused)
    }

    pub(super) fn parse(text: &str, given: Option<&[String]>) -> Result<Self, String> {
        let mut lines: Vec<(usize, Vec<String>)> = Vec::new();
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
            if lines.is_empty() && is_names && !has_file_name(&cells) {
                // The last line of names wins: files may begin with remarks.
                names = Some(cells.iter().map(|cell| plain(cell)).collect());
            } else if !is_remark {
                lines.push((index + 1, cells));
            }
        }
        let Some((_, first)) = lines.first() else { return Err("no rows".to_owned()) };
        let given = given.map(|given| given.iter().map(|name| plain(name)).collect());
        let Some(names): Option<Vec<String>> = given.or(names) else {
            return Err(format!(
                "no row names the columns: name them, as in --columns t_ms,x_cm,y_cm (the first row is {first:?})"
            ));
        };
        let n = names.len();
        let (rows, ragged): (Vec<_>, Vec<_>) = lines.into_iter().partition(|(_, row)| row.len() == n);
        let ragged = ragged.into_iter();
        let problems: Vec<(usize, String)> =
            ragged.map(|(line, row)| (line, format!("{} columns instead of {n}", row.len()))).collect();
        match problems.first() {
            Some((line, reason)) if rows.is_empty() => {
                Err(format!("no row can be used; line {line}: {reason}"))
            }
            _ => Ok(Self { names, rows, problems }),
        }
    }

    /// The column whose name begins with one of these words.
    pub(super) fn column(&self, words: &[&str]) -> Option<Column<'_>> {
        self.names.iter().enumerate().find_map(|(index, name)| {
            let (word, unit) = name.split_once(' ').unwrap_or((name, ""));
            words.contains(&word).then_some(Column { index, unit: unit.rsplit(' ').next().unwrap_or(unit) })
        })
    }
}

/// The finite number in a cell.
pub(super) fn number(row: &[String], column: Column<'_>) -> Result<f64, String> {
    let cell = &row[column.index];
    let value = cell.parse::<f64>().ok().filter(|value| value.is_finite());
    value.ok_or_else(|| format!("{cell:?} is not a number"))
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
fn plain(name: &str) -> String {
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
            "# x y\n1 2\n3 4",
            "# made by hand\n\nX;Y\n1;2\n3;4\n",
            "\u{feff}x\ty\r\n1\t2\r\n3\t4\r\n",
        ] {
            let table = Table::parse(text, None).unwrap();
            assert_eq!(table.names, ["x", "y"], "{text:?}");
            assert_eq!(table.rows[1].1, ["3", "4"]);
        }
        let table = Table::parse("Time [s], Filename\n0.1, a.png", None).unwrap();
        assert_eq!(table.names, ["time s", "filename"]);
        assert_eq!(table.column(&["t", "time"]), Some(Column { index: 0, unit: "s" }));
    }

    #[test]
    fn table_without_names_needs_given_ones() {
        let error = Table::parse("1,2\n3,4", None).unwrap_err();
        assert!(error.contains("--columns"), "{error}");
        let given = ["x_cm".to_owned(), "y_cm".to_owned()];
        let table = Table::parse("1,2\n3,4", Some(&given)).unwrap();
        assert_eq!(table.column(&["y"]), Some(Column { index: 1, unit: "cm" }));
    }

    #[test]
    fn short_rows_are_left_out_with_their_lines() {
        let table = Table::parse("x,y\n1,2\n3\n4,5\n", None).unwrap();
        assert_eq!(table.rows.len(), 2);
        assert_eq!(table.problems, [(3, "1 columns instead of 2".to_owned())]);
        assert_eq!(Table::parse("", None), Err("no rows".to_owned()));
        let nan = number(&["nan".to_owned()], Column { index: 0, unit: "" });
        assert_eq!(nan, Err("\"nan\" is not a number".to_owned()));
    }
}
