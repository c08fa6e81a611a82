//! A robot in a corridor: it knows where the doors are, and learns where it is by passing them.
//!
//! `cargo run -p wayfix-particle --example 01_find_yourself_in_a_corridor`

use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use wayfix_particle::{KldParams, KldSampling, ParticleSet, SystematicResampler, grid_cell};

/// Metres along the corridor. No two gaps are alike, or the robot could not tell where it is.
const DOORS: [f64; 4] = [3.0, 8.0, 10.0, 17.0];
const LENGTH: f64 = 20.0;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    // 1. The generator: everything random comes from it, so the same seed gives the same run.
    let mut rng = ChaCha8Rng::seed_from_u64(7);

    // 2. What is known at first: nothing but that the robot is in the corridor.
    let mut particles = ParticleSet::from_fn(2000, |rng| rng.random_range(0.0..LENGTH), &mut rng)?;

    // 3. To how many particles to resample.
    let kld = KldSampling::new(KldParams::default())?;

    // 4. Patrol in strides of half a metre. After 75 of them somebody carries the robot to the other end.
    let (mut robot, mut stride) = (1.0, 0.5);
    for step in 1..=150 {
        if !(1.0..=LENGTH - 1.0).contains(&(robot + stride)) {
            stride = -stride;
        }
        robot += stride;
        if step == 75 {
            robot = LENGTH - robot;
            println!("somebody carries the robot off");
        }

        // Odometry says how far, some centimetres off.
        particles.propagate(|x, rng| *x += stride + rng.random_range(-0.1..0.1), &mut rng);

        // The door sensor is wrong one time in twenty. Outside the corridor there is nothing: log 0.
        let sees_door = is_door(robot) != rng.random_bool(0.05);
        particles.reweigh(|x| match (0.0..LENGTH).contains(x) {
            true if is_door(*x) == sees_door => 0.95_f64.ln(),
            true => 0.05_f64.ln(),
            false => f64::NEG_INFINITY,
        })?;
        let evidence = particles.normalize()?;

        // One particle in a hundred starts anew anywhere: the robot may have been carried off.
        if evidence.effective_share() < 0.5 {
            let n = particles.kld_size(&kld, |x| grid_cell([*x], [0.2]), &mut rng)?;
            particles.resample(&SystematicResampler, n, &mut rng)?;
            particles.states_mut().iter_mut().step_by(100).for_each(|x| *x = rng.random_range(0.0..LENGTH));
        }

        // 5. Where is it?
        if step % 10 == 0 {
            let near = particles.expectation(|x| f64::from((x - robot).abs() < 1.0))?;
            let n = particles.n_particles();
            println!(
                "step {step:3}: robot at {robot:4.1} m, there with {:3.0} % by {n:4} particles",
                100.0 * near
            );
        }
    }
    Ok(())
}

fn is_door(x: f64) -> bool {
    DOORS.iter().any(|door| (x - door).abs() < 0.5)
}
