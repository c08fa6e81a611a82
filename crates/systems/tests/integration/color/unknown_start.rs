//! A robot that starts anywhere, in views that hardly tell where.

use std::path::Path;

use wayfix_sensor_log::{LogOpenOptions, Record, RecordData, open_all};
use wayfix_systems::color::{StartPose, priors, read_map};

use super::support::{localize_with, n_wrongly_tracked, table};

/// So many frames has a search: the status needs them all.
const N_FRAMES: usize = 16;

#[test]
fn first_place_of_a_search_is_not_tracked() {
    let fixtures = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../fixtures");
    let map = read_map(&fixtures.join("four-legged-field.toml")).expect("a map");
    let log = fixtures.join("color_bright.mcap").display().to_string();
    let records: Vec<Record> = open_all(&[log], &LogOpenOptions::default()).expect("a log").collect();
    for first in [35, 230] {
        let mut n_images = 0;
        let mut part = records.clone();
        part.retain(|record| {
            let is_image = matches!(record.data, RecordData::Image(_));
            n_images += usize::from(is_image);
            !is_image || (first..first + N_FRAMES).contains(&(n_images - 1))
        });
        let frames = localize_with(
            &part,
            map.clone(),
            &priors::built_in().expect("priors"),
            Some(StartPose::Anywhere),
        );
        assert_eq!(frames.len(), N_FRAMES);
        assert_eq!(n_wrongly_tracked(&frames), 0, "from frame {first}\n{}", table(&frames));
    }
}
