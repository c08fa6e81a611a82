"""Makes a long log of a stored one: the robot drives the same way to and fro until the log is long enough.

On the way back images and measurements come in reverse order, and each odometry increment is inverted.
"""

import math
from pathlib import Path

from mcap.reader import make_reader
from mcap.writer import CompressionType, Writer
from mcap_protobuf.decoder import DecoderFactory

INCREMENT = "/odom/increment"
# Copies for viewers.
COPIES = ("/scan/points",)


def inverted(increment):
    """The increment of the way back; both are in the frame of the robot before them."""
    back = type(increment)()
    back.CopyFrom(increment)
    position, turn = back.pose.position, back.pose.orientation
    heading = 2 * math.atan2(turn.z, turn.w)
    x, y = position.x, position.y
    position.x = -(math.cos(heading) * x + math.sin(heading) * y)
    position.y = math.sin(heading) * x - math.cos(heading) * y
    turn.z = -turn.z
    return back


def drives(stored: Path):
    """The records sent once, those of the way there and of the way back, each with its time in ns; and the duration of a way."""
    with stored.open("rb") as stream:
        reader = make_reader(stream, decoder_factories=[DecoderFactory()])
        rows = [row for row in reader.iter_decoded_messages() if row[1].topic not in COPIES]
    begin = min(message.log_time for _, _, message, _ in rows)
    there = [(message.log_time - begin, channel, schema, decoded) for schema, channel, message, decoded in rows]
    topics = [channel.topic for _, channel, _, _ in there]
    once = [row for row in there if topics.count(row[1].topic) == 1]
    there = [row for row in there if topics.count(row[1].topic) > 1]
    duration, before, back = there[-1][0], 0, []
    for time, channel, schema, decoded in there:
        if channel.topic == INCREMENT:
            # The way back undoes an increment when the robot is where it was before it.
            back.append((duration - before, channel, schema, inverted(decoded)))
            before = time
        else:
            back.append((duration - time, channel, schema, decoded))
    return once, there, sorted(back, key=lambda row: row[0]), duration


def write(stored: Path, long: Path, seconds: float) -> None:
    """Writes a log of this length, as large as a robot would write it: without compression."""
    once, there, back, duration = drives(stored)
    with long.open("wb") as stream:
        writer = Writer(stream, compression=CompressionType.NONE)
        writer.start(library="wayfix long runs")
        channels = {}

        def send(nanoseconds, channel, schema, decoded):
            if channel.topic not in channels:
                known = writer.register_schema(schema.name, schema.encoding, schema.data)
                channels[channel.topic] = writer.register_channel(channel.topic, channel.message_encoding, known)
            decoded.timestamp.FromNanoseconds(nanoseconds)
            writer.add_message(channels[channel.topic], nanoseconds, decoded.SerializeToString(), nanoseconds)

        for row in once:
            send(*row)
        start, ways = 0, (there, back)
        for k in range(math.ceil(seconds * 1e9 / duration)):
            for time, *rest in ways[k % 2]:
                # The first records of a way are the last ones of the way before.
                if (k == 0 or time > 0) and start + time <= seconds * 1e9:
                    send(start + time, *rest)
            start += duration
        writer.finish()
