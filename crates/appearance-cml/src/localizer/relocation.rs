use crate::{AppearanceError, SimplifyParams, Weighting, check};

/// When a robot doubts where it is, and how it finds itself again; by default it never doubts.
///
/// A robot that was carried away is told by what it does *not* see: it believes to be where references are, and they look otherwise.
/// An average over the last views says so, as the averages of augmented Monte Carlo localization do [Thrun et al. 2005, Sec. 8.3.5]. While there is
/// doubt references that look only somewhat like the view speak too ([`Recognition::Weak`](crate::Recognition::Weak)), anywhere in the map, and
/// a hypothesis wins by the evidence of many views.
///
/// It is for maps that stay true. Where much was rearranged the robot misses what it should see although it is there, and places that look alike win: the
/// figures of both are in `docs/cml.md`.
///
/// ```
/// use wayfix_appearance_cml::{LocalizerParams, RelocationParams};
/// let params = LocalizerParams {
///     relocation: RelocationParams { doubt: 0.5, ..RelocationParams::default() },
///     ..LocalizerParams::default()
/// };
/// assert!(params.validate().is_ok());
/// ```
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
    /// Share of them in which it does not, where it should, from which on it doubts; 1 never doubts. Default 1. With 0.5 it doubts after 6 views.
    pub doubt: f64,
    /// $`m`$ of [`Weighting::Evidence`](crate::Weighting::Evidence) while in doubt. Successive views are alike, at wrong places as well as at the right
    /// one, so that each counts for less than one alone would. Default 0.4.
    pub missed: f64,
    /// Share of the weight for new hypotheses while in doubt, for all the map together. Default 1e-4.
    pub appeared: f64,
}

impl Default for RelocationParams {
    fn default() -> Self {
        Self { views: 8.0, doubt: 1.0, missed: 0.4, appeared: 1e-4 }
    }
}

/// A hundredth of what one of a million places gets with the default.
const LEAST_WEIGHT: f64 = 1e-12;
/// Places that one view may look like, and those that earlier ones did.
const MOST_COMPONENTS: usize = 60;

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

    /// How small the mixture is kept in doubt: what appears starts far lighter, and there is more of it.
    pub(super) fn simplification(&self, usual: &SimplifyParams) -> SimplifyParams {
        SimplifyParams {
            least_weight: usual.least_weight.min(LEAST_WEIGHT),
            most: usual.most.max(MOST_COMPONENTS),
            ..*usual
        }
    }
}
