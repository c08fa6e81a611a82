//! Logs that are cut short, damaged, hostile or of another program.

#![expect(clippy::unwrap_used, reason = "a panic is the verdict of a test, in its helpers too")]

use crate::common;

use std::collections::BTreeMap;
use std::fs;
use std::io::Cursor;
use std::path::PathBuf;
use std::sync::LazyLock;

use mcap::records::MessageHeader;
use mcap::{Compression, WriteOptions};
use proptest::prelude::*;
use wayfix_sensor_log::{
    LogCompleteness, LogError, LogFormat, LogOpenOptions, McapWriter, ReadReport, Record, RecordData,
    RowProblemKind, open, write,
};

struct Scratch {
    _folder: tempfile::TempDir,
    path: PathBuf,
}

impl Scratch {
    fn new() -> Self {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("log.mcap");
        Self { _folder: folder, path }
    }
    fn read(&self, bytes: &[u8]) -> Result<(Vec<Record>, ReadReport), LogError> {
        fs::write(&self.path, bytes).unwrap();
        open(&self.path, &LogOpenOptions::default()).map(|log| log.read_all())
    }
}

fn whole_file(records: &[Record]) -> Vec<u8> {
    let scratch = Scratch::new();
    write(&scratch.path, LogFormat::Mcap, records.to_vec()).unwrap();
    fs::read(&scratch.path).unwrap()
}

/// The same messages as `bytes`, in other chunks.
fn rechunked(bytes: &[u8], options: WriteOptions) -> Vec<u8> {
    let mut out = Cursor::new(Vec::new());
    let mut writer = options.create(&mut out).unwrap();
    for message in mcap::MessageStream::new(bytes).unwrap() {
        writer.write(&message.unwrap()).unwrap();
    }
    writer.finish().unwrap();
    drop(writer);
    out.into_inner()
}

fn variants(records: &[Record]) -> [Vec<u8>; 4] {
    let plain = whole_file(records);
    let small_chunks = WriteOptions::new().chunk_size(Some(2000));
    [
        rechunked(&plain, small_chunks.clone().compression(Some(Compression::Lz4))),
        rechunked(&plain, small_chunks.compression(Some(Compression::Zstd))),
        rechunked(&plain, WriteOptions::new().use_chunks(false).compression(None)),
        plain,
    ]
}

#[test]
fn compressed_and_unchunked_files_read_the_same() {
    let records = common::drive(100);
    let scratch = Scratch::new();
    for bytes in variants(&records) {
        let (back, report) = scratch.read(&bytes).unwrap();
        assert_eq!(back, records);
        assert_eq!((report.n_problems(), report.end), (0, LogCompleteness::Complete));
    }
}

#[test]
fn a_file_cut_anywhere_gives_a_prefix_and_says_what_is_missing() {
    let records = common::drive(12);
    let scratch = Scratch::new();
    for bytes in variants(&records) {
        let mut n_before = 0;
        // A stride that is prime to the alignment of everything, and each of the bytes of the end mark.
        let cuts = (0..bytes.len()).filter(|n_bytes| n_bytes % 13 == 0 || n_bytes + 60 > bytes.len());
        for n_bytes in cuts {
            let n_records = match scratch.read(&bytes[..n_bytes]) {
                Ok((prefix, report)) => {
                    assert_eq!(prefix, records[..prefix.len()], "cut at {n_bytes}");
                    assert_eq!(report.n_problems(), 0, "cut at {n_bytes}: {report}");
                    let LogCompleteness::Truncated { file_bytes, missing_bytes } = report.end else {
                        panic!("cut at {n_bytes}: {:?}", report.end);
                    };
                    assert_eq!(file_bytes, n_bytes as u64);
                    assert!(
                        (1..=(bytes.len() - n_bytes) as u64).contains(&missing_bytes),
                        "cut at {n_bytes}"
                    );
                    prefix.len()
                }
                Err(LogError::Damaged { end: LogCompleteness::Truncated { .. }, .. }) => 0,
                Err(LogError::Empty { .. }) if n_bytes == 0 => 0,
                Err(LogError::NotThisFormat { .. }) if n_bytes < 8 => 0,
                Err(other) => panic!("cut at {n_bytes}: {other}"),
            };
            assert!(n_records >= n_before, "a longer file gives fewer records at {n_bytes}");
            n_before = n_records;
        }
        assert_eq!(n_before, records.len(), "all messages are there once the last byte but one is");
    }
}

