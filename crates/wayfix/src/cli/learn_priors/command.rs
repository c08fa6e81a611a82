use std::{collections::BTreeMap, fs, path::PathBuf, process::ExitCode};

use anyhow::{Context, Result, ensure};
use rand_chacha::{ChaCha8Rng, rand_core::SeedableRng};
use wayfix_color_model::{
    LabelledPixels, LightingFilterParams, LightingPriorError, LightingPriors, PriorLearningParams,
    TrainingVenue, learn_grouped_priors, split_by_brightness,
};
use wayfix_evaluation::terminal::{print, print_message};
use wayfix_systems::color::{ColorSystemParams, priors, read_map};

use super::{
    super::parameter_file::read_toml,
    labelled_images::{LabelledImage, LabelledImages},
    picture::picture,
    summary,
    venue_table::VenueTable,
};

/// Learn priors of the colours, for `run color --priors`, from your own labelled images.
///
/// The labels of K.jpg are K_labels.png, or K.png in another folder: an eight-bit grey PNG of the same size. A label is the number of the colour in
/// the map, from 1 on, or 0 for a pixel of no map colour. Two kinds of pixels are skipped: those next to another label, and those that differ from
/// the rest of their colour, for example a ball on the carpet.
///
/// A venue is a place with its light: its images share a mean of each colour. Several venues show how colours change together when the light changes:
/// the colour of the carpet then predicts that of pink. One venue is enough; the command then assumes a broad spread. Each kind of light, for example
/// sun and lamps, has a Gaussian of its own.
///
/// The command also writes a picture of the colours in the UV plane, with the ending .svg.
#[derive(clap::Args)]
#[command(after_long_help = EXAMPLES)]
pub(in crate::cli) struct Arguments {
    /// Folder of the images, JPEG or PNG.
    #[arg(long, value_name = "DIR")]
    images: PathBuf,
    /// Folder of their labels; it may be the same.
    #[arg(long, value_name = "DIR")]
    labels: PathBuf,
    /// The venue of each image: a CSV file with the first line `image,venue` or `image,venue,light`. Images that are not in it are skipped [default: all images
    /// are one venue].
    #[arg(long, value_name = "CSV")]
    groups: Option<PathBuf>,
    /// The map that names the colours in the order of the label numbers [default: green, white, yellow, cyan, pink].
    #[arg(long, value_name = "FILE")]
    map: Option<PathBuf>,
    /// Number of kinds of light into which the venues are split by their brightness, if the CSV file does not name them.
    #[arg(long, value_name = "N", default_value_t = 1)]
    lights: usize,
    /// The parameters of `run color` for which the priors are made; only `yuv_standard` is used.
    #[arg(long, value_name = "FILE")]
    params: Option<PathBuf>,
    /// The priors, as JSON.
    #[arg(long, value_name = "FILE")]
    out: PathBuf,
    /// Seed of the split by brightness.
    #[arg(long, value_name = "N", default_value_t = 1)]
    seed: u64,
}

const EXAMPLES: &str = "\
A CSV file:
  image,venue,light
  monday-1,lab,sun
  monday-2,lab,sun
  friday-1,hall,lamps

Examples:
  wayfix learn-priors --images photos --labels photos --map my-field.toml --out priors.json
  wayfix learn-priors --images photos --labels labels --groups venues.csv --out priors.json
  wayfix run color --log my.mcap --map my-field.toml --priors priors.json";

pub(in crate::cli) fn main(arguments: Arguments) -> Result<ExitCode> {
    let params = match &arguments.params {
        Some(path) => read_toml(path, "color", |text| toml::from_str(text))?,
        None => ColorSystemParams::default(),
    };
    let colors = match &arguments.map {
        Some(path) => read_map(path)?.colors().to_vec(),
        None => {
            let colors = priors::built_in()?.colors().to_vec();
            note(format!("no --map: the labels from 1 on are {}", colors.join(", ")));
            colors
        }
    };
    let found = LabelledImages::find(&arguments.images, &arguments.labels)?;
    note_names(&found.without_labels, "images without labels");
    note_names(&found.without_image, "labels without an image");
    let chosen = grouped(&found.images, &arguments)?;

    let (mut venues, mut images) = (Vec::new(), Vec::new());
    let min_pixels = params.localizer.min_pixels;
    for (name, members) in &chosen.venues {
        let read = members.iter().map(|image| image.read(colors.len(), params.yuv_standard));
        let read = read.collect::<Result<Vec<LabelledPixels>>>()?;
        venues.push(TrainingVenue::from_labelled_pixels(name, &read, min_pixels));
        images.extend(read);
    }
    summary::losses(&colors, &images, min_pixels).into_iter().for_each(note);
    let (names, lights) = chosen.lights(&venues, colors.len(), &arguments)?;
    let (learned, learning) = learn(&colors, &venues, &lights)?;
    summary::assumptions(&venues, &lights, &names, &learning).into_iter().for_each(note);

    let drawn = picture(&venues, &names, &learned, &params)?;
    let picture = arguments.out.with_extension("svg");
    let text = serde_json::to_string_pretty(&learned)? + "\n";
    for (path, text) in [(&arguments.out, text), (&picture, drawn.standalone())] {
        fs::write(path, text).with_context(|| format!("cannot write {}", path.display()))?;
    }
    print(summary::table(&learned, &names, &images, min_pixels))?;
    print_message(format!("wrote {} and {}", arguments.out.display(), picture.display()));
    Ok(ExitCode::SUCCESS)
}

