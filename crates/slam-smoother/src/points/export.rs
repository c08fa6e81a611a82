use wayfix_estimation_traits::Pose2;
use wayfix_smoother::Between;

use super::{MountedRangeBearing, PointSmoother, gaussian::StartPrior};
use crate::SlamSmootherError;

impl PointSmoother {
    /// The least squares problem as text, for other programs: a line for each variable with its present value, and for each residual.
    ///
    /// ```text
    /// POSE i seconds x y θ
    /// LANDMARK l x y
    /// LOG_SCALE s λ                                  of ranges
    /// HELD i                                         an exact variable
    /// START n i1 … in m… I…                          a Gaussian of n variables: coordinates of the mean, upper triangle of the information by rows
    /// MOTION i j x y θ I11 I12 I13 I22 I23 I33       log(z⁻¹ xᵢ⁻¹ xⱼ)
    /// DETECTION i l s ρ β x y θ I11 I12 I22          MountedRangeBearing with its mount; Cauchy kernel, c = 2.385
    /// ```
    ///
    /// # Errors
    /// [`SlamSmootherError::NotExported`] for a problem with other residuals: measurements of the pose, what was marginalized.
    pub fn export(&self) -> Result<String, SlamSmootherError> {
        self.check_exported()?;
        let mut lines = Vec::new();
        for frame in &self.window {
            let seconds = frame.seconds.unwrap_or_default();
            let pose = self.graph.value(frame.pose)?;
            lines.push(format!("POSE {} {seconds} {}", frame.pose.index(), numbers(pose)));
        }
        for id in self.landmarks.values() {
            let place = self.graph.value(*id)?;
            lines.push(format!("LANDMARK {} {} {}", id.index(), place.x, place.y));
        }
        lines.push(format!("LOG_SCALE {} {}", self.scale.index(), self.graph.value(self.scale)?.x));
        lines.extend(self.held().map(|held| format!("HELD {held}")));
        lines.extend(self.start.as_ref().map(StartPrior::line));
        for (_, motion, named, m) in self.graph.residuals::<Between<Pose2<f64>>>() {
            let information = format!("{} {} {} {} {} {}", m.m11, m.m12, m.m13, m.m22, m.m23, m.m33);
            lines.push(format!(
                "MOTION {} {} {} {information}",
                named[0],
                named[1],
                numbers(motion.measured())
            ));
        }
        for (_, detection, named, m) in self.graph.residuals::<MountedRangeBearing>() {
            let MountedRangeBearing { mount, range, bearing } = detection;
            let ids = format!("{} {} {}", named[0], named[1], named[2]);
            let information = format!("{} {} {}", m.m11, m.m12, m.m22);
            lines.push(format!("DETECTION {ids} {range} {bearing} {} {information}", numbers(mount)));
        }
        Ok(lines.join("\n") + "\n")
    }

    /// The solution as further lines of [`export`](Self::export): the cost, and the present value of each variable.
    ///
    /// ```text
    /// COST c
    /// SOLUTION i …                                   x y θ of a pose, x y of a landmark, λ of the scale
    /// ```
    ///
    /// # Errors
    /// Never while the smoother is whole.
    pub fn export_solution(&self) -> Result<String, SlamSmootherError> {
        let mut lines = vec![format!("COST {}", self.cost())];
        for frame in &self.window {
            lines.push(format!("SOLUTION {} {}", frame.pose.index(), numbers(self.graph.value(frame.pose)?)));
        }
        for id in self.landmarks.values() {
            let place = self.graph.value(*id)?;
            lines.push(format!("SOLUTION {} {} {}", id.index(), place.x, place.y));
        }
        lines.push(format!("SOLUTION {} {}", self.scale.index(), self.graph.value(self.scale)?.x));
        Ok(lines.join("\n") + "\n")
    }

    /// Numbers of the variables that do not move.
    fn held(&self) -> impl Iterator<Item = usize> {
        let at_start = [self.window[0].pose.index(), self.scale.index()];
        let is_uncertain =
            |held: &usize| self.start.as_ref().is_some_and(|start| start.variables.contains(held));
        let anchors = self.anchors.iter().filter_map(|anchor| self.landmarks.get(anchor));
        at_start
            .into_iter()
            .filter(move |held| !is_uncertain(held))
            .chain(anchors.map(|anchor| anchor.index()))
    }

    /// Whether each residual has a line.
    fn check_exported(&self) -> Result<(), SlamSmootherError> {
        let n_exported = self.graph.residuals::<Between<Pose2<f64>>>().count()
            + self.graph.residuals::<MountedRangeBearing>().count()
            + usize::from(self.start.is_some());
        match self.graph.n_residuals().saturating_sub(n_exported) {
            0 => Ok(()),
            n_residuals => Err(SlamSmootherError::NotExported { n_residuals }),
        }
    }
}

impl StartPrior {
    fn line(&self) -> String {
        let n = self.information.nrows();
        let triangle = (0..n).flat_map(|i| (i..n).map(move |k| self.information[(i, k)]));
        let numbers: Vec<String> =
            self.mean.iter().copied().chain(triangle).map(|number| number.to_string()).collect();
        let variables: Vec<String> = self.variables.iter().map(usize::to_string).collect();
        format!("START {} {} {}", variables.len(), variables.join(" "), numbers.join(" "))
    }
}

fn numbers(pose: &Pose2<f64>) -> String {
    format!("{} {} {}", pose.x(), pose.y(), pose.heading())
}
