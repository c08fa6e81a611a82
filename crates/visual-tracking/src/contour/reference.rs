use crate::{AffineMap, AffineSnake, ColorCloud, PrincipalColors, TrackingError};

/// Result of the last image, with which the next one is compared.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Reference {
    /// $`\mathcal C_{t-1}`$.
    pub(super) cloud: ColorCloud,
    /// $`\mathbf x_{t-1}`$.
    pub(super) colors: PrincipalColors,
    /// $`\mathbf r_{t-1}`$.
    pub(super) snake: AffineSnake,
    /// Motion of the middle in pixels a picture.
    pub(super) motion: [f64; 2],
    /// $`A_{t-1}, A_{t-2}`$ in square pixels.
    pub(super) areas: [f64; 2],
    /// Mean area of the last seconds.
    pub(super) steady_area: f64,
}

/// Weight of the newest motion.
const MOTION_GAIN: f64 = 0.6;

/// Weight of the newest area in the mean: a time constant of 50 images.
const STEADY_GAIN: f64 = 0.02;

impl Reference {
    /// At rest.
    pub(super) fn at_start(cloud: ColorCloud, snake: AffineSnake) -> Result<Self, TrackingError> {
        let colors = cloud.principal(None)?;
        let area = snake.area_at(snake.map());
        Ok(Self { cloud, colors, snake, motion: [0.0; 2], areas: [area; 2], steady_area: area })
    }

    /// Predicted map of the snake.
    pub(super) fn expected_map(&self) -> AffineMap {
        self.snake.map().shifted(self.motion)
    }

    /// $`\tilde A_t = A_{t-1} + μ (A_{t-1} - A_{t-2})`$, limited to 0.5 to 2 times the last area, mixed with a share of the mean.
    pub(super) fn expected_area(&self, gain: f64, memory: f64) -> f64 {
        let [last, before] = self.areas;
        let next = (last + gain * (last - before)).clamp(0.5 * last, 2.0 * last);
        (1.0 - memory) * next + memory * self.steady_area
    }

    /// The snake in its new place.
    pub(super) fn move_to(&mut self, map: &AffineMap, area: f64) -> Result<(), TrackingError> {
        let moved = map.translation - self.snake.map().translation;
        self.snake = self.snake.moved_to(map)?;
        self.motion = [0, 1].map(|axis| self.motion[axis] + MOTION_GAIN * (moved[axis] - self.motion[axis]));
        self.areas = [area, self.areas[0]];
        self.steady_area += STEADY_GAIN * (area - self.steady_area);
        Ok(())
    }

    /// Sets the snake to another position, at rest.
    pub(super) fn jump_to(&mut self, map: &AffineMap, area: f64) -> Result<(), TrackingError> {
        self.snake = self.snake.moved_to(map)?;
        (self.motion, self.areas) = ([0.0; 2], [area; 2]);
        Ok(())
    }

    /// The target as it was, in the place where it was seen last, at rest.
    pub(super) fn left_at(&self, last: &Self) -> Self {
        let map = AffineMap { translation: last.snake.map().translation, ..*self.snake.map() };
        let snake = self.snake.moved_to(&map).unwrap_or_else(|_| self.snake.clone());
        Self { snake, motion: [0.0; 2], ..self.clone() }
    }
}
