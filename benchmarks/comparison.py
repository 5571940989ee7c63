# Figures of ours and of peers on the same clouds of several seeds, beside what we hold ourselves to, as a table.
# SPDX-License-Identifier: GPL-3.0-or-later
from __future__ import annotations

import sys
from collections import defaultdict
from collections.abc import Callable, Iterable
from dataclasses import dataclass, field
from statistics import median
from typing import Any

import numpy as np

import measures

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


Method = Callable[[Any], Any]  # a cloud in, a result out; None: it crashed


@dataclass(frozen=True)
class Case:
    label: str
    make: Callable[[int], Any]  # a cloud, of a seed
    targets: dict[str, Target] = field(default_factory=dict)  # of figures
    quick: bool = False  # also in a quick run
    one_seed: bool = False


@dataclass(frozen=True)
class Column:
    """A peer; of several settings (name -> method) the best one is shown, picked for each figure by the truth.

    Methods of the same name in several columns are run once.
    """

    title: str
    methods: dict[str, Method]


def one(title: str, method: Method) -> Column:
    return Column(title, {title: method})


def compare(
    cases: Iterable[Case],
    seeds: Iterable[int],
    ours: Method,
    columns: list[Column],
    figures: Callable[[Any, Any], Figures],
    larger_is_better: Callable[[str], bool],
    *,
    every_seed: bool = False,
) -> str:
    """A table of the medians over the seeds. ``every_seed``: targets are to be met by the worst one, not by the median."""
    methods = {"ours": ours} | {name: run for column in columns for name, run in column.methods.items()}
    rows = []
    for case in cases:
        outcomes = {name: Outcome() for name in methods}
        for seed in [1] if case.one_seed else seeds:
            print(f"{case.label}, seed {seed}", file=sys.stderr)
            cloud = case.make(seed)
            for name, run in methods.items():
                result = run(cloud)
                outcomes[name].add(None if result is None else figures(cloud, result))
        mine = outcomes["ours"]
        for name in mine.names():
            at_least = larger_is_better(name)
            middle, worst = mine.median(name), mine.worst(name, at_least)
            row = [case.label, name, number(middle), number(worst)]
            row += verdict(worst if every_seed else middle, case.targets.get(name))
            for column in columns:
                tried = {setting: outcomes[setting] for setting in column.methods}
                row.append(best_cell(tried, name, at_least) if len(tried) > 1 else tried[column.title].cell(name))
            rows.append(row)
    header = ["cloud", "figure", "ours", "worst seed", "must", "aim", "met", *(column.title for column in columns)]
    return measures.markdown_table(header, rows)
