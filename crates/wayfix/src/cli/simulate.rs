use std::{
    fs,
    path::{Path, PathBuf},
    process::ExitCode,
};

use anyhow::{Context, Result, anyhow};
use clap::builder::PossibleValuesParser;
use wayfix_evaluation::terminal::{self, print};
use wayfix_scene_sim::{
    film::{FilmFrame, OcclusionEvent, Silhouette, SyntheticFilm},
    scenery::{ImagingConditions, RgbPicture, Scenery},
};

use super::outputs::create_folder;

/// Make simulated images to try a system on.
///
/// Logs with a laser, wheels, a camera or panoramas are in the folder `fixtures` of the repository.
#[derive(clap::Subcommand)]
#[command(after_long_help = EXAMPLES)]
pub(super) enum Command {
    /// A target under changing light, for `run track`: frames, true boxes, and the mask of the target in the first frame.
    Film {
        /// The film.
        #[arg(value_parser = PossibleValuesParser::new(SyntheticFilm::ALL.map(|film| film.name)))]
        name: String,
        /// Folder for `frames/`, `truth.txt` and `mask.png`.
        #[arg(long, value_name = "DIR")]
        out: PathBuf,
        /// Event that affects the target during the film.
        #[arg(long, alias = "incident", value_name = "WHAT", default_value = OcclusionEvent::None.name(),
              value_parser = PossibleValuesParser::new(OcclusionEvent::ALL.map(OcclusionEvent::name)))]
        occlusion: String,
        /// Number of frames, 25 per second.
        #[arg(long, value_name = "N", default_value_t = 175)]
        frames: usize,
        /// Seed of textures, paths, light and noise.
        #[arg(long, value_name = "N", default_value_t = 1)]
        seed: u64,
    },
    /// A large image and the same scene on another day, for `run views`: learned.png and real.png.
    Scene {
        /// The scene, named after those of the paper.
        #[arg(value_parser = PossibleValuesParser::new(Scenery::ALL.map(|scene| scene.name)))]
        name: String,
        /// Folder for `learned.png` and `real.png`.
        #[arg(long, value_name = "DIR")]
        out: PathBuf,
    },
}

const EXAMPLES: &str = "\
Examples:
  wayfix simulate film beetle --out beetle
  wayfix run track --frames beetle/frames --truth beetle/truth.txt --out tracked
  wayfix simulate scene lab --out lab
  wayfix run views --scene lab/real.png --learn-from lab/learned.png --view 256 --out drives";

pub(super) fn main(command: Command) -> Result<ExitCode> {
    match command {
        Command::Film { name, out, occlusion, frames, seed } => {
            let film = SyntheticFilm {
                n_frames: frames,
                occlusion: OcclusionEvent::named(&occlusion)?,
                seed,
                ..SyntheticFilm::named(&name)?
            };
            shoot(&film, &out)?;
            print(format!(
                "{0}: {frames} frames\n\nwayfix run track --frames {0}/frames --truth {0}/truth.txt\n",
                out.display()
            ))?;
        }
        Command::Scene { name, out } => {
            compose(&Scenery::named(&name)?, &out)?;
            print(format!(
                "wayfix run views --scene {0}/real.png --learn-from {0}/learned.png --view {1}\n",
                out.display(),
                Scenery::VIEW_PX
            ))?;
        }
    }
    Ok(ExitCode::SUCCESS)
}

fn shoot(film: &SyntheticFilm, out: &Path) -> Result<()> {
    let folder = out.join("frames");
    create_folder(&folder)?;
    let mut truth = String::new();
    let bar = terminal::bar(film.n_frames, "filming");
    for (index, frame) in film.frames()?.enumerate() {
        save(&folder.join(format!("{index:05}.png")), frame.picture.clone())?;
        if index == 0 {
            save(&out.join("mask.png"), black_and_white(&frame.target))?;
        }
        truth += &true_box(&frame);
        bar.inc(1);
    }
    bar.finish_and_clear();
    let path = out.join("truth.txt");
    fs::write(&path, truth).with_context(|| format!("cannot write {}", path.display()))
}

/// The box of the whole target, hidden parts included; zeros if the target is not visible.
fn true_box(frame: &FilmFrame) -> String {
    let seen = frame.visible.bounding_box().and_then(|_| frame.target.bounding_box());
    let [x, y, width, height] = seen.unwrap_or_default();
    format!("{x},{y},{width},{height}\n")
}

fn compose(scenery: &Scenery, out: &Path) -> Result<()> {
    create_folder(out)?;
    let learned = scenery.compose();
    let real = ImagingConditions::dimmed().picture_of(&learned, scenery.seed)?;
    save(&out.join("learned.png"), learned)?;
    save(&out.join("real.png"), real)
}

fn black_and_white(silhouette: &Silhouette) -> RgbPicture {
    let rgb = silhouette.pixels().iter().flat_map(|inside| [if *inside { 255 } else { 0 }; 3]).collect();
    RgbPicture { width: silhouette.width(), height: silhouette.height(), rgb }
}

fn save(path: &Path, picture: RgbPicture) -> Result<()> {
    let (width, height) = (u32::try_from(picture.width)?, u32::try_from(picture.height)?);
    let image = image::RgbImage::from_raw(width, height, picture.rgb)
        .ok_or_else(|| anyhow!("a picture of {width} × {height} has another number of pixels"))?;
    image.save(path).with_context(|| format!("cannot write {}", path.display()))
}
