# What a figure is held to, and the cells of a table that say whether it is met.
# SPDX-License-Identifier: GPL-3.0-or-later
from __future__ import annotations

from dataclasses import dataclass

import numpy as np


@dataclass(frozen=True)
class Target:
    """Two bounds of a figure: the one it must keep, and the narrower one we aim at. Unit: the figure's."""

    must: float
    aim: float
    at_least: bool = False  # larger is better


@dataclass(frozen=True)
class Bound:
    """One bound of a figure, in the figure's unit."""

    value: float
    at_least: bool = False  # larger is better

    def holds(self, value: float) -> bool:
        return value >= self.value if self.at_least else value <= self.value

    def __str__(self) -> str:
        return f"{'≥' if self.at_least else '≤'} {number(self.value)}"


def number(value: float) -> str:
    """Three significant digits; a dash for NaN, the figure that does not exist."""
    return "–" if np.isnan(value) else f"{value:.3g}"


def yes(condition: bool) -> str:
    return "yes" if condition else "**no**"


def verdict(value: float, target: Target | None) -> list[str]:
    """Three cells: must, aim, and which of them is met."""
    if target is None:
        return ["–", "–", ""]
    sign = -1.0 if target.at_least else 1.0
    met = "aim" if sign * value <= sign * target.aim else "must" if sign * value <= sign * target.must else "**missed**"
    return [number(target.must), number(target.aim), met]


def bound_cells(bound: Bound | None, *values: float) -> list[str]:
    """The bound, and a cell per value that says whether it is kept."""
    if bound is None:
        return ["–", *[""] * len(values)]
    return [str(bound), *(yes(bound.holds(value)) for value in values)]
