use std::{
    collections::BTreeMap,
    path::{Path, PathBuf},
};

use wayfix_sensor_log::{EncodedImage, ReadReport, RowProblem, RowProblemKind, image_files};

use crate::{
    RecordingError,
    frames::{keys, name_of, read_image},
    stamps::file_name,
    table::{Table, plain},
};

/// Name of the table of moves in a folder of frames.
pub const MOVE_TABLE: &str = "moves.csv";

/// A row of a table of moves.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct MoveRow {
    /// Picture taken after the move, if the table names it.
    pub file: Option<String>,
    /// Commanded move since the row before, columns and rows of the grid of places: each −1, 0 or 1. `None` if the table has none.
    pub action: Option<[i8; 2]>,
    /// True column and row after the move, if the table has them.
    pub place: Option<[usize; 2]>,
}

/// A table of moves on a grid of places: columns `dx`, `dy` (the commanded move), `column`, `row` (the true place) and `file`. `dy` and `row` are 0 without a
/// column, as along a route.
#[derive(Clone, Debug, PartialEq)]
pub struct MoveTable {
    /// Rows in order; `None` for an unusable one.
    pub rows: Vec<Option<MoveRow>>,
    /// Skipped rows.
    pub read: ReadReport,
}

impl MoveTable {
    /// Reads a text table with a header.
    ///
    /// # Errors
    /// Returns an error if the file cannot be read, or has neither a move nor a place.
    pub fn read(path: &Path) -> Result<Self, RecordingError> {
        let mut read = ReadReport::default();
        let table = Table::read(path, &mut read)?;
        let refused =
            |reason: &str| RecordingError::Table { path: path.to_owned(), reason: reason.to_owned() };
        let rows = rows(&table, &mut read).ok_or_else(|| {
            refused("no column dx or column in a first row of names; known are file, dx, dy, column, row")
        })?;
        if rows.iter().all(Option::is_none) {
            return Err(refused(&format!("no row is usable; {}", table.first_problem(&read))));
        }
        Ok(Self { rows, read })
    }
}

fn rows(table: &Table, read: &mut ReadReport) -> Option<Vec<Option<MoveRow>>> {
    let names = table.names.as_ref()?;
    let column = |name: &str| names.iter().position(|known| plain(known) == name);
    let [file, dx, dy, place_column, place_row] = ["file", "dx", "dy", "column", "row"].map(column);
    dx.or(place_column)?;
    let row = |cells: &[String]| -> Result<MoveRow, String> {
        table.check_width(cells)?;
        let cell = |index: usize| cells.get(index).map_or("", String::as_str);
        let step = |index: Option<usize>| match index.map_or(Ok(0), |index| cell(index).parse::<i8>()) {
            Ok(step @ -1..=1) => Ok(step),
            _ => Err(format!("{:?} is no move: −1, 0 or 1", index.map(cell).unwrap_or_default())),
        };
        let at = |index: Option<usize>| {
            let cell = index.map_or("0", cell);
            cell.parse::<usize>()
                .ok()
                .filter(|at| *at < MAX_SIDE)
                .ok_or_else(|| format!("{cell:?} is no place: a whole number from 0 to {}", MAX_SIDE - 1))
        };
        Ok(MoveRow {
            file: file.map(|index| cell(index).to_owned()),
            action: dx.map(|_| Ok::<_, String>([step(dx)?, step(dy)?])).transpose()?,
            place: place_column.map(|_| Ok::<_, String>([at(place_column)?, at(place_row)?])).transpose()?,
        })
    };
    let rows = table.rows.iter();
    Some(rows.map(|(line, cells)| row(cells).map_err(|why| table.leave_out(*line, why, read)).ok()).collect())
}

/// Largest number of columns or rows.
const MAX_SIDE: usize = 100_000;

/// A frame with the move before it.
#[derive(Clone, Debug, PartialEq)]
pub struct MovedFrame {
    /// Name of its file.
    pub name: String,
    /// Its row of the table; without a table the move is one column on. `None` if the table has no usable row for it.
    pub row: Option<MoveRow>,
    /// The file; `None` if it is unreadable. The move stays one.
    path: Option<PathBuf>,
}

impl MovedFrame {
    /// Reads the picture; `None` if the file is unreadable.
    pub fn image(&self) -> Option<EncodedImage> {
        read_image(self.path.as_ref()?).ok()
    }
}

/// A folder of frames with moves, in the order of the numbers in their names. Its pictures are read when they are needed.
#[derive(Clone, Debug, PartialEq)]
pub struct MovedFrameFolder {
    /// All frames.
    pub frames: Vec<MovedFrame>,
    /// Whether a table gives the moves, and not the order of the frames.
    pub has_table: bool,
    /// Skipped rows and images.
    pub read: ReadReport,
}

