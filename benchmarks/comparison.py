# Figures of ours and of peers on the same clouds of several seeds, beside what we hold ourselves to, as a table.
# SPDX-License-Identifier: GPL-3.0-or-later
from __future__ import annotations

from collections import defaultdict
from dataclasses import dataclass
from statistics import median

import numpy as np

Figures = dict[str, float]


@dataclass(frozen=True)
class Target:
    must: float
    aim: float
    at_least: bool = False  # larger is better


def number(value: float) -> str:
    return "–" if np.isnan(value) else f"{value:.3g}"


def verdict(value: float, target: Target | None) -> list[str]:
    """Must, aim, and which of them is met."""
    if target is None:
        return ["–", "–", ""]
    sign = -1.0 if target.at_least else 1.0
    met = "aim" if sign * value <= sign * target.aim else "must" if sign * value <= sign * target.must else "**missed**"
    return [number(target.must), number(target.aim), met]


class Outcome:
    """Figures of one method on the clouds of all seeds."""

    def __init__(self) -> None:
        self._figures: dict[str, list[float]] = defaultdict(list)
        self._runs = self._crashes = 0

    def add(self, figures: Figures | None) -> None:
        self._runs += 1
        if figures is None:
            self._crashes += 1
            return
        for name, value in figures.items():
            self._figures[name].append(value)

    def names(self) -> list[str]:
        return list(self._figures)

    def median(self, name: str) -> float:
        return median(self._figures[name]) if self._figures[name] else np.nan

    def worst(self, name: str, at_least: bool = False) -> float:
        return (min if at_least else max)(self._figures[name])

    def cell(self, name: str) -> str:
        if self._crashes == self._runs:
            return "crash"
        crashed = f" (crash: {self._crashes} of {self._runs} seeds)" if self._crashes else ""
        return number(self.median(name)) + crashed


def best_cell(outcomes: dict[str, Outcome], name: str, at_least: bool = False) -> str:
    """The best of some settings (the keys), picked with the truth in hand for this figure alone."""
    medians = {setting: outcome.median(name) for setting, outcome in outcomes.items()}
    known = {setting: value for setting, value in medians.items() if not np.isnan(value)}
    if not known:
        return "–"
    best = (max if at_least else min)(known, key=known.__getitem__)
    return f"{number(known[best])} ({best})"
