use std::{collections::BTreeMap, fs, path::Path};

use wayfix_estimation_traits::wrap_angle;
use wayfix_sensor_log::{EncodedImage, ReadReport, RowProblem, RowProblemKind, image_files};

use wayfix_evaluation::errors::LONGEST_GAP;

use crate::{
    RecordingError,
    columns::PoseTableColumns,
    poses::{self, PoseRow},
    stamps::{self, Stamps, file_name},
};

/// A frame with its pose.
#[derive(Clone, Debug, PartialEq)]
pub struct PosedFrame {
    /// Name of its file.
    pub name: String,
    /// Time, s.
    pub seconds: f64,
    /// Position, m.
    pub position: [f64; 2],
    /// Heading of the camera, rad, if the table has it.
    pub heading: Option<f64>,
    /// The picture.
    pub image: EncodedImage,
}

/// A folder of frames with poses, in capture order.
#[derive(Clone, Debug, PartialEq)]
pub struct PosedFrameFolder {
    /// Frames with a pose.
    pub frames: Vec<PosedFrame>,
    /// Number of images without a pose.
    pub n_without_pose: usize,
    /// Skipped rows and images, and assumptions made.
    pub read: ReadReport,
    /// Units of the tables.
    pub notes: Vec<String>,
}

/// The tables of a folder of frames.
#[derive(Clone, Copy, Debug)]
pub struct PoseTables<'a> {
    /// Table of poses.
    pub poses: &'a Path,
    /// Column names, for a table without a header.
    pub columns: Option<&'a PoseTableColumns>,
    /// Table of frame times; `None` searches the folder of the frames.
    pub stamps: Option<&'a Path>,
    /// Column names of the stamps, for a table without a header.
    pub stamp_columns: Option<&'a PoseTableColumns>,
}

impl PosedFrameFolder {
    /// Reads the images of a folder and the tables of their times and poses. Skips unusable rows and images.
    ///
    /// # Errors
    /// Returns an error if a table cannot be parsed, or fewer than two frames have an image and a pose.
    pub fn read(folder: &Path, tables: &PoseTables<'_>) -> Result<Self, RecordingError> {
        let files = image_files(folder)?;
        let names: Vec<String> = files.iter().map(|path| name_of(path)).collect();
        let Some(first) = names.first() else {
            return Err(RecordingError::Nothing { path: folder.to_owned(), what: "PNG or JPEG images" });
        };
        let (mut read, mut notes) = (ReadReport::default(), Vec::new());
        let rows = poses::read(tables.poses, tables.columns, &mut read, &mut notes)?;
        let found = match tables.stamps {
            Some(path) => Some(path.to_owned()),
            None => stamps::find(folder, tables.poses, first),
        };
        let stamps = match found.map(|path| stamps::read(&path, tables.stamp_columns, &mut read, &mut notes))
        {
            // Poses matched by file name need no times.
            Some(Err(_)) if tables.stamps.is_none() && is_by_file(&rows) => None,
            stamps => stamps.transpose()?,
        };
        let placed = place(&names, &rows, stamps.as_ref())?;

        let mut frames = Vec::new();
        for (index, (path, placed)) in files.iter().zip(&placed).enumerate() {
            let Some(Placed { seconds, position, heading }) = *placed else { continue };
            match read_image(path) {
                Ok(image) => {
                    read.warn_of_orientation(&image);
                    frames.push(PosedFrame { name: name_of(path), seconds, position, heading, image });
                }
                Err(reason) => read.add(RowProblem {
                    file: name_of(path),
                    row: index as u64 + 1,
                    kind: RowProblemKind::UnreadableImage,
                    reason,
                }),
            }
        }
        frames.sort_by(|a, b| a.seconds.total_cmp(&b.seconds));
        let n_without_pose = placed.iter().filter(|placed| placed.is_none()).count();
        if n_without_pose > 0 {
            let text = format!(
                "{n_without_pose} of {} frames in {} have no pose and are left out; poses are interpolated over at most {:.2} s",
                files.len(),
                folder.display(),
                longest_gap(&times(&rows))
            );
            read.warn("frame_without_pose", text);
        }
        if frames.len() < 2 {
            let reason = "fewer than two frames have an image and a pose";
            return Err(RecordingError::Unmatched { n_frames: names.len(), n_poses: rows.len(), reason });
        }
        Ok(Self { frames, n_without_pose, read, notes })
    }
}