impl MovedFrameFolder {
    /// Reads the images of a folder and the table of their moves: `table`, or [`MOVE_TABLE`] in the folder, if there is one.
    ///
    /// # Errors
    /// Returns an error if a table cannot be parsed, fits no frame, or no image can be read.
    pub fn read(folder: &Path, table: Option<&Path>) -> Result<Self, RecordingError> {
        let files = image_files(folder)?;
        let own = Some(folder.join(MOVE_TABLE)).filter(|path| path.is_file());
        let table = table.map(Path::to_owned).or(own).map(|path| MoveTable::read(&path)).transpose()?;
        let mut read = table.as_ref().map_or_else(ReadReport::default, |table| table.read.clone());
        let rows = match &table {
            None => vec![Some(MoveRow { action: Some([1, 0]), ..MoveRow::default() }); files.len()],
            Some(table) => matched(&files, &table.rows)?,
        };
        let mut frames = Vec::new();
        for (index, (path, row)) in files.iter().zip(rows).enumerate() {
            let (name, is_readable) = (name_of(path), read_image(path).map(drop));
            let path = is_readable.is_ok().then(|| path.clone());
            if let Err(reason) = is_readable {
                let (file, kind) = (name.clone(), RowProblemKind::UnreadableImage);
                read.add(RowProblem { file, row: index as u64 + 1, kind, reason });
            }
            frames.push(MovedFrame { name, row, path });
        }
        if frames.iter().all(|frame| frame.path.is_none()) {
            return Err(RecordingError::Nothing {
                path: folder.to_owned(),
                what: "readable PNG or JPEG images",
            });
        }
        Ok(Self { frames, has_table: table.is_some(), read })
    }
}

/// The row of each file, by its name, else by order.
fn matched(files: &[PathBuf], rows: &[Option<MoveRow>]) -> Result<Vec<Option<MoveRow>>, RecordingError> {
    let unmatched = |reason| RecordingError::Unmatched { n_frames: files.len(), n_poses: rows.len(), reason };
    let usable = || rows.iter().flatten();
    if !usable().any(|row| row.file.is_some()) {
        let as_many = rows.len() == files.len();
        return if as_many {
            Ok(rows.to_vec())
        } else {
            Err(unmatched("a row for each frame is needed, or a column of file names"))
        };
    }
    let named = usable().filter_map(|row| Some((file_name(row.file.as_ref()?), row)));
    let by_file: BTreeMap<String, &MoveRow> =
        named.flat_map(|(name, row)| keys(&name).into_iter().map(move |key| (key, row))).collect();
    let find = |path: &PathBuf| {
        keys(&name_of(path)).into_iter().find_map(|key| by_file.get(&key).map(|row| (*row).clone()))
    };
    let found: Vec<Option<MoveRow>> = files.iter().map(find).collect();
    if found.iter().all(Option::is_none) { Err(unmatched("no row names a frame")) } else { Ok(found) }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn parsed(text: &str) -> Option<(Vec<Option<MoveRow>>, ReadReport)> {
        let mut read = ReadReport::default();
        let rows = rows(&Table::parse(text).unwrap(), &mut read)?;
        Some((rows, read))
    }

    #[test]
    fn moves_and_places_are_read_by_name() {
        let (rows, _) = parsed("file,dx,dy,column,row\na.png,0,0,3,1\nb.png,-1,1,2,2").unwrap();
        let row = MoveRow { file: Some("b.png".to_owned()), action: Some([-1, 1]), place: Some([2, 2]) };
        assert_eq!(rows[1], Some(row));
        let (route, _) = parsed("dx,column\n1,4\n1,5").unwrap();
        assert_eq!(route[1], Some(MoveRow { file: None, action: Some([1, 0]), place: Some([5, 0]) }));
        let (places, _) = parsed("column,row\n1,4\n1,5").unwrap();
        assert_eq!(places[0], Some(MoveRow { file: None, action: None, place: Some([1, 4]) }));
    }

    #[test]
    fn far_moves_and_negative_places_keep_their_row_empty() {
        for bad in ["2,0,1,1", "nan,0,1,1", "1,0,-1,1", "1,0,1", "1,0,1.5,1", "1,0,100000,1"] {
            let (rows, read) = parsed(&format!("dx,dy,column,row\n{bad}\n1,0,1,1")).unwrap();
            assert_eq!([rows[0].is_some(), rows[1].is_some()], [false, true], "{bad}");
            assert_eq!(read.examples.len(), 1, "{bad}");
        }
        assert!(parsed("a,b\n1,2").is_none());
    }

    #[test]
    fn rows_find_their_frames_by_file_or_by_order() {
        let files = ["v/8.png", "v/9.png"].map(PathBuf::from);
        let row = |file: Option<&str>| Some(MoveRow { file: file.map(str::to_owned), ..MoveRow::default() });
        assert_eq!(matched(&files, &[row(Some("9"))]).unwrap(), [None, row(Some("9"))]);
        assert_eq!(matched(&files, &[row(None), None]).unwrap(), [row(None), None]);
        assert!(matched(&files, &[row(None)]).is_err() && matched(&files, &[row(Some("7"))]).is_err());
    }
}
