use std::{
    collections::{BTreeMap, BTreeSet, HashMap},
    io::BufRead,
};

use nalgebra::DMatrix;
use wayfix_estimation_traits::{Pose2, Pose3};

use super::{
    Edge, G2o, G2oError, LineProblem, PointEdge, PoseGraph, RigidPose, dead_reckoning, parse::Words,
};

/// The lines of a file, vertices not looked up yet.
struct Lines<P: RigidPose> {
    poses: Vec<(u64, P)>,
    points: Vec<(u64, P::Point)>,
    /// Line, both identifiers, measurement, information.
    edges: Vec<(usize, [u64; 2], P, DMatrix<f64>)>,
    point_edges: Vec<PointLine>,
    sensors: BTreeMap<u64, P>,
    fixed: BTreeMap<u64, usize>,
    known: BTreeSet<u64>,
}

/// Reads a file; the dimension is that of its first line.
///
/// # Errors
/// [`G2oError::Read`], [`G2oError::Line`] with the number of the line, [`G2oError::Empty`].
pub fn read(reader: impl BufRead) -> Result<G2o, G2oError> {
    let (mut planar, mut spatial) = (Lines::<Pose2<f64>>::new(), Lines::<Pose3<f64>>::new());
    let mut number = 0;
    for line in reader.lines() {
        let line = line.map_err(|source| G2oError::Read { line: number, source })?;
        number += 1;
        let Some(words) = Words::of(&line) else { continue };
        let result = match words.tag() {
            "FIX" => {
                planar.fix(number, words).map(|ids| spatial.fixed.extend(ids.iter().map(|id| (*id, number))))
            }
            "PARAMS_SE3OFFSET" => spatial.sensor(words),
            tag if Pose2::<f64>::TAGS.contains(&tag) => planar.take(number, words),
            tag if Pose3::<f64>::TAGS.contains(&tag) => spatial.take(number, words),
            tag => Err(LineProblem::UnknownTag(tag.to_owned())),
        };
        let mixed = (!planar.is_empty() && !spatial.is_empty()).then_some(LineProblem::MixedDimensions);
        if let Some(problem) = result.err().or(mixed) {
            return Err(G2oError::Line { line: number, problem });
        }
    }
    if spatial.is_empty() { planar.connect().map(G2o::Planar) } else { spatial.connect().map(G2o::Spatial) }
}

/// An edge to a landmark.
struct PointLine {
    line: usize,
    ends: [u64; 2],
    sensor: u64,
    measured: Vec<f64>,
    information: DMatrix<f64>,
}

impl<P: RigidPose> Lines<P> {
    fn new() -> Self {
        Self {
            poses: Vec::new(),
            points: Vec::new(),
            edges: Vec::new(),
            point_edges: Vec::new(),
            sensors: BTreeMap::new(),
            fixed: BTreeMap::new(),
            known: BTreeSet::new(),
        }
    }

    fn is_empty(&self) -> bool {
        self.known.is_empty() && self.edges.is_empty() && self.point_edges.is_empty()
    }

    fn fix(&mut self, line: usize, mut words: Words<'_>) -> Result<Vec<u64>, LineProblem> {
        let ids = (0..words.n_left()).map(|_| words.id()).collect::<Result<Vec<_>, _>>()?;
        self.fixed.extend(ids.iter().map(|id| (*id, line)));
        Ok(ids)
    }

    fn sensor(&mut self, mut words: Words<'_>) -> Result<(), LineProblem> {
        words.expect(1 + P::N_NUMBERS)?;
        let (id, numbers) = (words.id()?, words.numbers(P::N_NUMBERS)?);
        self.sensors.insert(id, P::from_numbers(&numbers)?);
        Ok(())
    }

    fn take(&mut self, line: usize, mut words: Words<'_>) -> Result<(), LineProblem> {
        let dim = P::COORDINATES.len();
        let [pose, point, edge, _] = P::TAGS;
        let triangle = |n: usize| n * (n + 1) / 2;
        if words.tag() == pose {
            words.expect(1 + P::N_NUMBERS)?;
            let id = self.new_vertex(&mut words)?;
            self.poses.push((id, P::from_numbers(&words.numbers(P::N_NUMBERS)?)?));
        } else if words.tag() == point {
            words.expect(1 + P::N)?;
            let id = self.new_vertex(&mut words)?;
            self.points.push((id, P::point(&words.numbers(P::N)?)));
        } else if words.tag() == edge {
            words.expect(2 + P::N_NUMBERS + triangle(dim))?;
            let ends = two_vertices(&mut words)?;
            let measured = P::from_numbers(&words.numbers(P::N_NUMBERS)?)?;
            self.edges.push((line, ends, measured, words.symmetric(dim)?));
        } else {
            let has_sensor = usize::from(P::N == 3);
            words.expect(2 + has_sensor + P::N + triangle(P::N))?;
            let ends = two_vertices(&mut words)?;
            let sensor = if has_sensor == 1 { words.id()? } else { 0 };
            let measured = words.numbers(P::N)?;
            let information = words.symmetric(P::N)?;
            self.point_edges.push(PointLine { line, ends, sensor, measured, information });
        }
        Ok(())
    }

