# Tables in Markdown, the result files they end in, and what is said on the way.
# SPDX-License-Identifier: GPL-3.0-or-later
from __future__ import annotations

import os
import platform
import subprocess
import sys
from importlib.metadata import version

from harness.shared import CHECKOUT, RESULTS


def progress(text: str) -> None:
    """To the standard error, so that the standard output holds the tables alone."""
    print(text, file=sys.stderr, flush=True)


def markdown_table(header: list[str], rows: list[list[str]]) -> str:
    lines = [header, ["---"] * len(header), *rows]
    return "\n".join("| " + " | ".join(line) + " |" for line in lines) + "\n"


def _commit() -> str:
    described = subprocess.run(
        ["git", "describe", "--always", "--dirty"], cwd=CHECKOUT, capture_output=True, text=True, check=False
    )
    return described.stdout.strip() or "unknown"


def write_result(name: str, command: str, title: str, body: str) -> None:
    """Writes results/NAME.md and prints it. Its head says which command (script and options), versions and machine."""
    RESULTS.mkdir(exist_ok=True)
    text = (
        f"# {title}\n\n"
        f"Written by `.venv/bin/python benchmarks/{command}`; plugin {version('pymeshlab-curvature-lines')}, "
        f"commit {_commit()}, "
        f"PyMeshLab {version('pymeshlab')}, {os.environ.get('OMP_NUM_THREADS', os.cpu_count())} threads (OpenMP), "
        f"{platform.machine()}.\n\n"
        f"{body}"
    )
    (RESULTS / f"{name}.md").write_text(text, encoding="utf-8")
    print(text)
