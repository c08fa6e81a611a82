use std::{cmp::Ordering, collections::BTreeMap, fs, path::Path};

use wayfix_sensor_log::{EncodedImage, ImageFormat, Problem, ProblemKind, image_files};

use super::{
    RecordingError,
    poses::{self, PoseRow, Poses},
    stamps::{self, Stamps, file_name},
};

/// A frame, and where it was taken.
#[derive(Clone, Debug, PartialEq)]
pub struct Frame {
    /// Name of its file.
    pub name: String,
    /// When, s.
    pub seconds: f64,
    /// Where, m.
    pub position: [f64; 2],
    /// The camera's heading, rad, where the table has it.
    pub heading: Option<f64>,
    /// The picture.
    pub image: EncodedImage,
}

/// A folder of frames with their poses, in the order in which they were taken.
#[derive(Clone, Debug, PartialEq)]
pub struct Recording {
    /// Those with a pose.
    pub frames: Vec<Frame>,
    /// How many images of the folder have none.
    pub n_without_pose: usize,
    /// Rows of the table and images that were left out.
    pub problems: Vec<Problem>,
    /// What columns of the table were read, in which units.
    pub columns: String,
    /// Columns whose names say no unit, with the one that was assumed.
    pub assumed: Vec<String>,
}

/// The files of a recording.
#[derive(Clone, Copy, Debug)]
pub struct RecordingFiles<'a> {
    /// The folder of the images.
    pub frames: &'a Path,
    /// The table of poses.
    pub poses: &'a Path,
    /// The names of its columns, where it has no row of names.
    pub columns: Option<&'a [String]>,
    /// The table of times, where the poses are by time; else the one beside the images.
    pub stamps: Option<&'a Path>,
    /// The names of its columns, where it has no row of names.
    pub stamp_columns: Option<&'a [String]>,
}

impl Recording {
    /// Reads the images of a folder and a table of poses. Rows and images that cannot be used are left out and reported.
    ///
    /// # Errors
    /// When a file cannot be read, or frames and poses cannot be brought together.
    pub fn read(from: &RecordingFiles<'_>) -> Result<Self, RecordingError> {
        let files = image_files(from.frames)?;
        let names: Vec<String> = files.iter().map(|path| name_of(path)).collect();
        let Some(first) = names.first() else {
            return Err(RecordingError::Nothing { path: from.frames.to_owned(), what: "PNG or JPEG images" });
        };
        let Poses { rows, problems, columns, assumed } = poses::read(from.poses, from.columns)?;
        let found = match from.stamps {
            Some(path) => Some(path.to_owned()),
            None => stamps::find(from.frames, from.poses, first),
        };
        let stamps = found.as_deref().map(|path| stamps::read(path, from.stamp_columns)).transpose()?;
        let n_rows = rows.len() + problems.len();
        let placed = place(&names, &rows, n_rows, stamps.as_ref())?;

        let table = name_of(from.poses);
        let row = |(line, reason): (usize, String)| Problem {
            file: table.clone(),
            row: line as u64,
            kind: ProblemKind::NotANumber,
            reason,
        };
        let mut problems: Vec<Problem> = problems.into_iter().map(row).collect();
        let mut frames = Vec::new();
        let mut n_without_pose = 0;
        for (index, (path, placed)) in files.iter().zip(placed).enumerate() {
            let Some(Placed { seconds, position, heading }) = placed else {
                n_without_pose += 1;
                continue;
            };
            match read_image(path) {
                Ok(image) => frames.push(Frame { name: name_of(path), seconds, position, heading, image }),
                Err(reason) => problems.push(Problem {
                    file: name_of(path),
                    row: index as u64 + 1,
                    kind: ProblemKind::UnreadableImage,
                    reason,
                }),
            }
        }
        if frames.is_empty() {
            return Err(RecordingError::Nothing {
                path: from.frames.to_owned(),
                what: "image that can be read",
            });
        }
        frames.sort_by(|a, b| a.seconds.total_cmp(&b.seconds));
        Ok(Self { frames, n_without_pose, problems, columns, assumed })
    }
}

#[derive(Clone, Copy, Debug, PartialEq)]
struct Placed {
    seconds: f64,
    position: [f64; 2],
    heading: Option<f64>,
}

/// Frames without a clock are taken to be so far apart, s.
const STEP: f64 = 0.1;

/// The pose of each frame that has one: by the file that its row names, else by time, else row by row, where there are as many rows.
fn place(
    names: &[String],
    rows: &[PoseRow],
    n_rows: usize,
    stamps: Option<&Stamps>,
) -> Result<Vec<Option<Placed>>, RecordingError> {
    let unmatched = |reason| RecordingError::Unmatched { n_frames: names.len(), n_poses: rows.len(), reason };
    let stamp = |name: &String| stamps.and_then(|stamps| stamps.get(name)).copied();
    let at = |index: usize, row: &PoseRow| Placed {
        seconds: stamp(&names[index]).or(row.time).unwrap_or(STEP * index as f64),
        position: [row.x, row.y],
        heading: row.heading,
    };
    let placed: Vec<Option<Placed>> = if rows.iter().any(|row| row.file.is_some()) {
        let by_file = by_file(rows);
        let find = |name: &String| keys(name).into_iter().find_map(|key| by_file.get(&key).copied());
        names.iter().enumerate().map(|(index, name)| Some(at(index, find(name)?))).collect()
    } else if stamps.is_some() && rows.iter().all(|row| row.time.is_some()) {
        let mut rows = rows.to_vec();
        rows.sort_by(|a, b| a.time.partial_cmp(&b.time).unwrap_or(Ordering::Equal));
        let longest = longest_gap(&rows);
        names.iter().map(|name| interpolated(&rows, stamp(name)?, longest)).collect()
    } else if n_rows == names.len() {
        let mut placed = vec![None; names.len()];
        rows.iter().for_each(|row| placed[row.ordinal] = Some(at(row.ordinal, row)));
        placed
    } else if rows.iter().all(|row| row.time.is_some()) {
        return Err(unmatched(
            "the poses are by time, and nothing tells when the frames were taken (--stamps FILE: rows of time, file)",
        ));
    } else {
        return Err(unmatched("a row for each frame is needed, or a column of file names"));
    };
    match placed.iter().flatten().count() {
        0 | 1 => Err(unmatched("fewer than two frames have a pose")),
        _ => Ok(placed),
    }
}

