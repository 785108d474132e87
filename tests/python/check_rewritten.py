"""Writes a grainflow log again with the MCAP project's own writer, and checks what grainflow says of the new one.

    python check_rewritten.py GRAINFLOW LOG

With zstd and without compression the log is as good as before, also where it has channels of another program. With lz4,
which grainflow does not read, it says so and calls nothing damaged. Prints `N passed, M failed`; the exit code is 1 where
something failed.
"""

import subprocess
import sys
import tempfile
from pathlib import Path

from mcap.reader import make_reader
from mcap.writer import CompressionType, Writer

from read_log import Checks


def rewrite(old, new, compression, with_notes):
    """Everything of the log, in its order, and two channels of our own: one without a schema, one with a foreign one."""
    with open(old, "rb") as source, open(new, "wb") as target:
        reader, writer = make_reader(source, validate_crcs=True), Writer(target, compression=compression)
        writer.start(profile="", library="check_rewritten")
        for one in reader.iter_metadata():
            writer.add_metadata(one.name, one.metadata)
        for one in reader.iter_attachments():
            writer.add_attachment(one.create_time, one.log_time, one.name, one.media_type, one.data)
        summary, schemas, channels = reader.get_summary(), {}, {}
        for number, one in sorted(summary.schemas.items()):
            schemas[number] = writer.register_schema(one.name, one.encoding, one.data)
        for number, one in sorted(summary.channels.items()):
            schema = schemas[one.schema_id]
            channels[number] = writer.register_channel(one.topic, one.message_encoding, schema, one.metadata)
        notes = []
        if with_notes:
            schema = writer.register_schema("note", "jsonschema", b"{}")
            notes = [writer.register_channel("/notes", "json", 0), writer.register_channel("/more", "json", schema)]
        for k, (_, channel, one) in enumerate(reader.iter_messages(log_time_order=False)):
            writer.add_message(channels[channel.id], one.log_time, one.data, one.publish_time, one.sequence)
            for note in notes if k % 7 == 0 else []:
                writer.add_message(note, one.log_time, b'{"note": 1}', one.publish_time, k)
        writer.finish()


def main(program, log):
    checks = Checks()

    def run(*arguments):
        return subprocess.run([program, *map(str, arguments)], capture_output=True, text=True)

    with tempfile.TemporaryDirectory() as folder:
        place = Path(folder)
        new, clean = place / "new.mcap", place / "clean.mcap"
        before = run("replay", log, "--verify").stdout
        for compression in (CompressionType.ZSTD, CompressionType.NONE):
            for with_notes in (False, True):
                rewrite(log, new, compression, with_notes)
                verified = run("replay", new, "--verify")
                checks.that(verified.stdout == before, f"{compression}, {with_notes}: {verified.stderr}")
                export = run("export", new, "--format", "csv", "--out", place / "new.csv", "--force")
                checks.that(export.returncode == 0, f"{compression}, {with_notes}: {export.stderr}")
                recovered = run("recover", new, "--out", clean)
                checks.that(not clean.exists(), f"{compression}, {with_notes}: {recovered.stdout}")
        rewrite(log, new, CompressionType.LZ4, False)
        for arguments in (("replay", new), ("export", new, "--format", "csv"), ("recover", new, "--out", clean)):
            done = run(*arguments)
            is_named = "lz4" in done.stderr and "--compression zstd" in done.stderr and "damaged" not in done.stderr
            checks.that(done.returncode == 2 and is_named, f"{arguments[0]}: {done.returncode}, {done.stderr}")
        checks.that(sorted(one.name for one in place.iterdir()) == ["new.csv", "new.mcap"], "nothing else is written")
    print(f"{checks.passed} passed, {checks.failed} failed")
    return 1 if checks.failed else 0


if __name__ == "__main__":
    if len(sys.argv) != 3:
        sys.exit(__doc__)
    sys.exit(main(*sys.argv[1:]))
