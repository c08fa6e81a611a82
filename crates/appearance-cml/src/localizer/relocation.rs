use crate::{AppearanceError, Weighting, check};

/// When a robot doubts where it is, and how it finds itself again.
///
/// A robot that was carried away is told by what it does *not* see: it believes to be where references are, and they look otherwise.
/// An average over the last views says so, as the averages of augmented Monte Carlo localization do [Thrun et al. 2005, Sec. 8.3.5]. While there is
/// doubt references that look only somewhat like the view speak too ([`Recognition::Weak`](crate::Recognition::Weak)), anywhere in the map, and
/// a hypothesis wins by the evidence of many views.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize, serde::Deserialize),
    serde(default, deny_unknown_fields)
)]
pub struct RelocationParams {
    /// Views over which it is averaged whether the robot recognizes where it is. Default 8: 2 m at a view every 25 cm.
    pub views: f64,
    /// Share of them in which it does not, where it should, from which on it doubts; 1 never doubts. Default 0.85: after 15 views, since a place may
    /// also have changed.
    pub doubt: f64,
    /// $`m`$ of [`Weighting::Evidence`](crate::Weighting::Evidence) while in doubt. Successive views are alike, at wrong places as well as at the right
    /// one, so that each counts for less than one alone would. Default 0.6.
    pub missed: f64,
    /// Share of the weight for new hypotheses while in doubt, for all the map together. Default 1e-6.
    pub appeared: f64,
}

impl Default for RelocationParams {
    fn default() -> Self {
        Self { views: 8.0, doubt: 0.85, missed: 0.6, appeared: 1e-6 }
    }
}

impl RelocationParams {
    /// Whether the numbers have a meaning.
    ///
    /// # Errors
    /// Names the first that has none.
    pub fn validate(&self) -> Result<(), AppearanceError> {
        check::positive("views to doubt after", self.views)?;
        check::share("share of views from which on the robot doubts", self.doubt)?;
        check::share("weight of a hypothesis that is missed in doubt", self.missed)?;
        check::share("weight of all hypotheses that appear in doubt", self.appeared)
    }

    /// What weights are made of in doubt, in a map of so many places; `anywhere` is the weight of what no hypothesis stands for.
    pub(super) fn weighting(&self, anywhere: f64, n_places: f64) -> Weighting {
        Weighting::Evidence { missed: self.missed, appeared: self.appeared.max(anywhere) / n_places.max(1.0) }
    }
}
