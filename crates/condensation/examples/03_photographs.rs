//! Runs to random goals in photographs, learned in one light and seen in another: successes of 100, for each feature.
//!
//! `cargo run --release -p wayfix-condensation --example 03_photographs -- FOLDER [first_seed [dx dy]]`, where the folder holds `china.jpg`, `coffee.png`,
//! `building.jpg` and the pair `motorcycle_left.png`, `motorcycle_right.png`.

use std::error::Error;
use std::path::Path;
use std::sync::Arc;

use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use wayfix_condensation::{
    ActionSelection, AppearanceLearningParams, AppearanceModel, ColorMeanStdDescriptor, DiscreteStateSpace,
    DominantGraysDescriptor, Fft6Descriptor, GlobalDescriptor, GridMove, LightChange, NavigationEnvironment,
    NavigationOutcome, Navigator, NavigatorParams, PositionGrid, RgbImage, SceneViews, StateDescriptorTable,
    ViewGrid, ViewLocalizer, ViewLocalizerParams, light_match, mapped, shifted,
};

const RUNS: u64 = 100;

/// A robot that really is somewhere, and sees the real scene there.
struct Drive<'a> {
    grid: PositionGrid,
    seen: &'a StateDescriptorTable,
    at: usize,
}

impl NavigationEnvironment<GridMove> for Drive<'_> {
    fn act(&mut self, action: GridMove) {
        self.at = self.grid.step(self.at, action);
    }

    fn observe(&mut self, features: &mut [f64]) {
        if let Some(row) = self.seen.get(self.at) {
            features.copy_from_slice(row);
        }
    }
}

fn main() -> Result<(), Box<dyn Error>> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let folder = Path::new(arguments.first().ok_or("which folder?")?);
    let number = |i: usize, default: i32| arguments.get(i).map_or(Ok(default), |text| text.parse());
    let (seed, dx, dy) = (number(1, 0)?, number(2, 4)?, number(3, 3)?);
    println!("successes (unsure) mean steps, mean steps to certainty");
    for name in ["china.jpg", "coffee.png", "building.jpg"] {
        let learned = load(&folder.join(name))?;
        let real = shifted(&LightChange { gain: 0.7, offset: 20.0, gamma: 1.3 }.apply(&learned)?, dx, dy);
        compare(name, &learned, &real, seed)?;
    }
    let (left, right) =
        (load(&folder.join("motorcycle_left.png"))?, load(&folder.join("motorcycle_right.png"))?);
    compare("motorcycle", &left, &right, seed)
}

fn compare(name: &str, learned: &RgbImage, real: &RgbImage, seed: i32) -> Result<(), Box<dyn Error>> {
    let light = light_match(real, learned).ok_or("a scene without contrast")?;
    let matched = mapped(real, &[light.inverse_table()?; 3]);
    let size = (learned.width() as usize, learned.height() as usize);
    for (view, step) in [(128, 32), (256, 16)] {
        let views = ViewGrid::new(size, (view, view), step)?;
        let modes = [
            ("whole scene", &matched, AppearanceLearningParams::normalized()),
            ("online", real, AppearanceLearningParams::online()),
        ];
        for (mode, scene, params) in modes {
            let features: [(&str, &dyn GlobalDescriptor); 3] = [
                ("MeanVar", &ColorMeanStdDescriptor),
                ("FFT6", &Fft6Descriptor),
                ("Hist6", &DominantGraysDescriptor::default()),
            ];
            for (feature_name, feature) in features {
                let appearance =
                    AppearanceModel::learn(&SceneViews::new(learned, &views)?, feature, &params)?;
                let seen = feature.extract_all(scene, &views)?;
                for choice in [ActionSelection::Greedy, ActionSelection::Informed { hypotheses: 12 }] {
                    let figures = runs(&Arc::new(appearance.clone()), &seen, *views.grid(), choice, seed)?;
                    println!("{name} {view}/{step} {mode} {feature_name} {choice:?}: {figures}");
                    if mode == "online" {
                        break; // the choice of actions is compared where a step costs least
                    }
                }
            }
        }
    }
    Ok(())
}

fn runs(
    appearance: &Arc<AppearanceModel>,
    seen: &StateDescriptorTable,
    grid: PositionGrid,
    choice: ActionSelection,
    seed: i32,
) -> Result<String, Box<dyn Error>> {
    let navigator =
        Navigator::new(grid, NavigatorParams { action_selection: choice, ..NavigatorParams::default() })?;
    let (mut successes, mut unsure, mut steps, mut certain, mut kidnappings) = (0, 0, 0, 0, 0);
    for run in 0..RUNS {
        let mut rng = ChaCha8Rng::seed_from_u64(run + seed.unsigned_abs() as u64);
        let mut drive = Drive { grid, seen, at: rng.random_range(0..grid.n_states()) };
        let goal = rng.random_range(0..grid.n_states());
        let mut localizer = ViewLocalizer::new(appearance.clone(), ViewLocalizerParams::default())?;
        let report = navigator.run(goal, &mut localizer, &mut drive, &mut |_, _| {}, &mut rng)?;
        successes += u32::from(report.arrival == NavigationOutcome::Reached && drive.at == goal);
        unsure += u32::from(report.arrival != NavigationOutcome::Reached);
        steps += report.steps;
        certain += report.steps_to_certainty.unwrap_or(report.steps);
        kidnappings += report.kidnappings;
    }
    let mean = |sum: usize| sum as f64 / RUNS as f64;
    Ok(format!("{successes} ({unsure}) {:.1} {:.2} kidnappings {kidnappings}", mean(steps), mean(certain)))
}

fn load(path: &Path) -> Result<RgbImage, Box<dyn Error>> {
    Ok(image::open(path)?.to_rgb8())
}
