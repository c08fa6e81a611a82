use wayfix_estimation_traits::Pose2;
use wayfix_smoother::Between;

use super::{MountedRangeBearing, PointSmoother};

impl PointSmoother {
    /// The least squares problem as text, for other programs: a line for each variable with its present value, and for each residual.
    ///
    /// ```text
    /// POSE i seconds x y θ                           the first one is held if the start is exact
    /// LANDMARK l x y
    /// LOG_SCALE s λ σ                                of ranges: prior 0, held if σ is 0
    /// MOTION i j x y θ I11 I12 I13 I22 I23 I33       log(z⁻¹ xᵢ⁻¹ xⱼ)
    /// DETECTION i l s ρ β x y θ I11 I12 I22          MountedRangeBearing with its mount; Cauchy kernel
    /// ```
    ///
    /// What the pose is measured by without the map, and what was marginalized, is not written.
    pub fn export(&self) -> String {
        let mut lines = Vec::new();
        for frame in &self.window {
            let Ok(pose) = self.graph.value(frame.pose) else { continue };
            let seconds = frame.seconds.unwrap_or_default();
            lines.push(format!("POSE {} {seconds} {}", frame.pose.index(), numbers(pose)));
        }
        for id in self.landmarks.values() {
            let Ok(place) = self.graph.value(*id) else { continue };
            lines.push(format!("LANDMARK {} {} {}", id.index(), place.x, place.y));
        }
        let (scale, sigma) = (self.scale.index(), self.log_range_scale_sigma);
        lines.push(format!(
            "LOG_SCALE {scale} {} {sigma}",
            self.graph.value(self.scale).map_or(0.0, |scale| scale.x)
        ));
        for (motion, named, m) in self.graph.residuals::<Between<Pose2<f64>>>() {
            let information = format!("{} {} {} {} {} {}", m.m11, m.m12, m.m13, m.m22, m.m23, m.m33);
            lines.push(format!(
                "MOTION {} {} {} {information}",
                named[0],
                named[1],
                numbers(motion.measured())
            ));
        }
        for (detection, named, m) in self.graph.residuals::<MountedRangeBearing>() {
            let MountedRangeBearing { mount, range, bearing } = detection;
            let ids = format!("{} {} {}", named[0], named[1], named[2]);
            let information = format!("{} {} {}", m.m11, m.m12, m.m22);
            lines.push(format!("DETECTION {ids} {range} {bearing} {} {information}", numbers(mount)));
        }
        lines.join("\n") + "\n"
    }
}

fn numbers(pose: &Pose2<f64>) -> String {
    format!("{} {} {}", pose.x(), pose.y(), pose.heading())
}
