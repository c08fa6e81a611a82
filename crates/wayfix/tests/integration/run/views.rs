//! `wayfix run views` as its users call it, on painted scenes.

use std::{ffi::OsStr, fs, io::Cursor, path::Path};

use image::{DynamicImage, GrayImage, ImageFormat, Rgb, RgbImage};

use crate::common::{Outcome, Scratch, wayfix};

const WIDTH: u32 = 256;
const HEIGHT: u32 = 192;

/// Coloured waves: every view differs from every other.
pub(super) fn painting() -> RgbImage {
    let wave = |phase: f64| (60.0 * phase.sin() + 120.0) as u8;
    RgbImage::from_fn(WIDTH, HEIGHT, |x, y| {
        let (x, y) = (f64::from(x), f64::from(y));
        let red = wave(x / 40.0 + (y / 50.0).sin());
        Rgb([red, wave(x * y / 6000.0), wave(y / 35.0 - (x / 80.0).cos())])
    })
}

pub(super) fn png(image: impl Into<DynamicImage>) -> Vec<u8> {
    let mut bytes = Cursor::new(Vec::new());
    image.into().write_to(&mut bytes, ImageFormat::Png).expect("encodes");
    bytes.into_inner()
}

/// `wayfix run views --scene SCENE --view 64 --step 16 --trials 20 --json …`; what is given twice counts as given last.
fn run_views(scene: &Path, more: &[&str]) -> Outcome {
    let usual = ["--view", "64", "--step", "16", "--trials", "20"];
    let named = |option: &str| more.contains(&option);
    let kept = usual.chunks(2).filter(|pair| !named(pair[0])).flatten().copied();
    let first = ["run", "views", "--json", "--scene"].map(OsStr::new);
    wayfix(
        first.into_iter().chain([scene.as_os_str()]).chain(kept.chain(more.iter().copied()).map(OsStr::new)),
    )
}

fn as_learned() -> [&'static str; 8] {
    ["--gain", "1", "--offset", "0", "--gamma", "1", "--shift", "0,0"]
}

/// Every figure but times.
fn figures(outcome: &Outcome) -> Vec<(String, f64)> {
    outcome.figures().into_iter().filter(|(name, _)| !name.ends_with("_ms")).collect()
}

#[test]
fn figures_have_the_names_of_the_contract() {
    let scratch = Scratch::new();
    let outcome = run_views(&scratch.file("scene.png", png(painting())), &["--seed", "7"]);
    for name in ["trials", "successes", "steps_mean", "steps_to_certainty_mean"] {
        assert!(outcome.metric(name).is_finite(), "{name}");
    }
    assert_eq!((outcome.metric("trials"), outcome.metric("n_places")), (20.0, 13.0 * 9.0));
    let events =
        ["arrived_at_goal", "arrived_elsewhere", "ended_unsure_of_place"].map(|name| outcome.event(name));
    assert_eq!(events.iter().sum::<u64>(), 20, "every drive ends in one of three ways: {events:?}");
    assert_eq!(outcome.json()["seed"], 7);
}

#[test]
fn where_nothing_changed_every_drive_arrives_with_every_feature() {
    let scratch = Scratch::new();
    let scene = scratch.file("scene.png", png(painting()));
    for feature in ["mean-var", "fft6", "hist6", "regions", "joined"] {
        let more = [&["--feature", feature][..], &as_learned()].concat();
        assert_eq!(run_views(&scene, &more).metric("successes"), 20.0, "{feature}");
    }
}

#[test]
fn other_light_is_normalized_by_the_whole_scene_and_online() {
    let scratch = Scratch::new();
    let scene = scratch.file("scene.png", png(painting()));
    // A light that the linear answer of the features does not reach from that of learning.
    let light = ["--gain", "0.5", "--offset", "90", "--gamma", "1.8"];
    let successes =
        |how| run_views(&scene, &[&light[..], &["--normalization", how]].concat()).metric("successes");
    let without = successes("none");
    // 97 % is what is asked of photographs.
    for how in ["whole-scene", "online"] {
        let with = successes(how);
        assert!(with >= 0.97 * 20.0 && with > without, "{how}: {with}, {without} without");
    }
}

#[test]
fn the_same_seed_gives_the_same_figures_and_another_one_others() {
    let scratch = Scratch::new();
    let scene = scratch.file("scene.png", png(painting()));
    let with = |seed| figures(&run_views(&scene, &["--seed", seed]));
    assert_eq!(with("3"), with("3"));
    assert_ne!(with("3"), with("4"));
}

