//! Learn a small picture, darken it, and find a goal in it from an unknown place: `cargo run --release -p wayfix-condensation --example 01_localize`

use std::sync::Arc;

use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;
use wayfix_condensation::{
    AppearanceLearningParams, AppearanceModel, ColorMeanStdDescriptor, DiscreteStateSpace, GlobalDescriptor,
    GridMove, LightChange, NavigationEnvironment, NavigationOutcome, Navigator, NavigatorParams,
    PositionGrid, RgbImage, SceneViews, StateDescriptorTable, ViewGrid, ViewLocalizer, ViewLocalizerParams,
    shifted,
};

/// The robot as it really is: at a place it does not know, before a scene darker than the one it learned.
struct Robot {
    grid: PositionGrid,
    views: StateDescriptorTable,
    at: usize,
}

impl NavigationEnvironment<GridMove> for Robot {
    fn act(&mut self, action: GridMove) {
        self.at = self.grid.step(self.at, action);
    }

    fn observe(&mut self, features: &mut [f64]) {
        features.copy_from_slice(self.views.get(self.at).expect("a state of the grid"));
    }
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    // Learning: 13 × 9 views of a painted scene, and how they answer to shifts and to light.
    let scene = painting(256, 192).ok_or("no picture")?;
    let views = ViewGrid::new((256, 192), (64, 64), 16)?;
    let params = AppearanceLearningParams::online();
    let appearance =
        AppearanceModel::learn(&SceneViews::new(&scene, &views)?, &ColorMeanStdDescriptor, &params)?;

    // The robot's world: less contrast, more offset, a bent tone curve, and all views a little beside the learned ones.
    let real = shifted(&LightChange { gain: 0.7, offset: 20.0, gamma: 1.3 }.apply(&scene)?, 4, 3);
    let grid = *views.grid();
    let start = grid.state(2, 6).ok_or("outside")?;
    let goal = grid.state(10, 1).ok_or("outside")?;
    let mut robot = Robot { grid, views: ColorMeanStdDescriptor.extract_all(&real, &views)?, at: start };

    let navigator = Navigator::new(grid, NavigatorParams::default())?;
    let mut localizer = ViewLocalizer::new(Arc::new(appearance), ViewLocalizerParams::default())?;
    let mut show = |step: usize, localizer: &ViewLocalizer| {
        let best = localizer.best();
        println!("{step:2}: place {:?} with confidence {:.4}", grid.place(best.state), best.confidence);
    };
    let mut rng = ChaCha8Rng::seed_from_u64(1);
    let report = navigator.run(goal, &mut localizer, &mut robot, &mut show, &mut rng)?;
    println!("{:?} after {} moves; {:?}", report.arrival, report.steps, localizer.disturbance().0);
    assert_eq!((report.arrival, robot.at), (NavigationOutcome::Reached, goal));
    Ok(())
}

/// Coloured waves.
fn painting(width: usize, height: usize) -> Option<RgbImage> {
    let wave = |phase: f64| (60.0 * phase.sin() + 120.0) as u8;
    let pixel = |i: usize| {
        let (x, y) = ((i % width) as f64, (i / width) as f64);
        [wave(x / 40.0 + (y / 50.0).sin()), wave(x * y / 6000.0), wave(y / 35.0 - (x / 80.0).cos())]
    };
    RgbImage::from_raw(width as u32, height as u32, (0..width * height).flat_map(pixel).collect())
}
