"""Runs the Python of a document, block after block, on a log.

    python run_snippets.py DOCUMENT LOG

The blocks share their names, as in a notebook, and find the log as `log.mcap` in the folder they run in.
"""

import os
import re
import sys
import tempfile
from pathlib import Path


def blocks(document):
    """The Python blocks of a document, each with the line that it begins at."""
    text = Path(document).read_text(encoding="utf-8")
    for found in re.finditer(r"^```python\n(.*?)^```$", text, re.MULTILINE | re.DOTALL):
        yield text[: found.start(1)].count("\n") + 1, found.group(1)


def main(document, log):
    document, log = Path(document).resolve(), Path(log).resolve()
    names = {"__name__": "__main__"}
    count = 0
    with tempfile.TemporaryDirectory() as folder:
        os.symlink(log, Path(folder) / "log.mcap")
        os.chdir(folder)
        for line, block in blocks(document):
            # Lines of a traceback are those of the document.
            exec(compile("\n" * (line - 1) + block, str(document), "exec"), names)
            count += 1
        os.chdir(document.parent)
    if count == 0:
        sys.exit(f"{document} has no Python")
    print(f"{document.name}: {count} blocks ran on {log}")


if __name__ == "__main__":
    if len(sys.argv) != 3:
        sys.exit(__doc__)
    main(*sys.argv[1:])
