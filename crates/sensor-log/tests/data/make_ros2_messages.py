#!/usr/bin/env python3
"""Writes ros2_messages.txt: one message of each type that is read, as the Python package rosbags serializes it, in both byte orders.

    pip install rosbags
    make_ros2_messages.py > ros2_messages.txt

A line is the type, `little` or `big`, and the bytes in hexadecimal. The numbers are repeated in ../ros_messages.rs.
"""

import numpy as np
from rosbags.typesys import Stores, get_typestore

STORE = get_typestore(Stores.ROS2_JAZZY)


def make(kind, **fields):
    return STORE.types[kind](**fields)


def header(frame):
    stamp = make("builtin_interfaces/msg/Time", sec=1_700_000_000, nanosec=123_456_789)
    return make("std_msgs/msg/Header", stamp=stamp, frame_id=frame)


def pose():
    return make(
        "geometry_msgs/msg/Pose",
        position=make("geometry_msgs/msg/Point", x=1.5, y=-2.25, z=0.125),
        orientation=make("geometry_msgs/msg/Quaternion", x=0.0, y=0.0, z=0.6, w=0.8),
    )


def twist():
    return make(
        "geometry_msgs/msg/Twist",
        linear=make("geometry_msgs/msg/Vector3", x=0.5, y=0.0, z=0.0),
        angular=make("geometry_msgs/msg/Vector3", x=0.0, y=0.0, z=-0.25),
    )


def transform(parent, child):
    return make(
        "geometry_msgs/msg/TransformStamped",
        header=header(parent),
        child_frame_id=child,
        transform=make(
            "geometry_msgs/msg/Transform",
            translation=make("geometry_msgs/msg/Vector3", x=1.5, y=-2.25, z=0.125),
            rotation=make("geometry_msgs/msg/Quaternion", x=0.0, y=0.0, z=0.6, w=0.8),
        ),
    )


def with_covariance(kind, **fields):
    return make(kind, covariance=np.arange(36.0), **fields)


MESSAGES = {
    "sensor_msgs/msg/LaserScan": dict(
        header=header("laser"),
        angle_min=-1.5,
        angle_max=1.5,
        angle_increment=0.75,
        time_increment=0.0625,
        scan_time=0.25,
        range_min=0.125,
        range_max=30.0,
        ranges=np.array([1.0, 2.5, np.inf, 0.0, 29.75], np.float32),
        intensities=np.array([7.0], np.float32),
    ),
    "nav_msgs/msg/Odometry": dict(
        header=header("odom"),
        child_frame_id="base_link",
        pose=with_covariance("geometry_msgs/msg/PoseWithCovariance", pose=pose()),
        twist=with_covariance("geometry_msgs/msg/TwistWithCovariance", twist=twist()),
    ),
    "sensor_msgs/msg/Image": dict(
        header=header("camera"),
        height=2,
        width=1,
        encoding="bgr8",
        is_bigendian=0,
        step=4,
        data=np.array([3, 2, 1, 99, 6, 5, 4, 99], np.uint8),
    ),
    "sensor_msgs/msg/CompressedImage": dict(
        header=header("camera"), format="rgb8; jpeg compressed bgr8", data=np.array([255, 216, 255, 224], np.uint8)
    ),
    "sensor_msgs/msg/CameraInfo": dict(
        header=header("camera"),
        height=480,
        width=640,
        distortion_model="plumb_bob",
        d=np.array([0.5, -0.25, 0.0]),
        k=np.arange(9.0),
        r=np.arange(9.0) + 10,
        p=np.arange(12.0) + 20,
        binning_x=2,
        binning_y=1,
        roi=make("sensor_msgs/msg/RegionOfInterest", x_offset=4, y_offset=5, height=6, width=7, do_rectify=True),
    ),
    "geometry_msgs/msg/PoseStamped": dict(header=header("map"), pose=pose()),
    "geometry_msgs/msg/PoseWithCovarianceStamped": dict(
        header=header("map"), pose=with_covariance("geometry_msgs/msg/PoseWithCovariance", pose=pose())
    ),
    "geometry_msgs/msg/TwistStamped": dict(header=header("base_link"), twist=twist()),
    "geometry_msgs/msg/Twist": dict(linear=twist().linear, angular=twist().angular),
    "tf2_msgs/msg/TFMessage": dict(transforms=[transform("odom", "base_link"), transform("base_link", "a")]),
}

for kind, fields in MESSAGES.items():
    for name, is_little_endian in [("little", True), ("big", False)]:
        data = STORE.serialize_cdr(make(kind, **fields), kind, little_endian=is_little_endian)
        print(kind, name, bytes(data).hex())
