use super::svg::axis::{Axis, AxisScale};
use super::svg::ellipse::ellipse;
use super::svg::ink::Ink;
use super::svg::layout::{Frame, PANEL_WIDTH, Plate, no_data};
use super::svg::legend::{Legend, Mark};
use super::svg::panel::Panel;
use super::{PlotError, SvgPlot};

/// Paths and landmarks of a planar run; both axes have the same scale.
/// ```
/// use wayfix_evaluation::plot::{EstimatedLandmark, MapPlot};
/// let map = MapPlot {
///     title: "Map".to_owned(),
///     estimate: vec![(0.0, 0.0), (2.0, 0.5), (3.0, 2.0)],
///     landmarks: vec![EstimatedLandmark { position: (1.0, 1.0), covariance: [[0.04, 0.01], [0.01, 0.02]] }],
///     ..MapPlot::default()
/// };
/// let picture = map.draw()?;
/// assert!(picture.svg.starts_with("<svg ") && picture.alt.contains("1 estimated landmark"));
/// # Ok::<(), wayfix_evaluation::plot::PlotError>(())
/// ```
#[derive(Clone, Debug, Default, PartialEq)]
pub struct MapPlot {
    /// Caption.
    pub title: String,
    /// True path `(x, y)`, m; may be empty, like every list here.
    pub truth: Vec<(f64, f64)>,
    /// Estimated path.
    pub estimate: Vec<(f64, f64)>,
    /// Path of the odometry alone. It drifts, so it is cut off where it leaves the surroundings of the others.
    pub dead_reckoning: Vec<(f64, f64)>,
    /// Estimated landmarks.
    pub landmarks: Vec<EstimatedLandmark>,
    /// True landmarks.
    pub true_landmarks: Vec<(f64, f64)>,
    /// Lines on the floor, true walls: drawn faintly beneath.
    pub surroundings: Vec<Vec<(f64, f64)>>,
    /// Extracted walls.
    pub walls: Vec<Vec<(f64, f64)>>,
    /// Outlines of the 2σ bands of walls.
    pub bands: Vec<Vec<(f64, f64)>>,
    /// Echoes of a laser; one dot a pixel is drawn.
    pub echoes: Vec<(f64, f64)>,
    /// Positions of a map's reference views, m.
    pub references: Vec<(f64, f64)>,
}

/// A landmark of the map.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct EstimatedLandmark {
    /// Mean `(x, y)`, metres.
    pub position: (f64, f64),
    /// Covariance of x and y, m²; drawn as its 2σ ellipse, or skipped if not positive definite.
    pub covariance: [[f64; 2]; 2],
}

/// Maximum extension of the map by ellipses and dead reckoning, as a share of its size on each side.
const OVERHANG: f64 = 0.35;
/// Height of the map as a share of its width.
const SHAPE: (f64, f64) = (0.4, 1.1);

impl MapPlot {
    /// The picture.
    ///
    /// # Errors
    /// Returns an error if the drawing library refuses.
    pub fn draw(&self) -> Result<SvgPlot, PlotError> {
        let ellipses: Vec<Vec<(f64, f64)>> = self
            .landmarks
            .iter()
            .map(|landmark| ellipse(landmark.position, landmark.covariance, 2.0))
            .collect();
        let Some((x, y, height)) = self.axes(&ellipses) else { return no_data(&self.title) };
        let frame = Frame { title: &self.title, alt: self.alt(), legend: self.legend(), x_label: "x, m" };
        let plate = Plate { heading: "y, m".to_owned(), x, y, height };
        frame.draw(&[plate], |_, panel| self.fill(panel, &ellipses))
    }

    fn fill(&self, panel: &Panel, ellipses: &[Vec<(f64, f64)>]) -> Result<(), PlotError> {
        self.surroundings.iter().try_for_each(|line| panel.path(line, Ink::Grid, 1.6))?;
        panel.dots(&self.echoes, 0.8, Ink::ECHO, 0.9)?;
        self.bands.iter().try_for_each(|band| panel.outline(band, Ink::LANDMARK))?;
        self.references.iter().try_for_each(|place| panel.dot(*place, 1.8, Ink::LANDMARK, 1.0))?;
        self.walls.iter().try_for_each(|wall| panel.path(wall, Ink::LANDMARK, 1.6))?;
        panel.path(&self.dead_reckoning, Ink::DEAD_RECKONING, 1.1)?;
        panel.path(&self.truth, Ink::TRUTH, 1.4)?;
        panel.path(&self.estimate, Ink::ESTIMATE, 1.4)?;
        for ellipse in ellipses {
            panel.outline(ellipse, Ink::LANDMARK)?;
        }
        for landmark in &self.landmarks {
            panel.dot(landmark.position, 1.8, Ink::LANDMARK, 1.0)?;
        }
        self.true_landmarks.iter().try_for_each(|position| panel.cross(*position, 3.5, Ink::Text))
    }

