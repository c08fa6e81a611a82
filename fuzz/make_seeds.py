#!/usr/bin/env python3
"""Makes the first inputs of the fuzz targets: golden messages of crates/sensor-log/tests/data, and small pose graphs.

    fuzz/make_seeds.py        writes fuzz/corpus/ros_message, fuzz/corpus/ros_bag and fuzz/corpus/g2o
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

GRAPHS = [
    "VERTEX_SE2 0 0 0 0\nVERTEX_SE2 1 1 0 1.5\nVERTEX_XY 7 2 2\nFIX 1\n"
    "EDGE_SE2 0 1 1 0 1.57 1 0 0 1 0 1\nEDGE_SE2_XY 1 7 2 -1 1 0 1\n",
    "EDGE_SE2 0 1 1 0 1.57 1 0 0 1 0 1\nEDGE_SE2 1 2 1 0 1.57 2 0.1 0 2 0 3\nEDGE_SE2 2 0 1 1 3.1 1 0 0 1 0 1\n",
    "VERTEX_SE3:QUAT 0 0 0 0 0 0 0 1\nVERTEX_SE3:QUAT 1 1 0 0 0 0 0.7071068 0.7071068\nVERTEX_TRACKXYZ 5 1 2 3\n"
    "PARAMS_SE3OFFSET 3 0.1 0.2 0.3 0 0 0.7071068 0.7071068\n"
    "EDGE_SE3:QUAT 0 1 1 0 0.1 0 0 0.7 0.714 1 0 0 0 0 0 1 0 0 0 0 1 0 0 0 1 0 0 1 0 1\n"
    "EDGE_SE3_TRACKXYZ 1 5 3 1 2 3 2 0.5 0 1 0 1\n",
]


def main():
    graphs = FUZZ / "corpus" / "g2o"
    graphs.mkdir(parents=True, exist_ok=True)
    for number, text in enumerate(GRAPHS):
        (graphs / f"{number}").write_text(text)
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
