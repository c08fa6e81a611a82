use std::iter;
use std::ops::Range;

use nalgebra::Isometry2;

use super::breakpoints::surfaces;
use super::curvature_test::curved;
use super::merge::merge;
use super::pieces::{Piece, split};
use super::points::Points;
use super::{BeamCounts, LineExtraction, LineExtractionParams, Scan, WallSegment};
use crate::LineExtractionError;
use crate::simplify::PolylineSimplifier;

/// The walls in one scan; [`LineExtractor`] does the same for many, faster.
///
/// ```
/// use wayfix_line_extract::{LineExtractionParams, Scan, extract};
///
/// // A corner: a wall 2 m ahead (x = 2) and one 1 m to the left (y = 1), seen over a quarter turn.
/// let increment = 0.5_f64.to_radians();
/// let ranges: Vec<_> = (0..180)
///     .map(|i| f64::from(i) * increment)
///     .map(|bearing| (2.0 / bearing.cos()).min(1.0 / bearing.sin()))
///     .collect();
/// let scan = Scan { angle_min: 0.0, angle_increment: increment, ranges: &ranges, max_range: 8.0 };
/// let walls = extract(&scan, &LineExtractionParams::default())?.segments;
/// assert_eq!(walls.len(), 2);
/// assert!((walls[0].estimate.line.rho() - 2.0).abs() < 1e-3 && walls[0].estimate.line.alpha().abs() < 1e-3);
/// assert!((walls[1].estimate.line.rho() - 1.0).abs() < 1e-3);
/// assert!((walls[1].length() - 2.0).abs() < 0.05);
/// # Ok::<(), wayfix_line_extract::LineExtractionError>(())
/// ```
///
/// # Errors
/// Returns [`LineExtractionError::Param`] if a parameter is out of range, and [`LineExtractionError::Scan`] or [`LineExtractionError::MoreThanATurn`] if the scan geometry is invalid.
/// Invalid ranges are no error: their beams are skipped and counted.
pub fn extract(scan: &Scan, params: &LineExtractionParams) -> Result<LineExtraction, LineExtractionError> {
    LineExtractor::new(*params)?.extract(scan)
}

/// Extracts the walls of a sequence of scans, with reused memory and directions computed once.
///
/// ```
/// use wayfix_line_extract::{LineExtractor, LineExtractionParams, Scan};
///
/// let mut extractor = LineExtractor::new(LineExtractionParams::default())?;
/// let mut ranges = vec![f64::NAN; 181];
/// let scan = Scan { angle_min: -1.57, angle_increment: 0.01745, ranges: &ranges, max_range: 8.0 };
/// let blind = extractor.extract(&scan)?;
/// assert_eq!((blind.segments.len(), blind.counts.nan), (0, 181));
/// # Ok::<(), wayfix_line_extract::LineExtractionError>(())
/// ```
#[derive(Clone, Debug)]
pub struct LineExtractor {
    params: LineExtractionParams,
    points: Points,
    surfaces: Vec<Range<usize>>,
    simplifier: PolylineSimplifier,
    corners: Vec<usize>,
    pieces: Vec<Piece>,
}

impl LineExtractor {
    /// # Errors
    /// Returns [`LineExtractionError::Param`] with the first value that is out of range.
    pub fn new(params: LineExtractionParams) -> Result<Self, LineExtractionError> {
        params.check()?;
        Ok(Self {
            params,
            points: Points::default(),
            surfaces: Vec::new(),
            simplifier: PolylineSimplifier::default(),
            corners: Vec::new(),
            pieces: Vec::new(),
        })
    }

    /// The parameters it was made with.
    pub fn params(&self) -> &LineExtractionParams {
        &self.params
    }

    /// Echoes to surfaces, surfaces to straight pieces, pieces to walls.
    ///
    /// # Errors
    /// Returns [`LineExtractionError::Scan`] or [`LineExtractionError::MoreThanATurn`] if the scan geometry is invalid.
    pub fn extract(&mut self, scan: &Scan) -> Result<LineExtraction, LineExtractionError> {
        self.extract_deskewed(scan, None)
    }

    /// The same for a sensor that moves by `step` from one beam to the next, in its own frame; walls are in the sensor frame at the first beam.
    ///
    /// # Errors
    /// Returns the errors of [`extract`](Self::extract), and [`LineExtractionError::Scan`] if the step is not finite.
    pub fn extract_deskewed(
        &mut self,
        scan: &Scan,
        step: Option<&Isometry2<f64>>,
    ) -> Result<LineExtraction, LineExtractionError> {
        scan.check()?;
        if let Some(value) = step.and_then(|step| step.to_matrix().iter().copied().find(|x| !x.is_finite())) {
            return Err(LineExtractionError::Scan {
                what: "motion from beam to beam",
                value,
                must: "finite",
            });
        }
        let mut counts = BeamCounts::default();
        self.points.fill(scan, &mut counts);
        if let Some(step) = step {
            self.points.deskew(step);
        }
        surfaces(&self.points, scan, &self.params, &mut self.surfaces);
        self.fit_pieces()?;
        merge(&mut self.pieces, &self.params);
        let segments: Vec<_> =
            self.pieces.iter().map(segment).filter(|segment| self.is_a_wall(segment)).collect();
        counts.surfaces = self.surfaces.len();
        counts.in_segments = segments.iter().map(|segment| segment.n_points).sum();
        Ok(LineExtraction { segments, counts })
    }

    fn fit_pieces(&mut self) -> Result<(), LineExtractionError> {
        self.pieces.clear();
        for surface in &self.surfaces {
            let echoes = &self.points.at[surface.clone()];
            split(echoes, &self.params, &mut self.simplifier, &mut self.corners)?;
            let last = self.corners.len() - 1;
            let first_piece = self.pieces.len();
            for (k, pair) in self.corners.windows(2).enumerate() {
                // A corner is counted once: it belongs to the wall after it, the last point to the last wall.
                let end = pair[1] + usize::from(k + 1 == last);
                let range = surface.start + pair[0]..surface.start + end;
                self.pieces.extend(Piece::fit(&self.points, range, &self.params));
            }
            let bends: Vec<_> = self.pieces[first_piece..].iter().map(|piece| piece.bend).collect();
            let curved = curved(&bends);
            let mut of_arcs = iter::repeat_n(false, first_piece).chain(curved);
            self.pieces.retain(|_| of_arcs.next() != Some(true));
        }
        Ok(())
    }

    fn is_a_wall(&self, segment: &WallSegment) -> bool {
        segment.n_points >= self.params.min_points && segment.length() >= self.params.min_length_m
    }
}

fn segment(piece: &Piece) -> WallSegment {
    let line = &piece.estimate.line;
    let [start, end] = piece.ends.map(|end| line.project(&end));
    WallSegment {
        estimate: piece.estimate,
        start,
        end,
        n_points: piece.moments.n_points,
        rms_m: piece.moments.rms(line),
        chi_squared: piece.moments.chi_squared(line),
        beams: piece.beams,
    }
}
