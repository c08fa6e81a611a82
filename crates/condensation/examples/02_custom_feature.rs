//! A feature of your own: how much of the view is edges, across and along. `cargo run --release -p wayfix-condensation --example 02_custom_feature`
//!
//! Two methods are enough; learning, the light and the localizer need to know nothing about it.

use std::sync::Arc;

use wayfix_condensation::{
    AppearanceLearningParams, AppearanceModel, ColorMeanStdDescriptor, ConcatenatedDescriptor,
    DiscreteStateSpace, GlobalDescriptor, GridMove, PositionGrid, RgbImage, SceneViews, SlipProbabilities,
    View, ViewGrid, ViewLocalizer, ViewLocalizerParams, shifted,
};

/// Mean absolute difference of grey values between neighbours, to the right and down.
struct EdgeEnergy;

impl GlobalDescriptor for EdgeEnergy {
    fn n_components(&self) -> usize {
        2
    }

    fn extract(&self, view: &View<'_>, features: &mut [f64]) {
        let grey = view.grey();
        let rows: Vec<&[u8]> = grey.as_raw().chunks_exact(view.width()).collect();
        let right: u64 =
            rows.iter().flat_map(|row| row.windows(2)).map(|w| u64::from(w[0].abs_diff(w[1]))).sum();
        let pairs = rows.windows(2).flat_map(|two| two[0].iter().zip(two[1]));
        let down: u64 = pairs.map(|(a, b)| u64::from(a.abs_diff(*b))).sum();
        features[0] = right as f64 / view.n_pixels() as f64;
        features[1] = down as f64 / view.n_pixels() as f64;
    }
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let scene = bricks(256, 192).ok_or("no picture")?;
    let views = ViewGrid::new((256, 192), (64, 64), 16)?;
    let feature = ConcatenatedDescriptor::new(vec![Box::new(ColorMeanStdDescriptor), Box::new(EdgeEnergy)]);
    let source = SceneViews::new(&scene, &views)?;
    let appearance =
        Arc::new(AppearanceModel::learn(&source, &feature, &AppearanceLearningParams::normalized())?);

    // Straight to the right along the middle row, telling the place on the way.
    let seen = feature.extract_all(&shifted(&scene, 3, 3), &views)?;
    let grid: PositionGrid = *views.grid();
    let right = GridMove { dx: 1, dy: 0 };
    let transition = SlipProbabilities::default().transition(&grid, right)?;
    let mut localizer = ViewLocalizer::new(appearance, ViewLocalizerParams::default())?;
    let mut at = grid.state(1, 4).ok_or("outside")?;
    for _ in 0..8 {
        let outcome = localizer.update(seen.get(at).ok_or("outside")?)?;
        let best = localizer.best();
        println!(
            "at {:?}, believed {:?}: {:.4} {outcome:?}",
            grid.place(at),
            grid.place(best.state),
            best.confidence
        );
        at = grid.step(at, right);
        localizer.predict(&transition)?;
    }
    assert_eq!(localizer.best().state, at);
    Ok(())
}

/// Bricks that get smaller to the right and brighter downwards.
fn bricks(width: usize, height: usize) -> Option<RgbImage> {
    let pixel = |i: usize| {
        let (x, y) = (i % width, i / width);
        let size = 40 - x / 8;
        let tone = (30 + y / 2 + 90 * ((x / size + y / 20) % 2)) as u8;
        [tone, tone / 2 + (x / 4) as u8, 120]
    };
    RgbImage::from_raw(width as u32, height as u32, (0..width * height).flat_map(pixel).collect())
}