    fn legend(&self) -> Legend {
        Legend::default()
            .with_if(!self.truth.is_empty(), Mark::Line(Ink::TRUTH), "true path")
            .with_if(!self.estimate.is_empty(), Mark::Line(Ink::ESTIMATE), "estimate")
            .with_if(!self.dead_reckoning.is_empty(), Mark::Line(Ink::DEAD_RECKONING), "dead reckoning")
            .with_if(!self.landmarks.is_empty(), Mark::Dot(Ink::LANDMARK), "landmark, 2σ")
            .with_if(!self.walls.is_empty(), Mark::Line(Ink::LANDMARK), "wall")
            .with_if(!self.bands.is_empty(), Mark::Band(Ink::LANDMARK), "2σ of a wall")
            .with_if(!self.echoes.is_empty(), Mark::Dot(Ink::ECHO), "scan point")
            .with_if(!self.references.is_empty(), Mark::Dot(Ink::LANDMARK), "reference view")
            .with_if(!self.true_landmarks.is_empty(), Mark::Cross(Ink::Text), "true landmark")
    }

    fn alt(&self) -> String {
        if self.landmarks.is_empty() && !self.walls.is_empty() {
            return format!("{}: map of {} walls that were found", self.title, self.walls.len());
        }
        if !self.references.is_empty() {
            return format!(
                "{}: map of the estimated path and {} reference views",
                self.title,
                self.references.len()
            );
        }
        let landmarks = self.landmarks.len();
        let plural = if landmarks == 1 { "" } else { "s" };
        let against = if self.truth.is_empty() { "" } else { " with the true path" };
        format!(
            "{}: map of the estimated path{against} and {landmarks} estimated landmark{plural} with 2σ ellipses",
            self.title
        )
    }

    /// Axes of one scale around everything that belongs to the map, and the height of the panel in pixels.
    fn axes(&self, ellipses: &[Vec<(f64, f64)>]) -> Option<(Axis, Axis, f64)> {
        let means = self.landmarks.iter().map(|landmark| landmark.position);
        let core: Vec<_> =
            [&self.truth, &self.estimate, &self.true_landmarks, &self.echoes, &self.references]
                .into_iter()
                .chain(self.surroundings.iter().chain(&self.walls))
                .flatten()
                .copied()
                .chain(means)
                .collect();
        let rest: Vec<_> = self.dead_reckoning.iter().chain(ellipses.iter().flatten()).copied().collect();
        let (x, y) = Extent::of(&core).or_else(|| Extent::of(&rest))?;
        let allowance = OVERHANG * x.length().max(y.length());
        let (rest_x, rest_y) = Extent::of(&rest).unwrap_or((x, y));
        let (x, y) = (x.stretched_to(rest_x, allowance), y.stretched_to(rest_y, allowance));

        let length = x.length().max(y.length());
        let least = if length > 0.0 { 1e-6 * length } else { 1.0 };
        let (x, y) = (x.padded(0.04 * length, least), y.padded(0.04 * length, least));
        let shape = (y.length() / x.length()).clamp(SHAPE.0, SHAPE.1);
        let meters_wide = x.length().max(y.length() / shape);
        // Round the height first, then derive the axes from it; rounding after would stretch one of them.
        let height = (PANEL_WIDTH * shape).round();
        Some((x.widened(meters_wide), y.widened(meters_wide * height / PANEL_WIDTH), height))
            .map(|(x, y, height)| (Axis::linear(x.low, x.high), Axis::linear(y.low, y.high), height))
    }
}

/// An interval of metres.
#[derive(Clone, Copy)]
struct Extent {
    low: f64,
    high: f64,
}

impl Extent {
    /// Ranges of drawable points in x and in y.
    fn of(points: &[(f64, f64)]) -> Option<(Self, Self)> {
        let drawable = |value: f64| Axis::covering([value], AxisScale::Linear, 0.0).is_some();
        let mut points = points.iter().filter(|(x, y)| drawable(*x) && drawable(*y));
        let first = points.next()?;
        let start = (Self { low: first.0, high: first.0 }, Self { low: first.1, high: first.1 });
        Some(points.fold(start, |(x, y), point| (x.including(point.0), y.including(point.1))))
    }
    fn including(self, value: f64) -> Self {
        Self { low: self.low.min(value), high: self.high.max(value) }
    }
    fn length(self) -> f64 {
        self.high - self.low
    }
    fn stretched_to(self, other: Self, allowance: f64) -> Self {
        self.including(other.low.max(self.low - allowance)).including(other.high.min(self.high + allowance))
    }
    fn padded(self, padding: f64, least: f64) -> Self {
        let padding = padding.max(0.5 * least);
        Self { low: self.low - padding, high: self.high + padding }
    }
    /// The same centre, `length` metres long.
    fn widened(self, length: f64) -> Self {
        let center = 0.5 * (self.low + self.high);
        Self { low: center - 0.5 * length, high: center + 0.5 * length }
    }
}