/// The images of each venue, and the kinds of light that the CSV file names.
struct GroupedImages<'a> {
    venues: Vec<(String, Vec<&'a LabelledImage>)>,
    light_of: BTreeMap<String, String>,
}

fn grouped<'a>(images: &'a [LabelledImage], arguments: &Arguments) -> Result<GroupedImages<'a>> {
    let Some(path) = &arguments.groups else {
        note("no --groups: all images are one venue".to_owned());
        let folder = arguments.images.file_name().unwrap_or(arguments.images.as_os_str());
        let venues = vec![(folder.to_string_lossy().into_owned(), images.iter().collect())];
        return Ok(GroupedImages { venues, light_of: BTreeMap::new() });
    };
    let mut table = VenueTable::read(path)?;
    let mut venues: BTreeMap<String, Vec<&LabelledImage>> = BTreeMap::new();
    let mut left_out = Vec::new();
    for image in images {
        match image.keys().find_map(|key| table.venue_of.remove(key)) {
            Some(venue) => venues.entry(venue).or_default().push(image),
            None => left_out.push(image.name.clone()),
        }
    }
    let unknown: Vec<&str> = table.venue_of.keys().map(String::as_str).collect();
    ensure!(unknown.is_empty(), "{}: no labelled image has the name {}", path.display(), unknown.join(", "));
    note_names(&left_out, &format!("images that {} does not name, left out", path.display()));
    Ok(GroupedImages { venues: venues.into_iter().collect(), light_of: table.light_of })
}

impl GroupedImages<'_> {
    /// The names of the kinds of light, and that of each venue.
    fn lights(
        &self,
        venues: &[TrainingVenue],
        n_colors: usize,
        arguments: &Arguments,
    ) -> Result<(Vec<String>, Vec<usize>)> {
        if self.light_of.is_empty() {
            let (k, rng) = (arguments.lights, &mut ChaCha8Rng::seed_from_u64(arguments.seed));
            let restarts = PriorLearningParams::default().n_restarts;
            ensure!(
                (1..=venues.len()).contains(&k),
                "--lights {k}: from 1 to the number of venues, {}; --groups names venues",
                venues.len()
            );
            let lights = split_by_brightness(venues, n_colors, k, restarts, rng)?;
            return Ok(((1..=k).map(|light| format!("light {light}")).collect(), lights));
        }
        ensure!(
            arguments.lights == 1,
            "--lights {}: the CSV file names the kinds of light",
            arguments.lights
        );
        let mut names: Vec<String> = Vec::new();
        let lights = venues.iter().map(|venue| {
            let light = &self.light_of[&venue.name];
            names.iter().position(|name| name == light).unwrap_or_else(|| {
                names.push(light.clone());
                names.len() - 1
            })
        });
        let lights = lights.collect();
        Ok((names, lights))
    }
}

/// The priors, and the parameters that were used.
fn learn(
    colors: &[String],
    venues: &[TrainingVenue],
    lights: &[usize],
) -> Result<(LightingPriors, PriorLearningParams)> {
    let mut params = PriorLearningParams::default();
    let learned = match learn_grouped_priors(colors, venues, lights, &params) {
        Err(LightingPriorError::UnknownScatter) => {
            let assumed = LightingFilterParams::default().mean_color_variance;
            let [y, u, v] = [0, 1, 2].map(|at| assumed[at].sqrt());
            note(format!(
                "no colour is in two images of a venue: assumed is that its mean differs from image to image by σ {y}, {u}, {v} (Y, U, V)"
            ));
            params.mean_color_variance = Some(assumed);
            learn_grouped_priors(colors, venues, lights, &params)
        }
        learned => learned,
    };
    Ok((learned?, params))
}

/// So many names are listed.
const MOST_NAMED: usize = 3;

fn note_names(names: &[String], what: &str) {
    let first = names.iter().take(MOST_NAMED).map(String::as_str).collect::<Vec<_>>().join(", ");
    let more = if names.len() > MOST_NAMED { ", …" } else { "" };
    if !names.is_empty() {
        note(format!("{what}: {} ({first}{more})", names.len()));
    }
}

fn note(text: String) {
    print_message(format!("note: {text}"));
}
