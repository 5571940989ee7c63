# Every benchmark can still be loaded: they run rarely, and what they import changes.
# SPDX-License-Identifier: GPL-3.0-or-later
import subprocess
import sys

import pytest

from helpers import CHECKOUT

SCRIPTS = sorted(file.stem for file in (CHECKOUT / "benchmarks").glob("*.py"))
LOAD_ALL = "import importlib, sys; sys.path.insert(0, '.'); [importlib.import_module(name) for name in sys.argv[1:]]"


def test_every_benchmark_loads():
    pytest.importorskip("pymeshlab_curvature_lines", reason="tests a plugin file, not the package")
    assert "curvature" in SCRIPTS
    done = subprocess.run(
        [sys.executable, "-c", LOAD_ALL, *SCRIPTS],
        cwd=CHECKOUT / "benchmarks",
        capture_output=True,
        text=True,
        check=False,
    )
    assert done.returncode == 0, done.stderr
