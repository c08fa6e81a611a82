//! Folders of images: the frames of a camera that wrote no log.

use std::fs::{self, File};
use std::io::{self, Read};
use std::iter::Enumerate;
use std::path::{Path, PathBuf};
use std::vec;

use crate::{Data, EncodedImage, ImageFormat, LogError, Problem, ProblemKind, ReadReport, Record, Stamp};

/// No frame is larger; a file that is something else must not fill the memory.
const MAX_FILE_BYTES: u64 = 128 << 20;

/// Frame rates from one in a quarter of an hour to what no camera reaches; stamps in nanoseconds hold both.
const RATES_HZ: std::ops::RangeInclusive<f64> = 1e-3..=1e6;

/// The images of a folder by name, one at a time: memory does not grow with their number.
pub(crate) struct ImageFolder {
    files: Enumerate<vec::IntoIter<PathBuf>>,
    rate_hz: f64,
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
        Ok(Self { files: files.into_iter().enumerate(), rate_hz })
    }

    /// The next frame that can be read; the others go into the report and leave a gap in time.
    pub(crate) fn next(&mut self, report: &mut ReadReport) -> Option<Record> {
        for (index, path) in self.files.by_ref() {
            match read(&path) {
                Ok(image) => {
                    report.rows_read += 1;
                    let nanoseconds = (index as f64 * 1e9 / self.rate_hz).round() as u64;
                    return Some(Record {
                        stamp: Stamp::from_nanoseconds(nanoseconds),
                        data: Data::Image(image),
                    });
                }
                Err(reason) => report.add(Problem {
                    file: file_name(&path),
                    row: index as u64 + 1,
                    kind: ProblemKind::UnreadableImage,
                    reason,
                }),
            }
        }
        None
    }
}

/// Everything in a folder that is called a PNG or JPEG image, by name: `frame10` comes after `frame9`.
///
/// # Errors
/// When the folder cannot be read.
pub fn image_files(folder: &Path) -> Result<Vec<PathBuf>, LogError> {
    let mut files = images_in(folder)?;
    files.sort_by_cached_key(|path| (natural_key(&file_name(path)), path.clone()));
    Ok(files)
}

/// Everything in the folder that is called an image.
pub(crate) fn images_in(folder: &Path) -> Result<Vec<PathBuf>, LogError> {
    let io = |source| LogError::io(folder, source);
    let paths: io::Result<Vec<PathBuf>> =
        fs::read_dir(folder).map_err(io)?.map(|entry| Ok(entry?.path())).collect();
    let mut paths = paths.map_err(io)?;
    paths.retain(|path| {
        path.extension().is_some_and(|found| {
            ["png", "jpg", "jpeg"].iter().any(|extension| found.eq_ignore_ascii_case(extension))
        })
    });
    Ok(paths)
}

fn read(path: &Path) -> Result<EncodedImage, String> {
    let mut bytes = Vec::new();
    File::open(path)
        .and_then(|file| file.take(MAX_FILE_BYTES + 1).read_to_end(&mut bytes))
        .map_err(|error| error.to_string())?;
    if bytes.len() as u64 > MAX_FILE_BYTES {
        return Err(format!("more than {MAX_FILE_BYTES} bytes"));
    }
    let format = ImageFormat::of_bytes(&bytes).ok_or("neither JPEG nor PNG")?;
    let image = EncodedImage::new(format, bytes);
    image.size().map_err(|error| error.to_string())?;
    Ok(image)
}

fn file_name(path: &Path) -> String {
    path.file_name().unwrap_or_default().to_string_lossy().into_owned()
}

/// A key by which `frame10` comes after `frame9`: before each number stands how many digits it has.
fn natural_key(name: &str) -> Vec<u8> {
    let mut key = Vec::with_capacity(name.len() + 8);
    let mut rest = name.as_bytes();
    while let Some(first) = rest.first() {
        let n_bytes = rest.iter().take_while(|byte| byte.is_ascii_digit() == first.is_ascii_digit()).count();
        let (run, after) = rest.split_at(n_bytes);
        if first.is_ascii_digit() {
            let n_zeros = run.iter().take_while(|digit| **digit == b'0').count();
            let digits = &run[n_zeros..];
            key.extend([b'0', digits.len().min(255) as u8]);
            key.extend(digits);
        } else {
            key.extend(run);
        }
        rest = after;
    }
    key
}

#[cfg(test)]
mod tests {
    use super::natural_key;

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
}
