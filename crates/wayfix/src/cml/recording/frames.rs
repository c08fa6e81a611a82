use std::{cmp::Ordering, collections::BTreeMap, fs, path::Path};

use wayfix_sensor_log::{EncodedImage, ImageFormat, image_files};

use super::{
    RecordingError,
    poses::{self, PoseRow, Units},
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
}

impl Recording {
    /// Reads the images of a folder and a table of poses; `stamps` names the table of times where the poses are by time.
    ///
    /// # Errors
    /// When something cannot be read, or frames and poses cannot be brought together.
    pub fn read(folder: &Path, poses: &Path, stamps: Option<&Path>) -> Result<Self, RecordingError> {
        let files = image_files(folder)?;
        let names: Vec<String> = files.iter().map(|path| name_of(path)).collect();
        let Some(first) = names.first() else {
            return Err(RecordingError::Nothing { path: folder.to_owned(), what: "PNG or JPEG images" });
        };
        let rows = poses::read(poses, Units::of(poses))?;
        let found = match stamps {
            Some(path) => Some(path.to_owned()),
            None => stamps::find(folder, poses, first),
        };
        let stamps = found.as_deref().map(stamps::read).transpose()?;
        let placed = place(&names, &rows, stamps.as_ref())?;

        let mut frames = Vec::new();
        for (path, placed) in files.iter().zip(placed) {
            if let Some(Placed { seconds, position, heading }) = placed {
                frames.push(Frame {
                    name: name_of(path),
                    seconds,
                    position,
                    heading,
                    image: read_image(path)?,
                });
            }
        }
        frames.sort_by(|a, b| a.seconds.total_cmp(&b.seconds));
        let n_without_pose = files.len() - frames.len();
        Ok(Self { frames, n_without_pose })
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

/// The pose of each frame that has one: by the file that its row names, else by time, else row by row.
fn place(
    names: &[String],
    rows: &[PoseRow],
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
        names.iter().map(|name| interpolated(&rows, stamp(name)?)).collect()
    } else if rows.len() == names.len() {
        rows.iter().enumerate().map(|(index, row)| Some(at(index, row))).collect()
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

/// Along a straight line between the two rows around a time, headings along the shorter arc.
fn interpolated(rows: &[PoseRow], seconds: f64) -> Option<Placed> {
    let after = rows.partition_point(|row| row.time < Some(seconds));
    let late = rows.get(after)?;
    if late.time == Some(seconds) {
        return Some(Placed { seconds, position: [late.x, late.y], heading: late.heading });
    }
    let early = rows.get(after.checked_sub(1)?)?;
    let share = (seconds - early.time?) / (late.time? - early.time?);
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

fn read_image(path: &Path) -> Result<EncodedImage, RecordingError> {
    let bytes = fs::read(path).map_err(|source| RecordingError::Io { path: path.to_owned(), source })?;
    let format = ImageFormat::of_bytes(&bytes);
    let format = format.ok_or_else(|| RecordingError::NotAnImage { path: path.to_owned() })?;
    let image = EncodedImage::new(format, bytes);
    image.size().map_err(|source| RecordingError::Image { path: path.to_owned(), source })?;
    Ok(image)
}

fn name_of(path: &Path) -> String {
    path.file_name().unwrap_or_default().to_string_lossy().into_owned()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn row(file: Option<&str>, time: Option<f64>, x: f64) -> PoseRow {
        PoseRow { file: file.map(str::to_owned), time, x, y: 0.0, heading: Some(3.0 * x) }
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
}
