use rand::Rng;
use wayfix_gaussian_core::{GaussianError, IterationError, fit_hierarchical};

use super::evidence::{evidence, pooled_mean_color_variance, pooled_pixel_color_variance};
use super::{LightingPriorError, LightingPriors, PriorLearningParams, TrainingVenue, k_means};

/// Learns a prior for each of `k` kinds of light from training venues. [Schulz & Fox 2004, III.B, Fig. 2]
///
/// The venues are split by their brightness ([`split_by_brightness`]); each group gives the Gaussian that maximizes [Schulz & Fox 2004, Eq. 10]
/// ([`fit_hierarchical`]).
/// Colours not in an image are missing, not estimated.
/// ```
/// use nalgebra::Vector3;
/// use rand_chacha::{ChaCha8Rng, rand_core::SeedableRng};
/// use wayfix_color_model::{ColorMeans, PriorLearningParams, TrainingVenue, learn_priors};
/// let image = |light: f64| ColorMeans::new([
///     (Some(Vector3::new(60.0 * light, 110.0, 100.0)), 500),
///     (Some(Vector3::new(120.0 * light, 128.0, 128.0)), 80),
/// ]);
/// let venue = |k: usize| {
///     let light = if k < 6 { 0.5 } else { 1.5 } + 0.05 * (k % 6) as f64;
///     TrainingVenue { name: k.to_string(), images: vec![image(light), image(light + 0.01)], pixels: None }
/// };
/// let venues: Vec<TrainingVenue> = (0..12).map(venue).collect();
/// let params = PriorLearningParams { mean_color_variance: Some(Vector3::repeat(1.0)), ..PriorLearningParams::default() };
/// let rng = &mut ChaCha8Rng::seed_from_u64(1);
/// let priors = learn_priors(&["green".into(), "white".into()], &venues, 2, &params, rng)?;
/// let [dark, bright] = priors.members() else { panic!("two kinds of light") };
/// assert!((dark.mean()[0] - 37.8).abs() < 0.5 && (bright.mean()[0] - 97.8).abs() < 0.5); // 60 times the mean of the lights
/// # Ok::<(), wayfix_color_model::LightingPriorError>(())
/// ```
///
/// # Errors
/// Returns an error if there are not `k` different venues, a venue or parameter makes no sense, a colour is in no image of a group, or EM does not arrive.
pub fn learn_priors<R: Rng + ?Sized>(
    colors: &[String],
    venues: &[TrainingVenue],
    k: usize,
    params: &PriorLearningParams,
    rng: &mut R,
) -> Result<LightingPriors, LightingPriorError> {
    params.check()?;
    let lights = split_by_brightness(venues, colors.len(), k, params.n_restarts, rng)?;
    learn_grouped_priors(colors, venues, &lights, params)
}

/// [`learn_priors`] of venues whose kind of light is known: `lights` has that of each venue, from 0 on.
///
/// # Errors
/// As for [`learn_priors`], and if `lights` is not as long as `venues` or a kind of light has no venue.
pub fn learn_grouped_priors(
    colors: &[String],
    venues: &[TrainingVenue],
    lights: &[usize],
    params: &PriorLearningParams,
) -> Result<LightingPriors, LightingPriorError> {
    let n_colors = colors.len();
    params.check()?;
    venues.iter().try_for_each(|venue| venue.check(n_colors))?;
    if lights.len() != venues.len() {
        let (what, expected, got) = ("kinds of light of venues", venues.len(), lights.len());
        return Err(LightingPriorError::Dimension { what, expected, got });
    }
    let mean_color_variance =
        params.mean_color_variance.map_or_else(|| pooled_mean_color_variance(venues, n_colors), Ok)?;
    let pixel_color_variance = pooled_pixel_color_variance(venues, &params.pixel_color_variance);
    let hierarchical = params.hierarchical(n_colors)?;
    let k = lights.iter().max().map_or(0, |last| last + 1);
    let mut members = Vec::with_capacity(k);
    for light in 0..k {
        let chosen: Vec<&TrainingVenue> =
            venues.iter().zip(lights).filter(|(_, l)| **l == light).map(|(venue, _)| venue).collect();
        let groups = chosen
            .iter()
            .map(|venue| evidence(venue, n_colors, &mean_color_variance))
            .collect::<Result<Vec<_>, _>>()?;
        let fit = fit_hierarchical(&groups, &hierarchical).map_err(|error| match error {
            IterationError::Step(GaussianError::Unobserved { coordinate }) => {
                let venues = chosen.iter().map(|venue| venue.name.clone()).collect();
                LightingPriorError::UnseenColor { venues, color: colors[coordinate / 3].clone() }
            }
            error => error.into(),
        })?;
        members.push(fit.gaussian);
    }
    LightingPriors::new(colors.to_vec(), members, pixel_color_variance, mean_color_variance)
}

/// The group of each venue, from 0 for the darkest to `k - 1`: k-means on the mean Y of each colour. [Schulz & Fox 2004, V]
///
/// # Errors
/// Returns an error if there are not `k` different venues, or a venue has no image that shows a colour, images of another number of colours, or means that
/// are not finite.
pub fn split_by_brightness<R: Rng + ?Sized>(
    venues: &[TrainingVenue],
    n_colors: usize,
    k: usize,
    restarts: usize,
    rng: &mut R,
) -> Result<Vec<usize>, LightingPriorError> {
    venues.iter().try_for_each(|venue| venue.check(n_colors))?;
    let brightness: Vec<_> = venues.iter().map(|venue| venue.brightness(n_colors)).collect();
    let split = k_means(&brightness, k, restarts, rng)?;
    let luminance = |group: &usize| split.centers[*group].iter().sum::<f64>();
    let mut order: Vec<usize> = (0..k).collect();
    order.sort_by(|a, b| luminance(a).total_cmp(&luminance(b)));
    let mut rank = vec![0; k];
    for (position, group) in order.into_iter().enumerate() {
        rank[group] = position;
    }
    Ok(split.assignment.into_iter().map(|group| rank[group]).collect())
}
