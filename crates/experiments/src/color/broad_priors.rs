//! Priors of a camera and a light of which nothing is known.

use anyhow::Result;
use nalgebra::Vector3;
use rand::{Rng, RngExt};
use rand_chacha::{ChaCha8Rng, rand_core::SeedableRng};
use rand_distr::StandardNormal;
use wayfix_color_model::{
    ColorMeans, LightingFilterParams, LightingPriors, PriorLearningParams, TrainingVenue, YuvStandard,
    learn_priors,
};
use wayfix_scene_sim::league::{COLOR_NAMES, LeagueVenue, LinearRgb, N_COLORS, black_body};

/// Seed of the venues; no log uses it.
const SEED: u64 = 2004;
/// So many that the hyperprior, of three venues, does not count.
const N_VENUES: usize = 1000;
/// Standard deviation of the logarithm of a reflectance, red, green and blue each. A map names a colour, not a paint: pots of one paint differ by 0.05, the
/// four greens of the ColorChecker [McCamy et al. 1976] by 0.4 to 0.6; a value between the two.
const PAINT_SIGMA: f64 = 0.25;
/// Warmest lamps [ANSI C78.377] and blue sky [CIE 15], in mired, 10⁶ over kelvin, in which equal steps look equal.
const MIREDS: std::ops::Range<f64> = 1e6 / 10_000.0..1e6 / 2_700.0;
/// Standard deviation of the logarithm of the green of a lamp, as in [`LeagueVenue`].
const TINT_SIGMA: f64 = 0.04;
/// Presets of the white balance, kelvin, as in [`LeagueVenue`]; half of the cameras have one, the nearest or the next.
const WHITE_BALANCES: [f64; 3] = [2800.0, 4300.0, 5600.0];
/// Standard deviation of the logarithm of the gain of a channel that balances white by itself: grey world has a median error of 6.3° on photographs.
/// [Gijsenij et al. 2011]
const WHITE_BALANCE_SIGMA: f64 = 0.13;
/// Reflectance to which exposure meters are set. [ISO 2720]
const GREY_CARD: f64 = 0.18;
/// Reflectance of the other half of a metered picture; the first one is carpet.
const SURROUNDINGS: std::ops::Range<f64> = 0.1..0.4;
/// Standard deviation of the light of a spot, as a logarithm: a stop, since a sports hall may have half of its mean light at a spot. [EN 12193, class III]
const LIGHT_SIGMA: f64 = std::f64::consts::LN_2;
/// Share of a channel that comes from each of the others: from corrected colours to the camera of an ERS-7.
const CROSSTALK: std::ops::Range<f64> = 0.0..0.17;
/// Exponent of the response: from sRGB to the camera of an ERS-7.
const GAMMA: std::ops::Range<f64> = 0.45..0.6;
/// Stray light, as a share of the mean of the picture.
const STRAY_LIGHT: f64 = 0.015;

/// Learns `k` priors, darkest first, from venues of any lamp and any camera. The broad priors were made with `k` = 2.
///
/// # Errors
/// Returns an error if learning fails.
pub(crate) fn learn_broad_priors(k: usize) -> Result<LightingPriors> {
    let mut rng = ChaCha8Rng::seed_from_u64(SEED);
    let scatter = LightingFilterParams::default().mean_color_variance;
    let venues: Vec<TrainingVenue> =
        (0..N_VENUES).map(|at| venue(at, &scatter, &mut rng)).collect::<Result<_>>()?;
    let params = PriorLearningParams { mean_color_variance: Some(scatter), ..PriorLearningParams::default() };
    Ok(learn_priors(&COLOR_NAMES.map(str::to_owned), &venues, k, &params, &mut rng)?)
}

/// One picture of all colours, whose means scatter as those of pictures do.
fn venue(at: usize, scatter: &Vector3<f64>, rng: &mut ChaCha8Rng) -> Result<TrainingVenue> {
    let paints =
        LeagueVenue::draw(rng)?.paints.map(|paint| paint.map(|r| (r * factor(PAINT_SIGMA, rng)).min(0.9)));
    let kelvin = 1e6 / rng.random_range(MIREDS);
    let light = black_body(kelvin).component_mul(&LinearRgb::new(1.0, factor(TINT_SIGMA, rng), 1.0));
    let balance = white_balance(kelvin, &light, rng);
    let (crosstalk, gamma) = (rng.random_range(CROSSTALK), rng.random_range(GAMMA));
    let signal = |reflectance: &LinearRgb| {
        let light = reflectance.component_mul(&light);
        let mixed = light * (1.0 - 3.0 * crosstalk) + LinearRgb::repeat(crosstalk * light.sum());
        mixed.component_mul(&balance)
    };
    let surroundings = signal(&LinearRgb::repeat(rng.random_range(SURROUNDINGS)));
    let metered = 0.5 * (signal(&paints[0]).y + surroundings.y);
    let gain = GREY_CARD / metered * factor(LIGHT_SIGMA, rng);
    let means: [Vector3<f64>; N_COLORS] = paints.map(|paint| {
        let signal = signal(&paint) * gain + LinearRgb::repeat(STRAY_LIGHT * GREY_CARD);
        let rgb = signal.map(|signal| (255.0 * signal.clamp(0.0, 1.0).powf(gamma)).round() as u8);
        let yuv = Vector3::from(YuvStandard::Bt601Full.from_rgb(rgb.into()).map(f64::from));
        yuv + scatter.map(|variance| variance.sqrt() * normal(rng))
    });
    let image = ColorMeans::new(means.map(|mean| (Some(mean), 1)));
    Ok(TrainingVenue { name: format!("venue {at}"), images: vec![image], pixels: None })
}

/// Gains of the channels: of a preset, or what makes the light white but for the error of an automatic camera.
fn white_balance<R: Rng>(kelvin: f64, light: &LinearRgb, rng: &mut R) -> LinearRgb {
    if rng.random_bool(0.5) {
        return light.map(|channel| factor(WHITE_BALANCE_SIGMA, rng) / channel);
    }
    let mut presets = WHITE_BALANCES;
    let off = |preset: &f64| (1.0 / preset - 1.0 / kelvin).abs();
    presets.sort_by(|a, b| off(a).total_cmp(&off(b)));
    black_body(presets[usize::from(rng.random_bool(0.35))]).map(|channel| 1.0 / channel.max(0.15))
}

fn factor<R: Rng>(sigma: f64, rng: &mut R) -> f64 {
    (sigma * normal(rng)).exp()
}

fn normal<R: Rng>(rng: &mut R) -> f64 {
    rng.sample(StandardNormal)
}

#[cfg(test)]
mod tests {
    use super::*;
    use wayfix_systems::color::priors;

    #[test]
    fn the_broad_priors_are_those_of_the_generator() {
        let (made, stored) = (learn_broad_priors(2).unwrap(), priors::broad().unwrap());
        assert_eq!(made.colors(), stored.colors());
        for (made, stored) in made.members().iter().zip(stored.members()) {
            // A tenth of a level: exponentials differ between machines in the last digit.
            assert!((made.mean() - stored.mean()).amax() < 0.1);
            assert!((made.covariance() - stored.covariance()).amax() < 1.0);
        }
    }

    #[test]
    fn they_are_wider_than_those_of_the_simulated_halls() {
        let (broad, halls) = (priors::broad().unwrap(), priors::built_in().unwrap());
        for (broad, halls) in broad.members().iter().zip(halls.members()) {
            assert!(broad.covariance().trace() > halls.covariance().trace());
        }
    }
}
