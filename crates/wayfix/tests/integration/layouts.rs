//! The layouts for Foxglove: whole, and with the topics that the systems write.
#![expect(
    clippy::unwrap_used,
    clippy::panic,
    reason = "a panic is the verdict of a test, in its helpers too"
)]

use std::{
    collections::BTreeSet,
    ffi::OsStr,
    fs,
    path::{Path, PathBuf},
};

use crate::common::{Scratch, wayfix};
use mcap::MessageStream;
use serde_json::Value;
use wayfix_evaluation::report::foxglove_layout;
use wayfix_scene_sim::film::SyntheticFilm;
use wayfix_sensor_log::{EncodedImage, LogFormat, LogOpenOptions, Record, open, write};

const LAYOUT: &str = "foxglove-layout.json";

fn fixture(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../fixtures").join(name)
}

/// The first records of a fixture: topics do not wait for long.
fn beginning(scratch: &Scratch, name: &str, n_records: usize) -> PathBuf {
    let records: Vec<Record> =
        open(fixture(name), &LogOpenOptions::default()).unwrap().take(n_records).collect();
    let path = scratch.path(name);
    write(&path, LogFormat::Mcap, records).unwrap();
    path
}

/// The topics in what `wayfix run SYSTEM … --out` wrote, beside which its layout must lie.
fn topics_of(system: &str, input: &[&OsStr]) -> BTreeSet<String> {
    let scratch = Scratch::new();
    let out = scratch.path("out");
    let first = [OsStr::new("run"), OsStr::new(system), OsStr::new("--out"), out.as_os_str()];
    let outcome = wayfix(first.iter().chain(input));
    assert_eq!(outcome.code, 0, "{}", outcome.stderr);
    assert_eq!(fs::read_to_string(out.join(LAYOUT)).unwrap(), foxglove_layout(system).unwrap());
    let page = fs::read_to_string(out.join("index.html")).unwrap();
    assert!(page.contains(&format!("href=\"{LAYOUT}\"")), "the page leads to the layout");
    let file = fs::read(out.join("estimates.mcap")).unwrap();
    MessageStream::new(&file).unwrap().map(|message| message.unwrap().channel.topic.clone()).collect()
}

fn layout(system: &str) -> Value {
    serde_json::from_str(foxglove_layout(system).unwrap()).unwrap()
}

/// Panels in the tree, each a leaf.
fn leaves(tree: &Value) -> Vec<String> {
    match tree {
        Value::String(panel) => vec![panel.clone()],
        split => {
            assert!(["row", "column"].contains(&split["direction"].as_str().unwrap()), "{split}");
            let share = split["splitPercentage"].as_f64().unwrap();
            assert!(share > 0.0 && share < 100.0, "{split}");
            [&split["first"], &split["second"]].into_iter().flat_map(leaves).collect()
        }
    }
}

/// Every topic that a panel shows.
fn shown(panel: &str, config: &Value) -> Vec<String> {
    let keys = |object: &Value| -> Vec<String> { object.as_object().unwrap().keys().cloned().collect() };
    match panel.split_once('!').unwrap().0 {
        "3D" => keys(&config["topics"]),
        "Image" => {
            let mode = &config["imageMode"];
            let image = mode["imageTopic"].as_str().unwrap().to_owned();
            keys(&mode["annotations"]).into_iter().chain([image]).collect()
        }
        "Plot" => {
            let paths = config["paths"].as_array().unwrap();
            assert!(!paths.is_empty() && paths.iter().all(|path| path["enabled"] == true), "{config}");
            let topic =
                |path: &Value| path["value"].as_str().unwrap().split(['.', '[']).next().unwrap().to_owned();
            paths.iter().map(topic).collect()
        }
        other => panic!("no panel is called {other}"),
    }
}

/// Each panel of the tree has a configuration and the other way round; all that they show is written.
fn fits(system: &str, written: &BTreeSet<String>) {
    let layout = layout(system);
    let configs = layout["configById"].as_object().unwrap();
    let panels: BTreeSet<String> = leaves(&layout["layout"]).into_iter().collect();
    assert_eq!(panels, configs.keys().cloned().collect(), "{system}");
    for (panel, config) in configs {
        for topic in shown(panel, config) {
            assert!(written.contains(&topic), "{system}, {panel}: {topic} is not among {written:?}");
        }
    }
}

#[test]
fn slam_and_lines_layouts_show_their_topics() {
    let scratch = Scratch::new();
    let log = OsStr::new("--log");
    let points = beginning(&scratch, "loop_known.mcap", 600);
    let scans = beginning(&scratch, "office_laser.mcap", 300);
    let mut written = topics_of("slam", &[log, points.as_os_str()]);
    assert!(!written.contains("/estimate/walls"));
    written.extend(topics_of("slam", &[log, scans.as_os_str()]));
    fits("slam", &written);
    fits("lines", &topics_of("lines", &[log, scans.as_os_str()]));
}

#[test]
fn color_and_cml_show_what_they_write() {
    let scratch = Scratch::new();
    let (log, map) = (beginning(&scratch, "color_dark.mcap", 60), fixture("four-legged-field.toml"));
    let input = [OsStr::new("--log"), log.as_os_str(), OsStr::new("--map"), map.as_os_str()];
    fits("color", &topics_of("color", &input));
    let log = beginning(&scratch, "store_area.mcap", 120);
    fits("cml", &topics_of("cml", &[OsStr::new("--log"), log.as_os_str()]));
}

#[test]
fn track_and_views_show_what_they_write() {
    let scratch = Scratch::new();
    let film = SyntheticFilm { n_frames: 4, ..SyntheticFilm::named("head").unwrap() };
    let mut first = None;
    for (index, frame) in film.frames().unwrap().enumerate() {
        let png = EncodedImage::png_rgb(320, 240, &frame.picture.rgb).unwrap();
        scratch.file(&format!("frames/{index}.png"), &png.bytes);
        first.get_or_insert(frame.target.bounding_box().unwrap().map(|number| number.to_string()).join(","));
    }
    let (frames, init) = (scratch.path("frames"), first.unwrap());
    let input = [OsStr::new("--frames"), frames.as_os_str(), OsStr::new("--init"), OsStr::new(&init)];
    fits("track", &topics_of("track", &input));
    let scene = scratch.path("frames/0.png");
    let small = ["--view", "64", "--step", "32", "--trials", "2"].map(OsStr::new);
    let input = [&[OsStr::new("--scene"), scene.as_os_str()], &small[..]].concat();
    fits("views", &topics_of("views", &input));
}

#[test]
fn every_layout_belongs_to_a_system() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../evaluation/layouts");
    for entry in fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        let system = path.file_stem().unwrap().to_str().unwrap().to_owned();
        assert_eq!(foxglove_layout(&system), fs::read_to_string(&path).ok().as_deref(), "{system}");
    }
}
