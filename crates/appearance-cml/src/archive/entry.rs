use nalgebra::Matrix3;
use wayfix_estimation_traits::Pose2;
use wayfix_gaussian_core::{Gaussian, GaussianMixture};

use super::bytes::{Reader, Writer};
use crate::{
    PanoramaDescriptor, PlaceComponent, ReferenceId, ReferenceView, ViewDifferenceModel, ViewDifferenceSample,
};

/// Something that a map has, or that has become of it.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Entry {
    /// A reference, new or in place of the one with that number.
    Reference(ReferenceId, PanoramaDescriptor, ReferenceView),
    /// New places of one that is there.
    Places(ReferenceId, ReferenceView),
    /// One is gone.
    Forgotten(ReferenceId),
    /// How views change with the lag, and the number of the next reference.
    Scale(ViewDifferenceModel, u32),
    /// Where the robot may be; `None` for anywhere.
    State(Option<GaussianMixture<Pose2<f64>>>),
}

impl Entry {
    pub(super) fn to_bytes(&self) -> Vec<u8> {
        let mut writer = Writer::default();
        match self {
            Self::Reference(id, view, reference) => {
                writer.u8(0);
                writer.u32(id.0);
                write_view(view, &mut writer);
                write_places(reference, &mut writer);
            }
            Self::Places(id, reference) => {
                writer.u8(1);
                writer.u32(id.0);
                write_places(reference, &mut writer);
            }
            Self::Forgotten(id) => {
                writer.u8(2);
                writer.u32(id.0);
            }
            Self::Scale(scale, next) => {
                writer.u8(3);
                writer.u32(*next);
                write_scale(scale, &mut writer);
            }
            Self::State(state) => {
                writer.u8(4);
                write_state(state.as_ref(), &mut writer);
            }
        }
        writer.0
    }

    /// `Err` says what is wrong if the bytes cannot be decoded or are too long.
    pub(super) fn from_bytes(bytes: &[u8]) -> Result<Self, &'static str> {
        let mut reader = Reader(bytes);
        let entry = read(&mut reader).ok_or("it cannot be decoded")?;
        if reader.0.is_empty() { Ok(entry) } else { Err("it goes on after its end") }
    }
}

fn read(reader: &mut Reader) -> Option<Entry> {
    let kind = reader.u8()?;
    if kind == 4 {
        return read_state(reader).map(Entry::State);
    }
    let number = reader.u32()?;
    let id = ReferenceId(number);
    match kind {
        0 => {
            let view = read_view(reader)?;
            Some(Entry::Reference(id, view, read_places(reader)?))
        }
        1 => read_places(reader).map(|reference| Entry::Places(id, reference)),
        2 => Some(Entry::Forgotten(id)),
        3 => read_scale(reader).map(|scale| Entry::Scale(scale, number)),
        _ => None,
    }
}

fn write_view(view: &PanoramaDescriptor, writer: &mut Writer) {
    writer.f32(view.scale());
    writer.u8(view.n_rings());
    let coefficients = view.coefficients();
    writer.u32(coefficients.len() as u32);
    writer.0.extend(coefficients.iter().map(|value| *value as u8));
}

fn read_view(reader: &mut Reader) -> Option<PanoramaDescriptor> {
    let (scale, n_rings) = (reader.f32()?, reader.u8()?);
    let n = reader.count(1)?;
    let coefficients = reader.take(n)?.iter().map(|byte| *byte as i8).collect();
    PanoramaDescriptor::from_parts(scale, n_rings, coefficients).ok()
}

fn write_places(reference: &ReferenceView, writer: &mut Writer) {
    writer.u32(reference.places.len() as u32);
    for place in &reference.places {
        writer.f64s([place.weight, place.count]);
        write_gaussian(&place.gaussian, writer);
    }
}

fn read_places(reader: &mut Reader) -> Option<ReferenceView> {
    let n = reader.count(14 * 8)?;
    let place = |reader: &mut Reader| {
        let [weight, count] = reader.f64s()?;
        Some(PlaceComponent { weight, count, gaussian: read_gaussian(reader)? })
    };
    let places: Option<Vec<PlaceComponent>> = (0..n).map(|_| place(reader)).collect();
    let reference = ReferenceView { places: places? };
    reference.validate().ok()?;
    Some(reference)
}

fn write_scale(scale: &ViewDifferenceModel, writer: &mut Writer) {
    let near: Vec<ViewDifferenceSample> = scale.near().collect();
    let ahead: Vec<ViewDifferenceSample> = scale.ahead().collect();
    for samples in [&near, &ahead] {
        writer.u32(samples.len() as u32);
        samples.iter().for_each(|sample| writer.f64s([sample.lag, sample.distance]));
    }
    let far: Vec<f64> = scale.far().collect();
    writer.u32(far.len() as u32);
    writer.f64s(far);
}

fn read_scale(reader: &mut Reader) -> Option<ViewDifferenceModel> {
    let samples = |reader: &mut Reader| -> Option<Vec<ViewDifferenceSample>> {
        let n = reader.count(16)?;
        (0..n).map(|_| reader.f64s().map(|[lag, distance]| ViewDifferenceSample { lag, distance })).collect()
    };
    let (near, ahead) = (samples(reader)?, samples(reader)?);
    let n = reader.count(8)?;
    let far: Option<Vec<f64>> = (0..n).map(|_| reader.f64()).collect();
    ViewDifferenceModel::from_parts(&near, &ahead, &far?).ok()
}

fn write_state(state: Option<&GaussianMixture<Pose2<f64>>>, writer: &mut Writer) {
    let Some(state) = state else { return writer.u32(0) };
    writer.u32(state.components().len() as u32);
    for (log_weight, component) in state.log_weights().iter().zip(state.components()) {
        writer.f64(*log_weight);
        write_gaussian(component, writer);
    }
}

fn read_state(reader: &mut Reader) -> Option<Option<GaussianMixture<Pose2<f64>>>> {
    let n = reader.count(13 * 8)?;
    let component = |reader: &mut Reader| Some((reader.f64()?, read_gaussian(reader)?));
    let components: Option<Vec<(f64, Gaussian<Pose2<f64>>)>> = (0..n).map(|_| component(reader)).collect();
    if n == 0 {
        return Some(None);
    }
    GaussianMixture::from_log_weights(components?).ok().map(Some)
}

fn write_gaussian(gaussian: &Gaussian<Pose2<f64>>, writer: &mut Writer) {
    let mean = gaussian.mean();
    writer.f64s([mean.x(), mean.y(), mean.heading()]);
    writer.f64s(gaussian.covariance().iter().copied());
}

fn read_gaussian(reader: &mut Reader) -> Option<Gaussian<Pose2<f64>>> {
    let [x, y, heading] = reader.f64s()?;
    let covariance = Matrix3::from_column_slice(&reader.f64s::<9>()?);
    let mean = Pose2::new(x, y, heading);
    mean.is_finite().then(|| Gaussian::new(mean, covariance).ok()).flatten()
}
