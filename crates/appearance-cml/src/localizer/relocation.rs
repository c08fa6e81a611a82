use crate::{AppearanceMapError, check};

/// When a robot doubts where it is, and how it finds itself again.
///
/// A robot that was carried away is told by what it does *not* see: it believes to be where references are, and they look otherwise.
/// An average over the last views says so, as the averages of augmented Monte Carlo localization do [Thrun et al. 2005, Sec. 8.3.5]. But a place that
/// was rearranged looks otherwise too. So what it believes is not given up: while there is doubt a second belief is begun from nothing and goes
/// along beside the first. It takes over when it alone has recognized where it is, over a way that hardly any place that looks like another lasts for; then the first goes along beside
/// the second, to be believed again should it have been right.
///
/// A view *recognizes* a place when a reference there, of that heading, is nearer to it than all of 64 references of far places. At a wrong
/// place the best of half a dozen is so by chance in one view of eleven.
///
/// ```
/// use wayfix_appearance_cml::{LocalizerParams, RelocationParams};
/// let never = LocalizerParams {
///     relocation: RelocationParams { doubt: 1.0, ..RelocationParams::default() },
///     ..LocalizerParams::default()
/// };
/// assert!(never.validate().is_ok());
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
    /// Share of them in which it does not, where it should, from which on it doubts; 1 never doubts. Default 0.5: after 6 views.
    pub doubt: f64,
    /// What the second belief has to show after a break, when it has known its place from there on: after a view that is as strange to the one before as
    /// a far place, which who is carried sees, and who drives into an aisle that was rearranged does not. Default: over 5 m, a quarter of
    /// the way after which a robot should know where it is, a fifth of the views, twice what chance makes; it may drive on into an aisle
    /// that was rearranged.
    pub carried: Proof,
    /// What it has to show after a break when it found its place later, by more than a metre, when the robot explored and knew nothing before, or when the
    /// view before was a break too, as at a corner. Default: four fifths of the views over 8 m: such a robot may as well not have been carried, and come to
    /// an aisle that looks like another.
    pub carried_unknown: Proof,
    /// Way for which a break counts, m: whoever was carried should know by then where it is, and one that was none goes on to be a danger where
    /// doubt lasts. Default 20.
    pub break_way: f64,
    /// [`AppearanceMapParams::match_limit_fraction`](crate::AppearanceMapParams::match_limit_fraction) for who is lost, from the start or after a break that did not come while it explored,
    /// until it believes in a place: it has to be found by references that are further off, or have changed. Not less than that of the map. Default 0.5.
    pub match_share: f64,
    /// What it has to show without one. Default: half of the views over 25 m, because whole aisles look like others when their lamps are out.
    pub strayed: Proof,
    /// Share of these views in which the first may recognize where it is. Default 0.15: what chance makes of it, and a little more.
    pub by_chance: f64,
    /// Way for which the first goes along when the second has taken over, m, and nothing is learned: most aisles that look like others end by then. Default 50.
    pub ousted_way: f64,
    /// What it has to show meanwhile to be believed again. Default: half of the views over 5 m. It had been right for as long as the robot has driven, and is not
    /// looked for anywhere else.
    pub reinstated: Proof,
}

/// What a second belief has to show before it is believed.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(deny_unknown_fields))]
pub struct Proof {
    /// Way over which both are compared, m.
    pub way: f64,
    /// Share of the views of this way in which it recognizes where it is.
    pub recognized: f64,
}

impl Default for RelocationParams {
    fn default() -> Self {
        Self {
            views: 8.0,
            doubt: 0.5,
            carried: Proof { way: 5.0, recognized: 0.2 },
            carried_unknown: Proof { way: 8.0, recognized: 0.8 },
            break_way: 20.0,
            match_share: 0.5,
            strayed: Proof { way: 25.0, recognized: 0.5 },
            by_chance: 0.15,
            ousted_way: 50.0,
            reinstated: Proof { way: 5.0, recognized: 0.5 },
        }
    }
}

impl RelocationParams {
    /// Whether the numbers have a meaning.
    ///
    /// # Errors
    /// Names the first that has none.
    pub fn validate(&self) -> Result<(), AppearanceMapError> {
        check::positive("views to doubt after", self.views)?;
        check::share("share of views from which on the robot doubts", self.doubt)?;
        check::positive("way for which a break counts (m)", self.break_way)?;
        check::share("share of the match limit for who is lost", self.match_share)?;
        check::not_negative("way for which a belief goes along that was ousted (m)", self.ousted_way)?;
        for proof in [&self.carried, &self.carried_unknown, &self.strayed, &self.reinstated] {
            check::positive("way over which two beliefs are compared (m)", proof.way)?;
            check::share("share of views that the second belief recognizes", proof.recognized)?;
        }
        check::share("share of views that the first belief recognizes by chance", self.by_chance)
    }
}