#[derive(Clone, Copy, Debug, PartialEq)]
struct Placed {
    seconds: f64,
    position: [f64; 2],
    heading: Option<f64>,
}

/// Assumed time between frames without stamps, s.
const STEP: f64 = 0.1;

/// The pose of each frame, matched by the file name in its row, else by time, else by row order.
fn place(
    names: &[String],
    rows: &[Option<PoseRow>],
    stamps: Option<&Stamps>,
) -> Result<Vec<Option<Placed>>, RecordingError> {
    let unmatched = |reason| RecordingError::Unmatched { n_frames: names.len(), n_poses: rows.len(), reason };
    let stamp = |name: &String| stamps.and_then(|stamps| stamps.get(name)).copied();
    let at = |index: usize, row: &PoseRow| Placed {
        seconds: stamp(&names[index]).or(row.time).unwrap_or(STEP * index as f64),
        position: [row.x, row.y],
        heading: row.heading,
    };
    let usable = || rows.iter().flatten();
    let have_times = usable().all(|row| row.time.is_some());
    let placed: Vec<Option<Placed>> = if is_by_file(rows) {
        let by_file = by_file(usable());
        let find = |name: &String| keys(name).into_iter().find_map(|key| by_file.get(&key).copied());
        names.iter().enumerate().map(|(index, name)| Some(at(index, find(name)?))).collect()
    } else if stamps.is_some() && have_times {
        let mut rows: Vec<PoseRow> = usable().cloned().collect();
        rows.sort_by(|a, b| a.time.unwrap_or(0.0).total_cmp(&b.time.unwrap_or(0.0)));
        let gap = longest_gap(&rows.iter().filter_map(|row| row.time).collect::<Vec<_>>());
        names.iter().map(|name| interpolated(&rows, stamp(name)?, gap)).collect()
    } else if rows.len() == names.len() {
        rows.iter().enumerate().map(|(index, row)| Some(at(index, row.as_ref()?))).collect()
    } else if have_times {
        return Err(unmatched(
            "the poses are by time, and the frames have no stamps (--stamps FILE: rows of time, file)",
        ));
    } else {
        return Err(unmatched("a row for each frame is needed, or a column of file names"));
    };
    match placed.iter().flatten().count() {
        0 | 1 => Err(unmatched("fewer than two frames have a pose")),
        _ => Ok(placed),
    }
}

fn is_by_file(rows: &[Option<PoseRow>]) -> bool {
    rows.iter().flatten().any(|row| row.file.is_some())
}

fn times(rows: &[Option<PoseRow>]) -> Vec<f64> {
    let mut times: Vec<f64> = rows.iter().flatten().filter_map(|row| row.time).collect();
    times.sort_by(f64::total_cmp);
    times
}

/// The longest interval between two poses that is interpolated, s: the limit for truth, or 1.5 periods of a slower table. One missing row
/// is then a gap.
fn longest_gap(times: &[f64]) -> f64 {
    let mut steps: Vec<f64> = times.windows(2).map(|pair| pair[1] - pair[0]).collect();
    steps.sort_by(f64::total_cmp);
    steps.get(steps.len() / 2).map_or(LONGEST_GAP, |period| LONGEST_GAP.max(1.5 * period))
}

fn by_file<'a>(rows: impl Iterator<Item = &'a PoseRow>) -> BTreeMap<String, &'a PoseRow> {
    let named = rows.filter_map(|row| Some((file_name(row.file.as_ref()?), row)));
    named.flat_map(|(name, row)| keys(&name).into_iter().map(move |key| (key, row))).collect()
}

/// Keys that match a file: its name, its name without extension, the number in it.
pub(super) fn keys(name: &str) -> Vec<String> {
    // In `1.05` the dot is a decimal point.
    let is_extension = |end: &str| end.bytes().any(|byte| byte.is_ascii_alphabetic());
    let stem = name.rsplit_once('.').filter(|(_, end)| is_extension(end)).map_or(name, |(stem, _)| stem);
    let digits = stem.trim_start_matches(|c: char| !c.is_ascii_digit());
    let mut keys = vec![name.to_owned(), stem.to_owned()];
    // Matches `view_010` with a row that says `10`.
    keys.extend(digits.parse::<u64>().ok().map(|number| number.to_string()));
    keys
}

