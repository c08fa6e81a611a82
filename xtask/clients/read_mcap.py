#!/usr/bin/env python3
"""Reads MCAP files with Python's mcap: checksums, schemas, every message decoded, time in order.

Images are decoded with Pillow, where it is installed.

    read_mcap.py FILE…
"""

import collections
import io
import sys

from mcap.reader import make_reader
from mcap_protobuf.decoder import DecoderFactory

try:
    from PIL import Image
except ImportError:
    Image = None


def check_image(message):
    """Raises when a foxglove.CompressedImage does not decode, or to another format than it says."""
    image = Image.open(io.BytesIO(message.data))
    image.load()
    if image.format.lower() != message.format:
        raise ValueError(f"{image.format} under the name {message.format}")


def read(path):
    """Messages per (topic, schema); raises on a bad checksum, schema or order."""
    counts = collections.Counter()
    latest = 0
    with open(path, "rb") as file:
        reader = make_reader(file, validate_crcs=True, decoder_factories=[DecoderFactory()])
        for schema, channel, message, decoded in reader.iter_decoded_messages(log_time_order=False):
            if message.log_time < latest:
                raise ValueError(f"{channel.topic}: time goes back from {latest} to {message.log_time}")
            latest = message.log_time
            if decoded.DESCRIPTOR.full_name != schema.name:
                raise ValueError(f"{channel.topic}: {decoded.DESCRIPTOR.full_name} under the name {schema.name}")
            if Image is not None and schema.name == "foxglove.CompressedImage":
                check_image(decoded)
            counts[channel.topic, schema.name] += 1
        summary = reader.get_summary()
    if summary is None or summary.statistics.message_count != sum(counts.values()):
        raise ValueError("the summary does not count the messages that are there")
    if not counts:
        raise ValueError("no messages")
    return counts


def main(paths):
    for path in paths:
        try:
            counts = read(path)
        except Exception as error:
            sys.exit(f"{path}: {type(error).__name__}: {error}")
        print(f"mcap: {path}")
        for (topic, schema), count in sorted(counts.items()):
            print(f"    {count:7} {topic} ({schema})")


if __name__ == "__main__":
    if len(sys.argv) < 2:
        sys.exit(__doc__)
    main(sys.argv[1:])
