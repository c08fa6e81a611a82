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

/// Everything in a folder that is called a PNG or JPEG image, in the order of the names; hidden files are none.
///
/// Where all names are one word and a number, with or without a sign and decimals, the order is that of the numbers: stamps. A minus belongs to
/// the number unless a letter or digit stands before it. Else digits count by value: `frame10` comes after `frame9`.
///
/// # Errors
/// When the folder cannot be read.
pub fn image_files(folder: &Path) -> Result<Vec<PathBuf>, LogError> {
    let mut files = images_in(folder)?;
    files.sort_by_cached_key(|path| (natural_key(&file_name(path)), path.clone()));
    let stems: Vec<String> = files
        .iter()
        .map(|path| path.file_stem().unwrap_or_default().to_string_lossy().into_owned())
        .collect();
    if let Some(numbers) = numbers(&stems) {
        let mut numbered: Vec<(i128, PathBuf)> = numbers.into_iter().zip(files).collect();
        numbered.sort_by_key(|(number, _)| *number); // of equals the order of the names stays
        files = numbered.into_iter().map(|(_, path)| path).collect();
    }
    Ok(files)
}

/// The numbers behind the word that all names begin with, in units of the 18th decimal.
fn numbers(stems: &[String]) -> Option<Vec<i128>> {
    let word = |stem: &String| {
        let word = stem.find(|c: char| c.is_ascii_digit()).map_or(stem.as_str(), |at| &stem[..at]);
        let before_minus = word.strip_suffix('-').filter(|before| !before.ends_with(char::is_alphanumeric));
        before_minus.unwrap_or(word).to_owned()
    };
    let first = word(stems.first()?);
    stems.iter().map(|stem| decimal(stem.strip_prefix(&first)?)).collect()
}

fn decimal(text: &str) -> Option<i128> {
    const DECIMALS: usize = 18;
    let (sign, digits) = text.strip_prefix('-').map_or((1, text), |rest| (-1, rest));
    let (whole, fraction) = digits.split_once('.').unwrap_or((digits, ""));
    let are_digits = |part: &str| part.bytes().all(|byte| byte.is_ascii_digit());
    if whole.is_empty() || whole.len() > DECIMALS || !are_digits(whole) || !are_digits(fraction) {
        return None;
    }
    let fraction: String = fraction.chars().chain(std::iter::repeat('0')).take(DECIMALS).collect();
    Some(
        sign * (whole.parse::<i128>().ok()? * 10_i128.pow(DECIMALS as u32)
            + fraction.parse::<i128>().ok()?),
    )
}

/// Everything in the folder that is called an image.
pub(crate) fn images_in(folder: &Path) -> Result<Vec<PathBuf>, LogError> {
    let io = |source| LogError::io(folder, source);
    let paths: io::Result<Vec<PathBuf>> =
        fs::read_dir(folder).map_err(io)?.map(|entry| Ok(entry?.path())).collect();
    let mut paths = paths.map_err(io)?;
    paths.retain(|path| {
        let is_hidden = file_name(path).starts_with('.');
        !is_hidden
            && !path.is_dir()
            && path.extension().is_some_and(|found| {
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
    use super::{image_files, natural_key};

    fn in_order(names: &[&str]) -> Vec<String> {
        let folder = tempfile::tempdir().unwrap();
        for name in names.iter().rev() {
            std::fs::write(folder.path().join(name), "").unwrap();
        }
        let files = image_files(folder.path()).unwrap();
        files.iter().map(|path| path.file_name().unwrap().to_string_lossy().into_owned()).collect()
    }

    #[test]
    fn names_that_are_numbers_are_in_their_order() {
        for names in [
            &["-1.5.png", "-0.5.png", "0.png", "1.05.png", "1.1.png", "1.15.png", "2.png", "10.png"][..],
            &["t_-2.png", "t_-1.png", "t_3.png"],
            &["img-1.png", "img-2.png", "img-10.png"],
            &["1700000000.0999999999.png", "1700000000.123456789.png", "1700000000.2.png"],
            &["frame9.png", "frame010.png", "frame011.png"],
            &["a1b2.png", "a1b10.png", "c.png"],
        ] {
            assert_eq!(in_order(names), names);
        }
    }

    #[test]
    fn hidden_files_and_folders_are_no_images() {
        let folder = tempfile::tempdir().unwrap();
        for name in ["1.png", "._1.png", ".DS_Store", "Thumbs.db"] {
            std::fs::write(folder.path().join(name), "").unwrap();
        }
        std::fs::create_dir(folder.path().join("2.png")).unwrap();
        assert_eq!(image_files(folder.path()).unwrap(), [folder.path().join("1.png")]);
    }

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
