//! Masks one pixel at a time, from the definitions: what words are compared with.

use wayfix_visual_tracking::{PixelConnectivity, PixelMask, StructuringElement};

#[derive(Clone, PartialEq, Eq)]
pub(crate) struct Plain {
    width: i64,
    height: i64,
    on: Vec<bool>,
}

impl Plain {
    pub(crate) fn of(mask: &PixelMask) -> Self {
        Self::new(mask.width() as i64, mask.height() as i64, |u, v| mask.get(u as usize, v as usize))
    }

    /// Pixels whose middle is inside by the rule of crossings to the left, an odd number of them.
    pub(crate) fn of_polygon(size: (usize, usize), corners: &[[f64; 2]]) -> Self {
        Self::new(size.0 as i64, size.1 as i64, |u, v| {
            let (x, y) = (u as f64 + 0.5, v as f64 + 0.5);
            let n = corners.len();
            let crosses = |i: &usize| {
                let ([x0, y0], [x1, y1]) = (corners[*i], corners[(i + 1) % n]);
                (y0 <= y) != (y1 <= y) && x0 + (y - y0) * (x1 - x0) / (y1 - y0) <= x
            };
            (0..n).filter(crosses).count() % 2 == 1
        })
    }

    pub(crate) fn dilated(&self, element: StructuringElement) -> Self {
        self.map(|u, v| reach(element, self.width.max(self.height)).any(|(du, dv)| self.get(u + du, v + dv)))
    }

    pub(crate) fn eroded(&self, element: StructuringElement) -> Self {
        self.map(|u, v| {
            let mut reach = reach(element, self.width.max(self.height));
            reach.all(|(du, dv)| self.get(u + du, v + dv) || !self.has(u + du, v + dv))
        })
    }

    pub(crate) fn boundary(&self) -> Self {
        let surrounded = |u, v| neighbours(PixelConnectivity::Four).all(|(du, dv)| self.get(u + du, v + dv));
        self.map(|u, v| self.get(u, v) && !surrounded(u, v))
    }

    /// Connected parts, in the order of their first pixels.
    pub(crate) fn parts(&self, connectivity: PixelConnectivity) -> Vec<Self> {
        let mut rest = self.clone();
        let mut parts = Vec::new();
        while let Some(first) = rest.on.iter().position(|&on| on) {
            let mut part = self.map(|_, _| false);
            let mut open = vec![(first as i64 % self.width, first as i64 / self.width)];
            while let Some((u, v)) = open.pop() {
                if rest.get(u, v) {
                    let i = (v * self.width + u) as usize;
                    (rest.on[i], part.on[i]) = (false, true);
                    open.extend(neighbours(connectivity).map(|(du, dv)| (u + du, v + dv)));
                }
            }
            parts.push(part);
        }
        parts
    }

    /// Parts of what is off that do not reach the edge.
    pub(crate) fn holes(&self, connectivity: PixelConnectivity) -> Vec<Self> {
        let mut parts = self.map(|u, v| !self.get(u, v)).parts(connectivity.dual());
        let at_edge = |u, v| u == 0 || v == 0 || u == self.width - 1 || v == self.height - 1;
        parts.retain(|part| !part.pixels().iter().any(|&[u, v]| at_edge(u as i64, v as i64)));
        parts
    }

    /// By squares of 2 × 2 with one, three or two diagonal pixels. [Gray 1971]
    pub(crate) fn euler_number(&self, connectivity: PixelConnectivity) -> i64 {
        let (mut ones, mut threes, mut diagonals) = (0, 0, 0);
        for v in -1..self.height {
            for u in -1..self.width {
                let square = [(0, 0), (1, 0), (0, 1), (1, 1)].map(|(du, dv)| self.get(u + du, v + dv));
                match square.iter().filter(|&&on| on).count() {
                    1 => ones += 1,
                    3 => threes += 1,
                    2 if square[0] == square[3] => diagonals += 1,
                    _ => {}
                }
            }
        }
        match connectivity {
            PixelConnectivity::Four => (ones - threes + 2 * diagonals) / 4,
            PixelConnectivity::Eight => (ones - threes - 2 * diagonals) / 4,
        }
    }

    pub(crate) fn or(&self, other: &Self) -> Self {
        self.zip(other, |a, b| a || b)
    }

    pub(crate) fn zip(&self, other: &Self, op: fn(bool, bool) -> bool) -> Self {
        self.map(|u, v| op(self.get(u, v), other.get(u, v)))
    }

    pub(crate) fn pixels(&self) -> Vec<[usize; 2]> {
        let all = (0..self.height).flat_map(|v| (0..self.width).map(move |u| (u, v)));
        all.filter(|&(u, v)| self.get(u, v)).map(|(u, v)| [u as usize, v as usize]).collect()
    }

    fn map(&self, on: impl Fn(i64, i64) -> bool) -> Self {
        Self::new(self.width, self.height, on)
    }

    fn new(width: i64, height: i64, on: impl Fn(i64, i64) -> bool) -> Self {
        let on = (0..height).flat_map(|v| (0..width).map(move |u| (u, v))).map(|(u, v)| on(u, v)).collect();
        Self { width, height, on }
    }

    fn has(&self, u: i64, v: i64) -> bool {
        (0..self.width).contains(&u) && (0..self.height).contains(&v)
    }

    fn get(&self, u: i64, v: i64) -> bool {
        self.has(u, v) && self.on[(v * self.width + u) as usize]
    }
}

/// As a picture, since a list of pixels says nothing.
impl std::fmt::Debug for Plain {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        for row in self.on.chunks(self.width as usize) {
            writeln!(f)?;
            row.iter().try_for_each(|&on| f.write_str(if on { "#" } else { "." }))?;
        }
        Ok(())
    }
}

/// The pixels of an element; beyond `limit` there are none to reach.
fn reach(element: StructuringElement, limit: i64) -> impl Iterator<Item = (i64, i64)> {
    let (radius, cross) = match element {
        StructuringElement::Square { radius } => (radius, false),
        StructuringElement::Cross { radius } => (radius, true),
    };
    let radius = (radius as i64).min(limit);
    let all = (-radius..=radius).flat_map(move |dv| (-radius..=radius).map(move |du| (du, dv)));
    all.filter(move |&(du, dv)| !cross || du == 0 || dv == 0)
}

fn neighbours(connectivity: PixelConnectivity) -> impl Iterator<Item = (i64, i64)> {
    let element = match connectivity {
        PixelConnectivity::Four => StructuringElement::Cross { radius: 1 },
        PixelConnectivity::Eight => StructuringElement::Square { radius: 1 },
    };
    reach(element, 1).filter(|&step| step != (0, 0))
}
