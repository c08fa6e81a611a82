#!/usr/bin/env python3
"""Makes the first inputs of both fuzz targets from the golden messages of crates/sensor-log/tests/data.

    fuzz/make_seeds.py        writes fuzz/corpus/ros_message and fuzz/corpus/ros_bag
"""

import pathlib

FUZZ = pathlib.Path(__file__).parent
GOLDEN = FUZZ / "../crates/sensor-log/tests/data/ros2_messages.txt"
# As in fuzz_targets/ros_message.rs; on which topics of ros_bag.rs they are.
TOPICS = {
    "sensor_msgs/msg/LaserScan": [0, 1],
    "nav_msgs/msg/Odometry": [2, 3],
    "sensor_msgs/msg/Image": [6, 7],
    "sensor_msgs/msg/CompressedImage": [9],
    "sensor_msgs/msg/CameraInfo": [8],
    "geometry_msgs/msg/PoseStamped": [10],
    "geometry_msgs/msg/PoseWithCovarianceStamped": [11],
    "geometry_msgs/msg/TwistStamped": [13],
    "geometry_msgs/msg/Twist": [12],
    "tf2_msgs/msg/TFMessage": [4, 5],
}


def main():
    folders = [FUZZ / "corpus" / name for name in ("ros_message", "ros_bag")]
    for folder in folders:
        folder.mkdir(parents=True, exist_ok=True)
    whole = b""
    for number, line in enumerate(GOLDEN.read_text().splitlines()):
        kind, order, digits = line.split()
        message = bytes.fromhex(digits)
        (folders[0] / f"{number}").write_bytes(bytes([list(TOPICS).index(kind)]) + message)
        if len(message) < 256:
            for topic in TOPICS[kind]:
                whole += bytes([topic, len(message)]) + message
        (folders[1] / f"{number}").write_bytes(whole)


if __name__ == "__main__":
    main()
