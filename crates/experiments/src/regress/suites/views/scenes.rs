use anyhow::Result;
use wayfix_condensation::{RgbImage, shifted};
use wayfix_scene_sim::scenery::{ImagingConditions, Scenery};
use wayfix_systems::views::{self, DescriptorKind, LightNormalization, RealSceneTransform, ViewSystemConfig};

use super::settings::{ImagingConditionsKind, Settings};
use crate::regress::PlannedJob;

/// The learned scene and the real one, and their views.
pub(super) struct Scenes {
    pub(super) learned: RgbImage,
    pub(super) real: RgbImage,
    view: usize,
    step: usize,
}

impl Scenes {
    /// Pictures in files.
    pub(super) fn read(job: &PlannedJob<'_>, settings: &Settings) -> Result<Self> {
        let path = job.log()?;
        let scene = views::read_scene(path)?.picture;
        let (learned, real) = match &settings.learn_from {
            Some(file) => {
                let learned = views::read_scene(&path.with_file_name(file))?.picture;
                let (dx, dy) =
                    settings.register.map_or((0, 0), |reach| views::mean_shift(&learned, &scene, reach));
                (learned, shifted(&scene, -dx, -dy))
            }
            None => {
                let real = RealSceneTransform::default().of(&scene)?;
                (scene, real)
            }
        };
        Ok(Self { learned, real, view: settings.view, step: settings.step })
    }

    /// A composed scene.
    pub(super) fn compose(settings: &Settings) -> Result<Self> {
        let scenery = Scenery::named(settings.scene()?)?;
        let imaging_conditions = match settings.imaging_conditions {
            ImagingConditionsKind::Dimmed => ImagingConditions::dimmed(),
            ImagingConditionsKind::OtherCamera => ImagingConditions::default(),
        };
        let (learned, real) = views::composed_scene_pair(&scenery, &imaging_conditions)?;
        Ok(Self { learned, real, view: Scenery::VIEW_PX, step: scenery.step_px })
    }

    pub(super) fn setup(
        &self,
        feature: DescriptorKind,
        normalization: LightNormalization,
    ) -> ViewSystemConfig {
        ViewSystemConfig { view: self.view, step: self.step, feature, normalization }
    }
}
