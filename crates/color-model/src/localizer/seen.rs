use super::{particle::ColorParticle, views::Views, weighed::Weighed};

/// Particles, and what one frame or several say of them.
pub(crate) struct Seen {
    pub(crate) particles: Vec<ColorParticle>,
    pub(crate) views: Views,
    pub(crate) weighed: Weighed,
    /// How much better than the frame's own colours they explain it, nats a pixel.
    pub(crate) fit: f64,
}
