//! Folders of images as logs.

#![expect(
    clippy::unwrap_used,
    clippy::panic,
    reason = "a panic is the verdict of a test, in its helpers too"
)]

use std::fs;
use std::path::Path;

use wayfix_sensor_log::{
    EncodedImage, LogError, LogFormat, LogOpenOptions, Record, RecordData, RowProblemKind, Stamp, convert,
    open, write,
};

/// A picture whose width tells which one it is.
fn picture(width: u32) -> EncodedImage {
    EncodedImage::png_gray(width, 2, &vec![100; 2 * width as usize]).unwrap()
}

fn put(folder: &Path, name: &str, image: &EncodedImage) {
    fs::write(folder.join(name), &image.bytes).unwrap();
}

fn widths(records: &[Record]) -> Vec<u32> {
    let image = |record: &Record| match &record.data {
        RecordData::Image(image) => image.size().unwrap().0,
        other => panic!("{other:?}"),
    };
    records.iter().map(image).collect()
}

#[test]
fn frames_come_in_the_order_of_their_names_at_the_stated_rate() {
    let folder = tempfile::tempdir().unwrap();
    for (name, width) in [("img10.png", 10), ("img9.PNG", 9), ("img1.png", 1), ("img2.jpeg", 2)] {
        put(folder.path(), name, &picture(width)); // what a file is counts, not how it ends
    }
    fs::write(folder.path().join("boxes.txt"), "1,2,3,4").unwrap();
    let log = open(folder.path(), &LogOpenOptions::default()).unwrap();
    assert_eq!(log.meta().format, LogFormat::Images);
    let (records, report) = log.read_all();
    assert_eq!(widths(&records), [1, 2, 9, 10]);
    assert!(report.is_clean() && report.rows_read == 4, "{report}");
    let nanoseconds = |records: &[Record]| records.iter().map(|r| r.stamp.nanoseconds()).collect::<Vec<_>>();
    assert_eq!(nanoseconds(&records), [0, 33_333_333, 66_666_667, 100_000_000]);

    let options = LogOpenOptions { frame_rate_hz: 12.5, ..Default::default() };
    let records = open(folder.path(), &options).unwrap().read_all().0;
    assert_eq!(nanoseconds(&records), [0, 80_000_000, 160_000_000, 240_000_000]);
}

#[test]
fn frames_that_cannot_be_read_are_counted_and_leave_their_gap() {
    let folder = tempfile::tempdir().unwrap();
    let at = |name: &str| folder.path().join(name);
    put(folder.path(), "2.png", &picture(2));
    put(folder.path(), "6.png", &picture(6));
    fs::write(at("1.png"), b"").unwrap();
    fs::write(at("3.jpg"), "not a picture").unwrap();
    let whole = EncodedImage::jpeg(8, 8, &[50; 192], 90).unwrap();
    fs::write(at("4.jpg"), &whole.bytes[..whole.bytes.len() - 2]).unwrap();
    fs::create_dir(at("5.png")).unwrap();
    let (records, report) = open(folder.path(), &LogOpenOptions::default()).unwrap().read_all();
    assert_eq!(widths(&records), [2, 6]);
    assert_eq!(records[1].stamp, Stamp::from_nanoseconds(133_333_333), "the fifth file; a folder is none");
    assert_eq!(report.problems[&RowProblemKind::UnreadableImage], 3);
    let reasons: Vec<String> = report.examples.iter().map(ToString::to_string).collect();
    assert_eq!(reasons[0], "1.png:1: neither JPEG nor PNG");
    assert_eq!(reasons[2], format!("4.jpg:4: the image breaks off after {} bytes", whole.bytes.len() - 2));
}

#[test]
fn a_folder_without_a_frame_is_an_error_that_says_why() {
    let folder = tempfile::tempdir().unwrap();
    let at = |options: &LogOpenOptions| open(folder.path(), options).unwrap_err();
    let images = LogOpenOptions { format: Some(LogFormat::Images), ..Default::default() };
    assert!(matches!(at(&LogOpenOptions::default()), LogError::IsADirectory { .. }));
    assert!(matches!(at(&images), LogError::Empty { .. }));
    fs::write(folder.path().join("a.png"), "?").unwrap();
    assert!(matches!(at(&images), LogError::NotThisFormat { format: LogFormat::Images, .. }));
    for rate in [0.0, -30.0, f64::NAN, f64::INFINITY, 1e-9] {
        let error = at(&LogOpenOptions { frame_rate_hz: rate, ..Default::default() });
        assert!(matches!(error, LogError::BadFrameRate { .. }), "{error}");
    }
    assert!(open(folder.path().join("a.png"), &images).is_err(), "a file is no folder");
    assert!(matches!(write("nowhere", LogFormat::Images, []), Err(LogError::NotWritable { .. })));
}

#[test]
fn a_folder_becomes_an_mcap_file_and_keeps_where_it_comes_from() {
    let folder = tempfile::tempdir().unwrap();
    (1..40).for_each(|width| put(folder.path(), &format!("{width:04}.png"), &picture(width)));
    let path = folder.path().join("frames.mcap");
    convert(open(folder.path(), &LogOpenOptions::default()).unwrap(), &path, LogFormat::Mcap).unwrap();
    let from_mcap = open(&path, &LogOpenOptions::default()).unwrap();
    assert_eq!(from_mcap.meta().origin, Some(LogFormat::Images));
    let from_folder = open(folder.path(), &LogOpenOptions::default()).unwrap();
    assert_eq!(from_mcap.read_all().0, from_folder.read_all().0);
}
