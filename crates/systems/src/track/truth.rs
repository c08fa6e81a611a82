use std::{fs, path::Path};

use wayfix_visual_tracking::BoundingBox;

use super::TrackSystemError;

/// True boxes of the target, frame by frame.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct TrueBoxes {
    frames: Vec<TargetTruth>,
    n_unusable: usize,
    /// The first invalid lines.
    unusable: Vec<String>,
}

/// Maximum number of invalid lines that are named.
const MOST_NAMED: usize = 3;

/// Truth of one frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum TargetTruth {
    /// The target is in this box.
    At(BoundingBox),
    /// The target is not in the image.
    Absent,
    /// The truth is unknown.
    Unknown,
}

impl TargetTruth {
    /// The true box, if it is known and in the image.
    pub fn target(self) -> Option<BoundingBox> {
        match self {
            Self::At(target) => Some(target),
            Self::Absent | Self::Unknown => None,
        }
    }
}

impl TrueBoxes {
    /// Reads one box per line, line k for frame k, as in [`parse_box`]. The truth of a frame with a blank or invalid line is unknown.
    /// A first line without a number is a header. Empty lines at the end do not count.
    ///
    /// # Errors
    /// Returns [`TrackSystemError::Read`], or [`TrackSystemError::Line`] for the first line if no line is a box.
    pub fn read(path: &Path) -> Result<Self, TrackSystemError> {
        let read = fs::read(path).map_err(|source| TrackSystemError::Read { path: path.into(), source })?;
        Self::parse(&String::from_utf8_lossy(&read))
    }

    /// Parses the same format from a text.
    ///
    /// # Errors
    /// Returns [`TrackSystemError::Line`].
    pub fn parse(text: &str) -> Result<Self, TrackSystemError> {
        let text = text.trim_start_matches('\u{feff}').trim_end();
        let mut found = Self::default();
        let mut first_error = None;
        let n_header = usize::from(text.lines().next().is_some_and(is_header) && text.lines().count() > 1);
        for (index, line) in text.lines().enumerate().skip(n_header) {
            found.frames.push(match parse_box(line) {
                Ok(Some(target)) => TargetTruth::At(target),
                Ok(None) => TargetTruth::Absent,
                Err(source) => {
                    let error = TrackSystemError::Line { line: index + 1, source: Box::new(source) };
                    if found.unusable.len() < MOST_NAMED {
                        let line: String = line.chars().take(80).collect();
                        found.unusable.push(format!("line {} {line:?}", index + 1));
                    }
                    found.n_unusable += 1;
                    first_error.get_or_insert(error);
                    TargetTruth::Unknown
                }
            });
        }
        match first_error {
            Some(error) if found.n_unusable == found.frames.len() => Err(error),
            _ => Ok(found),
        }
    }

    /// A message about invalid lines.
    pub(super) fn unusable_lines_message(&self) -> Option<String> {
        (self.n_unusable > 0).then(|| {
            let (n, named) = (self.n_unusable, self.unusable.join(", "));
            format!(
                "{n} of {} lines of the truth are no box ({named}): their frames are not judged",
                self.len()
            )
        })
    }

    /// Truth of a frame, counted from 0.
    pub fn at(&self, frame: usize) -> TargetTruth {
        self.frames.get(frame).copied().unwrap_or(TargetTruth::Unknown)
    }

    /// Number of frames.
    pub fn len(&self) -> usize {
        self.frames.len()
    }

    /// Whether there are no frames.
    pub fn is_empty(&self) -> bool {
        self.frames.is_empty()
    }
}

