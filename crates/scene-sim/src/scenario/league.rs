use super::{Scenario, ScenarioParams};
use crate::league::{LampSetting, LeagueParams};

/// The hall of all scenarios, selected from 24 because its dark light shows best how seen colours predict an unseen one. It is not
/// representative; for random halls use [`Scenario::with_seed`].
const HALL: u64 = 2034;

pub(super) fn all() -> Vec<Scenario> {
    let league =
        |name, seed, params| Scenario { name, seed, params: ScenarioParams::League(Box::new(params)) };
    let kidnap_frames = vec![95, 190];
    vec![
        league("color_dark", 21, under(LampSetting::Dark)),
        league("color_bright", 22, under(LampSetting::Bright)),
        league("color_switching", 23, switching()),
        league("color_kidnapped", 24, LeagueParams { kidnap_frames, ..under(LampSetting::Bright) }),
        league("color_sun", 25, LeagueParams { n_frames: 200, ..under(LampSetting::Sunny) }),
    ]
}

fn under(lighting: LampSetting) -> LeagueParams {
    LeagueParams { venue_seed: Some(HALL), lamp_settings: vec![(0, lighting)], ..LeagueParams::default() }
}

/// Lights go off and on again five times; every frame is labelled, for the classification rate over time.
fn switching() -> LeagueParams {
    use LampSetting::{Bright, Dark};
    let lights = vec![(0, Bright), (50, Dark), (95, Bright), (140, Dark), (170, Bright), (230, Dark)];
    let params = LeagueParams { lamp_settings: lights, ..under(Bright) };
    LeagueParams { n_labelled_frames: params.n_frames, ..params }
}
