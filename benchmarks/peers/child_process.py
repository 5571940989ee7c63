# A peer in a process of its own, because it can bring that process down or needs another Python.
# SPDX-License-Identifier: GPL-3.0-or-later
from __future__ import annotations

import subprocess
import sys
import tempfile
from collections.abc import Callable
from pathlib import Path

import numpy as np

Arrays = dict[str, np.ndarray]


def _read(path: str | Path) -> Arrays:
    with np.load(path) as found:
        return dict(found)


def _write(path: Path, arrays: Arrays) -> None:
    np.savez(path, **arrays)  # type: ignore[arg-type]


def in_child(module: str, given: Arrays, *words: object, python: str | Path = sys.executable) -> Arrays | None:
    """What ``module`` (which ends in :func:`serve`) makes of the arrays and words; None if it crashed."""
    with tempfile.TemporaryDirectory() as folder:
        before, after = Path(folder) / "before.npz", Path(folder) / "after.npz"
        _write(before, given)
        done = subprocess.run(
            [python, "-m", module, before, after, *map(str, words)],
            cwd=Path(__file__).resolve().parent.parent,
            capture_output=True,
            check=False,
        )
        if done.returncode < 0:
            return None
        if done.returncode > 0:
            raise RuntimeError(done.stderr.decode(errors="replace"))
        return _read(after)


def serve(run: Callable[..., Arrays]) -> None:
    """The child's side: ``run`` gets the arrays and the words."""
    before, after, *words = sys.argv[1:]
    _write(Path(after), run(_read(before), *words))
