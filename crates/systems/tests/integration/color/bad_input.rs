//! What disturbs the camera: a robot is never sure of a wrong pose, and finds itself again.

use std::ops::Range;

use wayfix_scene_sim::league::{
    FieldWalkParams, LampLight, LeaguePicture, LeagueVenue, LeggedRobotParams, LightField,
};
use wayfix_sensor_log::{Record, RecordData};

use super::support::{
    CameraOnHead, Judged, drive, drive_with_cameras, hall, localize, localize_with_second_camera,
    n_wrongly_tracked, sunny_hall, table,
};

/// Two seconds of trouble, at 10 frames a second: more than the 16 frames that a search uses.
const DISTURBED: Range<usize> = 20..40;
/// After it, 16 frames until the search sees none of it, three seconds to the next search and three to the one that confirms it, and 16 frames to believe it.
const N_FRAMES: usize = DISTURBED.end + 16 + 30 + 30 + 16;

/// A robot that stands and looks around.
pub(crate) fn standing() -> LeggedRobotParams {
    let params = LeggedRobotParams::default();
    let walk = FieldWalkParams { speed_mps: 0.0, sideways_share: 1.0, ..params.walk };
    LeggedRobotParams { walk, ..params }
}

/// At most three frames call a wrong pose tracked. In the last 16 frames, those that the status looks at, the pose is right and most call it tracked.
fn check(what: &str, frames: &[Judged]) {
    let table = table(frames);
    assert!(n_wrongly_tracked(frames) <= 3, "{what}: sure of a wrong pose\n{table}");
    let last = &frames[frames.len() - 16..];
    let n_tracked = last.iter().filter(|frame| frame.is_tracking()).count();
    assert!(last.iter().all(Judged::is_right) && n_tracked > 8, "{what}: not found again\n{table}");
}

/// At the end of the trouble, of which no frame shows the map, the pose is not called good.
fn check_blind(what: &str, frames: &[Judged]) {
    check(what, frames);
    assert!(!frames[DISTURBED.end - 1].is_tracking(), "{what}: sure without sight\n{}", table(frames));
}

