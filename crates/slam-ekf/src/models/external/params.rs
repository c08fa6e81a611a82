use nalgebra::{Matrix1, Matrix3, Vector2, Vector3};
use wayfix_gaussian_core::{GaussianError, check_covariance};

use super::LocalPlane;
use crate::SlamError;

/// Which measurements of the pose a filter takes, and the noise of those that state none. Nothing is taken by default.
#[derive(Clone, Debug, PartialEq, Default)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize, serde::Deserialize),
    serde(default, deny_unknown_fields)
)]
pub struct ExternalParams {
    /// Names of frames that are the frame of the map; measurements in others are refused. `enu`: the x axis of the map points east.
    pub map_frame_ids: Vec<String>,
    /// Latitude and longitude of the origin of the map, whose x axis then points east, degrees; without it WGS 84 positions are refused.
    #[cfg_attr(feature = "serde", serde(skip_serializing_if = "Option::is_none"))]
    pub datum: Option<[f64; 2]>,
    /// Standard deviation of positions without a covariance, m; without it they are refused.
    #[cfg_attr(feature = "serde", serde(skip_serializing_if = "Option::is_none"))]
    pub position_sigma: Option<f64>,
    /// Standard deviation of headings without a covariance, rad; without it they are refused.
    #[cfg_attr(feature = "serde", serde(skip_serializing_if = "Option::is_none"))]
    pub heading_sigma: Option<f64>,
}

/// Why a measurement of the pose is refused.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum ExternalError {
    /// It is in a frame that is not that of the map.
    #[error("its frame {0:?} is not that of the map (`external.map_frame_ids`)")]
    Frame(String),
    /// A WGS 84 position, and the map has no datum on earth.
    #[error("the map has no place on earth (`external.datum`)")]
    Datum,
    /// It has no covariance, and the parameters have none.
    #[error("it has no covariance (`external.position_sigma`, `external.heading_sigma`)")]
    NoCovariance,
    /// Its stated covariance is not positive definite in what it measures.
    #[error(transparent)]
    Covariance(#[from] GaussianError),
    /// The filter refuses it.
    #[error(transparent)]
    Filter(#[from] SlamError),
}

impl ExternalParams {
    /// Whether any measurement is taken.
    pub fn is_on(&self) -> bool {
        !self.map_frame_ids.is_empty() || self.datum.is_some()
    }

    /// Checks that sigmas are positive and that the datum is a place on earth.
    ///
    /// # Errors
    /// Returns [`SlamError::Parameter`] with the name of the first that is not.
    pub fn check(&self) -> Result<(), SlamError> {
        let sigmas = [
            ("external.position_sigma", self.position_sigma),
            ("external.heading_sigma", self.heading_sigma),
        ];
        for (name, sigma) in sigmas {
            if let Some(value) = sigma.filter(|sigma| !(*sigma > 0.0 && sigma.is_finite())) {
                return Err(SlamError::Parameter { name, value, range: "positive" });
            }
        }
        match self.datum {
            Some([latitude, longitude]) if LocalPlane::new(latitude, longitude).is_none() => {
                let range = "a latitude within ±90° and a longitude within ±360°";
                let value = if latitude.abs() <= 90.0 { longitude } else { latitude };
                Err(SlamError::Parameter { name: "external.datum", value, range })
            }
            _ => Ok(()),
        }
    }

    /// Admits a measurement in this frame.
    ///
    /// # Errors
    /// Returns [`ExternalError::Frame`] if the frame is not that of the map.
    pub fn check_frame(&self, frame: &str) -> Result<(), ExternalError> {
        let is_of_map = self.map_frame_ids.iter().any(|of_map| of_map == frame);
        if is_of_map { Ok(()) } else { Err(ExternalError::Frame(frame.to_owned())) }
    }

    /// A WGS 84 position in the map, m.
    ///
    /// # Errors
    /// Returns [`ExternalError::Datum`] if the map has no datum on earth.
    pub fn position(&self, latitude: f64, longitude: f64) -> Result<Vector2<f64>, ExternalError> {
        let datum = self.datum.and_then(|[latitude, longitude]| LocalPlane::new(latitude, longitude));
        datum.map(|plane| plane.position(latitude, longitude)).ok_or(ExternalError::Datum)
    }

    /// The covariance of `(x, y, θ)` that the sensor states, else that of the parameters.
    ///
    /// # Errors
    /// Returns [`ExternalError::NoCovariance`] if there is none for what is measured, [`ExternalError::Covariance`] if the stated one is not
    /// positive definite in what is measured.
    pub fn covariance(
        &self,
        stated: Option<Matrix3<f64>>,
        has_position: bool,
        has_heading: bool,
    ) -> Result<Matrix3<f64>, ExternalError> {
        let sigma = |is_measured: bool, sigma: Option<f64>| if is_measured { sigma } else { Some(0.0) };
        let sigmas = sigma(has_position, self.position_sigma).zip(sigma(has_heading, self.heading_sigma));
        let assumed = sigmas.map(|(position, heading)| {
            Matrix3::from_diagonal(&Vector3::new(position, position, heading).map(|sigma| sigma * sigma))
        });
        let Some(stated) = stated else { return assumed.ok_or(ExternalError::NoCovariance) };
        match (has_position, has_heading) {
            (true, true) => check_covariance("its", &stated)?,
            (true, false) => check_covariance("its", &stated.fixed_view::<2, 2>(0, 0).into_owned())?,
            (false, true) => check_covariance("its", &Matrix1::new(stated.m33))?,
            (false, false) => {}
        }
        Ok(stated)
    }
}
