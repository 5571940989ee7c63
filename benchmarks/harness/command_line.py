# The command line of every benchmark, and where its sections go: to the screen or to a result file.
# SPDX-License-Identifier: GPL-3.0-or-later
from __future__ import annotations

import argparse
from collections.abc import Callable
from dataclasses import dataclass, field
from pathlib import Path

from harness.report import write_result

USUAL_SEEDS = 5
USUAL_TARGETS = (0, 2000, 5000)  # vertices; 0: the filter's own choice


@dataclass(frozen=True)
class Settings:
    """What the command line asked for."""

    quick: bool = False  # one seed and fewer clouds
    peers: bool = True
    data: Path | None = None  # the folder of scans
    seed_count: int = USUAL_SEEDS
    asked_targets: tuple[int, ...] = USUAL_TARGETS
    pictures: Path | None = None  # the folder they go to
    parameters: dict[str, object] = field(default_factory=dict)  # of our filter, beyond its defaults

    @property
    def seeds(self) -> range:
        return range(1, 1 + (1 if self.quick else self.seed_count))

    @property
    def targets(self) -> tuple[int, ...]:
        return self.asked_targets[:1] if self.quick else self.asked_targets

    @property
    def seeds_in_words(self) -> str:
        return "seed 1" if self.quick else f"seeds 1 to {self.seeds[-1]}"


Section = Callable[[Settings], str]  # Markdown without its heading


@dataclass
class Benchmark:
    """A script: the result file, and what stands in it, in the order in which the script says so."""

    name: str  # of the script and of the result file
    title: str
    options: tuple[str, ...] = ()  # keys of OPTIONS
    data: str = ""  # what the folder of --data holds; without, there is no such option
    opening: Section | None = None  # what stands first, or all there is
    experiments: dict[str, tuple[str, Section]] = field(default_factory=dict)  # name: heading, what writes the section

    def introduction(self, write: Section) -> Section:
        self.opening = write
        return write

    def experiment(self, name: str, heading: str) -> Callable[[Section], Section]:
        """Adds what follows as a section that can be asked for by its name."""

        def add(write: Section) -> Section:
            self.experiments[name] = heading, write
            return write

        return add


def numbers(text: str) -> tuple[int, ...]:
    return tuple(int(word) for word in text.split(","))


OPTIONS: dict[str, tuple[str, dict]] = {
    "quick": ("--quick", {"action": "store_true", "help": "one seed and fewer clouds, to the screen"}),
    "peers": ("--without-peers", {"action": "store_true", "help": "only ours"}),
    "scale_mode": ("--scale-mode", {"help": "of our filter, instead of its default"}),
    "seeds": (
        "--seeds",
        {
            "type": int,
            "default": USUAL_SEEDS,
            "metavar": "N",
            "help": "seeds 1 to N of every cloud (default: %(default)s)",
        },
    ),
    "targets": (
        "--targets",
        {
            "type": numbers,
            "default": USUAL_TARGETS,
            "metavar": "N,N",
            "help": "vertices asked for, 0: the filter's own choice (default: 0,2000,5000)",
        },
    ),
    "pictures": ("--pictures", {"type": Path, "metavar": "FOLDER", "help": "where pictures of the results go as well"}),
}


def parser_of(benchmark: Benchmark) -> argparse.ArgumentParser:
    description = f"Writes benchmarks/results/{benchmark.name}.md."
    if benchmark.experiments:
        description += " With names of experiments as arguments: only these, to the screen."
    parser = argparse.ArgumentParser(description=description)
    if benchmark.experiments:
        parser.add_argument("experiments", nargs="*", metavar="EXPERIMENT", help=", ".join(benchmark.experiments))
    for key in benchmark.options:
        flag, details = OPTIONS[key]
        parser.add_argument(flag, **details)
    if benchmark.data:
        parser.add_argument("--data", type=Path, metavar="FOLDER", help=f"where {benchmark.data}")
    parser.set_defaults(experiments=[], quick=False, without_peers=False, data=None, scale_mode=None, pictures=None)
    parser.set_defaults(seeds=USUAL_SEEDS, targets=USUAL_TARGETS)
    return parser


def _command(benchmark: Benchmark, given: argparse.Namespace) -> str:
    """The script and its options, as a result file names them."""
    words = [f"{benchmark.name}.py"]
    if given.data:
        words.append("--data FOLDER")
    if given.without_peers:
        words.append("--without-peers")
    if given.scale_mode:
        words.append(f"--scale-mode {given.scale_mode}")
    if given.seeds != USUAL_SEEDS:
        words.append(f"--seeds {given.seeds}")
    if given.targets != USUAL_TARGETS:
        words.append(f"--targets {','.join(map(str, given.targets))}")
    return " ".join(words)


def main(benchmark: Benchmark, arguments: list[str] | None = None) -> None:
    """Runs what was asked for; the whole benchmark writes its result file, a part of it only prints."""
    parser = parser_of(benchmark)
    given = parser.parse_args(arguments)
    for name in given.experiments:
        if name not in benchmark.experiments:
            parser.error(f"no experiment is called {name}")
    settings = Settings(
        quick=given.quick,
        peers=not given.without_peers,
        data=given.data,
        seed_count=max(1, given.seeds),
        asked_targets=given.targets,
        pictures=given.pictures,
        parameters={"scale_mode": given.scale_mode} if given.scale_mode else {},
    )
    to_screen = bool(given.experiments) or given.quick
    sections = []

    def add(section: str) -> None:
        sections.append(section)
        if to_screen:
            print(section, flush=True)

    if benchmark.opening:
        add(benchmark.opening(settings))
    for heading, write in (benchmark.experiments[name] for name in given.experiments or benchmark.experiments):
        add(f"## {heading}\n\n{write(settings)}")
    if not to_screen:
        write_result(benchmark.name, _command(benchmark, given), benchmark.title, "\n".join(sections))
