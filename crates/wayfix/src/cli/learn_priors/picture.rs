use anyhow::Result;
use wayfix_color_model::{ColorMeans, LightingPriors, TrainingVenue};
use wayfix_evaluation::plot::{CovarianceEllipsesPlot, NamedEllipse, SvgPlot};
use wayfix_systems::color::{ColorSystemParams, priors::bank, uv_ellipses};

/// Ellipses in the UV plane: the pixels of each colour in each image, and what each prior expects of a pixel.
pub(super) fn picture(
    venues: &[TrainingVenue],
    lights: &[String],
    priors: &LightingPriors,
    params: &ColorSystemParams,
) -> Result<SvgPlot> {
    let images = venues.iter().flat_map(|venue| venue.images.iter().map(move |image| (venue, image)));
    let seen = images.flat_map(|(venue, image)| of_image(venue, image, priors.colors()));
    let bank = bank(priors, params)?;
    let expected = lights.iter().enumerate().map(|(at, light)| {
        (format!("prior of a pixel, {light}: V"), uv_ellipses(priors.colors(), bank.member(at)))
    });
    let plot = CovarianceEllipsesPlot {
        title: "Colours of the labelled images and their prior, 2σ".to_owned(),
        x_label: "U".to_owned(),
        sigmas: 2.0,
        groups: std::iter::once(("labelled images: V".to_owned(), seen.collect())).chain(expected).collect(),
    };
    Ok(plot.draw()?)
}

/// The means of an image with the scatter of the pixels of its venue.
fn of_image(venue: &TrainingVenue, image: &ColorMeans, colors: &[String]) -> Vec<NamedEllipse> {
    let variances = venue.pixels.map(|pixels| pixels.variances).unwrap_or_default();
    let ellipse = |(color, mean): (wayfix_color_map::ColorId, nalgebra::Vector3<f64>)| NamedEllipse {
        name: colors[color.index()].clone(),
        center: (mean.y, mean.z),
        covariance: [[variances.y, 0.0], [0.0, variances.z]],
    };
    image.seen().map(ellipse).collect()
}
