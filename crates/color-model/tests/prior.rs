//! Priors learned from made-up venues whose lights are known.
#![allow(clippy::unwrap_used, clippy::panic, reason = "helpers of tests fail like tests")]

use nalgebra::Vector3;
use rand::RngExt;
use rand_chacha::{ChaCha8Rng, rand_core::SeedableRng};
use wayfix_color_map::ColorId;
use wayfix_color_model::{
    ColorMeans, LightingFilter, LightingFilterParams, LightingPriorError, LightingPriors,
    PooledPixelVariance, PriorLearningParams, TrainingVenue, learn_priors, split_by_brightness,
};

const COLORS: [&str; 3] = ["green", "white", "pink"];
const PAINTS: [[f64; 3]; 3] = [[80.0, 110.0, 100.0], [170.0, 128.0, 128.0], [120.0, 140.0, 170.0]];

fn colors() -> Vec<String> {
    COLORS.map(str::to_owned).to_vec()
}

/// A hall whose light scales all colours alike, with paints of its own, seen in six images that each lack one colour.
fn venue(light: f64, rng: &mut ChaCha8Rng) -> TrainingVenue {
    let mut scatter = |size: f64| Vector3::from_fn(|_, _| rng.random_range(-size..size));
    let paints = PAINTS.map(|[y, u, v]| Vector3::new(light * y, u, v) + scatter(4.0));
    let image = |missing: usize, scatter: &mut dyn FnMut(f64) -> Vector3<f64>| {
        ColorMeans::new(
            (0..3).map(|m| if m == missing { (None, 0) } else { (Some(paints[m] + scatter(2.0)), 400) }),
        )
    };
    let images = (0..6).map(|k| image(k % 3, &mut scatter)).collect();
    TrainingVenue { name: format!("light {light:.2}"), images, pixels: None }
}

/// 15 dark halls and 15 bright ones, mixed.
fn venues(rng: &mut ChaCha8Rng) -> Vec<TrainingVenue> {
    (0..30)
        .map(|k| {
            let light = if k % 2 == 0 { rng.random_range(0.3..0.6) } else { rng.random_range(1.0..1.4) };
            venue(light, rng)
        })
        .collect()
}

#[test]
fn venues_are_split_where_the_light_is() {
    let rng = &mut ChaCha8Rng::seed_from_u64(11);
    let split = split_by_brightness(&venues(rng), 3, 2, 20, rng).unwrap();
    assert!(split.iter().enumerate().all(|(k, group)| *group == k % 2), "{split:?}");
}

#[test]
fn only_the_joint_prior_predicts_an_unseen_colour() {
    let rng = &mut ChaCha8Rng::seed_from_u64(12);
    let joint = learn_priors(&colors(), &venues(rng), 2, &PriorLearningParams::default(), rng).unwrap();
    let params = LightingFilterParams {
        pixel_color_variance: joint.pixel_color_variance(),
        mean_color_variance: joint.mean_color_variance(),
        ..Default::default()
    };
    let errors = |priors: &LightingPriors, rng: &mut ChaCha8Rng| -> f64 {
        let member = &priors.members()[1];
        let square = (0..40).map(|_| {
            let light = rng.random_range(1.0..1.4);
            let mut filter = LightingFilter::new(member.clone(), params).unwrap();
            for image in &venue(light, rng).images {
                filter.update(&image.without(ColorId(2))).unwrap();
            }
            (filter.color(ColorId(2)).mean.x - light * PAINTS[2][0]).powi(2)
        });
        (square.sum::<f64>() / 40.0).sqrt()
    };
    let seed = || ChaCha8Rng::seed_from_u64(13);
    let (with, without) = (errors(&joint, &mut seed()), errors(&joint.independent(), &mut seed()));
    // Without the others, pink's Y is as uncertain as the light: 120 · 0.4 / √12 = 13.9. With them it is off by what its paint scatters,
    // 4 / √3 = 2.3, and by as much again through the others: 3.3 at most. A regression on six numbers from fifteen venues adds
    // 6 / (15 - 6 - 2) to the variance: 4.5. Three standard errors of a root mean square over 40 make it 6.
    assert!((without - 13.9).abs() < 3.0, "{without}");
    assert!(with < 6.0, "{with}");
}

#[test]
fn noise_is_learned_where_the_data_carry_it() {
    let rng = &mut ChaCha8Rng::seed_from_u64(14);
    let mut venues = venues(rng);
    let params = PriorLearningParams::default();
    let priors = learn_priors(&colors(), &venues, 1, &params, rng).unwrap();
    assert_eq!(priors.pixel_color_variance(), params.pixel_color_variance);
    // Uniform in ±2: variance 4/3, from 30 venues of 3 colours with 4 images each: 270 degrees of freedom, and the relative error of a
    // variance of uniform numbers is √(0.8 / 270) = 0.054 or little more; five of them.
    assert!(
        (priors.mean_color_variance() / (4.0 / 3.0)).iter().all(|ratio| (ratio - 1.0).abs() < 0.3),
        "{}",
        priors.mean_color_variance()
    );
    venues[0].pixels =
        Some(PooledPixelVariance { variances: Vector3::repeat(10.0), degrees_of_freedom: 1000.0 });
    venues[1].pixels =
        Some(PooledPixelVariance { variances: Vector3::repeat(40.0), degrees_of_freedom: 2000.0 });
    assert_eq!(
        learn_priors(&colors(), &venues, 1, &params, rng).unwrap().pixel_color_variance(),
        Vector3::repeat(30.0)
    );
}

