//! Priors learned from made-up venues whose lights are known.
#![allow(clippy::unwrap_used, clippy::panic, reason = "helpers of tests fail like tests")]

use nalgebra::Vector3;
use rand::RngExt;
use rand_chacha::{ChaCha8Rng, rand_core::SeedableRng};
use wayfix_color_map::ColorId;
use wayfix_color_model::{
    ColorMeans, LabelledPixels, LightingFilter, LightingFilterParams, LightingPriorError, LightingPriors,
    PooledPixelVariance, PriorLearningParams, TrainingVenue, YuvImage, learn_grouped_priors, learn_priors,
    split_by_brightness,
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

/// Carpet of 20 × 20 pixels with noise of ±2 levels and a white line of 4 columns, and their labels.
fn labelled(rng: &mut ChaCha8Rng) -> (Vec<[u8; 3]>, Vec<u8>) {
    let at = |k: usize| if (8..12).contains(&(k % 20)) { ([200, 128, 128], 2) } else { ([80, 110, 100], 1) };
    let (mut pixels, labels): (Vec<[u8; 3]>, Vec<u8>) = (0..400).map(at).unzip();
    pixels.iter_mut().flatten().for_each(|value| *value = *value - 2 + rng.random_range(0..5));
    (pixels, labels)
}

#[test]
fn edges_and_balls_do_not_move_the_mean_of_a_colour() {
    let rng = &mut ChaCha8Rng::seed_from_u64(17);
    let (mut pixels, labels) = labelled(rng);
    for row in 5..9 {
        pixels[20 * row + 1..20 * row + 5].fill([150, 60, 160]); // a ball on the carpet: 16 of 280 pixels inside
    }
    for row in 0..20 {
        pixels[20 * row + 8] = [140, 119, 114]; // mixed
    }
    let image = YuvImage::new(20, 20, pixels).unwrap();
    let read = LabelledPixels::from_image(&image, (20, 20), &labels, 3).unwrap();
    // Two columns on either side of both edges of the line.
    assert_eq!((read.n_edge_pixels(), read.n_outliers()), (80, 16));
    assert_eq!([0, 1, 2].map(|color| read.n_pixels(color)), [264, 40, 0]);
    let means = read.means(3);
    let green = means.mean(ColorId(0)).unwrap() - Vector3::new(80.0, 110.0, 100.0);
    // Five standard errors of 264 uniform numbers of variance 2.
    assert!(green.amax() < 5.0 * (2.0_f64 / 264.0).sqrt(), "{green}");
    assert_eq!((means.mean(ColorId(2)), read.means(41).mean(ColorId(1))), (None, None));
    let venue = TrainingVenue::from_labelled_pixels("lab", &[read], 3);
    let spread = venue.pixels.unwrap();
    assert_eq!(spread.degrees_of_freedom, 302.0);
    // The standard error of a variance of 302 numbers is 8 % for a Gaussian, less for uniform ones.
    assert!((spread.variances / 2.0).iter().all(|ratio| (ratio - 1.0).abs() < 0.4), "{}", spread.variances);
}

#[test]
fn labels_of_another_size_or_of_no_colour_are_refused() {
    let (pixels, mut labels) = labelled(&mut ChaCha8Rng::seed_from_u64(18));
    let image = YuvImage::new(20, 20, pixels).unwrap();
    let read = |size: (u32, u32), n: usize| LabelledPixels::from_image(&image, size, &labels[..n], 2);
    for (size, n) in [((10, 40), 400), ((20, 19), 380), ((20, 20), 380)] {
        let refused = LightingPriorError::LabelSize { image: (20, 20), labels: size };
        assert_eq!(read(size, n), Err(refused));
    }
    labels[3..6].fill(255);
    let refused = LightingPriorError::UnknownLabel { label: 255, n_pixels: 3, n_colors: 2 };
    assert_eq!(LabelledPixels::from_image(&image, (20, 20), &labels, 2), Err(refused));
}

#[test]
fn one_venue_keeps_the_assumed_spread() {
    let rng = &mut ChaCha8Rng::seed_from_u64(19);
    let one = [venue(1.0, rng)];
    let params = PriorLearningParams::default();
    let priors = learn_grouped_priors(&colors(), &one, &[0], &params).unwrap();
    let covariance = priors.members()[0].covariance();
    // The mode of the posterior: three pseudo-venues of 30² and one venue at its own mean.
    let share = covariance[(0, 0)] / (0.75 * 900.0);
    assert!((share - 1.0).abs() < 0.02, "{share}");
    let correlation = covariance[(0, 3)] / (covariance[(0, 0)] * covariance[(3, 3)]).sqrt();
    assert!((correlation - 0.9).abs() < 0.02, "{correlation}");
    let mismatch = LightingPriorError::Dimension { what: "kinds of light of venues", expected: 1, got: 2 };
    assert_eq!(learn_grouped_priors(&colors(), &one, &[0, 0], &params), Err(mismatch));
    assert!(learn_grouped_priors(&colors(), &one, &[1], &params).is_err(), "no venue of the light 0");
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
