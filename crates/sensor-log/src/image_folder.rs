//! Folders of images: the frames of a camera that wrote no log.

use std::fs::{self, File};
use std::io::{self, Read};
use std::iter::Enumerate;
use std::path::{Path, PathBuf};
use std::vec;

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
/// `frame9` comes before `frame10`. A dot between two digits is a decimal point: `1.05` comes before `1.1`, and `1700000000.123456.png` is a
/// time. Three numbers with dots between them are three whole numbers. A dash is a minus at the beginning of the name or after a character other
/// than a letter or digit: `-2`, `t_-2`; in `img-1` it separates. Hidden files, whose names begin with a dot, are skipped.
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
    let key = |path: &PathBuf| stem_key(&stem(&file_name(path)));
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

fn stem(name: &str) -> String {
    name.rsplit_once('.').map_or(name, |(stem, _)| stem).to_owned()
}

/// Sort key for the order of [`image_files`]; the extension counts last.
fn natural_key(name: &str) -> (Vec<u8>, String) {
    (stem_key(&stem(name)), name.to_owned())
}

/// Text is unchanged. A number becomes its digit count, its digits and its decimals; a negative one has each byte inverted.
fn stem_key(stem: &str) -> Vec<u8> {
    let bytes = stem.as_bytes();
    let n_digits =
        |from: usize| bytes[from.min(bytes.len())..].iter().take_while(|byte| byte.is_ascii_digit()).count();
    let is_dot = |at: usize| bytes.get(at) == Some(&b'.');
    let mut key = Vec::with_capacity(bytes.len() + 8);
    let mut at = 0;
    let mut is_negative = false;
    while let Some(&byte) = bytes.get(at) {
        let n_whole = n_digits(at);
        if n_whole == 0 {
            let follows_a_word = at > 0 && bytes[at - 1].is_ascii_alphanumeric();
            is_negative = byte == b'-' && !follows_a_word && n_digits(at + 1) > 0;
            if !is_negative {
                key.push(byte);
            }
            at += 1;
            continue;
        }
        let whole = &bytes[at..at + n_whole];
        let after_dot = at + n_whole + 1;
        let n_decimals = if is_dot(after_dot - 1) { n_digits(after_dot) } else { 0 };
        // `1.2.3` is not a decimal number.
        let is_first = at < 2 || !is_dot(at - 1) || !bytes[at - 2].is_ascii_digit();
        let is_last = !is_dot(after_dot + n_decimals) || n_digits(after_dot + n_decimals + 1) == 0;
        let decimals =
            if is_first && is_last { &bytes[after_dot.min(bytes.len())..][..n_decimals] } else { &[] };
        at += n_whole + if decimals.is_empty() { 0 } else { 1 + n_decimals };

        let n_zeros = whole.iter().take_while(|digit| **digit == b'0').count();
        let digits = &whole[n_zeros..];
        let n_kept = decimals.iter().rposition(|digit| *digit != b'0').map_or(0, |last| last + 1);
        let mut number = vec![digits.len().min(255) as u8];
        number.extend(digits.iter().chain(&decimals[..n_kept]));
        number.push(0);
        if is_negative && number.iter().any(|byte| *byte != 0) {
            key.push(b'-');
            key.extend(number.iter().map(|byte| !byte));
        } else {
            key.push(b'0');
            key.extend(number);
        }
        is_negative = false;
    }
    key
}

#[cfg(test)]
mod tests {
    use std::path::PathBuf;

    use super::{natural_key, same_numbers};

    #[test]
    fn numbers_count_by_value_and_names_by_their_letters() {
        let sorted = [
            "a.png",
            "frame0.png",
            "frame9.png",
            "frame10.png",
            "frame010b.png",
            "frame0100.png",
            "left.png",
        ];
        let mut names = sorted;
        names.reverse();
        names.sort_by_key(|name| natural_key(name));
        assert_eq!(names, sorted);
    }

    fn check_order(sorted: &[&str]) {
        let mut names = sorted.to_vec();
        names.reverse();
        names.sort_by_key(|name| natural_key(name));
        assert_eq!(names, sorted);
    }

    #[test]
    fn stamps_as_names_sort_by_their_value() {
        check_order(&["1.0.png", "1.05.png", "1.1.png", "1.15.png", "2.png", "10.5.png"]);
        check_order(&["1699999999.9.jpg", "1700000000.05.jpg", "1700000000.123456.jpg", "1700000000.2.jpg"]);
        check_order(&["rgb_9.95.png", "rgb_10.05.png", "rgb_10.1.png"]);
        check_order(&["v1.2.9.png", "v1.2.10.png", "v1.10.1.png"]);
    }

    #[test]
    fn negative_numbers_come_first_and_a_dash_separates() {
        check_order(&["-10.png", "-2.png", "-1.1.png", "-1.05.png", "-1.png", "0.png", "1.png"]);
        check_order(&["t_-2.png", "t_-1.png", "t_0.png"]);
        check_order(&["img-1.png", "img-2.png", "img-10.png"]);
        check_order(&["2024-01-02.png", "2024-01-10.png"]);
    }

    #[test]
    fn images_with_the_same_number_are_said() {
        let files = ["1.0.png", "1.00.png", "2.png"].map(PathBuf::from);
        let doubt = same_numbers(&files).unwrap();
        assert!(doubt.contains("1 of 3") && doubt.contains("1.00.png"), "{doubt}");
        assert_eq!(same_numbers(&files[1..]), None);
    }
}
