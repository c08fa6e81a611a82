use anyhow::{Context, Result};
use nalgebra::Vector3;
use wayfix_color_map::ColorId;
use wayfix_color_model::{ColorDensity, ColorMeans, LightingFilter, LightingFilterParams, LightingPriors};

use super::image::VenueImage;
use super::prior::{BALL, CARPET, TrainingStatistics, block};

/// Methods for the Gaussians of the two colours of an image, in the order of all tables.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Method {
    Fixed,
    Joint,
    Independent,
    SharedNoise,
    Oracle,
}

impl Method {
    pub(super) const ALL: [Self; 5] =
        [Self::Fixed, Self::Joint, Self::Independent, Self::SharedNoise, Self::Oracle];

    /// Its name in figures.
    pub(super) fn name(self) -> &'static str {
        match self {
            Self::Fixed => "fixed",
            Self::Joint => "joint_prior",
            Self::Independent => "independent",
            Self::SharedNoise => "shared_noise",
            Self::Oracle => "oracle",
        }
    }

    /// The legend in pictures.
    pub(super) fn title(self) -> &'static str {
        match self {
            Self::Fixed => "fixed",
            Self::Joint => "adapted, joint prior",
            Self::Independent => "adapted, independent prior",
            Self::SharedNoise => "adapted, one noise for all colours",
            Self::Oracle => "oracle",
        }
    }

    /// Gaussians of carpet and ball for one image of a venue with true ball pixels `own_ball`.
    pub(super) fn densities(
        self,
        experience: &TrainingStatistics,
        image: &VenueImage,
        own_ball: &ColorDensity,
    ) -> Result<[ColorDensity; 2]> {
        let own_carpet = image.carpet.density;
        let seen = &own_carpet.mean;
        Ok(match self {
            Self::Fixed => [CARPET, BALL].map(|color| predicted(experience, &prior(experience), color)),
            Self::Joint => {
                [own_carpet, predicted(experience, &lit(experience, &experience.priors, seen)?, BALL)]
            }
            Self::Independent => {
                let light = lit(experience, &experience.priors.independent(), seen)?;
                [own_carpet, predicted(experience, &light, BALL)]
            }
            Self::SharedNoise => {
                let light = filter(experience, &experience.priors, seen)?;
                [CARPET, BALL].map(|color| light.color(ColorId(color as u8)))
            }
            Self::Oracle => [own_carpet, *own_ball],
        })
    }
}

/// Estimate of the colours' means.
struct Light {
    mean: nalgebra::DVector<f64>,
    covariance: nalgebra::DMatrix<f64>,
}

fn prior(experience: &TrainingStatistics) -> Light {
    let joint = experience.joint();
    Light { mean: joint.mean().clone(), covariance: joint.covariance().clone() }
}

/// The colours' means after observing an image's carpet.
fn lit(experience: &TrainingStatistics, priors: &LightingPriors, carpet: &Vector3<f64>) -> Result<Light> {
    let light = filter(experience, priors, carpet)?;
    Ok(Light { mean: light.mean().clone(), covariance: light.covariance().clone() })
}

fn filter(
    experience: &TrainingStatistics,
    priors: &LightingPriors,
    carpet: &Vector3<f64>,
) -> Result<LightingFilter> {
    let params = LightingFilterParams {
        pixel_color_variance: experience.priors.pixel_color_variance(),
        mean_color_variance: experience.priors.mean_color_variance(),
        ..LightingFilterParams::default()
    };
    let prior = priors.members().first().context("no prior")?;
    let mut light = LightingFilter::new(prior.clone(), params)?;
    light.update(&ColorMeans::new([(Some(*carpet), 1), (None, 0)]))?;
    Ok(light)
}

/// Predicted pixel distribution of a colour: the sum of the variances of its mean, of the image's mean, and of the pixels within the image.
fn predicted(experience: &TrainingStatistics, light: &Light, color: usize) -> ColorDensity {
    let (mean, covariance) = block(&light.mean, &light.covariance, color);
    ColorDensity {
        mean,
        covariance: covariance + experience.mean_color_variance() + experience.pixels[color],
    }
}

/// Gain of the joint prior over the independent one in predicting the venue's ball, nats: the log ratio of the densities of the mean ball given the
/// mean carpet.
pub(super) fn joint_gain_nats(
    experience: &TrainingStatistics,
    carpet: &Vector3<f64>,
    ball: &Vector3<f64>,
) -> Result<f64> {
    let log_density = |priors: &LightingPriors| -> Result<f64> {
        let light = lit(experience, priors, carpet)?;
        let (mean, covariance) = block(&light.mean, &light.covariance, BALL);
        Ok(wayfix_gaussian_core::Gaussian::new(mean, covariance)?.log_density(ball)?)
    };
    Ok(log_density(&experience.priors)? - log_density(&experience.priors.independent())?)
}