    fn new_vertex(&mut self, words: &mut Words<'_>) -> Result<u64, LineProblem> {
        let id = words.id()?;
        if self.known.insert(id) { Ok(id) } else { Err(LineProblem::DuplicateVertex(id)) }
    }

    /// Looks the vertices of the edges up.
    fn connect(mut self) -> Result<PoseGraph<P>, G2oError> {
        if self.edges.is_empty() && self.point_edges.is_empty() {
            return Err(G2oError::Empty);
        }
        let is_dead_reckoned = self.known.is_empty();
        if is_dead_reckoned {
            self.make_vertices();
        }
        let place = |id: &(usize, u64)| (id.1, id.0);
        let poses: HashMap<u64, usize> =
            self.poses.iter().map(|(id, _)| *id).enumerate().map(|p| place(&p)).collect();
        let points: HashMap<u64, usize> =
            self.points.iter().map(|(id, _)| *id).enumerate().map(|p| place(&p)).collect();
        let find = |among: &HashMap<u64, usize>, others: &HashMap<u64, usize>, id: u64, line: usize| {
            let problem = if others.contains_key(&id) {
                LineProblem::WrongVertex(id)
            } else {
                LineProblem::MissingVertex(id)
            };
            among.get(&id).copied().ok_or(G2oError::Line { line, problem })
        };
        let mut edges = Vec::with_capacity(self.edges.len());
        for (line, [from, to], measured, information) in self.edges {
            let (from, to) = (find(&poses, &points, from, line)?, find(&poses, &points, to, line)?);
            edges.push(Edge { from, to, measured, information, line });
        }
        let mut point_edges = Vec::with_capacity(self.point_edges.len());
        for PointLine { line, ends: [from, to], sensor, measured, information } in self.point_edges {
            let (from, to) = (find(&poses, &points, from, line)?, find(&points, &poses, to, line)?);
            let sensor = match self.sensors.get(&sensor) {
                Some(sensor) => *sensor,
                None if sensor == 0 => P::identity(),
                None => return Err(G2oError::Line { line, problem: LineProblem::MissingSensor(sensor) }),
            };
            let (measured, information) = in_the_body(&sensor, &measured, &information);
            let finite = |what, numbers: &[f64]| {
                let problem = LineProblem::NotFinite(what);
                numbers
                    .iter()
                    .all(|number| number.is_finite())
                    .then_some(())
                    .ok_or(G2oError::Line { line, problem })
            };
            finite("the measurement in the body frame", &P::coordinates(&measured))?;
            finite("the information in the body frame", information.as_slice())?;
            point_edges.push(PointEdge { from, to, measured, information, line });
        }
        for (id, line) in &self.fixed {
            if !poses.contains_key(id) && !points.contains_key(id) {
                return Err(G2oError::Line { line: *line, problem: LineProblem::MissingVertex(*id) });
            }
        }
        let fixed = self.fixed.into_keys().collect();
        let mut graph =
            PoseGraph { poses: self.poses, points: self.points, edges, point_edges, fixed, is_dead_reckoned };
        if is_dead_reckoned {
            dead_reckoning::place(&mut graph);
        }
        Ok(graph)
    }

    /// The vertices that edges name, by identifier.
    fn make_vertices(&mut self) {
        let on_edges = self.edges.iter().flat_map(|(_, ends, ..)| *ends);
        let poses: BTreeSet<u64> = on_edges.chain(self.point_edges.iter().map(|edge| edge.ends[0])).collect();
        let points: BTreeSet<u64> = self.point_edges.iter().map(|edge| edge.ends[1]).collect();
        self.points = points.difference(&poses).map(|id| (*id, P::point(&[0.0; 3]))).collect();
        self.poses = poses.into_iter().map(|id| (id, P::identity())).collect();
    }
}

fn two_vertices(words: &mut Words<'_>) -> Result<[u64; 2], LineProblem> {
    let ends = [words.id()?, words.id()?];
    if ends[0] == ends[1] { Err(LineProblem::SelfEdge(ends[0])) } else { Ok(ends) }
}

/// A measurement of a sensor on the robot as one of the robot: the residual turns with the sensor.
fn in_the_body<P: RigidPose>(
    sensor: &P,
    measured: &[f64],
    information: &DMatrix<f64>,
) -> (P::Point, DMatrix<f64>) {
    let mut position = nalgebra::Vector3::zeros();
    position.as_mut_slice()[..P::N].copy_from_slice(measured);
    let rotation = sensor.rotation_part();
    let turn = DMatrix::from_fn(P::N, P::N, |i, k| rotation[(i, k)]);
    let turned = &turn * information * turn.transpose();
    (P::point_at(&(rotation * position + sensor.translation_part())), turned.symmetric_part())
}
