#!/usr/bin/env python3
"""Writes ROS 2 bags from known numbers with the Python package rosbags, and checks what `wayfix convert` makes of them.

    pip install rosbags mcap mcap-protobuf-support numpy
    ros_bags.py write DIR                   DIR/little and DIR/big, a bag each; they differ in the byte order of the messages
    ros_bags.py check BAG CONVERTED.mcap    compares the converted bag with the numbers that were written
    ros_bags.py golden FILE.mcap            the small bag in crates/sensor-log/tests/data: every third step, compressed

The robot drives a part of a circle in a room of 8 m x 6 m; its odometry says that it went 5 % further. The laser hangs head down, turned
by 0.5 rad, 0.3 m before the middle.
"""

import math
import pathlib
import shutil
import sys
import tempfile

import numpy as np

STEPS = 80
START_NS = 1_700_000_000_000_000_000
SECONDS_A_STEP = 0.1
RADIUS, SPEED = 1.5, 0.5
ROOM = (4.0, 3.0)  # half its sides, m
LASER = (0.3, 0.0, 0.4)
LASER_YAW = 0.5
BEAMS, FIRST_BEAM, BEAM_STEP = 91, -math.pi / 2, math.pi / 90
RANGE_MIN, RANGE_MAX = 0.1, 12.0
WIDTH, HEIGHT, PADDING = 16, 12, 4
CAMERA_HEIGHT = 0.6
ODOMETRY_SCALE = 1.05


def true_pose(step):
    """On a circle about the middle of the room, tangentially."""
    angle = SPEED * SECONDS_A_STEP * step / RADIUS
    return RADIUS * math.sin(angle), -RADIUS * math.cos(angle), angle


def odometry_pose(step):
    """The same, too large, from another origin, turned by 1 rad."""
    x, y, heading = true_pose(step)
    x, y = ODOMETRY_SCALE * x, ODOMETRY_SCALE * y
    sin, cos = math.sin(1.0), math.cos(1.0)
    return 5.0 + cos * x - sin * y, -2.0 + sin * x + cos * y, heading + 1.0


def stamp_ns(step):
    return START_NS + round(step * SECONDS_A_STEP * 1e9)


def ranges(step):
    """What the laser sees: its beams go clockwise seen from above, since it hangs head down."""
    x, y, heading = true_pose(step)
    laser = np.array([x + LASER[0] * math.cos(heading), y + LASER[0] * math.sin(heading)])
    bearings = heading + LASER_YAW - (FIRST_BEAM + BEAM_STEP * np.arange(BEAMS))
    directions = np.stack([np.cos(bearings), np.sin(bearings)])
    with np.errstate(divide="ignore"):
        to_walls = (np.sign(directions) * np.array(ROOM)[:, None] - laser[:, None]) / directions
    seen = to_walls.min(axis=0).astype(np.float32)
    seen[0], seen[1] = np.inf, np.nan  # nothing came back
    seen[2] = RANGE_MIN / 2
    return seen


def picture(step):
    rows, columns = np.mgrid[0:HEIGHT, 0:WIDTH]
    return np.stack([rows * 20, columns * 15, np.full_like(rows, step)], axis=-1).astype(np.uint8)


def write(folder):
    for name, is_little_endian in [("little", True), ("big", False)]:
        write_bag(pathlib.Path(folder) / name, is_little_endian)


def write_golden(file):
    with tempfile.TemporaryDirectory() as folder:
        bag = pathlib.Path(folder) / "golden"
        write_bag(bag, True, steps=range(0, STEPS, 3), compress=True)
        shutil.copyfile(bag / "golden.mcap", file)


