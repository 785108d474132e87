"""Reads a grainflow log with the MCAP project's own Python packages and checks what it finds.

    python read_log.py LOG

Every topic is decoded by the descriptions that stand in the file, checksums are checked, grains are
loaded as NumPy arrays. Prints `N passed, M failed`; the exit code is 1 where something failed.
"""

import json
import sys
from collections import defaultdict

import numpy as np
from mcap.reader import make_reader
from mcap.stream_reader import StreamReader
from mcap.records import Chunk
from mcap_protobuf.decoder import DecoderFactory

SCHEMAS = {
    "/measures": "grainflow.Measures",
    "/particles": "foxglove.PointCloud",
    "/profiles": "grainflow.Profile",
    "/state": "grainflow.State",
    "/walls": "foxglove.SceneUpdate",
}
# Topics `/fields/<name>` hold grids: of cells in a plane, or in space.
GRIDS = {"foxglove.Grid", "foxglove.VoxelGrid"}
FIELDS = {"density", "velocity", "temperature", "collisions", "attempts", "bound"}
# Ticks are counted in 63 bits.
LAST_TICK = 2**63 - 1
# foxglove.PackedElementField.NumericType
NUMPY_TYPES = {1: "u1", 2: "i1", 3: "<u2", 4: "<i2", 5: "<u4", 6: "<i4", 7: "<f4", 8: "<f8"}


class Checks:
    """Counts what holds and prints what does not."""

    def __init__(self):
        self.passed = 0
        self.failed = 0

    def that(self, holds, what):
        if holds:
            self.passed += 1
        else:
            self.failed += 1
            print(f"failed: {what}")


def points(cloud):
    """The points of a foxglove.PointCloud as a structured array, without copying."""
    layout = np.dtype(
        {
            "names": [field.name for field in cloud.fields],
            "formats": [NUMPY_TYPES[field.type] for field in cloud.fields],
            "offsets": [field.offset for field in cloud.fields],
            "itemsize": cloud.point_stride,
        }
    )
    return np.frombuffer(cloud.data, dtype=layout)


