# What every method of the cleaning benchmark gives back, ours and the peers'.
# SPDX-License-Identifier: GPL-3.0-or-later
from __future__ import annotations

from dataclasses import dataclass

import numpy as np


@dataclass(frozen=True)
class Selection:
    outliers: np.ndarray  # mask of points
    seconds: float  # wall clock


@dataclass(frozen=True)
class Moved:
    positions: np.ndarray  # of all points, in the order given
    seconds: float  # wall clock
