use std::io::Write;

use nalgebra::DMatrix;

use super::{G2o, G2oError, PoseGraph, RigidPose};

impl G2o {
    /// Writes the graph so that it is read again to the bit.
    ///
    /// # Errors
    /// [`G2oError::Write`]
    pub fn write(&self, writer: impl Write) -> Result<(), G2oError> {
        match self {
            Self::Planar(graph) => graph.write(writer),
            Self::Spatial(graph) => graph.write(writer),
        }
    }
}

impl<P: RigidPose> PoseGraph<P> {
    /// Writes the graph so that it is read again to the bit; measurements of sensors on the robot as such of the robot.
    ///
    /// # Errors
    /// [`G2oError::Write`]
    pub fn write(&self, mut writer: impl Write) -> Result<(), G2oError> {
        self.lines(&mut writer).and_then(|()| writer.flush()).map_err(G2oError::Write)
    }

    fn lines(&self, writer: &mut impl Write) -> std::io::Result<()> {
        let [pose_tag, point_tag, edge_tag, point_edge_tag] = P::TAGS;
        for (id, pose) in &self.poses {
            writeln!(writer, "{pose_tag} {id}{}", text(&pose.numbers()))?;
        }
        for (id, point) in &self.points {
            writeln!(writer, "{point_tag} {id}{}", text(&P::coordinates(point)))?;
        }
        for id in &self.fixed {
            writeln!(writer, "FIX {id}")?;
        }
        for edge in &self.edges {
            let (from, to) = (self.poses[edge.from].0, self.poses[edge.to].0);
            let numbers = text(&edge.measured.numbers());
            writeln!(writer, "{edge_tag} {from} {to}{numbers}{}", triangle(&edge.information))?;
        }
        for edge in &self.point_edges {
            let (from, to) = (self.poses[edge.from].0, self.points[edge.to].0);
            let sensor = if P::N == 3 { " 0" } else { "" };
            let numbers = text(&P::coordinates(&edge.measured));
            writeln!(writer, "{point_edge_tag} {from} {to}{sensor}{numbers}{}", triangle(&edge.information))?;
        }
        Ok(())
    }
}

fn text(numbers: &[f64]) -> String {
    numbers.iter().map(|number| format!(" {number:?}")).collect()
}

/// The upper triangle by rows.
fn triangle(matrix: &DMatrix<f64>) -> String {
    let entries = (0..matrix.nrows()).flat_map(|i| (i..matrix.ncols()).map(move |k| matrix[(i, k)]));
    text(&entries.collect::<Vec<_>>())
}