#[test]
fn venues_that_make_no_prior_are_refused() {
    let rng = &mut ChaCha8Rng::seed_from_u64(15);
    let params = PriorLearningParams::default();
    let good = venues(rng);
    let mut learn = |venues: &[TrainingVenue], k, params: &PriorLearningParams| {
        learn_priors(&colors(), venues, k, params, rng)
    };
    assert!(matches!(learn(&[], 1, &params), Err(LightingPriorError::TooFew { .. })));
    assert!(matches!(learn(&good, 0, &params), Err(LightingPriorError::TooFew { .. })));
    assert!(matches!(learn(&good[..1], 2, &params), Err(LightingPriorError::TooFew { .. })));
    for bad in [-0.1, 1.0, f64::NAN, f64::INFINITY] {
        assert!(
            learn(&good, 2, &PriorLearningParams { prior_color_correlation: bad, ..params.clone() }).is_err()
        );
    }
    for bad in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        assert!(learn(&good, 2, &PriorLearningParams { n_pseudo_venues: bad, ..params.clone() }).is_err());
        assert!(
            learn(
                &good,
                2,
                &PriorLearningParams { mean_color_variance: Some(Vector3::repeat(bad)), ..params.clone() }
            )
            .is_err()
        );
    }
    let without = |color: u8| -> Vec<TrainingVenue> {
        let strip = |venue: &TrainingVenue| TrainingVenue {
            images: venue.images.iter().map(|image| image.without(ColorId(color))).collect(),
            ..venue.clone()
        };
        good.iter().map(strip).collect()
    };
    let Err(LightingPriorError::UnseenColor { color, venues: unlabelled }) = learn(&without(1), 2, &params)
    else {
        panic!("no image shows white")
    };
    assert_eq!((color.as_str(), unlabelled.len()), ("white", 15), "the dark halls");
    let mut blank = good.clone();
    blank[4].images.clear();
    assert!(matches!(learn(&blank, 2, &params), Err(LightingPriorError::Blank { .. })));
    let mut wild = good.clone();
    wild[4].images[0] = ColorMeans::new([(Some(Vector3::repeat(f64::NAN)), 1), (None, 0), (None, 0)]);
    assert!(matches!(learn(&wild, 2, &params), Err(LightingPriorError::OutOfRange { .. })));
    wild[4].images[0] = ColorMeans::new([(None, 0)]);
    assert!(matches!(learn(&wild, 2, &params), Err(LightingPriorError::Dimension { .. })));
    let single: Vec<TrainingVenue> = good
        .iter()
        .map(|venue| TrainingVenue { images: venue.images[..1].to_vec(), ..venue.clone() })
        .collect();
    assert!(matches!(learn(&single, 2, &params), Err(LightingPriorError::UnknownScatter)));
}

#[cfg(feature = "serde")]
#[test]
fn a_file_gives_the_same_priors_and_a_spoiled_one_gives_none() {
    let rng = &mut ChaCha8Rng::seed_from_u64(16);
    let priors = learn_priors(&colors(), &venues(rng), 2, &PriorLearningParams::default(), rng).unwrap();
    let text = serde_json::to_string(&priors).unwrap();
    let read: LightingPriors = serde_json::from_str(&text).unwrap();
    // serde_json reads a number back to within one unit in the last place.
    assert!((read.members()[1].covariance() - priors.members()[1].covariance()).amax() < 1e-12);
    assert_eq!(read.colors(), priors.colors());
    let old =
        text.replace("pixel_color_variance", "pixel_noise").replace("mean_color_variance", "mean_noise");
    assert_eq!(serde_json::from_str::<LightingPriors>(&old).unwrap(), read, "files of before");
    let spoil = |path: &str, value: serde_json::Value| {
        let mut file: serde_json::Value = serde_json::from_str(&text).unwrap();
        *file.pointer_mut(path).unwrap_or_else(|| panic!("no {path}")) = value;
        serde_json::from_value::<LightingPriors>(file).unwrap_err().to_string()
    };
    assert!(spoil("/members/1/covariance/0/0", (-1.0).into()).contains("not positive definite"));
    assert!(spoil("/members/0/mean", vec![1.0; 6].into()).contains("dimension"));
    assert!(spoil("/colors", vec!["green"].into()).contains("expected 3, got 9"));
    assert!(spoil("/pixel_color_variance/1", 0.0.into()).contains("variance"));
    assert!(spoil("/members", serde_json::json!([])).contains("members"));
    assert!(spoil("/members/0/covariance/3", vec![1.0].into()).contains("row"));
}