/// Interpolates linearly between the two rows around a time; headings along the shorter arc.
fn interpolated(rows: &[PoseRow], seconds: f64, longest_gap: f64) -> Option<Placed> {
    let after = rows.partition_point(|row| row.time < Some(seconds));
    let late = rows.get(after)?;
    if late.time == Some(seconds) {
        return Some(Placed { seconds, position: [late.x, late.y], heading: late.heading });
    }
    let early = rows.get(after.checked_sub(1)?)?;
    if late.time? - early.time? > longest_gap {
        return None;
    }
    let share = (seconds - early.time?) / (late.time? - early.time?);
    let between = |early: f64, late: f64| early + share * (late - early);
    let heading = match (early.heading, late.heading) {
        (Some(early), Some(late)) => {
            let turn = wrap_angle(late - early);
            Some(wrap_angle(early + share * turn))
        }
        _ => None,
    };
    Some(Placed { seconds, position: [between(early.x, late.x), between(early.y, late.y)], heading })
}

pub(super) fn read_image(path: &Path) -> Result<EncodedImage, String> {
    let bytes = fs::read(path).map_err(|error| error.to_string())?;
    let image = EncodedImage::from_bytes(bytes).ok_or("neither PNG nor JPEG")?;
    image.size().map_err(|error| error.to_string())?;
    Ok(image)
}

pub(super) fn name_of(path: &Path) -> String {
    path.file_name().unwrap_or_default().to_string_lossy().into_owned()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn row(file: Option<&str>, time: Option<f64>, x: f64) -> Option<PoseRow> {
        Some(PoseRow { file: file.map(str::to_owned), time, x, y: 0.0, heading: Some(3.0 * x) })
    }

    fn names() -> Vec<String> {
        ["view_8.png", "view_9.png", "view_10.png"].map(str::to_owned).to_vec()
    }

    fn xs(placed: Vec<Option<Placed>>) -> Vec<Option<f64>> {
        placed.iter().map(|placed| placed.map(|placed| placed.position[0])).collect()
    }

    #[test]
    fn frames_are_placed_by_file_by_time_or_by_row() {
        let files = [row(Some("10"), None, 3.0), row(Some("a/view_8.png"), None, 1.0)];
        assert_eq!(xs(place(&names(), &files, None).unwrap()), [Some(1.0), None, Some(3.0)]);
        let stamps: Stamps = names().into_iter().zip([0.5, 1.0, 9.0]).collect();
        let times = [row(None, Some(0.0), 0.0), row(None, Some(1.0), 1.0), row(None, Some(2.0), 4.0)];
        let placed = place(&names(), &times, Some(&stamps)).unwrap();
        assert_eq!(placed[0].unwrap().heading, Some(1.5));
        assert_eq!(xs(placed), [Some(0.5), Some(1.0), None]);
        assert_eq!(xs(place(&names(), &times, None).unwrap()), [Some(0.0), Some(1.0), Some(4.0)]);
        assert!(place(&names(), &times[..2], None).unwrap_err().to_string().contains("--stamps"));
        let untimed = [row(None, None, 0.0), row(None, None, 1.0)];
        assert!(place(&names(), &untimed, None).is_err());
    }

    #[test]
    fn a_gap_between_poses_gives_no_pose() {
        let stamps: Stamps = names().into_iter().zip([0.05, 5.0, 20.05]).collect();
        let rows = [0.0, 0.1, 0.2, 20.0, 20.1].map(|time| row(None, Some(time), time));
        let placed = xs(place(&names(), &rows, Some(&stamps)).unwrap());
        assert!(placed[0].is_some() && placed[1].is_none() && placed[2].is_some(), "{placed:?}");
        assert_eq!(longest_gap(&[0.0, 0.1, 0.2]), 0.5);
        assert_eq!(longest_gap(&[0.0, 1.0, 2.0]), 1.5);
    }

    #[test]
    fn a_bad_row_leaves_its_own_frame_without_pose() {
        let rows = [row(None, None, 1.0), None, row(None, None, 3.0)];
        assert_eq!(xs(place(&names(), &rows, None).unwrap()), [Some(1.0), None, Some(3.0)]);
    }
}
