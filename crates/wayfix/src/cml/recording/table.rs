use std::{fs, path::Path};

use super::RecordingError;

/// A text of rows and columns: comma, semicolon, tab or blanks between them, `#` before remarks, a row of names first or none.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Table {
    /// Lower case, without what is in brackets being lost: `Time [s]` is `time s`.
    pub(super) names: Option<Vec<String>>,
    /// Each with the number of its line, from 1.
    pub(super) rows: Vec<(usize, Vec<String>)>,
}

/// No table of poses is larger; a file that is something else must not fill the memory.
const MAX_BYTES: u64 = 256 << 20;

impl Table {
    pub(super) fn read(path: &Path) -> Result<Self, RecordingError> {
        let io = |source| RecordingError::Io { path: path.to_owned(), source };
        let refused = |reason: String| RecordingError::Table { path: path.to_owned(), reason };
        if fs::metadata(path).map_err(io)?.len() > MAX_BYTES {
            return Err(refused(format!("more than {MAX_BYTES} bytes")));
        }
        let bytes = fs::read(path).map_err(io)?;
        let text = String::from_utf8(bytes).map_err(|_| refused("not a text".to_owned()))?;
        Self::parse(&text).map_err(refused)
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
                // The last line of names wins: files may begin with remarks.
                names = Some(cells.iter().map(|cell| plain(cell)).collect());
            } else if !is_remark {
                rows.push((index + 1, cells));
            }
        }
        let Some((_, first)) = rows.first() else { return Err("no rows".to_owned()) };
        let n = first.len();
        if let Some((line, row)) = rows.iter().find(|(_, row)| row.len() != n) {
            return Err(format!("line {line} has {} columns, the others have {n}", row.len()));
        }
        let names = names.filter(|names: &Vec<String>| names.len() == n);
        Ok(Self { names, rows })
    }

    pub(super) fn n_columns(&self) -> usize {
        self.rows.first().map_or(0, |(_, row)| row.len())
    }

    /// The numbers of a column.
    pub(super) fn numbers(&self, column: usize) -> Result<Vec<f64>, String> {
        let number = |(line, row): &(usize, Vec<String>)| {
            let value = row[column].parse::<f64>().ok().filter(|value| value.is_finite());
            value.ok_or_else(|| format!("line {line}: {:?} is not a number", row[column]))
        };
        self.rows.iter().map(number).collect()
    }

    /// Whether every cell of a column is a number.
    pub(super) fn is_numeric(&self, column: usize) -> bool {
        self.rows.iter().all(|(_, row)| row[column].parse::<f64>().is_ok())
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
            "x\ty\r\n1\t2\r\n3\t4\r\n",
        ] {
            let table = Table::parse(text).unwrap();
            assert_eq!(table.names, Some(vec!["x".to_owned(), "y".to_owned()]), "{text:?}");
            assert_eq!((table.numbers(0), table.numbers(1)), (Ok(vec![1.0, 3.0]), Ok(vec![2.0, 4.0])));
        }
        assert_eq!(Table::parse("1,2\n3,4").unwrap().names, None);
        assert_eq!(
            Table::parse("Time [s], Filename\n0.1, a.png").unwrap().names.unwrap(),
            ["time s", "filename"]
        );
    }

    #[test]
    fn what_is_no_table_says_where() {
        assert_eq!(Table::parse(""), Err("no rows".to_owned()));
        assert_eq!(Table::parse("1,2\n3\n"), Err("line 2 has 1 columns, the others have 2".to_owned()));
        let table = Table::parse("1,2\n3,nan\n").unwrap();
        assert_eq!(table.numbers(1), Err("line 2: \"nan\" is not a number".to_owned()));
    }
}
