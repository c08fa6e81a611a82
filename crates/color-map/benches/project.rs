//! Views of a field in nanoseconds: `cargo bench -p wayfix-color-map --features serde`.
//!
//! Prints `bench<TAB>job<TAB>program<TAB>nanoseconds`, the mean over many poses a robot has in play, and on the error stream how many spans
//! those views have.

use std::{hint::black_box, sync::Arc};

use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use wayfix_color_map::{
    ColorMap, MapRenderer, PinholeCamera, PixelSpan, RenderError,
    nalgebra::{UnitQuaternion, Vector3},
};
use wayfix_estimation_traits::Pose3;

const N_POSES: usize = 500;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let map: Arc<ColorMap> = Arc::new(toml::from_str(include_str!("../tests/field.toml"))?);
    // That of an ERS-7, and a camera of today.
    for (width, height) in [(208, 160), (640, 480)] {
        let camera =
            PinholeCamera::from_field_of_view(width, height, 56.9_f64.to_radians(), 45.2_f64.to_radians())?;
        let mut renderer = MapRenderer::new(Arc::clone(&map), camera);
        let poses = poses();

        let (mut n_spans, mut n_pixels) = (0, 0_usize);
        for pose in &poses {
            renderer.spans(pose, &mut |span| {
                n_spans += 1;
                n_pixels += usize::from(span.end - span.start);
            })?;
        }
        let n = N_POSES as f64;
        eprintln!(
            "{width}x{height}: {:.0} spans, {:.0} pixels a view",
            n_spans as f64 / n,
            n_pixels as f64 / n
        );

        report(&format!("field view to spans {width}x{height}"), &poses, |pose| {
            let mut sum = 0;
            renderer.spans(pose, &mut |span| add(&mut sum, span))?;
            Ok(sum)
        })?;
        report(&format!("field view to inner spans {width}x{height}"), &poses, |pose| {
            let mut sum = 0;
            renderer.inner_spans(pose, 1, &mut |span| add(&mut sum, span))?;
            Ok(sum)
        })?;
    }
    Ok(())
}

/// On the field, some 20 cm up, looking around a bit below the horizon, with the head tilted.
fn poses() -> Vec<Pose3<f64>> {
    let mut rng = ChaCha8Rng::seed_from_u64(7);
    let mut pose = || Pose3 {
        translation: Vector3::new(
            rng.random_range(-1.9..1.9),
            rng.random_range(-1.2..1.2),
            rng.random_range(0.15..0.25),
        ),
        rotation: UnitQuaternion::from_euler_angles(
            rng.random_range(-0.1..0.1),
            rng.random_range(-0.1..0.5),
            rng.random_range(-3.1..3.1),
        ),
    };
    (0..N_POSES).map(|_| pose()).collect()
}

/// A consumer that costs next to nothing.
fn add(sum: &mut usize, span: PixelSpan) {
    *sum += usize::from(span.end - span.start) * span.color.index();
}

/// Prints the mean time of a view: the best of several rounds through all poses.
fn report(
    job: &str,
    poses: &[Pose3<f64>],
    mut view: impl FnMut(&Pose3<f64>) -> Result<usize, RenderError>,
) -> Result<(), RenderError> {
    let mut best = f64::INFINITY;
    for _ in 0..15 {
        #[allow(clippy::disallowed_methods, reason = "a benchmark measures time")]
        let start = std::time::Instant::now();
        for pose in poses {
            black_box(view(black_box(pose))?);
        }
        best = best.min(start.elapsed().as_secs_f64() / poses.len() as f64);
    }
    println!("bench\t{job}\twayfix\t{:.0}", best * 1e9);
    Ok(())
}
