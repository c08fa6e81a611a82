//! Lights that are switched: the bank of a particle, and four ways to follow them from known poses.

use std::sync::Arc;

use nalgebra::DVector;
use rand::{RngExt, SeedableRng, distr::Distribution};
use rand_chacha::ChaCha8Rng;
use wayfix_color_model::{
    ColorMeans, ColorModelError, Gpb2LightingTracker, ImmLightingTracker, JumpMarkovLightingTracker,
    LightingDrift, LightingFilter, LightingFilterBank, LightingFilterParams, LightingTracker,
};
use wayfix_gaussian_core::moment_matched;
use wayfix_kalman::{JumpMarkovFilterParams, MarkovChain};

use crate::support::{BRIGHT, common_gain, filter, means, noisy, stacked};

/// Two lights; the dark one has two fifths of the brightness and colour.
fn dark() -> Vec<[f64; 3]> {
    let darker = |[y, u, v]: &[f64; 3]| [0.4 * y, 128.0 + 0.4 * (u - 128.0), 128.0 + 0.4 * (v - 128.0)];
    BRIGHT.iter().map(darker).collect()
}

fn bank() -> LightingFilterBank {
    let light = |colors: &[[f64; 3]]| filter(common_gain(colors, 0.15), LightingFilterParams::default());
    LightingFilterBank::new(
        vec![light(&dark()), light(&BRIGHT)],
        MarkovChain::sticky(2, 0.98).expect("valid by construction"),
    )
    .expect("valid by construction")
}

#[test]
fn only_the_active_filter_learns_and_only_it_is_copied() {
    let mut bank = bank();
    let others = bank.clone();
    let seen = means(&stacked(&BRIGHT), 0b10100);
    bank.update_member(1, &seen).unwrap();
    assert_eq!(bank.active(), 1);
    assert!(Arc::ptr_eq(&bank.members()[0], &others.members()[0]), "what did not learn is shared");
    let mut alone = others.members()[1].as_ref().clone();
    alone.update(&seen).unwrap();
    assert_eq!((bank.member(1).mean(), bank.member(1).covariance()), (alone.mean(), alone.covariance()));
    // The dark one falls back to what it knew, however long the bright one was on.
    for _ in 0..100 {
        bank.predict(0.04).unwrap();
        bank.update_member(1, &seen).unwrap();
    }
    assert_eq!(bank.member(0).covariance(), others.member(0).covariance());
}

#[test]
fn members_are_drawn_as_often_as_they_are_probable() {
    let chain = MarkovChain::new(&[vec![0.9, 0.1], vec![0.3, 0.7]], &[0.5, 0.5]).unwrap();
    let lights: Vec<LightingFilter> = bank().members().iter().map(|light| light.as_ref().clone()).collect();
    let mut bank = LightingFilterBank::new(lights, chain).unwrap();
    bank.update_member(1, &means(&stacked(&BRIGHT), 0)).unwrap();
    // π₁ⱼ p(z|j) = 0.3 e^(1) and 0.7 e^(0), far below what exp can hold.
    let logs = [-5000.0 + 1.0, -5000.0];
    let (dark, bright) = (0.3 * 1.0_f64.exp(), 0.7);
    let mut rng = ChaCha8Rng::seed_from_u64(421);
    let n = 20_000;
    let mut n_dark = 0;
    for _ in 0..n {
        let choice = bank.choose(&logs, &mut rng).unwrap();
        assert!((choice.log_likelihood - (-5000.0 + (dark + bright).ln())).abs() < 1e-9);
        n_dark += usize::from(choice.member == 0);
    }
    let share = dark / (dark + bright);
    // Four standard deviations of a binomial share.
    let sigma = (share * (1.0 - share) / f64::from(n)).sqrt();
    assert!((n_dark as f64 / f64::from(n) - share).abs() < 4.0 * sigma);
    let impossible = bank.choose(&[f64::NEG_INFINITY; 2], &mut rng).unwrap();
    assert_eq!((impossible.member, impossible.log_likelihood), (1, f64::NEG_INFINITY));
    for _ in 0..100 {
        assert_eq!(bank.choose(&[f64::NEG_INFINITY, -3.0], &mut rng).unwrap().member, 1);
    }
}

/// One filter whose prior covers both lights.
fn single() -> LightingFilter {
    let priors: Vec<_> = bank().members().iter().map(|light| light.prior().clone()).collect();
    filter(
        moment_matched(&[0.5, 0.5], &priors).expect("valid by construction"),
        LightingFilterParams::default(),
    )
}

fn trackers() -> Vec<(&'static str, Box<dyn LightingTracker>)> {
    let jump_markov = JumpMarkovLightingTracker::new(&bank(), JumpMarkovFilterParams::default())
        .expect("valid by construction");
    vec![
        ("single", Box::new(single())),
        ("jump Markov", Box::new(jump_markov)),
        ("IMM", Box::new(ImmLightingTracker::new(&bank()).expect("valid by construction"))),
        ("GPB2", Box::new(Gpb2LightingTracker::new(&bank()).expect("valid by construction"))),
    ]
}

fn error_of_pink(tracker: &dyn LightingTracker, truth: &DVector<f64>) -> f64 {
    (tracker.colors().expect("valid by construction")[4].mean - truth.fixed_rows::<3>(12)).norm()
}

