# Figures over several seeds, beside what we hold ourselves to and beside other tools on the same clouds, as a table.
# SPDX-License-Identifier: GPL-3.0-or-later
from __future__ import annotations

from collections import defaultdict
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass, field
from statistics import median
from typing import Any

import numpy as np

from harness.command_line import Settings
from harness.report import markdown_table, progress
from harness.verdicts import Target, number, verdict

Figures = dict[str, float]  # name, with its unit where it has one: value


def prefixed(part: str, figures: Figures) -> Figures:
    """Figures of a part of a cloud; the whole has no name."""
    return {f"{part}, {name}" if part else name: value for name, value in figures.items()}


class Outcome:
    """Figures of one method on the clouds of all seeds."""

    def __init__(self) -> None:
        self._figures: dict[str, list[float]] = defaultdict(list)
        self._runs = self._crashes = 0

    def add(self, figures: Figures | None) -> None:
        """``None``: the method crashed."""
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
        """The smallest where ``at_least``, for a figure of which more is better; else the largest."""
        return (min if at_least else max)(self._figures[name])

    def cell(self, name: str) -> str:
        if self._crashes == self._runs:
            return "crash"
        crashed = f" (crash: {self._crashes} of {self._runs} seeds)" if self._crashes else ""
        return number(self.median(name)) + crashed


def over_seeds(label: str, seeds: Iterable[int], figures: Callable[[int], Figures]) -> Outcome:
    outcome = Outcome()
    for seed in seeds:
        progress(f"{label}, seed {seed}")
        outcome.add(figures(seed))
    return outcome


SEED_HEADER = ["figure", "median", "worst seed", "must", "aim", "met"]


def seed_rows(label: str, outcome: Outcome, targets: Mapping[str, Target]) -> list[list[str]]:
    """Of figures of ours alone: a row each under :data:`SEED_HEADER`, judged by the worst seed."""
    rows = []
    for name in outcome.names():
        target = targets.get(name)
        worst = outcome.worst(name, target is not None and target.at_least)
        row_label = f"{label}: {name}" if label else name
        rows.append([row_label, number(outcome.median(name)), number(worst), *verdict(worst, target)])
    return rows


Method = Callable[[Any], Any]  # a cloud in, a result out; None: it crashed


@dataclass(frozen=True)
class Case:
    """The clouds of some rows of a comparison, and what their figures are held to."""

    label: str
    make: Callable[[int], Any]  # a cloud, of a seed
    targets: dict[str, Target] = field(default_factory=dict)  # of figures
    quick: bool = False  # also in a quick run
    one_seed: bool = False


@dataclass(frozen=True)
class Column:
    """A peer; of several settings (name: method) the best one is shown, picked for each figure by the truth.

    Methods of the same name in several columns are run once.
    """

    title: str
    methods: dict[str, Method]

    def cell(self, outcomes: dict[str, Outcome], figure: str, at_least: bool) -> str:
        if len(self.methods) == 1:
            return outcomes[next(iter(self.methods))].cell(figure)
        medians = {name: outcomes[name].median(figure) for name in self.methods}
        known = {name: value for name, value in medians.items() if not np.isnan(value)}
        if not known:
            return "–"
        best = (max if at_least else min)(known, key=known.__getitem__)
        return f"{number(known[best])} ({best})"


def one(title: str, method: Method) -> Column:
    return Column(title, {title: method})


def methods_of(columns: Iterable[Column]) -> dict[str, Method]:
    return {name: run for column in columns for name, run in column.methods.items()}


@dataclass(frozen=True)
class Comparison:
    """Our method and the peers that a table sets beside it."""

    ours: Method
    peers: Callable[[], list[Column]] = list  # asked for only where the settings want peers
    larger_is_better: Callable[[str], bool] = lambda name: False  # of a figure
    every_seed: bool = False  # targets are to be met by the worst seed, not by the median

    def table(self, cases: Iterable[Case], settings: Settings, figures: Callable[[Any, Any], Figures]) -> str:
        """A row per case and figure: medians over the seeds. ``figures``: of a cloud and a method's result."""
        columns = self.peers() if settings.peers else []
        methods = {"ours": self.ours} | methods_of(columns)
        rows: list[list[str]] = []
        for case in cases:
            if settings.quick and not case.quick:
                continue
            outcomes = {name: Outcome() for name in methods}
            for seed in [1] if case.one_seed else settings.seeds:
                progress(f"{case.label}, seed {seed}")
                cloud = case.make(seed)
                for name, run in methods.items():
                    result = run(cloud)
                    outcomes[name].add(None if result is None else figures(cloud, result))
            rows += self._rows(case, outcomes, columns)
        header = ["cloud", "figure", "ours", "worst seed", "must", "aim", "met", *(column.title for column in columns)]
        return markdown_table(header, rows)

    def _rows(self, case: Case, outcomes: dict[str, Outcome], columns: list[Column]) -> list[list[str]]:
        ours, rows = outcomes["ours"], []
        for name in ours.names():
            at_least = self.larger_is_better(name)
            middle, worst = ours.median(name), ours.worst(name, at_least)
            if np.isnan(middle):  # the figure means nothing on this cloud
                continue
            row = [case.label, name, number(middle), number(worst)]
            row += verdict(worst if self.every_seed else middle, case.targets.get(name))
            rows.append(row + [column.cell(outcomes, name, at_least) for column in columns])
        return rows
