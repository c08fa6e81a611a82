use nalgebra::Vector2;

use super::ambient_light::AmbientLight;

/// Distance between the points for which the light is known, metres.
const CELL_M: f64 = 2.0;

/// Source of the light.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct LightGroup {
    /// Lamps that are switched together, or a window.
    pub(super) kind: LightKind,
    /// Light of each source directly below it; 1 shows a white wall at typical brightness.
    pub(super) color: [f32; 3],
    /// Places of its lamps or of the window, metres.
    pub(super) places: Vec<Vector2<f64>>,
    /// At this distance half of the light is left, metres.
    pub(super) reach_m: f64,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum LightKind {
    /// Lamps, by number.
    Lamps(usize),
    /// The window of the curtain of that number.
    Window(usize),
    /// Unobstructed daylight.
    Skylight,
}

/// Irradiance by every group of lamps, on a lattice over the floor.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct LightField {
    low: Vector2<f64>,
    n: [usize; 2],
    groups: Vec<(LightKind, [f32; 3], Vec<f32>)>,
}

impl LightField {
    pub(super) fn new(size: Vector2<f64>, groups: &[LightGroup]) -> Self {
        let n = [size.x, size.y].map(|length| (length / CELL_M).ceil() as usize + 1);
        let low = -0.5 * size;
        let at = |i: usize| low + Vector2::new((i % n[0]) as f64, (i / n[0]) as f64) * CELL_M;
        let arriving = |group: &LightGroup| {
            let falloff = |i: usize| {
                let square = |place: &Vector2<f64>| (place - at(i)).norm_squared() / group.reach_m.powi(2);
                group.places.iter().map(|place| 1.0 / (1.0 + square(place))).sum::<f64>() as f32
            };
            (group.kind, group.color, (0..n[0] * n[1]).map(falloff).collect())
        };
        Self { low, n, groups: groups.iter().map(arriving).collect() }
    }

    /// The light at this moment.
    pub(super) fn mix(&self, ambient_light: &AmbientLight, mixed: &mut MixedLight) {
        mixed.cells.clear();
        mixed.cells.resize(self.n[0] * self.n[1], ambient_light.stray);
        for (kind, color, cells) in &self.groups {
            let level = ambient_light.level(*kind) as f32;
            let color = color.map(|channel| level * channel);
            for (sum, share) in mixed.cells.iter_mut().zip(cells) {
                for k in 0..3 {
                    sum[k] += color[k] * share;
                }
            }
        }
        (mixed.low, mixed.n) = (self.low, self.n);
    }
}

/// The light of a moment on the lattice.
#[derive(Clone, Debug, Default)]
pub(super) struct MixedLight {
    low: Vector2<f64>,
    n: [usize; 2],
    cells: Vec<[f32; 3]>,
}

impl MixedLight {
    /// Irradiance at a place; beyond the lattice, that at its edge.
    pub(super) fn at(&self, place: Vector2<f64>) -> [f32; 3] {
        let [x, y] = [0, 1].map(|k| ((place[k] - self.low[k]) / CELL_M).clamp(0.0, (self.n[k] - 1) as f64));
        let (i, j) = ((x as usize).min(self.n[0] - 2), (y as usize).min(self.n[1] - 2));
        let (u, v) = ((x - i as f64) as f32, (y - j as f64) as f32);
        let row = |j: usize| {
            let (a, b) = (self.cells[j * self.n[0] + i], self.cells[j * self.n[0] + i + 1]);
            [0, 1, 2].map(|k| a[k] + (b[k] - a[k]) * u)
        };
        let (low, high) = (row(j), row(j + 1));
        [0, 1, 2].map(|k| low[k] + (high[k] - low[k]) * v)
    }
}
