# Progress of a running filter: PyMeshLab has no callback, but prints what the filter reports when verbose.
# SPDX-License-Identifier: GPL-3.0-or-later
"""Reads the host's progress lines while a filter runs."""

from __future__ import annotations

import os
import re
import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from threading import Thread

import pymeshlab
from tqdm import tqdm

_PROGRESS = re.compile(r"LOG: \d+ (?P<stage>.*?)\s*\[\s*(?P<percent>\d+)% \]")


@contextmanager
def progress(ms: pymeshlab.MeshSet, report: Callable[[str, int], None]) -> Iterator[None]:
    """Calls ``report(stage, percent)`` from a second thread for whatever filters of ``ms`` report in the body.

    The host writes to the file descriptors of stdout and stderr, so these are taken away from everybody for the
    time being; ``report`` must write elsewhere, as ``progress_bar`` does.
    """
    reader, writer = os.pipe()

    def listen() -> None:
        with open(reader, errors="replace") as lines:
            for line in lines:
                if found := _PROGRESS.search(line):
                    # The host's own last line names the filter, not a stage.
                    stage = "Done" if found["stage"].endswith(" applied!") else found["stage"]
                    report(stage, int(found["percent"]))

    listener = Thread(target=listen, daemon=True)
    sys.stdout.flush()
    sys.stderr.flush()
    saved = {stream: os.dup(stream) for stream in (1, 2)}
    for stream in saved:
        os.dup2(writer, stream)
    os.close(writer)
    listener.start()
    ms.set_verbosity(True)
    try:
        yield
    finally:
        ms.set_verbosity(False)
        sys.stdout.flush()
        for stream, copy in saved.items():
            os.dup2(copy, stream)
            os.close(copy)
        listener.join()


@contextmanager
def progress_bar(title: str = "") -> Iterator[Callable[[str, int], None]]:
    """A bar on stderr, as the function to give to ``progress``."""
    with os.fdopen(os.dup(sys.stderr.fileno()), "w") as terminal:
        layout = title + "{desc:<36.36} {percentage:3.0f}% |{bar}| {elapsed}"
        with tqdm(total=100, file=terminal, bar_format=layout) as bar:

            def report(stage: str, percent: int) -> None:
                bar.set_description_str(stage, refresh=False)
                bar.n = percent
                bar.refresh()

            yield report