def cells(grid):
    """The cells of a foxglove.Grid or foxglove.VoxelGrid as a structured array [z, y, x], without copying."""
    layout = np.dtype(
        {
            "names": [field.name for field in grid.fields],
            "formats": [NUMPY_TYPES[field.type] for field in grid.fields],
            "offsets": [field.offset for field in grid.fields],
            "itemsize": grid.cell_stride,
        }
    )
    rows = getattr(grid, "row_count", len(grid.data) // grid.row_stride)
    return np.frombuffer(grid.data, dtype=layout).reshape(-1, rows, grid.column_count)


def seconds(timestamp):
    return timestamp.seconds + 1e-9 * timestamp.nanos


def check_header(reader, checks):
    records = [record for record in reader.iter_metadata() if record.name == "grainflow"]
    checks.that(len(records) == 1, "one metadata record `grainflow`")
    metadata = records[0].metadata if records else {}
    checks.that(metadata.get("format") == "1", f"format 1, not {metadata.get('format')}")
    scale = metadata.get("time_scale", "")
    checks.that(scale.startswith("1") and set(scale[1:]) <= {"0"}, f"time_scale {scale!r} is a power of ten")
    scenarios = [one for one in reader.iter_attachments() if one.name == "scenario.toml"]
    checks.that(len(scenarios) == 1, "one attachment scenario.toml")
    for scenario in scenarios:
        checks.that(scenario.media_type == "application/toml", "the scenario is application/toml")
        checks.that("=" in scenario.data.decode("utf-8"), "the scenario is text")
    return int(scale) if scale.isdigit() else 10**9


def check_measures(messages, channel, scale, checks):
    fields = [field for field in messages[0][1].DESCRIPTOR.fields if field.number >= 16]
    checks.that(fields, "the series has columns")
    for field in fields:
        checks.that(f"unit.{field.name}" in channel.metadata, f"{field.name} has a unit")
    table = {field.name: np.array([getattr(one, field.name) for _, one in messages]) for field in fields}
    checks.that(all(len(column) == len(messages) for column in table.values()), "columns are complete")
    times = np.array([one.time for _, one in messages])
    checks.that(np.all(np.isfinite(times)) and np.all(np.diff(times) > 0), "times of the series rise")
    ticks = np.array([log_time for log_time, _ in messages], dtype=float)
    # Ticks end where their range does; the times in the messages do not.
    checks.that(np.allclose(ticks, np.minimum(times * scale, LAST_TICK), rtol=1e-12, atol=0.5), "log times are the times")
    hashes = [one.state_hash for _, one in messages]
    checks.that(all(len(text) == 64 for text in hashes), "every recording has a state hash")
    return len(times)


def check_particles(messages, grains, checks):
    for (log_time, cloud), count in zip(messages, grains):
        array = points(cloud)
        checks.that(set(array.dtype.names) >= {"x", "y", "z", "vx", "vy", "vz", "id"}, "point fields")
        checks.that(len(array) == min(count, len(array)) and len(array) > 0 or count == 0, "points per frame")
        finite = all(np.all(np.isfinite(array[name])) for name in array.dtype.names)
        checks.that(finite, f"points at {log_time} are finite")
        checks.that(len(np.unique(array["id"])) == len(array), "identities are unique")
        checks.that(cloud.frame_id == "world" and cloud.pose.orientation.w == 1.0, "frame and pose")
        checks.that(round(seconds(cloud.timestamp) * 1e9) // 1000 == log_time // 1000, "timestamps")


def check_fields(topic, messages, channel, recordings, checks):
    """`recordings`: (log time, grains) of each recording, by sequence number."""
    name = topic.removeprefix("/fields/")
    checks.that(name in FIELDS, f"{name} is a field")
    for sequence, log_time, grid in messages:
        array = cells(grid)
        checks.that(set(array.dtype.names) <= {key.removeprefix("unit.") for key in channel.metadata}, "units")
        checks.that(sequence in recordings, f"{topic}: recording {sequence} is there")
        checks.that(recordings.get(sequence, (0, 0))[0] == log_time, f"{topic}: times are those of the recording")
        checks.that(grid.frame_id == "world" and grid.pose.orientation.w == 1.0, "frame and pose of a field")
        checks.that(grid.cell_size.x > 0 and grid.cell_size.y > 0, "cells have a size")
        if name in {"velocity", "temperature"}:
            continue  # not a number where there are no grains
        checks.that(all(np.all(array[one] >= 0) for one in array.dtype.names), f"{topic} is not negative")
        if name == "density":
            grains = recordings.get(sequence, (0, 0))[1]
            checks.that(np.any(array[name] > 0) == (grains > 0), f"{topic} shows grains where there are some")


def check_states(messages, checks):
    whole = 0
    for _, state in messages:
        positions = np.frombuffer(state.positions, "<f8").reshape(-1, state.dimension)
        velocities = np.frombuffer(state.velocities, "<f8").reshape(-1, state.dimension)
        ids = np.frombuffer(state.ids, "<u4")
        checks.that(positions.shape == velocities.shape == (len(ids), state.dimension), "state columns fit")
        checks.that(np.all(np.isfinite(positions)), "positions of a state are finite")
        whole += state.first_row + len(ids) == state.grains
    checks.that(whole > 0 or not messages, "a state is complete")


def check_others(messages, checks):
    for _, profile in messages["/profiles"]:
        lengths = {len(column.values) for column in profile.columns}
        checks.that(len(lengths) == 1, f"columns of the profile {profile.name} are equally long")
        checks.that(all(column.unit for column in profile.columns), f"{profile.name} has units")
    for _, scene in messages["/walls"]:
        keys = {pair.key for entity in scene.entities for pair in entity.metadata}
        checks.that({"lower", "upper", "x.lower"} <= keys, "walls are described")


def check_counts(path, summary, messages, checks):
    """Counts in the statistics, and a second pass that checks every chunk from the front."""
    counted = summary.statistics.channel_message_counts
    for number, channel in summary.channels.items():
        expected = counted.get(number, 0)
        found = len(messages[channel.topic])
        checks.that(found == expected, f"{channel.topic}: {found} messages, statistics say {expected}")
    with open(path, "rb") as file:
        chunks = sum(isinstance(one, Chunk) for one in StreamReader(file, emit_chunks=True).records)
    checks.that(chunks == summary.statistics.chunk_count, "chunks are all there")


def main(path):
    checks = Checks()
    messages = defaultdict(list)
    sequences = defaultdict(list)
    channels = {}
    with open(path, "rb") as file:
        reader = make_reader(file, validate_crcs=True, decoder_factories=[DecoderFactory()])
        scale = check_header(reader, checks)
        summary = reader.get_summary()
        for schema, channel, message, decoded in reader.iter_decoded_messages(log_time_order=False):
            checks.that(message.log_time == message.publish_time, "log time and publish time agree")
            is_field = channel.topic.startswith("/fields/") and schema.name in GRIDS
            checks.that(is_field or SCHEMAS.get(channel.topic) == schema.name, f"{channel.topic} holds {schema.name}")
            channels[channel.topic] = channel
            messages[channel.topic].append((message.log_time, decoded))
            sequences[channel.topic].append(message.sequence)
    for topic, found in messages.items():
        checks.that(np.all(np.diff([time for time, _ in found]) >= 0), f"{topic} rises")
    checks.that(messages["/measures"], "there are measures")
    if messages["/measures"]:
        check_measures(messages["/measures"], channels["/measures"], scale, checks)
        # Frames and fields belong to the recording of their sequence number.
        recordings = {
            number: (log_time, one.grains_in_gas)
            for number, (log_time, one) in zip(sequences["/measures"], messages["/measures"])
        }
        framed = sequences["/particles"]
        checks.that(set(framed) <= set(recordings), "a recording for every frame")
        check_particles(messages["/particles"], [recordings[number][1] for number in framed], checks)
        for topic in [topic for topic in messages if topic.startswith("/fields/")]:
            numbered = [(number, *one) for number, one in zip(sequences[topic], messages[topic])]
            check_fields(topic, numbered, channels[topic], recordings, checks)
    check_states(messages["/state"], checks)
    check_others(messages, checks)
    check_counts(path, summary, messages, checks)
    counts = {topic: len(found) for topic, found in sorted(messages.items())}
    print(f"{path}: {json.dumps(counts)}")
    print(f"{checks.passed} passed, {checks.failed} failed")
    return 1 if checks.failed else 0


if __name__ == "__main__":
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    sys.exit(main(sys.argv[1]))