#[test]
fn second_picture_is_used_unchanged_and_a_shift_is_found() {
    let scratch = Scratch::new();
    let scene = scratch.file("learned.png", png(painting()));
    let learned = scene.to_str().expect("a plain path");
    let same = run_views(&scene, &["--learn-from", learned]);
    assert_eq!(figures(&same), figures(&run_views(&scene, &as_learned())));

    let painting = painting();
    let aside = RgbImage::from_fn(WIDTH, HEIGHT, |x, y| *painting.get_pixel((x + 21).min(WIDTH - 1), y));
    let moved = scratch.file("moved.png", png(aside));
    let found = run_views(&moved, &["--learn-from", learned, "--register", "32"]);
    assert!(found.stderr.contains("21 pixels to the right and 0 down"), "{}", found.stderr);
    assert!(found.metric("successes") > run_views(&moved, &["--learn-from", learned]).metric("successes"));
}

#[test]
fn grey_16_bit_and_transparent_pictures_are_converted_and_named() {
    let scratch = Scratch::new();
    let plain = figures(&run_views(&scratch.file("plain.png", png(painting())), &[]));
    let deep = DynamicImage::ImageRgb8(painting()).into_rgb16();
    let transparent = DynamicImage::ImageRgb8(painting()).into_rgba8();
    for (name, bytes, remark) in [
        ("deep.png", png(deep), "more than eight bits a channel: rounded"),
        ("alpha.png", png(transparent), "transparency: left out"),
    ] {
        let outcome = run_views(&scratch.file(name, bytes), &[]);
        assert!(outcome.stderr.contains(remark), "{name}: {}", outcome.stderr);
        assert_eq!(figures(&outcome), plain, "{name}");
    }
    let grey: GrayImage = DynamicImage::ImageRgb8(painting()).into_luma8();
    let outcome = run_views(&scratch.file("grey.png", png(grey)), &as_learned());
    assert!(outcome.stderr.contains("is grey"), "{}", outcome.stderr);
    assert_eq!(outcome.metric("successes"), 20.0);
}

#[test]
fn out_holds_the_page_the_report_the_pictures_and_a_drive() {
    let scratch = Scratch::new();
    let (scene, out) = (scratch.file("scene.png", png(painting())), scratch.path("new/results"));
    let outcome = run_views(&scene, &["--out", out.to_str().expect("a plain path")]);
    let report: serde_json::Value =
        serde_json::from_slice(&fs::read(out.join("report.json")).expect("report.json")).expect("JSON");
    assert_eq!(report["suites"][0]["name"], "views");
    let page = fs::read_to_string(out.join("index.html")).expect("index.html");
    assert!(page.contains("Belief over the places") && page.contains("How many drives"));
    assert!(fs::read_to_string(out.join("figure-3.svg")).expect("a picture").contains("<svg"));
    assert!(outcome.stderr.contains("estimates.mcap") && out.join("estimates.mcap").is_file());
}

#[test]
fn without_echo_the_scene_is_not_in_the_estimates() {
    let scratch = Scratch::new();
    let scene = scratch.file("scene.png", png(painting()));
    let size = |option: &[&str]| {
        let out = scratch.path("out");
        run_views(&scene, &[&["--out", out.to_str().expect("a plain path")], option].concat());
        fs::metadata(out.join("estimates.mcap")).expect("estimates").len()
    };
    assert!(size(&["--no-echo"]) < size(&[]));
}

#[test]
fn printed_parameters_round_trip() {
    let scratch = Scratch::new();
    let scene = scratch.file("scene.png", png(painting()));
    let printed = run_views(&scene, &["--print-params", "--informed", "4"]);
    assert_eq!(printed.code, 0, "{}", printed.stderr);
    let file = scratch.file("params.toml", &printed.stdout);
    let back = run_views(&scene, &["--params", file.to_str().expect("a plain path")]);
    assert_eq!(figures(&back), figures(&run_views(&scene, &["--informed", "4"])));
    let file = scratch.file("few.toml", "[navigator]\nmax_steps = 0");
    let none = run_views(&scene, &["--params", file.to_str().expect("a plain path")]);
    assert_eq!((none.metric("steps_mean"), none.metric("successes")), (0.0, 0.0));
    let file =
        scratch.file("slip.toml", "[navigator.slip]\nstay_probability = 0.3\nother_action_probability = 0.1");
    let slips = run_views(&scene, &["--params", file.to_str().expect("a plain path")]);
    // A way of n moves takes n / 0.7 and more, and a robot that knows it still arrives.
    let usual = run_views(&scene, &[]).metric("steps_mean");
    assert!(slips.metric("steps_mean") > 1.1 * usual && slips.metric("successes") >= 0.9 * 20.0, "{slips:?}");
}