#[test]
fn switching_filters_predict_a_colour_unseen_since_the_switch() {
    let params = LightingFilterParams::default();
    let mut rng = ChaCha8Rng::seed_from_u64(422);
    let lights: Vec<DVector<f64>> =
        bank().members().iter().map(|light| light.prior().sampler().sample(&mut rng)).collect();
    // Two looks at each light's pink, then only at the first two colours, three images after each switch.
    let mut after_switch = [0.0; 4];
    let mut trackers = trackers();
    let switches = [1, 0, 1, 0, 1, 0];
    for (at, light) in switches.iter().enumerate() {
        for frame in 0..30 {
            let hidden = if at < 2 { 0 } else { 0b11100 };
            let seen = means(&noisy(&lights[*light], &params.mean_color_variance, &mut rng), hidden);
            for (k, (_, tracker)) in trackers.iter_mut().enumerate() {
                tracker.predict(0.04).unwrap();
                tracker.update(&seen).unwrap();
                if at >= 2 && frame == 2 {
                    after_switch[k] += error_of_pink(tracker.as_ref(), &lights[*light]) / 4.0;
                }
            }
        }
    }
    let [single, jump_markov, imm, gpb2] = after_switch[..] else { unreachable!() };
    println!(
        "error of unseen pink: single {single:.1}, jump Markov {jump_markov:.1}, IMM {imm:.1}, GPB2 {gpb2:.1}"
    );
    // It has seen this light's pink thirty times: the noise of a mean (9.8) over the root of 30 is 1.8, three times that.
    assert!(jump_markov < 5.4, "{jump_markov}");
    // They start again from the light's prior: a spread of 5 a channel (8.7), and what the two seen colours say of the gain.
    assert!(imm < 26.0 && gpb2 < 26.0, "{imm} {gpb2}");
    assert!(jump_markov < imm && jump_markov < gpb2 && jump_markov < single);
}

#[test]
fn without_switches_one_light_is_a_kalman_filter_for_all() {
    let only = filter(common_gain(&BRIGHT, 0.15), LightingFilterParams::default());
    let bank = LightingFilterBank::new(vec![only.clone()], MarkovChain::sticky(1, 1.0).unwrap()).unwrap();
    let mut rng = ChaCha8Rng::seed_from_u64(423);
    let mut plain = only;
    let mut jump_markov = JumpMarkovLightingTracker::new(&bank, JumpMarkovFilterParams::default()).unwrap();
    let mut imm = ImmLightingTracker::new(&bank).unwrap();
    let mut gpb2 = Gpb2LightingTracker::new(&bank).unwrap();
    for _ in 0..50 {
        let seen = means(
            &noisy(&stacked(&BRIGHT), &plain.params().mean_color_variance, &mut rng),
            rng.random_range(0..31),
        );
        let others: [&mut dyn LightingTracker; 3] = [&mut jump_markov, &mut imm, &mut gpb2];
        plain.predict(0.04).unwrap();
        plain.update(&seen).unwrap();
        for other in others {
            other.predict(0.04).unwrap();
            other.update(&seen).unwrap();
            for (ours, theirs) in plain.colors().zip(other.colors().unwrap()) {
                // Two algorithms for the same numbers, condition about 1e3.
                assert!((ours.mean - theirs.mean).amax() < 1e-10 * 200.0);
                assert!((ours.covariance - theirs.covariance).amax() < 1e-10 * 1000.0);
            }
        }
    }
}

#[test]
fn trackers_refuse_and_stay_and_become_unsure_in_the_dark() {
    for (name, mut tracker) in trackers() {
        tracker.predict(0.04).unwrap();
        tracker.update(&means(&stacked(&BRIGHT), 0)).unwrap();
        let before = tracker.colors().unwrap();
        for seconds in [-1.0, f64::NAN] {
            assert!(matches!(tracker.predict(seconds), Err(ColorModelError::OutOfRange { .. })), "{name}");
        }
        assert!(tracker.update(&ColorMeans::default()).is_err(), "{name}");
        assert!(tracker.update(&means(&(stacked(&BRIGHT) * f64::NAN), 0)).is_err(), "{name}");
        assert_eq!(tracker.colors().unwrap(), before, "{name}");
        let nothing = means(&stacked(&BRIGHT), 0b11111);
        let mut last = before.iter().map(|color| color.covariance.determinant()).collect::<Vec<_>>();
        for _ in 0..500 {
            tracker.predict(0.04).unwrap();
            tracker.update(&nothing).unwrap();
            let now: Vec<f64> =
                tracker.colors().unwrap().iter().map(|color| color.covariance.determinant()).collect();
            // A mixture that has forgotten everything is as wide as it gets, to rounding.
            assert!(now.iter().zip(&last).all(|(now, last)| *now >= last * (1.0 - 1e-9)), "{name}");
            last = now;
        }
    }
}

#[test]
fn a_walk_makes_the_trackers_as_wide_as_the_filter() {
    let walk = LightingDrift::RandomWalk(nalgebra::Vector3::new(4.0, 1.0, 1.0));
    let light = filter(
        common_gain(&BRIGHT, 0.15),
        LightingFilterParams { lighting_drift: walk, ..LightingFilterParams::default() },
    );
    let bank = LightingFilterBank::new(vec![light.clone()], MarkovChain::sticky(1, 1.0).unwrap()).unwrap();
    let mut tracker = JumpMarkovLightingTracker::new(&bank, JumpMarkovFilterParams::default()).unwrap();
    let mut light = light;
    LightingTracker::predict(&mut light, 7.0).unwrap();
    tracker.predict(7.0).unwrap();
    for (ours, theirs) in light.colors().zip(tracker.colors().unwrap()) {
        assert!((ours.covariance - theirs.covariance).amax() < 1e-9);
    }
}