def write_bag(path, is_little_endian, steps=range(STEPS), compress=False):
    from rosbags.rosbag2 import CompressionFormat, CompressionMode, StoragePlugin, Writer
    from rosbags.typesys import Stores, get_typestore

    store = get_typestore(Stores.ROS2_JAZZY)
    types = store.types
    shutil.rmtree(path, ignore_errors=True)

    def header(step, frame):
        seconds, nanoseconds = divmod(stamp_ns(step), 10**9)
        time = types["builtin_interfaces/msg/Time"](sec=seconds, nanosec=nanoseconds)
        return types["std_msgs/msg/Header"](stamp=time, frame_id=frame)

    def vector(x, y, z):
        return types["geometry_msgs/msg/Vector3"](x=x, y=y, z=z)

    def point(x, y, z):
        return types["geometry_msgs/msg/Point"](x=x, y=y, z=z)

    def quaternion(x, y, z, w):
        return types["geometry_msgs/msg/Quaternion"](x=x, y=y, z=z, w=w)

    def turned(heading):
        return quaternion(0.0, 0.0, math.sin(heading / 2), math.cos(heading / 2))

    def pose(x, y, heading):
        return types["geometry_msgs/msg/Pose"](position=point(x, y, 0.0), orientation=turned(heading))

    def transform(step, parent, child, place, rotation):
        content = types["geometry_msgs/msg/Transform"](translation=vector(*place), rotation=rotation)
        kind = types["geometry_msgs/msg/TransformStamped"]
        return kind(header=header(step, parent), child_frame_id=child, transform=content)

    def transforms(*all_of_them):
        return types["tf2_msgs/msg/TFMessage"](transforms=list(all_of_them))

    def odometry(step):
        twist = types["geometry_msgs/msg/Twist"](
            linear=vector(SPEED, 0.0, 0.0), angular=vector(0.0, 0.0, SPEED / RADIUS)
        )
        with_covariance = types["geometry_msgs/msg/PoseWithCovariance"](
            pose=pose(*odometry_pose(step)), covariance=np.arange(36.0)
        )
        return types["nav_msgs/msg/Odometry"](
            header=header(step, "odom"),
            child_frame_id="base_link",
            pose=with_covariance,
            twist=types["geometry_msgs/msg/TwistWithCovariance"](twist=twist, covariance=np.zeros(36)),
        )

    def scan(step, frame, seen):
        return types["sensor_msgs/msg/LaserScan"](
            header=header(step, frame),
            angle_min=FIRST_BEAM,
            angle_max=FIRST_BEAM + BEAM_STEP * (BEAMS - 1),
            angle_increment=BEAM_STEP,
            time_increment=0.0,
            scan_time=SECONDS_A_STEP,
            range_min=RANGE_MIN,
            range_max=RANGE_MAX,
            ranges=seen,
            intensities=np.zeros(0, np.float32),
        )

    def image(step):
        pixels = picture(step) if is_little_endian else picture(step)[:, :, ::-1]
        rows = np.pad(pixels.reshape(HEIGHT, -1), ((0, 0), (0, PADDING)))
        return types["sensor_msgs/msg/Image"](
            header=header(step, "camera_optical_frame"),
            height=HEIGHT,
            width=WIDTH,
            encoding="rgb8" if is_little_endian else "bgr8",
            is_bigendian=0,
            step=rows.shape[1],
            data=rows.reshape(-1),
        )

    def camera_info(step):
        k = np.array([20.0, 0.0, 7.5, 0.0, 21.0, 5.5, 0.0, 0.0, 1.0])
        roi = types["sensor_msgs/msg/RegionOfInterest"](
            x_offset=0, y_offset=0, height=0, width=0, do_rectify=False
        )
        return types["sensor_msgs/msg/CameraInfo"](
            header=header(step, "camera_optical_frame"),
            height=HEIGHT,
            width=WIDTH,
            distortion_model="plumb_bob",
            d=np.zeros(5),
            k=k,
            r=np.eye(3).reshape(-1),
            p=np.array([20.0, 0.0, 7.5, 0.0, 0.0, 21.0, 5.5, 0.0, 0.0, 0.0, 1.0, 0.0]),
            binning_x=0,
            binning_y=0,
            roi=roi,
        )

    def stamped_pose(step):
        return types["geometry_msgs/msg/PoseStamped"](header=header(step, "map"), pose=pose(*true_pose(step)))

    head_down = quaternion(math.cos(LASER_YAW / 2), math.sin(LASER_YAW / 2), 0.0, 0.0)  # yaw, then roll by pi
    optical = quaternion(-0.5, 0.5, -0.5, 0.5)
    still = transforms(
        transform(0, "base_footprint", "base_link", (0.0, 0.0, 0.1), turned(0.0)),
        transform(0, "base_link", "laser", LASER, head_down),
        transform(0, "base_link", "camera_link", (0.1, 0.0, CAMERA_HEIGHT - 0.1), turned(0.0)),
        transform(0, "camera_link", "camera_optical_frame", (0.0, 0.0, 0.0), optical),
    )

    writer = Writer(path, version=9, storage_plugin=StoragePlugin.MCAP)
    if compress:
        writer.set_compression(CompressionMode.STORAGE, CompressionFormat.ZSTD)
    with writer:
        connections = {}

        def put(topic, kind, step, message):
            if topic not in connections:
                connections[topic] = writer.add_connection(topic, kind, typestore=store)
            data = store.serialize_cdr(message, kind, little_endian=is_little_endian)
            writer.write(connections[topic], stamp_ns(step) + 1000, data)

        put("/tf_static", "tf2_msgs/msg/TFMessage", 0, still)
        put("/chatter", "std_msgs/msg/String", 0, types["std_msgs/msg/String"](data="not a record"))
        for step in steps:
            put("/odom", "nav_msgs/msg/Odometry", step, odometry(step))
            put("/scan", "sensor_msgs/msg/LaserScan", step, scan(step, "laser", ranges(step)))
            put("/mocap/pose", "geometry_msgs/msg/PoseStamped", step, stamped_pose(step))
            if step % (10 * steps.step) == 0:
                put("/camera/camera_info", "sensor_msgs/msg/CameraInfo", step, camera_info(step))
                put("/camera/image_raw", "sensor_msgs/msg/Image", step, image(step))
                nothing = np.full(BEAMS, np.inf, np.float32)
                put("/scan_rear", "sensor_msgs/msg/LaserScan", step, scan(step, "base_link", nothing))