#[test]
fn unusable_scene_is_refused_with_a_reason() {
    let scratch = Scratch::new();
    let scene = scratch.file("scene.png", png(painting()));
    let refused = |outcome: Outcome, reason: &str| {
        assert_eq!((outcome.code, outcome.stdout.as_str()), (1, ""), "{outcome:?}");
        assert!(
            outcome.stderr.starts_with("error: ") && outcome.stderr.contains(reason),
            "{}",
            outcome.stderr
        );
    };
    refused(run_views(&scene, &["--view", "200"]), "does not fit");
    refused(run_views(&scene, &["--view", "1", "--step", "1", "--normalization", "online"]), "larger step");
    refused(run_views(&scratch.path("absent.png"), &[]), "absent.png");
    refused(run_views(&scratch.path(""), &[]), "cannot read");
    refused(run_views(&scratch.file("letter.png", "Dear sir,"), &[]), "neither JPEG nor PNG");
    let whole = png(painting());
    refused(run_views(&scratch.file("cut.png", &whole[..whole.len() / 2]), &[]), "cut.png");

    let constant = scratch.file("constant.png", png(RgbImage::from_pixel(WIDTH, HEIGHT, Rgb([90; 3]))));
    refused(run_views(&constant, &[]), "look the same");
    let small =
        scratch.file("small.png", png(RgbImage::from_fn(100, 100, |x, y| Rgb([x as u8, y as u8, 0]))));
    refused(run_views(&scene, &["--learn-from", small.to_str().expect("a plain path")]), "(100, 100)");
    // So dark that nothing is left: the offset pushes every pixel below black.
    refused(run_views(&scene, &["--offset", "-300"]), "look the same");

    for (option, value) in [("--gain", "0"), ("--gain", "nan"), ("--gamma", "-1"), ("--offset", "inf")] {
        refused(run_views(&scene, &[option, value]), option.trim_start_matches('-'));
    }
}

#[test]
fn invalid_parameters_and_options_are_refused_by_name() {
    let scratch = Scratch::new();
    let scene = scratch.file("scene.png", png(painting()));
    for (text, key) in [
        ("[navigator]\ngoal_confidence = 1.5", "goal_confidence"),
        ("[navigator]\ngoal_confidenec = 0.5", "goal_confidenec"),
        ("[localizer]\nkidnapping_probability = nan", "kidnapping_probability"),
        ("[scene_normalized_appearance_learning.noise_covariance]\npooled_share = 0.0", "pooled_share"),
        ("[scene_normalized_appearance_learning]\nlight_changes = []", "conditions"),
        ("navigator = 3", "navigator"),
    ] {
        let file = scratch.file("params.toml", text);
        let outcome = run_views(&scene, &["--params", file.to_str().expect("a plain path")]);
        assert_eq!((outcome.code, outcome.stdout.as_str()), (1, ""), "{text}");
        assert!(outcome.stderr.contains(key), "{text}: {}", outcome.stderr);
    }
    for (more, what_is_right) in [
        (["--feature", "sift"], "[possible values: mean-var, fft6, hist6, regions, joined]"),
        (["--normalization", "some"], "[possible values: none, whole-scene, online]"),
        (["--shift", "4"], "two whole numbers"),
        (["--view", "0"], "1..=1000000"),
        (["--trials", "none"], "invalid digit"),
    ] {
        let outcome = run_views(&scene, &more);
        assert_eq!(outcome.code, 2, "{more:?}");
        assert!(outcome.stderr.contains(what_is_right), "{more:?}: {}", outcome.stderr);
    }
}

#[test]
fn help_teaches() {
    let outcome = wayfix(["run", "views", "--help"]);
    for taught in ["steps_to_certainty_mean", "--learn-from left.png", "estimated jointly"] {
        assert!(outcome.stdout.contains(taught), "{taught}: {}", outcome.stdout);
    }
}
