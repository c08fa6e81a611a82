use std::{path::Path, sync::Arc};

use anyhow::{Result, ensure};
use rayon::prelude::*;
use wayfix_color_map::{ColorId, ColorMap};
use wayfix_color_model::{ColorDensity, LightingFilterBank, LightingPriors};
use wayfix_evaluation::{
    errors::MeanInterval,
    report::{Metric, ReportRun},
};
use wayfix_system_core::Stopwatch;
use wayfix_systems::color::{ClassificationCounts, ColorSystemParams, priors, rate_of, read_map};

use super::{
    figures,
    known_pose::{AdaptedLight, KnownPose},
    place::{Place, prior_without},
    rates::count,
};
use crate::color::compared;

/// Minimum number of labelled pixels of a colour in an image for a rate of its own.
const MIN_PIXELS: u64 = 20;

/// Classification in the labelled images of `folder`; see the [module](super). Pictures show the images named `shown`.
///
/// # Errors
/// Returns an error if the folder has no map or fewer than two labelled images, or a colour is in no image of the others.
pub fn run(folder: &Path, shown: &[String], params: &ColorSystemParams) -> Result<ReportRun> {
    let stopwatch = Stopwatch::start();
    let map = Arc::new(read_map(&folder.join("field.toml"))?);
    let places = Place::read_all(&folder.join("images"), map.colors().len(), params)?;
    let built_in = priors::built_in()?;
    ensure!(built_in.colors() == map.colors(), "the colours are not those of the built-in priors");
    let tested = (0..places.len()).into_par_iter().map(|at| {
        let prior = prior_without(at, &places, map.colors())?;
        TestedPlace::new(&places[at], &map, [&prior, &built_in], params)
    });
    let tested = tested.collect::<Result<Vec<_>>>()?;
    let mut metrics = vec![Metric::new("n_labelled_images", places.len() as f64, "")];
    metrics.extend(classified(&tested, map.colors()));
    metrics.extend(withheld(&tested, map.colors()));
    let mut figures = Vec::new();
    let mut in_film = Vec::new();
    for (place, tested) in places.iter().zip(tested).filter(|(place, _)| shown.contains(&place.name)) {
        figures.push(figures::ellipses(place, map.colors(), &tested.prior, &tested.light)?);
        in_film.push((place, tested.light));
    }
    if !in_film.is_empty() {
        figures.push(figures::film(&in_film, map.colors())?);
    }
    let seconds = stopwatch.elapsed().as_secs_f64();
    Ok(ReportRun { metrics, figures, seconds, ..ReportRun::default() })
}

/// A place under the prior of the others.
struct TestedPlace {
    name: String,
    prior: Vec<ColorDensity>,
    light: AdaptedLight,
    /// In the order of [`METHODS`].
    counts: [ClassificationCounts; 4],
    /// Of each withheld colour, with the joint prior and with the independent one.
    withheld: Vec<[Option<f64>; 2]>,
}

impl TestedPlace {
    fn new(
        place: &Place,
        map: &Arc<ColorMap>,
        [learned, built_in]: [&LightingPriors; 2],
        params: &ColorSystemParams,
    ) -> Result<Self> {
        let n_colors = map.colors().len();
        let banks = [priors::bank(learned, params)?, priors::bank(&learned.independent(), params)?];
        let pose = KnownPose::new(place, map, params)?;
        let prior = params.localizer.pixels.shaded(banks[0].member(0).colors());
        let light = pose.adapt(banks[0].clone(), None)?;
        let from_built_in = pose.adapt(priors::bank(built_in, params)?, None)?;
        let lights =
            [vec![prior.as_slice()], vec![light.sun.as_slice()], light.lights(), from_built_in.lights()];
        let [a, b, c, d] = lights.map(|lights| count(place, &lights, n_colors));
        let withheld = (0..n_colors).map(|color| {
            let rate = |bank: &LightingFilterBank| -> Result<Option<f64>> {
                let light = pose.adapt(bank.clone(), Some(color))?;
                let counts = count(place, &light.lights(), n_colors)?;
                Ok(counts.rate_of(ColorId(color as u8)).filter(|_| counts.by_color[color].1 >= MIN_PIXELS))
            };
            Ok([rate(&banks[0])?, rate(&banks[1])?])
        });
        let withheld = withheld.collect::<Result<_>>()?;
        Ok(Self { name: place.name.clone(), prior, light, counts: [a?, b?, c?, d?], withheld })
    }
}

const METHODS: [&str; 4] = ["prior", "sun", "sun_or_shade", "built_in_prior_sun_or_shade"];

/// Rates of all labelled pixels of an image, and of each colour, as means over images; and of each image.
fn classified(tested: &[TestedPlace], colors: &[String]) -> Vec<Metric> {
    let mut metrics = Vec::new();
    for (at, method) in METHODS.iter().enumerate() {
        let mut mean = |name: String, rates: Vec<f64>| {
            if let Some(mean) = MeanInterval::of(&rates) {
                metrics.extend(Metric::of_mean(&name, &mean, ""));
                metrics.push(Metric::new(format!("{name}_n_images"), rates.len() as f64, ""));
            }
        };
        let counts = || tested.iter().map(|place| &place.counts[at]);
        mean(format!("{method}_classification_rate"), counts().filter_map(|counts| counts.rate()).collect());
        for (color, name) in colors.iter().enumerate() {
            let rates = rate_of(counts(), ColorId(color as u8), MIN_PIXELS);
            mean(format!("{method}_classification_rate_{name}"), rates);
        }
    }
    for place in tested {
        for (method, counts) in METHODS.iter().zip(&place.counts) {
            let name = format!("{}_{method}_classification_rate", place.name);
            metrics.extend(counts.rate().map(|rate| Metric::new(name, rate, "")));
        }
    }
    metrics
}

/// The lower half of [Schulz & Fox 2004, Table 1].
fn withheld(tested: &[TestedPlace], colors: &[String]) -> Vec<Metric> {
    let mut metrics = Vec::new();
    for (color, name) in colors.iter().enumerate() {
        let pairs = tested.iter().filter_map(|place| {
            let [joint, independent] = place.withheld[color];
            joint.zip(independent)
        });
        let (joint, independent): (Vec<f64>, Vec<f64>) = pairs.unzip();
        if !joint.is_empty() {
            metrics.push(Metric::new(format!("withheld_{name}_n_images"), joint.len() as f64, ""));
        }
        metrics.extend(compared(name, &[joint, independent]));
    }
    metrics
}
