#!/usr/bin/env python3
"""Decodes every message of an MCAP file with the Python packages mcap and mcap-protobuf-support.

Prints topic, schema and count. Fails when a message does not decode, there is none, or an expected topic is missing. Images are
decoded with Pillow, where it is installed.

    pip install mcap mcap-protobuf-support pillow
    check_mcap.py FILE.mcap [TOPIC...]
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


def main(path, expected_topics):
    counts = collections.Counter()
    with open(path, "rb") as file:
        reader = make_reader(file, validate_crcs=True, decoder_factories=[DecoderFactory()])
        for schema, channel, _, message in reader.iter_decoded_messages():
            if not message.ListFields() and schema.name != "foxglove.SceneUpdate":
                sys.exit(f"{path}: empty message on {channel.topic}")
            if Image is not None and schema.name == "foxglove.CompressedImage":
                Image.open(io.BytesIO(message.data)).load()
            counts[channel.topic, schema.name] += 1
        statistics = reader.get_summary().statistics
    for (topic, schema), count in sorted(counts.items()):
        print(f"{topic}\t{schema}\t{count}")
    if not counts:
        sys.exit(f"{path}: no message")
    if statistics.message_count != sum(counts.values()):
        sys.exit(f"{path}: the index says {statistics.message_count} messages, {sum(counts.values())} decode")
    missing = set(expected_topics) - {topic for topic, _ in counts}
    if missing:
        sys.exit(f"{path}: nothing on {', '.join(sorted(missing))}")


if __name__ == "__main__":
    if len(sys.argv) < 2:
        sys.exit(__doc__)
    main(sys.argv[1], sys.argv[2:])