#[test]
fn file_cut_inside_a_chunk_gives_every_whole_message() {
    let records = common::drive(50);
    let bytes = whole_file(&records);
    let ends = message_ends(&bytes);
    assert_eq!(ends.len(), records.len());
    for (n_whole, end) in ends.iter().enumerate().skip(1) {
        let (prefix, _) = Scratch::new().read(&bytes[..end - 1]).unwrap();
        assert_eq!(prefix.len(), n_whole);
    }
}

/// Where each message of an uncompressed file ends, found by the layout that mcap.dev specifies.
fn message_ends(bytes: &[u8]) -> Vec<usize> {
    const CHUNK_HEADER_BYTES: usize = 8 + 8 + 8 + 4 + 4 + 8;
    let (mut at, mut ends) = (8, Vec::new());
    while at + 9 <= bytes.len() {
        let (opcode, length) =
            (bytes[at], u64::from_le_bytes(bytes[at + 1..at + 9].try_into().unwrap()) as usize);
        at += 9;
        match opcode {
            0x06 => at += CHUNK_HEADER_BYTES, // go inside
            0x02 => break,
            _ => at += length,
        }
        if opcode == 0x05 {
            ends.push(at);
        }
    }
    ends
}

#[test]
fn chunk_with_wrong_checksum_is_skipped_and_the_next_read() {
    let records = common::drive(100);
    for compression in [None, Some(Compression::Lz4), Some(Compression::Zstd)] {
        let options = WriteOptions::new().chunk_size(Some(2000)).compression(compression);
        let mut bytes = rechunked(&whole_file(&records), options);
        let first_chunk = 8 + 9 + u64::from_le_bytes(bytes[9..17].try_into().unwrap()) as usize;
        assert_eq!(bytes[first_chunk], 0x06, "a chunk follows the header");
        bytes[first_chunk + 9 + 24] ^= 1; // its checksum comes after two times and a size
        let (back, report) = Scratch::new().read(&bytes).unwrap();
        assert_eq!(report.problems[&RowProblemKind::DamagedChunk], 1, "{report}");
        // Channels are announced in the lost chunk only, so nothing on them can be understood; later ones can.
        assert!(back.len() < records.len());
        assert!(back.iter().all(|record| records.contains(record)));
    }
}

#[test]
fn lengths_beyond_reason_are_an_error_at_once() {
    for (opcode, claimed) in
        [(0x06_u8, u64::from(u32::MAX)), (0x05, u64::MAX), (0x03, 1 << 40), (0x04, 1 << 30), (0x7f, 1 << 60)]
    {
        let mut bytes = b"\x89MCAP0\r\n".to_vec();
        bytes.push(opcode);
        bytes.extend(claimed.to_le_bytes());
        bytes.extend([7; 100]);
        let error = Scratch::new().read(&bytes).unwrap_err();
        assert!(matches!(error, LogError::Damaged { end: LogCompleteness::Damaged { .. }, .. }), "{error}");
    }
}

#[test]
fn a_chunk_that_claims_to_unpack_to_gigabytes_is_left_out() {
    let mut bytes = b"\x89MCAP0\r\n".to_vec();
    let mut chunk = [0_u8; 16].to_vec();
    chunk.extend((1_u64 << 32).to_le_bytes()); // uncompressed size
    chunk.extend(1_u32.to_le_bytes()); // checksum
    chunk.extend(3_u32.to_le_bytes());
    chunk.extend(b"lz4");
    chunk.extend(4_u64.to_le_bytes());
    chunk.extend([1, 2, 3, 4]);
    bytes.push(0x06);
    bytes.extend((chunk.len() as u64).to_le_bytes());
    bytes.extend(chunk);
    let error = Scratch::new().read(&bytes).unwrap_err();
    assert!(matches!(error, LogError::Damaged { .. } | LogError::NotThisFormat { .. }), "{error}");
}

