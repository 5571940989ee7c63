# Where the checkout's folders are, and what benchmarks share with tests: the exact surfaces of sample_data/, the names of
# the filters (importing helpers.py loads the plugin) and clouds as layers. No other module extends the search path.
# SPDX-License-Identifier: GPL-3.0-or-later
from __future__ import annotations

import sys
from pathlib import Path

import pymeshlab

CHECKOUT = Path(__file__).resolve().parents[2]
RESULTS = CHECKOUT / "benchmarks" / "results"
BUILD = CHECKOUT / "build" / "release"  # as scripts/setup.sh configures it
MESHLAB_SAMPLES = Path(pymeshlab.__file__).parent / "tests" / "sample_meshes"

sys.path.insert(0, str(CHECKOUT / "tests" / "python"))

import helpers  # noqa: E402, F401
from helpers import (  # noqa: E402, F401
    BOUNDARY,
    CURVATURE,
    DENOISE,
    FEATURES,
    M_WEIGHTED,
    MESH,
    NORMALS,
    OUTLIERS,
    PIPELINE,
    PROJECT,
    RAY_TRACE,
    TRACE,
    analytic_surfaces,
    axis_angle,
    layer,
    rms,
)
