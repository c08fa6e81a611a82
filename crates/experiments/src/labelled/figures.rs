use anyhow::Result;
use wayfix_color_map::ColorId;
use wayfix_color_model::{ColorDensity, PixelClassifier};
use wayfix_evaluation::plot::{
    CovarianceEllipsesPlot, FilmStrip, FilmStripFrame, NamedEllipse, SvgPlot, named_color,
};
use wayfix_sensor_log::EncodedImage;

use super::{known_pose::AdaptedLight, place::Place};

/// Display colour of a map colour without one, and of the background.
const OTHER: [u8; 3] = [96, 96, 100];

/// The colours before the image and in its lights. [Schulz & Fox 2004, Fig. 5]
pub(super) fn ellipses(
    place: &Place,
    colors: &[String],
    prior: &[ColorDensity],
    light: &AdaptedLight,
) -> Result<SvgPlot> {
    let shade = light.shade.as_deref().map(|shade| ("shade", shade));
    let panels = [("prior", prior), ("sun", light.sun.as_slice())].into_iter().chain(shade);
    let group = |(name, densities): (&str, &[ColorDensity])| {
        (format!("{name}: V"), densities.iter().zip(colors).map(ellipse).collect())
    };
    let plot = CovarianceEllipsesPlot {
        title: format!("Colours of a pixel in {}, 1σ: before the image, and in its lights", place.name),
        x_label: "U".to_owned(),
        sigmas: 1.0,
        groups: panels.map(group).collect(),
    };
    Ok(plot.draw()?)
}

fn ellipse((density, name): (&ColorDensity, &String)) -> NamedEllipse {
    let c = density.covariance;
    NamedEllipse {
        name: name.clone(),
        center: (density.mean.y, density.mean.z),
        covariance: [[c.m22, c.m23], [c.m32, c.m33]],
    }
}

/// Images beside their labels and their classification.
pub(super) fn film(shown: &[(&Place, AdaptedLight)], colors: &[String]) -> Result<SvgPlot> {
    let paint = |color: Option<usize>| {
        color.and_then(|at| colors.get(at)).and_then(|name| named_color(name)).unwrap_or(OTHER)
    };
    let (mut camera, mut labels, mut classified) = (Vec::new(), Vec::new(), Vec::new());
    let mut frame_size = (0, 0);
    for (place, light) in shown {
        let (width, height) = (place.image.width(), place.image.height());
        frame_size = (width, height);
        let frame = |pixels: Vec<u8>| -> Result<FilmStripFrame> {
            let image = EncodedImage::png_rgb(width, height, &pixels)?;
            Ok(FilmStripFrame { image, caption: place.name.clone() })
        };
        let classifier = PixelClassifier::new(light.lights().into_iter().flatten().copied())?;
        let color_of = |pixel: &[u8; 3]| {
            classifier.classify(*pixel).map(|ColorId(color)| usize::from(color) % colors.len())
        };
        camera
            .push(FilmStripFrame { image: place.encoded.to_browser_format()?, caption: place.name.clone() });
        labels.push(frame(
            place.labels.iter().flat_map(|label| paint(usize::from(*label).checked_sub(1))).collect(),
        )?);
        classified
            .push(frame(place.image.pixels().iter().flat_map(|pixel| paint(color_of(pixel))).collect())?);
    }
    let film = FilmStrip {
        title: "Images, labels of the map at the true pose, and the colour of each pixel in sun or shade"
            .to_owned(),
        rows: vec![
            ("camera".to_owned(), camera),
            ("labels, grey for none".to_owned(), labels),
            ("classified".to_owned(), classified),
        ],
        frame_size,
    };
    Ok(film.draw()?)
}
