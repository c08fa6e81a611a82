//! Byte-order marks, line ends, encodings and first rows of text logs.

use std::fs;
use std::path::Path;

use wayfix_sensor_log::{LogFormat, LogOpenOptions, ReadReport, Record, open};

fn write(folder: &Path, name: &str, text: &str) {
    fs::write(folder.join(name), text).expect("the scratch folder is writable");
}

/// Opens a text that is written as `name`.
fn read_text(folder: &Path, name: &str, bytes: &[u8]) -> (LogFormat, Vec<Record>, ReadReport) {
    fs::write(folder.join(name), bytes).expect("the scratch folder is writable");
    let log = open(folder.join(name), &LogOpenOptions::default()).expect("a log of a known format");
    let format = log.meta().format;
    let (records, report) = log.read_all();
    (format, records, report)
}

const TEXTS: [(&str, &str); 4] = [
    ("walk.txt", "L 7 2.0 0.0\nO 0.5 0.0 0.0\nZ 7 1.5 0.0\n"),
    ("poses.tum", "1 2 3 0 0 0 0 1\n2 2 3 0 0 0 0 1\n"),
    ("scan.log", "FLASER 2 1 1 0 0 0 0 0 0 1.5 host 1.5\n"),
    ("scan.json", "{\"map\": {\"1\": {\"range\": [1, 2], \"theta\": 0, \"x\": 0,\n\"y\": 0}}}"),
];

#[test]
fn a_byte_order_mark_or_other_line_ends_change_nothing() {
    let folder = tempfile::tempdir().unwrap();
    for (name, text) in TEXTS {
        let plain = read_text(folder.path(), name, text.as_bytes());
        assert_eq!(plain.2.n_problems(), 0, "{name}");
        let variants = ["\u{feff}".to_owned() + text, text.replace('\n', "\r\n"), text.replace('\n', "\r")];
        for variant in variants {
            assert_eq!(read_text(folder.path(), name, variant.as_bytes()), plain, "{variant:?}");
        }
    }
}

#[test]
fn sets_of_files_with_byte_order_marks_are_read() {
    let folder = tempfile::tempdir().unwrap();
    let mark = "\u{feff}";
    write(folder.path(), "odometry.csv", &format!("{mark}t_s,speed_mps,steering_rad\r\n1,0.5,0\r\n"));
    write(folder.path(), "trees.csv", &format!("{mark}t_s,range_m,bearing_rad,diameter_m\r\n1,9,1,0.5\r\n"));
    let (records, report) = open(folder.path(), &LogOpenOptions::default()).unwrap().read_all();
    assert_eq!((records.len(), report.n_problems()), (3, 0));

    let folder = tempfile::tempdir().unwrap();
    write(folder.path(), "Barcodes.dat", &format!("{mark}# Subject Barcode\n6 72\n"));
    write(folder.path(), "Robot1_Odometry.dat", &format!("{mark}100 0.1 0\n"));
    write(folder.path(), "Robot1_Measurement.dat", &format!("{mark}100 72 1 0.5\n"));
    let (records, report) = open(folder.path(), &LogOpenOptions::default()).unwrap().read_all();
    assert_eq!((records.len(), report.n_problems()), (2, 0));
}

#[test]
fn utf_16_is_named_with_the_way_out() {
    let folder = tempfile::tempdir().unwrap();
    let text = TEXTS[0].1;
    let little: Vec<u8> = text.encode_utf16().flat_map(u16::to_le_bytes).collect();
    let big: Vec<u8> = text.encode_utf16().flat_map(u16::to_be_bytes).collect();
    let marked = |mark: [u8; 2], text: &[u8]| [&mark, text].concat();
    for bytes in [little.clone(), big.clone(), marked([0xff, 0xfe], &little), marked([0xfe, 0xff], &big)] {
        fs::write(folder.path().join("walk.txt"), bytes).unwrap();
        let error = open(folder.path().join("walk.txt"), &LogOpenOptions::default()).unwrap_err().to_string();
        assert!(error.contains("UTF-16") && error.contains("iconv"), "{error}");
    }
}

#[test]
fn a_header_or_a_damaged_first_row_does_not_hide_the_format() {
    let folder = tempfile::tempdir().unwrap();
    for (name, text) in &TEXTS[..3] {
        let (format, records, _) = read_text(folder.path(), name, text.as_bytes());
        for first in ["t x y z qx qy qz qw\n", "FLASER 180 1.5 1.", "\u{1}\u{2}"] {
            let damaged = format!("{first}\n{text}");
            let (format_again, records_again, report) = read_text(folder.path(), name, damaged.as_bytes());
            assert_eq!((format_again, records_again), (format, records.clone()));
            assert_eq!((report.n_problems(), report.examples[0].row), (1, 1));
        }
    }
}