fn by_file(rows: &[PoseRow]) -> BTreeMap<String, &PoseRow> {
    let named = rows.iter().filter_map(|row| Some((file_name(row.file.as_ref()?), row)));
    named.flat_map(|(name, row)| keys(&name).into_iter().map(move |key| (key, row))).collect()
}

/// What a file may be called: by its name, without its extension, by the number in it.
fn keys(name: &str) -> Vec<String> {
    let stem = name.rsplit_once('.').map_or(name, |(stem, _)| stem);
    let digits = stem.trim_start_matches(|c: char| !c.is_ascii_digit());
    let mut keys = vec![name.to_owned(), stem.to_owned()];
    // `view_010` and a row that says `10`.
    keys.extend(digits.parse::<u64>().ok().map(|number| number.to_string()));
    keys
}

/// Poses are interpolated over at most three usual steps of the table, s: two rows in a row may be lost.
fn longest_gap(rows: &[PoseRow]) -> f64 {
    let steps = rows.windows(2).filter_map(|pair| Some(pair[1].time? - pair[0].time?));
    let mut steps: Vec<f64> = steps.collect();
    steps.sort_by(f64::total_cmp);
    3.0 * steps.get(steps.len() / 2).copied().unwrap_or(0.0)
}

/// Along a straight line between the two rows around a time, headings along the shorter arc; not over a gap that is longer.
fn interpolated(rows: &[PoseRow], seconds: f64, longest: f64) -> Option<Placed> {
    let after = rows.partition_point(|row| row.time < Some(seconds));
    let late = rows.get(after)?;
    if late.time == Some(seconds) {
        return Some(Placed { seconds, position: [late.x, late.y], heading: late.heading });
    }
    let early = rows.get(after.checked_sub(1)?)?;
    let gap = late.time? - early.time?;
    if gap > longest {
        return None;
    }
    let share = (seconds - early.time?) / gap;
    let between = |early: f64, late: f64| early + share * (late - early);
    let heading = match (early.heading, late.heading) {
        (Some(early), Some(late)) => {
            let turn = wayfix_estimation_traits::wrap_angle(late - early);
            Some(wayfix_estimation_traits::wrap_angle(early + share * turn))
        }
        _ => None,
    };
    Some(Placed { seconds, position: [between(early.x, late.x), between(early.y, late.y)], heading })
}

fn read_image(path: &Path) -> Result<EncodedImage, String> {
    let bytes = fs::read(path).map_err(|error| error.to_string())?;
    let format = ImageFormat::of_bytes(&bytes).ok_or("neither PNG nor JPEG")?;
    let image = EncodedImage::new(format, bytes);
    image.size().map_err(|error| error.to_string())?;
    Ok(image)
}

fn name_of(path: &Path) -> String {
    path.file_name().unwrap_or_default().to_string_lossy().into_owned()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn row(file: Option<&str>, time: Option<f64>, x: f64) -> PoseRow {
        PoseRow { ordinal: 0, file: file.map(str::to_owned), time, x, y: 0.0, heading: Some(3.0 * x) }
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
        assert_eq!(xs(place(&names(), &files, 2, None).unwrap()), [Some(1.0), None, Some(3.0)]);
        let stamps: Stamps = names().into_iter().zip([0.5, 1.0, 9.0]).collect();
        let times = [row(None, Some(0.0), 0.0), row(None, Some(1.0), 1.0), row(None, Some(2.0), 4.0)];
        let placed = place(&names(), &times, times.len(), Some(&stamps)).unwrap();
        assert_eq!(placed[0].unwrap().heading, Some(1.5));
        assert_eq!(xs(placed), [Some(0.5), Some(1.0), None]);
        let mut by_row = times.to_vec();
        by_row.iter_mut().enumerate().for_each(|(ordinal, row)| row.ordinal = ordinal);
        assert_eq!(xs(place(&names(), &by_row, 3, None).unwrap()), [Some(0.0), Some(1.0), Some(4.0)]);
        by_row.remove(1);
        assert_eq!(xs(place(&names(), &by_row, 3, None).unwrap()), [Some(0.0), None, Some(4.0)]);
        assert!(place(&names(), &times[..2], 2, None).unwrap_err().to_string().contains("--stamps"));
        let untimed = [row(None, None, 0.0), row(None, None, 1.0)];
        assert!(place(&names(), &untimed, 2, None).is_err());
    }

    #[test]
    fn poses_are_not_interpolated_over_a_gap() {
        let times = [0.0, 0.1, 0.2, 0.3, 20.3, 20.4].map(|time| row(None, Some(time), time));
        let stamps: Stamps = names().into_iter().zip([0.15, 10.0, 20.35]).collect();
        let placed = place(&names(), &times, times.len(), Some(&stamps)).unwrap();
        assert!(placed[0].is_some() && placed[1].is_none() && placed[2].is_some());
    }
}
