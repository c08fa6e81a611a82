#!/usr/bin/env python3
"""Watches a run with a WebSocket client that is not ours, and compares what it sees with the MCAP file of the same run.

    pip install websockets mcap mcap-protobuf-support
    watch_live.py ESTIMATES.mcap COMMAND…

COMMAND is a `wayfix run … --live 0 --out DIR`; ESTIMATES.mcap is what it will have written when it is over. The first viewer must get every
message of every topic in order, byte by byte, with schemas that decode them; one that joins after the end the last of each topic. The run
must end by itself when both have gone.
"""

import asyncio
import base64
import collections
import json
import re
import struct
import sys

import websockets
from mcap.reader import make_reader
from mcap.records import Schema
from mcap_protobuf.decoder import DecoderFactory

MESSAGE, TIME = 1, 2
LONGEST_S = 120


class Viewer:
    """Subscribes to everything that is announced and keeps it: log time and bytes by topic."""

    def __init__(self, socket):
        self.socket = socket
        self.channels = {}
        self.seen = collections.defaultdict(list)
        self.times = []

    async def watch(self):
        async for message in self.socket:
            if isinstance(message, str):
                await self.take_text(json.loads(message))
            elif message[0] == MESSAGE:
                subscription, log_time = struct.unpack_from("<IQ", message, 1)
                self.seen[self.channels[subscription]["topic"]].append((log_time, message[13:]))
            elif message[0] == TIME:
                self.times.append(struct.unpack_from("<Q", message, 1)[0])

    async def take_text(self, message):
        if message["op"] == "serverInfo":
            assert message["name"] == "wayfix" and message["capabilities"] == ["time"], message
        elif message["op"] == "advertise":
            for channel in message["channels"]:
                self.channels[channel["id"]] = channel
            wanted = [{"id": channel["id"], "channelId": channel["id"]} for channel in message["channels"]]
            await self.socket.send(json.dumps({"op": "subscribe", "subscriptions": wanted}))
        elif message["op"] == "status":
            raise ValueError(f"the server complains: {message}")

    def counts(self):
        return {topic: len(messages) for topic, messages in self.seen.items()}


async def connected(url, act):
    """What `act` makes of a viewer that watches meanwhile."""
    async with websockets.connect(url, subprotocols=["foxglove.sdk.v1"], max_size=None) as socket:
        assert socket.subprotocol == "foxglove.sdk.v1", socket.subprotocol
        viewer = Viewer(socket)
        watching = asyncio.create_task(viewer.watch())
        acting = asyncio.create_task(act(viewer))
        await asyncio.wait([watching, acting], return_when=asyncio.FIRST_COMPLETED)
        if not acting.done():
            acting.cancel()
            watching.result()
            raise ValueError("the server has hung up")
        result = acting.result()
        watching.cancel()
        return result


async def line_with(stream, pattern):
    """The first line that matches; what comes before is passed on."""
    async for line in stream:
        text = line.decode()
        sys.stderr.write(text)
        found = re.search(pattern, text)
        if found:
            return found
    raise ValueError(f"the run ended without saying {pattern!r}")


async def has_all(viewer, counts):
    """Returns when a viewer has as much as there is, or nothing more comes."""
    for _ in range(100):
        if viewer.counts() == counts:
            break
        await asyncio.sleep(0.1)
    await asyncio.sleep(0.5)  # what would be too much would come now


def read(path):
    """Log time and bytes by topic, and the decoded poses."""
    messages, poses = collections.defaultdict(list), []
    with open(path, "rb") as file:
        reader = make_reader(file, decoder_factories=[DecoderFactory()])
        for schema, channel, message, decoded in reader.iter_decoded_messages(log_time_order=False):
            messages[channel.topic].append((message.log_time, message.data))
            if channel.topic == "/estimate/pose":
                assert schema.name == "foxglove.PoseInFrame", schema.name
                poses.append(decoded)
    return messages, poses


def decoded_poses(viewer):
    """The poses, with the schema that the server announced."""
    channel = next(c for c in viewer.channels.values() if c["topic"] == "/estimate/pose")
    assert (channel["encoding"], channel["schemaEncoding"]) == ("protobuf", "protobuf"), channel
    data = base64.b64decode(channel["schema"])
    schema = Schema(id=1, name=channel["schemaName"], encoding="protobuf", data=data)
    decode = DecoderFactory().decoder_for("protobuf", schema)
    return [decode(data) for _, data in viewer.seen["/estimate/pose"]]


def compare(viewer, path):
    written, poses = read(path)
    counts = {topic: len(messages) for topic, messages in written.items()}
    assert viewer.counts() == counts, f"seen {viewer.counts()}, written {counts}"
    for topic, messages in written.items():
        assert viewer.seen[topic] == messages, f"{topic}: not what was written"
    live = decoded_poses(viewer)
    assert len(live) == len(poses) > 0
    for seen, kept in zip(live, poses):
        assert seen.frame_id == kept.frame_id == "world"
        assert seen.pose.position.x == kept.pose.position.x and seen.pose.position.y == kept.pose.position.y
        assert (seen.timestamp.seconds, seen.timestamp.nanos) == (kept.timestamp.seconds, kept.timestamp.nanos)
    assert viewer.times == sorted(set(viewer.times)) and viewer.times, "the clock goes forward"
    return written


async def watch(path, command):
    run = await asyncio.create_subprocess_exec(*command, stderr=asyncio.subprocess.PIPE)
    try:
        url = (await line_with(run.stderr, r"live: open (ws://\S+)")).group(1)

        async def first(viewer):
            await line_with(run.stderr, "stays in view")
            written, _ = read(path)
            await has_all(viewer, {topic: len(messages) for topic, messages in written.items()})
            written = compare(viewer, path)

            async def late(viewer):
                await has_all(viewer, {topic: 1 for topic in written})
                assert viewer.seen == {topic: messages[-1:] for topic, messages in written.items()}

            await connected(url, late)
            return viewer

        viewer = await connected(url, first)
        code = await run.wait()
        assert code == 0, f"the run ended with {code}"
        return viewer
    finally:
        if run.returncode is None:
            run.kill()


def main(path, command):
    viewer = asyncio.run(asyncio.wait_for(watch(path, command), LONGEST_S))
    print(f"live: {sum(viewer.counts().values())} messages, as in {path}")
    for topic, count in sorted(viewer.counts().items()):
        print(f"    {count:7} {topic}")


if __name__ == "__main__":
    if len(sys.argv) < 3:
        sys.exit(__doc__)
    main(sys.argv[1], sys.argv[2:])