/// A walk under `light`, or under `other` while disturbed.
fn walk(
    venue: &LeagueVenue,
    [light, other]: [&(impl LightField + Clone + 'static); 2],
    spoil: impl Fn(usize, &mut LeaguePicture),
) -> Vec<Record> {
    drive(
        venue,
        N_FRAMES,
        LeggedRobotParams::default(),
        |frame| Box::new(if DISTURBED.contains(&frame) { other.clone() } else { light.clone() }),
        |frame, picture| {
            if DISTURBED.contains(&frame) {
                spoil(frame, picture);
            }
        },
    )
}

#[test]
fn sun_patches_that_move_past_a_standing_robot() {
    let venue = sunny_hall(1);
    let light = |frame: usize| -> Box<dyn LightField> {
        let mut sun = venue.sunny.clone();
        sun.first_pane_m += 0.02 * frame as f64; // 0.2 m/s, as when a gate with windows opens
        Box::new(sun)
    };
    check("moving sun", &localize(&drive(&venue, N_FRAMES, standing(), light, |_, _| {})));
}

/// A walk in the sun, which a cloud hides while disturbed: every image is all shade then.
fn cloud(hall: u64) -> Vec<Judged> {
    let venue = sunny_hall(hall);
    let mut cloudy = venue.sunny.clone();
    cloudy.beam *= 0.0;
    cloudy.hall.bounce = venue.bright.bounce;
    localize(&walk(&venue, [&venue.sunny, &cloudy], |_, _| {}))
}

#[test]
fn cloud_that_hides_the_sun() {
    check("cloud", &cloud(1));
}

#[test]
fn cloud_after_which_the_pose_stays_doubtful() {
    let frames = cloud(2);
    assert!(n_wrongly_tracked(&frames) <= 3, "cloud: sure of a wrong pose\n{}", table(&frames));
}

#[test]
fn light_switched_off_in_mid_drive() {
    let (venue, dark) = (hall(2), LampLight::default());
    check_blind("light off", &localize(&walk(&venue, [&venue.bright, &dark], |_, _| {})));
}

#[test]
fn lens_flare() {
    let venue = hall(4);
    check("lens flare", &localize(&walk(&venue, [&venue.bright; 2], flare)));
}

#[test]
fn ball_that_fills_the_image() {
    let venue = hall(5);
    check_blind("ball", &localize(&walk(&venue, [&venue.bright; 2], ball)));
}

/// Takes the images of these frames out of a log.
fn without_images(mut records: Vec<Record>, frames: &Range<usize>) -> Vec<Record> {
    let mut n_images = 0;
    records.retain(|record| {
        let is_image = matches!(record.data, RecordData::Image(_));
        n_images += usize::from(is_image);
        !(is_image && frames.contains(&(n_images - 1)))
    });
    records
}

#[test]
fn camera_that_stops_and_returns() {
    let venue = hall(6);
    let records = walk(&venue, [&venue.bright; 2], |_, _| {});
    check("camera stops", &localize(&without_images(records, &DISTURBED)));
}

#[test]
fn either_of_two_cameras_stops_and_returns() {
    let venue = hall(6);
    let behind = CameraOnHead { pan: std::f64::consts::PI, gain: 0.7, phase_ms: 50 };
    let light = |_| -> Box<dyn LightField> { Box::new(venue.bright.clone()) };
    let cameras = [CameraOnHead::default(), behind];
    let logs = drive_with_cameras(&venue, N_FRAMES, LeggedRobotParams::default(), light, |_, _| {}, cameras);
    let [first, second] = logs;
    let later = DISTURBED.end + 20..DISTURBED.end + 40;
    let frames =
        localize_with_second_camera(&without_images(first, &DISTURBED), without_images(second, &later));
    check("either camera stops", &frames);
}

/// Veiling glare that falls off from a corner, and ghosts of the aperture on a line through the middle.
fn flare(_: usize, picture: &mut LeaguePicture) {
    let (width, height) = (f64::from(picture.width), f64::from(picture.height));
    let source = (0.2 * width, 0.1 * height);
    let ghosts =
        [(0.6, 0.08, [40.0, 90.0, 50.0]), (1.2, 0.05, [90.0, 50.0, 30.0]), (1.7, 0.12, [30.0, 40.0, 90.0])];
    for (pixel, rgb) in picture.rgb.chunks_exact_mut(3).enumerate() {
        let (x, y) = ((pixel as u32 % picture.width) as f64, (pixel as u32 / picture.width) as f64);
        let from_source = (x - source.0).hypot(y - source.1) / width;
        let veil = 40.0 + 300.0 * (-from_source / 0.12).exp();
        for (channel, value) in rgb.iter_mut().enumerate() {
            let ghost: f64 = ghosts
                .iter()
                .filter(|(along, radius, _)| {
                    let centre = (
                        source.0 + along * (width / 2.0 - source.0),
                        source.1 + along * (height / 2.0 - source.1),
                    );
                    (x - centre.0).hypot(y - centre.1) < radius * width
                })
                .map(|(_, _, tint)| tint[channel])
                .sum();
            *value = (f64::from(*value) + veil + ghost).min(255.0) as u8;
        }
    }
}

/// Orange, lit from above, with other noise in every frame.
fn ball(frame: usize, picture: &mut LeaguePicture) {
    for (pixel, rgb) in picture.rgb.chunks_exact_mut(3).enumerate() {
        let down = f64::from(pixel as u32 / picture.width) / f64::from(picture.height);
        let grain = ((pixel * 7919 + frame * 104_729) % 13) as f64;
        for (value, paint) in rgb.iter_mut().zip([220.0, 110.0, 40.0]) {
            *value = (paint * (1.0 - 0.5 * down) + grain) as u8;
        }
    }
}
