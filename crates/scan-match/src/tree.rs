use nalgebra::Vector2;

use crate::surface::SurfacePoint;

/// Surfaces of a scan by place: a balanced k-d tree, the root of every range in its middle.
#[derive(Clone, Debug, Default)]
pub(crate) struct Tree(Vec<SurfacePoint>);

impl Tree {
    pub(crate) fn new(mut surfaces: Vec<SurfacePoint>) -> Self {
        arrange(&mut surfaces, 0);
        Self(surfaces)
    }

    pub(crate) fn len(&self) -> usize {
        self.0.len()
    }

    pub(crate) fn iter(&self) -> impl Iterator<Item = &SurfacePoint> {
        self.0.iter()
    }

    /// The nearest surface within a distance, m.
    pub(crate) fn nearest(&self, point: &Vector2<f64>, within: f64) -> Option<&SurfacePoint> {
        let mut best = (within * within, None);
        search(&self.0, 0, point, &mut best);
        best.1
    }
}

fn arrange(surfaces: &mut [SurfacePoint], axis: usize) {
    if surfaces.len() > 1 {
        let middle = surfaces.len() / 2;
        let (left, _, right) =
            surfaces.select_nth_unstable_by(middle, |a, b| a.at[axis].total_cmp(&b.at[axis]));
        arrange(left, 1 - axis);
        arrange(right, 1 - axis);
    }
}

/// Depth is the logarithm of the number of beams.
fn search<'a>(
    surfaces: &'a [SurfacePoint],
    axis: usize,
    point: &Vector2<f64>,
    best: &mut (f64, Option<&'a SurfacePoint>),
) {
    if surfaces.is_empty() {
        return;
    }
    let (left, rest) = surfaces.split_at(surfaces.len() / 2);
    let (root, right) = (&rest[0], &rest[1..]);
    let squared = (root.at - point).norm_squared();
    if squared < best.0 {
        *best = (squared, Some(root));
    }
    let beyond = point[axis] - root.at[axis];
    let (near, far) = if beyond < 0.0 { (left, right) } else { (right, left) };
    search(near, 1 - axis, point, best);
    if beyond * beyond < best.0 {
        search(far, 1 - axis, point, best);
    }
}

#[cfg(test)]
mod tests {
    use rand::{RngExt, SeedableRng};
    use rand_chacha::ChaCha8Rng;

    use super::*;

    #[test]
    fn finds_what_looking_at_all_finds() {
        let mut rng = ChaCha8Rng::seed_from_u64(41);
        for n in [0, 1, 2, 3, 50, 500] {
            let mut place = || Vector2::new(rng.random_range(-5.0..5.0), rng.random_range(-1.0..1.0));
            let surfaces: Vec<_> = (0..n)
                .map(|_| SurfacePoint { at: place(), normal: Vector2::x(), normal_variance: 0.0 })
                .collect();
            let tree = Tree::new(surfaces.clone());
            for _ in 0..200 {
                let point = place();
                let distance = |surface: &SurfacePoint| (surface.at - point).norm();
                let nearest = surfaces.iter().map(distance).fold(f64::INFINITY, f64::min);
                let found = tree.nearest(&point, 0.5).map(distance);
                assert_eq!(found, (nearest < 0.5).then_some(nearest));
            }
        }
    }
}
