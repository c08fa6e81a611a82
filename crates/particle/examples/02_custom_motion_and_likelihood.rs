//! Your own motion and your own sensor: a boat that drifts at sea and hears how strong a beacon is.
//!
//! Nothing here is Gaussian or has a Jacobian. `cargo run -p wayfix-particle --example 02_custom_motion_and_likelihood`

use nalgebra::Vector2;
use rand::{Rng, RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use wayfix_estimation_traits::{LikelihoodModel, Manifold, Pose2, SampleMotion};
use wayfix_particle::{BootstrapFilter, ParticleSet, StratifiedResampler};

/// Speed through the water and rudder are known; gusts turn the boat now and then.
struct Boat;

impl SampleMotion for Boat {
    type State = Pose2<f64>;
    /// Metres ahead and radians to port in this step.
    type Control = (f64, f64);

    fn sampler<R: Rng + ?Sized>(&self, control: &(f64, f64)) -> impl Fn(&Pose2<f64>, &mut R) -> Pose2<f64> {
        let (ahead, turn) = *control;
        move |pose, rng| {
            let gust = if rng.random_bool(0.05) { rng.random_range(-0.5..0.5) } else { 0.0 };
            let slip = rng.random_range(0.8..1.2);
            pose.retract(&[ahead * slip, rng.random_range(-0.2..0.2), turn + gust].into())
        }
    }
}

/// Signal strength falls with the distance; sometimes a wave swallows it.
struct Receiver {
    beacons: [Vector2<f64>; 2],
}

impl LikelihoodModel for Receiver {
    type State = Pose2<f64>;
    /// Decibels below the strength at 1 m, of each beacon; `None` for one that was not heard.
    type Measurement = [Option<f64>; 2];

    fn log_likelihood(&self, measurement: &[Option<f64>; 2]) -> impl Fn(&Pose2<f64>) -> f64 {
        let heard = *measurement;
        move |pose| {
            let beacons = self.beacons.iter().zip(heard);
            beacons.filter_map(|(beacon, loss)| Some(log_likelihood(loss?, loss_at(pose, beacon)))).sum()
        }
    }
}

fn loss_at(pose: &Pose2<f64>, beacon: &Vector2<f64>) -> f64 {
    20.0 * (pose.translation - beacon).norm().max(1.0).log10()
}

/// Laplace's distribution, scale 1 dB, which forgives outliers.
fn log_likelihood(loss: f64, expected: f64) -> f64 {
    -(loss - expected).abs()
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let mut rng = ChaCha8Rng::seed_from_u64(7);
    let receiver = Receiver { beacons: [Vector2::new(0.0, 300.0), Vector2::new(400.0, 0.0)] };

    // The boat left the harbour an hour ago.
    let anywhere = |rng: &mut ChaCha8Rng| {
        Pose2::new(rng.random_range(0.0..400.0), rng.random_range(0.0..300.0), rng.random_range(-0.5..0.5))
    };
    let prior = ParticleSet::from_fn(5000, anywhere, &mut rng)?;

    let mut boat = Pose2::new(100.0, 80.0, 0.0);
    let hear = |boat: &Pose2<f64>, rng: &mut ChaCha8Rng| {
        receiver
            .beacons
            .map(|beacon| rng.random_bool(0.7).then(|| loss_at(boat, &beacon) + rng.random_range(-1.0..1.0)))
    };
    let measurements: Vec<_> = (0..60)
        .map(|_| {
            boat = Boat.sampler(&(3.0, 0.01))(&boat, &mut rng);
            hear(&boat, &mut rng)
        })
        .collect();

    let mut filter = BootstrapFilter::new(prior, Boat, receiver);
    for (step, measurement) in measurements.iter().enumerate() {
        filter.predict(&(3.0, 0.01), &mut rng)?;
        let evidence = filter.update(measurement)?;
        if step % 2 == 1 && evidence.effective_share() < 0.5 {
            filter.particles_mut().resample(&StratifiedResampler, 2000, &mut rng)?;
        }
    }

    let moments = filter.particles().moments(|pose| *pose)?;
    let sigma = moments.covariance.fixed_view::<2, 2>(0, 0).trace().sqrt();
    let error = (moments.mean.translation - boat.translation).norm();
    println!("the boat is {error:.0} m from where it is believed to be, give or take {sigma:.0} m");
    assert!(error < 3.0 * sigma, "the filter is sure of itself and wrong");
    Ok(())
}
