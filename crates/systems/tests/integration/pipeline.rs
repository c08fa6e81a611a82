//! The common pipeline: records in time order, where a run starts, and what must be known beforehand.

mod drive {
    use wayfix_sensor_log::{Record, RecordData, Stamp, Velocity};
    use wayfix_systems::system::{EventCounts, System, drive};

    /// Passes records in time order and rejects the others.
    #[derive(Default)]
    struct OneWay {
        taken: Vec<u64>,
        events: EventCounts,
    }

    impl System for OneWay {
        fn take(&mut self, record: &Record) -> Result<(), String> {
            match record.data {
                RecordData::Velocity(velocity) if velocity.linear < 0.0 => Err("backwards".to_owned()),
                _ => {
                    self.taken.push(record.stamp.nanoseconds());
                    Ok(())
                }
            }
        }
        fn events(&mut self) -> &mut EventCounts {
            &mut self.events
        }
    }

    fn record(nanoseconds: u64, linear: f64) -> Record {
        let data = RecordData::Velocity(Velocity { linear, angular: 0.0 });
        Record { stamp: Stamp::from_nanoseconds(nanoseconds), data }
    }

    #[test]
    fn record_back_in_time_is_refused_with_its_index() {
        let mut system = OneWay::default();
        let records = [record(10, 1.0), record(20, 1.0), record(15, 1.0), record(20, 1.0), record(30, -1.0)];
        let mut n_observed = 0;
        drive(&mut system, &records, |_| n_observed += 1);
        assert_eq!(system.taken, [10, 20, 20]);
        assert_eq!(n_observed, records.len());
        assert_eq!(system.events.get("record_refused"), 2);
        let refused: Vec<String> = system.events.refusals().iter().map(ToString::to_string).collect();
        assert_eq!(
            refused,
            [
                "record 2 at 0.000000015 s: time goes back by 0.000000005 s",
                "record 4 at 0.000000030 s: backwards"
            ]
        );
    }

    #[test]
    fn the_first_twenty_refusals_are_listed_and_the_rest_counted() {
        let mut system = OneWay::default();
        let records: Vec<Record> = (0..50).map(|stamp| record(stamp, -1.0)).collect();
        drive(&mut system, &records, |_| {});
        assert_eq!((system.events.refusals().len(), system.events.n_refusals()), (20, 50));
        assert_eq!(system.events.get("record_refused"), 50);
    }
}

mod known_start {
    use approx::assert_abs_diff_eq;
    use wayfix_estimation_traits::Pose2;
    use wayfix_evaluation::errors::ReferencePath;
    use wayfix_sensor_log::{Record, RecordData, Stamp, Velocity};
    use wayfix_systems::system::TrueStartPose;

    fn at(milliseconds: u64) -> Stamp {
        Stamp::from_nanoseconds(milliseconds * 1_000_000)
    }

    fn increment(milliseconds: u64, x: f64) -> Record {
        Record { stamp: at(milliseconds), data: RecordData::OdometryIncrement(Pose2::new(x, 0.0, 0.0)) }
    }

    fn truth(milliseconds: u64, x: f64) -> Record {
        Record { stamp: at(milliseconds), data: RecordData::TruePose(Pose2::new(x, 0.0, 0.0)) }
    }

    #[test]
    fn truth_that_begins_late_is_led_back_by_odometry() {
        let odometry = [increment(0, 0.0), increment(1000, 1.0), increment(2000, 2.0)];
        let records = [&odometry[..], &[truth(1500, 7.0), truth(1600, 7.2)]].concat();
        let track = ReferencePath::from_records(&records);
        let start = TrueStartPose::at(at(500), &track, &records).unwrap();
        assert_abs_diff_eq!(start.pose.x(), 7.0 - 0.5 - 1.0, epsilon = 1e-12);
        assert_abs_diff_eq!(start.seconds_late, 1.0, epsilon = 1e-12);
        assert_eq!(TrueStartPose::at(at(1500), &track, &records).unwrap().seconds_late, 0.0);
        assert_eq!(TrueStartPose::at(at(500), &ReferencePath::default(), &records), None);
    }

    #[test]
    fn velocities_lead_back_as_well() {
        let data = RecordData::Velocity(Velocity { linear: 2.0, angular: 0.0 });
        let records = [Record { stamp: at(0), data }, truth(1500, 7.0), truth(1600, 7.2)];
        let start = TrueStartPose::at(at(500), &ReferencePath::from_records(&records), &records).unwrap();
        assert_abs_diff_eq!(start.pose.x(), 5.0, epsilon = 1e-12);
    }
}

mod overview {
    use wayfix_sensor_log::{LogOpenOptions, Record, RecordData};

    use wayfix_systems::{
        points::{self, PointSlamParams, RobotProfile},
        system::LogOverview,
    };

    fn overview(log: &str, head: usize) -> (Vec<Record>, LogOverview) {
        let path = format!("{}/../../fixtures/{log}", env!("CARGO_MANIFEST_DIR"));
        let open = || wayfix_sensor_log::open(&path, &LogOpenOptions::default()).expect("a stored log");
        (open().read_all().0, LogOverview::read_with_head(open(), 1, head))
    }

    #[test]
    fn a_run_that_knows_the_overview_equals_one_that_knows_all() {
        for log in ["loop_known.mcap", "office_velocity.mcap"] {
            let (records, overview) = overview(log, 200);
            assert_eq!(overview.n_records, records.len());
            assert!(overview.records.len() < 3 * records.len() / 4, "{}", overview.records.len());
            let n_true = |records: &[Record]| {
                records.iter().filter(|record| matches!(record.data, RecordData::TruePose(_))).count()
            };
            assert!(n_true(&overview.records) < n_true(&records) / 2, "{}", n_true(&overview.records));
            let params = PointSlamParams::of(RobotProfile::Generic);
            let mut whole = points::run(&records, &params, |_| {}).unwrap();
            let mut streamed = points::run_streamed(&overview.records, &records, &params, |_| {}).unwrap();
            assert_eq!(streamed.system.save(), whole.system.save());
            assert_eq!(points::summarize(&mut streamed).metrics, points::summarize(&mut whole).metrics);
        }
    }

    #[test]
    fn records_stay_in_order_and_one_image_has_pixels() {
        let (records, overview) = overview("store_area.mcap", 9);
        assert!(overview.records.is_sorted_by_key(|record| record.stamp));
        assert_eq!(overview.records.last().unwrap().stamp, records.last().unwrap().stamp);
        let images = overview.records.iter().filter_map(|record| match &record.data {
            RecordData::Image(image) => Some(image.bytes.is_empty()),
            _ => None,
        });
        let images: Vec<bool> = images.collect();
        assert!(!images[0] && images.len() < 10 && images[1..].iter().all(|empty| *empty), "{images:?}");
        assert_eq!(overview.n_images, 456);
    }
}
