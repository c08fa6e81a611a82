use anyhow::{Context, Result};
use nalgebra::Vector3;
use wayfix_color_map::ColorId;
use wayfix_color_model::PixelClassifier;

use super::{
    methods::{Method, joint_gain_nats},
    prior::{BALL, CARPET, TrainingStatistics},
    venue::Venue,
};

/// A venue left out: how each method did.
pub(super) struct VenueScore {
    /// In the order of [`Method::ALL`].
    pub(super) rates: Vec<Rates>,
    /// Gain of the joint prior over the independent one in predicting the ball, nats.
    pub(super) joint_gain_nats: f64,
}

/// Correctly classified pixels of each kind.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Rates {
    right: [u64; 2],
    all: [u64; 2],
}

impl Rates {
    /// The mean of the two rates.
    pub(super) fn balanced(&self) -> f64 {
        0.5 * (self.of(CARPET) + self.of(BALL))
    }

    /// The share of ball pixels classified as ball.
    pub(super) fn of_ball(&self) -> f64 {
        self.of(BALL)
    }

    fn of(&self, color: usize) -> f64 {
        self.right[color] as f64 / self.all[color] as f64
    }

    fn count(&mut self, classifier: &PixelClassifier, color: usize, pixels: &[[u8; 3]]) {
        let right = pixels.iter().filter(|pixel| classifier.classify(**pixel) == Some(ColorId(color as u8)));
        self.right[color] += right.count() as u64;
        self.all[color] += pixels.len() as u64;
    }
}

/// Learns from `others` and classifies the pixels of `venue`.
pub(super) fn score(venue: &Venue, others: &[&Venue]) -> Result<VenueScore> {
    let experience = TrainingStatistics::of(others)?;
    let own_ball = venue.ball().context("no ball in any image")?;
    let rates = Method::ALL.into_iter().map(|method| {
        let mut rates = Rates::default();
        for image in &venue.images {
            let classifier = PixelClassifier::new(method.densities(&experience, image, &own_ball)?)?;
            rates.count(&classifier, CARPET, &image.carpet_pixels);
            rates.count(&classifier, BALL, &image.ball_pixels);
        }
        Ok(rates)
    });
    let rates = rates.collect::<Result<_>>()?;
    let carpet = venue.images.iter().map(|image| image.carpet.density.mean).sum::<Vector3<f64>>()
        / venue.images.len() as f64;
    let ball = venue.ball_mean().context("no ball in any image")?;
    let joint_gain_nats = joint_gain_nats(&experience, &carpet, &ball)?;
    Ok(VenueScore { rates, joint_gain_nats })
}