#[test]
fn garbage_with_an_mcap_name_is_refused_by_its_first_bytes() {
    let scratch = Scratch::new();
    // A gigabyte that takes no room on the disk.
    let file = fs::File::create(&scratch.path).unwrap();
    file.set_len(1 << 30).unwrap();
    let error = open(&scratch.path, &LogOpenOptions::default()).unwrap_err();
    assert!(matches!(error, LogError::NotThisFormat { format: LogFormat::Mcap, .. }));
    let error = open(scratch.path.with_extension("absent.mcap"), &LogOpenOptions::default()).unwrap_err();
    assert!(matches!(error, LogError::NotFound { .. }));
}

#[test]
fn other_topics_and_schemas_are_counted() {
    let mut out = Cursor::new(Vec::new());
    let mut writer = WriteOptions::new().create(&mut out).unwrap();
    let schema = writer.add_schema("std_msgs/String", "ros2msg", b"string data").unwrap();
    for topic in ["/chatter", "/truth/pose"] {
        let channel_id = writer.add_channel(schema, topic, "cdr", &BTreeMap::new()).unwrap();
        let header = MessageHeader { channel_id, sequence: 0, log_time: 1, publish_time: 1 };
        writer.write_to_known_channel(&header, &[0; 9]).unwrap();
    }
    writer.finish().unwrap();
    drop(writer);
    let error = Scratch::new().read(&out.into_inner()).unwrap_err();
    let LogError::NoKnownTopic { ignored, .. } = error else { panic!("{error}") };
    assert_eq!(ignored, ["/chatter (std_msgs/String)", "/truth/pose (std_msgs/String)"]);
}

#[test]
fn late_messages_are_sorted_and_much_later_ones_reported() {
    let records = common::drive(200);
    let mut late = records.clone();
    late.swap(100, 150);
    let (back, report) = Scratch::new().read(&whole_file(&late)).unwrap();
    assert_eq!(report.n_problems(), 0, "{report}");
    assert!(back.is_sorted_by_key(|record| record.stamp));
    assert_eq!(back.len(), records.len());

    let mut much_too_late = records.clone();
    let moved = much_too_late.remove(1);
    much_too_late.push(moved);
    let (back, report) = Scratch::new().read(&whole_file(&much_too_late)).unwrap();
    assert_eq!(report.problems[&RowProblemKind::TooLate], 1);
    assert_eq!(report.examples[0].row, records.len() as u64, "the last message is named");
    assert_eq!(back.len(), records.len() - 1);
}

#[test]
fn messages_with_numbers_that_are_none_are_counted() {
    let mut out = Cursor::new(Vec::new());
    let mut writer = McapWriter::new(&mut out).unwrap();
    let stamp = wayfix_sensor_log::Stamp::from_nanoseconds(9);
    let pose = wayfix_estimation_traits::Pose2::new(f64::NAN, 0.0, 0.0);
    writer.pose_in_frame("/truth/pose", stamp, "world", &pose).unwrap();
    writer.record(&Record { stamp, data: RecordData::Detections(Vec::new()) }).unwrap();
    writer.finish().unwrap();
    let (back, report) = Scratch::new().read(&out.into_inner()).unwrap();
    assert_eq!(back.len(), 1);
    assert_eq!(report.problems[&RowProblemKind::NotFinite], 1);
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(1000))]
    #[test]
    fn flipped_bits_never_panic(
        flips in prop::collection::vec((any::<prop::sample::Index>(), 0..8_u8), 1..6),
        variant in 0..4_usize,
    ) {
        static VARIANTS: LazyLock<[Vec<u8>; 4]> = LazyLock::new(|| variants(&common::drive(40)));
        let mut bytes = VARIANTS[variant].clone();
        for (index, bit) in flips {
            let at = index.index(bytes.len());
            bytes[at] ^= 1 << bit;
        }
        if let Ok((back, _)) = Scratch::new().read(&bytes) {
            prop_assert!(back.is_sorted_by_key(|record| record.stamp));
        }
    }

    #[test]
    fn random_bytes_never_panic(bytes in prop::collection::vec(any::<u8>(), 0..3000), name in 0..3_usize) {
        let scratch = Scratch::new();
        let mut with_magic = b"\x89MCAP0\r\n".to_vec();
        with_magic.extend(&bytes);
        let _ = scratch.read(&with_magic);
        let _ = scratch.read(&bytes);
        let format = Some([LogFormat::Tum, LogFormat::RangeBearing, LogFormat::Utias][name]);
        let _ = open(&scratch.path, &LogOpenOptions { format, ..Default::default() }).map(|log| log.read_all());
    }
}
