//! Folders of images: the frames of a camera that wrote no log.

use std::fs::{self, File};
use std::io::{self, Read};
use std::iter::Enumerate;
use std::path::{Path, PathBuf};
use std::vec;

use wayfix_encoded_image::natural_key;

use crate::{EncodedImage, LogError, ReadReport, Record, RecordData, RowProblem, RowProblemKind, Stamp};

/// No frame is larger; a file that is something else must not fill the memory.
const MAX_FILE_BYTES: u64 = 128 << 20;

/// Accepted frame rates, Hz; nanosecond stamps can represent both ends.
const RATES_HZ: std::ops::RangeInclusive<f64> = 1e-3..=1e6;

/// The images of a folder by name, one at a time: memory does not grow with their number.
pub(crate) struct ImageFolder {
    files: Enumerate<vec::IntoIter<PathBuf>>,
    rate_hz: f64,
    /// A pending warning about the names.
    doubt: Option<String>,
}

impl ImageFolder {
    pub(crate) fn open(folder: &Path, rate_hz: f64) -> Result<Self, LogError> {
        if !RATES_HZ.contains(&rate_hz) {
            return Err(LogError::BadFrameRate { rate_hz });
        }
        let files = image_files(folder)?;
        if files.is_empty() {
            return Err(LogError::Empty { path: folder.into() });
        }
        let doubt = same_numbers(&files);
        Ok(Self { files: files.into_iter().enumerate(), rate_hz, doubt })
    }

    /// The next frame that can be read; the others go into the report and leave a gap in time.
    pub(crate) fn next(&mut self, report: &mut ReadReport) -> Option<Record> {
        if let Some(doubt) = self.doubt.take() {
            report.warn("duplicate_image_number", doubt);
        }
        for (index, path) in self.files.by_ref() {
            match read(&path) {
                Ok(image) => {
                    report.rows_read += 1;
                    report.warn_of_orientation(&image);
                    let nanoseconds = (index as f64 * 1e9 / self.rate_hz).round() as u64;
                    return Some(Record {
                        stamp: Stamp::from_nanoseconds(nanoseconds),
                        data: RecordData::Image(image),
                    });
                }
                Err(reason) => report.add(RowProblem {
                    file: file_name(&path),
                    row: index as u64 + 1,
                    kind: RowProblemKind::UnreadableImage,
                    reason,
                }),
            }
        }
        None
    }
}

/// All PNG and JPEG files of a folder, by extension, in the order of the numbers in their names.
///
/// The order is that of [`natural_key`]. Hidden files, whose names begin with a dot, are skipped.
/// # Errors
/// Returns an error if the folder cannot be read.
pub fn image_files(folder: &Path) -> Result<Vec<PathBuf>, LogError> {
    let mut files = images_in(folder)?;
    files.sort_by_cached_key(|path| (natural_key(&file_name(path)), path.clone()));
    Ok(files)
}

/// Whether a name begins with a dot, as `.DS_Store` and the `._0001.png` of macOS do.
pub fn is_hidden(path: &Path) -> bool {
    file_name(path).starts_with('.')
}

/// Everything in the folder that is called an image.
pub(crate) fn images_in(folder: &Path) -> Result<Vec<PathBuf>, LogError> {
    let io = |source| LogError::io(folder, source);
    let paths: io::Result<Vec<PathBuf>> =
        fs::read_dir(folder).map_err(io)?.map(|entry| Ok(entry?.path())).collect();
    let mut paths = paths.map_err(io)?;
    paths.retain(|path| {
        let is_named_so = path.extension().is_some_and(|found| {
            ["png", "jpg", "jpeg"].iter().any(|extension| found.eq_ignore_ascii_case(extension))
        });
        is_named_so && !is_hidden(path) && !path.is_dir()
    });
    Ok(paths)
}

/// A warning about ambiguous names: images that differ only in leading zeros or the extension.
fn same_numbers(files: &[PathBuf]) -> Option<String> {
    let key = |path: &PathBuf| natural_key(&file_name(path)).0;
    let mut pairs = files.windows(2).filter(|pair| key(&pair[0]) == key(&pair[1]));
    let first = pairs.next()?;
    let n_pairs = 1 + pairs.count();
    let (a, b) = (file_name(&first[0]), file_name(&first[1]));
    Some(format!(
        "{n_pairs} of {} images have the number of the one before, the first {a} and {b}; each counts as a frame",
        files.len()
    ))
}

fn read(path: &Path) -> Result<EncodedImage, String> {
    let mut bytes = Vec::new();
    File::open(path)
        .and_then(|file| file.take(MAX_FILE_BYTES + 1).read_to_end(&mut bytes))
        .map_err(|error| error.to_string())?;
    if bytes.len() as u64 > MAX_FILE_BYTES {
        return Err(format!("more than {MAX_FILE_BYTES} bytes"));
    }
    let image = EncodedImage::from_bytes(bytes).ok_or("neither JPEG nor PNG")?;
    image.size().map_err(|error| error.to_string())?;
    Ok(image)
}

fn file_name(path: &Path) -> String {
    path.file_name().unwrap_or_default().to_string_lossy().into_owned()
}

#[cfg(test)]
mod tests {
    use std::path::PathBuf;

    use super::same_numbers;

    #[test]
    fn images_with_the_same_number_are_said() {
        let files = ["1.0.png", "1.00.png", "2.png"].map(PathBuf::from);
        let doubt = same_numbers(&files).unwrap();
        assert!(doubt.contains("1 of 3") && doubt.contains("1.00.png"), "{doubt}");
        assert_eq!(same_numbers(&files[1..]), None);
    }
}
