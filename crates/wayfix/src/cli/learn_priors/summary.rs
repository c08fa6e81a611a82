use std::fmt::Write;

use wayfix_color_model::{LabelledPixels, LightingPriors, PriorLearningParams, TrainingVenue};

/// What was learned, as a table.
pub(super) fn table(
    priors: &LightingPriors,
    lights: &[String],
    images: &[LabelledPixels],
    min_pixels: u64,
) -> String {
    let width = priors.colors().iter().map(|name| name.chars().count()).max().unwrap_or(0).max(6);
    let mut text = format!("{:width$}  images    pixels\n", "colour");
    for (color, name) in priors.colors().iter().enumerate() {
        let counts = || images.iter().map(|image| image.n_pixels(color)).filter(|n| *n >= min_pixels);
        let _ = writeln!(text, "{name:width$}  {:6}  {:8}", counts().count(), counts().sum::<u64>());
    }
    for (light, member) in lights.iter().zip(priors.members()) {
        let _ = writeln!(text, "\n{light}: mean, and standard deviation between venues");
        let _ = writeln!(text, "{:width$}       Y      U      V     σ_Y    σ_U    σ_V", "colour");
        for (color, name) in priors.colors().iter().enumerate() {
            let mean = |at: usize| member.mean()[3 * color + at];
            let sigma = |at: usize| member.covariance()[(3 * color + at, 3 * color + at)].sqrt();
            let _ = writeln!(
                text,
                "{name:width$}  {:6.1} {:6.1} {:6.1}  {:6.1} {:6.1} {:6.1}",
                mean(0),
                mean(1),
                mean(2),
                sigma(0),
                sigma(1),
                sigma(2)
            );
        }
    }
    text
}

/// What was left out of the images.
pub(super) fn losses(colors: &[String], images: &[LabelledPixels], min_pixels: u64) -> Vec<String> {
    let mut notes = Vec::new();
    for (color, name) in colors.iter().enumerate() {
        let is_small = |image: &&LabelledPixels| (1..min_pixels).contains(&image.n_pixels(color));
        let n = images.iter().filter(is_small).count();
        if n > 0 {
            notes.push(format!(
                "{name}: fewer than {min_pixels} pixels in {n} of {} images, not used there",
                images.len()
            ));
        }
    }
    let n_colors = colors.len();
    let kept: u64 = images.iter().flat_map(|image| (0..n_colors).map(|at| image.n_pixels(at))).sum();
    let sum = |count: fn(&LabelledPixels) -> u64| images.iter().map(count).sum::<u64>();
    let (edges, outliers) = (sum(LabelledPixels::n_edge_pixels), sum(LabelledPixels::n_outliers));
    if edges + outliers > 0 {
        notes.push(format!(
            "of {} labelled pixels {edges} are left out next to another label, and {outliers} that differ from the rest of their colour",
            kept + edges + outliers
        ));
    }
    notes
}

/// What these venues do not determine, and what is assumed instead.
pub(super) fn assumptions(
    venues: &[TrainingVenue],
    lights: &[usize],
    names: &[String],
    params: &PriorLearningParams,
) -> Vec<String> {
    let [y, u, v] = [0, 1, 2].map(|at| params.prior_color_sigmas[at]);
    let spread = format!(
        "σ {y}, {u}, {v} (Y, U, V) between venues, and a correlation of {} of any two colours",
        params.prior_color_correlation
    );
    let note = |(light, name): (usize, &String)| {
        let of_light: Vec<&str> = venues
            .iter()
            .zip(lights)
            .filter(|(_, l)| **l == light)
            .map(|(venue, _)| venue.name.as_str())
            .collect();
        match of_light[..] {
            [one] => format!(
                "{name}: the one venue {one} cannot tell how colours change together between venues; assumed: {spread}"
            ),
            _ => format!(
                "{name}: {} venues, and an assumed spread that counts as {} more: {spread}",
                of_light.len(),
                params.n_pseudo_venues
            ),
        }
    };
    names.iter().enumerate().map(|(at, name)| note((at, name))).collect()
}
