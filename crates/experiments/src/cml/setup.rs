use serde::Deserialize;
use wayfix_appearance_cml::LocalizerParams;

/// Setup of an experiment.
#[derive(Clone, Copy, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct CmlExperimentSetup {
    /// Number of seeds; each has its own world.
    pub n_seeds: u64,
    /// Length of a drive, metres, where the experiment leaves it open.
    #[serde(default)]
    pub length_m: f64,
    /// Share of the shelf sections that are rearranged between visits, where the experiment leaves it open. Default 0.4.
    #[serde(default = "CmlExperimentSetup::usually_rearranged")]
    pub rearranged_share: f64,
    /// The localizer. Default as everywhere.
    #[serde(default)]
    pub localizer: LocalizerParams,
}

impl CmlExperimentSetup {
    fn usually_rearranged() -> f64 {
        0.4
    }

    /// The seeds for `regress --seed SEED`, disjoint from those of the stored logs.
    pub(super) fn seeds(&self, seed: u64) -> std::ops::Range<u64> {
        const FIRST: u64 = 20_000;
        let first = FIRST + 1000 * seed;
        first..first + self.n_seeds
    }
}
