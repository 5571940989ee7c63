# The command line that benchmarks of several experiments share, and their report: to the screen or to a result file.
# SPDX-License-Identifier: GPL-3.0-or-later
from __future__ import annotations

import argparse
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import measures

Experiments = dict[str, tuple[str, Callable[[Any], str]]]  # name: title of the section, and what writes it


@dataclass(frozen=True)
class Settings:
    quick: bool = False
    peers: bool = True
    data: Path | None = None
    seed_count: int = 5

    @property
    def seeds(self) -> range:
        return range(1, 1 + (1 if self.quick else self.seed_count))


def parser_of(experiments: Experiments, description: str | None, data: str) -> argparse.ArgumentParser:
    """``data``: what the folder of the option of that name holds."""
    parser = argparse.ArgumentParser(description=description)
    parser.add_argument("experiments", nargs="*", metavar="EXPERIMENT", help=", ".join(experiments))
    parser.add_argument("--quick", action="store_true", help="one seed and fewer clouds, to the screen")
    parser.add_argument("--without-peers", action="store_true", help="only ours")
    parser.add_argument("--data", type=Path, metavar="FOLDER", help=data)
    return parser


def parse(parser: argparse.ArgumentParser, experiments: Experiments) -> argparse.Namespace:
    given = parser.parse_args()
    for name in given.experiments:
        if name not in experiments:
            parser.error(f"no experiment is called {name}")
    return given


def report(
    name: str,
    title: str,
    introduction: str,
    experiments: Experiments,
    settings: Any,
    given: argparse.Namespace,
    further: str = "",
) -> None:
    """Runs what was asked for. ``further``: options of this benchmark alone, as given."""
    to_screen = bool(given.experiments) or given.quick
    sections = []

    def add(section: str) -> None:
        sections.append(section)
        if to_screen:
            print(section, flush=True)

    add(introduction)
    for heading, run in (experiments[key] for key in given.experiments or experiments):
        add(f"## {heading}\n\n{run(settings)}")
    if not to_screen:
        data = " --data FOLDER" if given.data else ""
        peers = " --without-peers" if given.without_peers else ""
        measures.write_result(name, f"{name}.py{data}{peers}{further}", title, "\n".join(sections))
