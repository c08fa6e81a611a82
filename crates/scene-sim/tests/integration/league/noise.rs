//! Noise of the chip.

use approx::{abs_diff_eq, assert_abs_diff_eq};
use wayfix_scene_sim::league::{CameraParams, LinearRgb};

use super::support::{deviation, honest, mean, of_blank};

#[test]
fn shot_and_read_noise_add_up() {
    for (signal, full_well_electrons, read_noise_sigma) in
        [(0.5, 500.0, 0.0), (0.1, 500.0, 0.0), (0.5, 1e15, 0.03), (0.2, 500.0, 0.02)]
    {
        let camera = CameraParams { full_well_electrons, read_noise_sigma, ..honest() };
        let picture = of_blank(camera, LinearRgb::repeat(signal));
        let green: Vec<f64> = picture.rgb.chunks_exact(3).map(|rgb| f64::from(rgb[1])).collect();
        let n = green.len() as f64;
        // Rounding to whole levels adds 1/12.
        let sigma = (255.0 * 255.0 * (signal / full_well_electrons + read_noise_sigma * read_noise_sigma)
            + 1.0 / 12.0_f64)
            .sqrt();
        let off = (deviation(&green) - sigma).abs();
        assert!(off < 4.0 * sigma / (2.0 * n).sqrt() + 0.02, "σ {} wanted {sigma}", deviation(&green));
        // Half a step of the response is lost.
        assert!(
            abs_diff_eq!(mean(&green), 255.0 * signal, epsilon = 4.0 * sigma / n.sqrt() + 0.05),
            "mean {}",
            mean(&green)
        );
    }
}

#[test]
fn fast_normal_deviate_has_unit_variance_and_normal_tails() {
    use rand_chacha::{ChaCha8Rng, rand_core::SeedableRng};
    let mut rng = ChaCha8Rng::seed_from_u64(3);
    let n = 200_000;
    let draws: Vec<f64> = (0..n).map(|_| wayfix_scene_sim::random::deviate::quick_normal(&mut rng)).collect();
    let root = f64::from(n).sqrt();
    assert!(mean(&draws).abs() < 4.0 / root, "{}", mean(&draws));
    assert_abs_diff_eq!(deviation(&draws), 1.0, epsilon = 4.0 / (2.0_f64.sqrt() * root));
    // Four uniform numbers: kurtosis 3 − 6/(5·4) = 2.7. The standard error of a fourth moment is at most √(E x⁸/n) < √(70/n).
    let fourth = mean(&draws.iter().map(|x| x.powi(4)).collect::<Vec<_>>());
    assert_abs_diff_eq!(fourth, 2.7, epsilon = 4.0 * 70.0_f64.sqrt() / root);
    assert!(draws.iter().all(|x| x.abs() <= 12.0_f64.sqrt()));
}