/// Parses a box from four numbers `x,y,w,h` or from the eight corner coordinates `x1,y1 … x4,y4` of a quadrangle, whose bounding box it returns.
/// Separators are commas, semicolons, tabs or blanks. Returns `None` for an absent target: NaN or zero extent.
///
/// ```
/// use wayfix_systems::track::parse_box;
/// assert_eq!(parse_box("10 20 30 40")?, parse_box("40,20,40,60,10,60,10,20")?);
/// assert_eq!(parse_box("NaN,NaN,NaN,NaN")?, None);
/// assert!(parse_box("10,20,30").is_err() && parse_box("10,20,30,high").is_err());
/// # Ok::<(), wayfix_systems::track::TrackSystemError>(())
/// ```
///
/// # Errors
/// Returns [`TrackSystemError::NotABox`] for another count of numbers, a non-number or a negative extent.
pub fn parse_box(text: &str) -> Result<Option<BoundingBox>, TrackSystemError> {
    let wrong = |reason: String| TrackSystemError::NotABox { text: text.chars().take(80).collect(), reason };
    let words = text.split([',', ';', '\t', ' ']).map(str::trim).filter(|word| !word.is_empty());
    let number = |word: &str| word.parse::<f64>().map_err(|_| wrong(format!("{word:?} is no number")));
    let numbers: Vec<f64> = words.map(number).collect::<Result<_, _>>()?;
    let [x, y, width, height] = match numbers[..] {
        [x, y, width, height] => [x, y, width, height],
        [x1, y1, x2, y2, x3, y3, x4, y4] => around([[x1, y1], [x2, y2], [x3, y3], [x4, y4]]),
        _ => return Err(wrong(format!("{} numbers, neither 4 nor 8", numbers.len()))),
    };
    if numbers.iter().any(|number| !number.is_finite()) || width == 0.0 || height == 0.0 {
        return Ok(None);
    }
    BoundingBox::from_corner(x, y, width, height).map(Some).map_err(|error| wrong(error.to_string()))
}

/// Whether a line consists of words, such as `x,y,w,h`.
fn is_header(line: &str) -> bool {
    let mut words =
        line.split([',', ';', '\t', ' ']).map(str::trim).filter(|word| !word.is_empty()).peekable();
    words.peek().is_some() && words.all(|word| word.parse::<f64>().is_err())
}

/// Left, top, width and height of the bounding box of points.
fn around(corners: [[f64; 2]; 4]) -> [f64; 4] {
    let least = |k: usize| corners.iter().map(|corner| corner[k]).fold(f64::INFINITY, f64::min);
    let most = |k: usize| corners.iter().map(|corner| corner[k]).fold(f64::NEG_INFINITY, f64::max);
    [least(0), least(1), most(0) - least(0), most(1) - least(1)]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_separator_is_understood() {
        let expected = BoundingBox::from_corner(1.5, 2.0, 30.0, 40.0).unwrap();
        for text in ["1.5,2,30,40", "1.5\t2\t30\t40", " 1.5  2 30 40 \r", "1.5, 2; 30, 40"] {
            assert_eq!(parse_box(text).unwrap(), Some(expected), "{text:?}");
        }
        let tilted = parse_box("5,0 10,5 5,10 0,5").unwrap().unwrap();
        assert_eq!((tilted.corner(), tilted.width(), tilted.height()), ([0.0, 0.0], 10.0, 10.0));
    }

    #[test]
    fn absent_target_is_valid_and_inverted_box_is_an_error() {
        for text in ["0,0,0,0", "nan nan nan nan", "NaN,1,2,3", "inf,0,1,1", "3,3,3,3,3,3,3,3"] {
            assert_eq!(parse_box(text).unwrap(), None, "{text:?}");
        }
        for text in ["", "1,2,-3,4", "1,2,3,4,5", "one,2,3,4", "x"] {
            assert!(matches!(parse_box(text), Err(TrackSystemError::NotABox { .. })), "{text:?}");
        }
    }

    #[test]
    fn a_line_that_is_no_box_leaves_its_frame_unknown() {
        let truth = TrueBoxes::parse("1,2,3,4\n\n5,6,3,4\n160,1\n").unwrap();
        assert_eq!(truth.len(), 4);
        assert_eq!((truth.at(1), truth.at(3)), (TargetTruth::Unknown, TargetTruth::Unknown));
        assert_eq!(truth.at(2).target().unwrap().corner(), [5.0, 6.0]);
        let doubt = truth.unusable_lines_message().unwrap();
        assert!(doubt.contains("2 of 4") && doubt.contains("line 2") && doubt.contains("line 4"), "{doubt}");
        let error = TrueBoxes::parse("1,2,3\n4,5,6\n").unwrap_err();
        assert!(matches!(error, TrackSystemError::Line { line: 1, .. }), "{error}");
        assert!(TrueBoxes::parse("x,y,w,h\n1,2,3,4").unwrap().at(0).target().is_some());
    }

    #[test]
    fn what_lies_beyond_the_list_is_unknown() {
        let truth = TrueBoxes::parse("\u{feff}1,2,3,4\r\n0,0,0,0\r\n\r\n").unwrap();
        assert_eq!((truth.len(), truth.unusable_lines_message()), (2, None));
        assert!(truth.at(0).target().is_some());
        assert_eq!((truth.at(1), truth.at(2)), (TargetTruth::Absent, TargetTruth::Unknown));
        assert!(TrueBoxes::parse("").unwrap().is_empty());
    }
}