def check(bag, converted):
    """Every number of the converted log against the formulas above; single precision where the message has it."""
    from mcap.reader import make_reader
    from mcap_protobuf.decoder import DecoderFactory

    by_topic = {}
    with open(converted, "rb") as file:
        for _, channel, message, content in make_reader(
            file, decoder_factories=[DecoderFactory()]
        ).iter_decoded_messages():
            by_topic.setdefault(channel.topic, []).append((message.log_time, channel, content))

    def heading_of(q):
        return math.atan2(2 * (q.w * q.z + q.x * q.y), q.w**2 + q.x**2 - q.y**2 - q.z**2)

    def near(what, ours, expected, tolerance=1e-12):
        difference = np.abs(np.asarray(ours, float) - np.asarray(expected, float)).max()
        if not difference <= tolerance:
            sys.exit(f"{bag}: {what}: {ours} is not {expected}")

    def count(topic, expected):
        if len(by_topic.get(topic, [])) != expected:
            sys.exit(f"{bag}: {len(by_topic.get(topic, []))} messages on {topic}, not {expected}")
        return by_topic[topic]

    truth = count("/truth/pose", STEPS)
    for step, (time, _, message) in enumerate(truth):
        x, y, heading = true_pose(step)
        near("stamp", time - stamp_ns(step), 0)
        found = message.pose
        turn = heading_of(found.orientation) - heading
        near("true pose", [found.position.x, found.position.y, math.remainder(turn, math.tau)], [x, y, 0.0])

    increments = count("/odom/increment", STEPS - 1)
    x, y, heading = odometry_pose(0)
    for step, (time, _, message) in enumerate(increments, 1):
        near("stamp", time - stamp_ns(step), 0)
        by, turn = message.pose.position, heading_of(message.pose.orientation)
        sin, cos = math.sin(heading), math.cos(heading)
        x, y, heading = x + cos * by.x - sin * by.y, y + sin * by.x + cos * by.y, heading + turn
        near("odometry", [x, y, heading], odometry_pose(step), 1e-12 * STEPS)

    [(_, _, mount)] = count("/scan/mount", 1)
    near("laser", [mount.translation.x, mount.translation.y], LASER[:2])
    near("laser", heading_of(mount.rotation), LASER_YAW)
    for step, (_, channel, message) in enumerate(count("/scan", STEPS)):
        near("first beam", message.start_angle, -np.float32(FIRST_BEAM))
        near("beams", float(channel.metadata["angle_increment"]), -np.float32(BEAM_STEP))
        near("longest range", float(channel.metadata["range_max"]), RANGE_MAX)
        near("ranges", message.ranges[3:], ranges(step)[3:], 0.0)
        if message.ranges[0] != math.inf or not all(map(math.isnan, message.ranges[1:3])):
            sys.exit(f"{bag}: {message.ranges[:3]} for beams that saw nothing")

    [(_, _, mount)] = count("/camera/mount", 1)
    near("camera", [mount.translation.x, mount.translation.y, mount.translation.z], [0.1, 0.0, CAMERA_HEIGHT])
    near("camera", [mount.rotation.x, mount.rotation.y, mount.rotation.z, abs(mount.rotation.w)], [0, 0, 0, 1])
    for _, _, message in count("/camera/info", STEPS // 10):
        near("camera", [*message.K[:6]], [20.0, 0.0, 8.0, 0.0, 21.0, 6.0])
    for index, (_, _, message) in enumerate(count("/camera/image", STEPS // 10)):
        pixels = np.frombuffer(message.data, np.uint8).reshape(HEIGHT, WIDTH, 3)
        near("pixels", pixels, picture(10 * index), 0)
    print(f"{bag}: {sum(map(len, by_topic.values()))} messages as they were written")


if __name__ == "__main__":
    match sys.argv[1:]:
        case ["write", folder]:
            write(folder)
        case ["golden", file]:
            write_golden(file)
        case ["check", bag, converted]:
            check(bag, converted)
        case _:
            sys.exit(__doc__)
