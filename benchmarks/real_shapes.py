# Whether a mesh of the whole pipeline has every part of a shape, to the tips, on real shapes and on exact ones of our own,
# beside what we hold it to and beside the two-step routes a user has today at the same number of faces.
# SPDX-License-Identifier: GPL-3.0-or-later
from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np

from clouds.thin_shapes import REAL_SHAPES
from clouds.views import looks_at
from clouds.whole_shapes import EXACT, Shape, real
from figures.mesh import PolygonMesh
from figures.whole_mesh import whole_figures
from harness.command_line import Benchmark, Settings, main
from harness.comparison import Figures
from harness.our_filters import run_on
from harness.pictures import draw, write_sheet
from harness.report import markdown_table, progress
from harness.shared import PIPELINE, layer
from harness.verdicts import Target, number, verdict
from peers.quad_columns import check_packages
from peers.whole_columns import OURS, QUADRIFLOW, ROUTES, route

BENCHMARK = Benchmark(
    "real_shapes",
    "Whole meshes of real shapes",
    options=("quick", "peers", "seeds", "targets", "pictures"),
    data="the scans are",
)

WORST = "ours, worst seed"  # of an exact shape
LESS_IS_WORSE = ("sj min", "quads")
STRUCTURE = ("parts", "χ", "rims")
STRUCTURE_ALONE = 10000  # vertices asked for: from here on no peers and no distances
TOLD = ("uncovered_share", "largest_gap", "folded_faces", "limb_vertices", "dropped_components", "dropped_points")
PICTURED = (OURS, QUADRIFLOW, "Instant Meshes, 30°")  # from left to right
SHOWN = ("c rms", "c max", "a rms", "a max", "irregular", "sj < 0", "folded", "parts", "χ", "rims")  # while it runs

EVERYWHERE = {"sj < 0": Target(0.0, 0.0), "folded": Target(0.0, 0.0), "wrong structure": Target(0.0, 0.0)}
OVER_PEER = "{} over QuadriFlow's"
COMPARED = ("c rms", "a rms")  # with QuadriFlow's


def farthest(must: float, aim: float) -> dict[str, Target]:
    return {"c max": Target(must, aim)}


RATIOS = {OVER_PEER.format(name): Target(0.9, 0.6) for name in COMPARED}
IN_EDGES = {"rim rms": Target(0.02, 0.01)}
# Of a shape: vertices asked for, and what the figures are held to there beside EVERYWHERE.
HELD: dict[str, dict[int, dict[str, Target]]] = {
    "horse": {0: farthest(0.8, 0.5) | RATIOS},
    "fish": {0: farthest(0.8, 0.5) | RATIOS},
    "rocker arm": {0: farthest(1.2, 0.5) | RATIOS},
    "hand": {0: farthest(0.8, 0.5) | RATIOS},
    "cow": {0: farthest(0.8, 0.5) | RATIOS},
    "bunny": {0: farthest(0.8, 0.5) | RATIOS},
    "armadillo": {0: farthest(0.8, 0.5) | RATIOS},
    "chameleon": {0: farthest(1.5, 0.5)},
    "spike": {0: farthest(0.8, 0.5), 2000: farthest(0.6, 0.3), 5000: farthest(0.5, 0.2)},
    "pin_0_05": {0: farthest(1.0, 0.5)},
    "pin_0_1": {0: farthest(0.8, 0.5)},
    "blade": {0: farthest(0.5, 0.5)},
    "rounded_box": {
        0: farthest(0.6, 0.5)
        | {"off rms": Target(0.05, 0.05), "off max": Target(0.2, 0.2), "fillet angle": Target(3.0, 3.0)}
    },
    "two_limbs": {0: farthest(0.5, 0.5)},
    "bumpy_grid": {0: IN_EDGES},
    "pipe": {0: IN_EDGES},
}


def targets_of(name: str, asked: int) -> dict[str, Target]:
    return EVERYWHERE | HELD.get(name, {}).get(asked, {})


@dataclass
class Run:
    """What the methods made of a shape at a number of vertices."""

    asked: int
    figures: dict[str, Figures] = field(default_factory=dict)  # of a method; empty: it crashed
    meshes: dict[str, PolygonMesh] = field(default_factory=dict)


def our_mesh(shape: Shape, asked: int) -> tuple[PolygonMesh | None, Figures]:
    """The mesh, and the seconds with what the filter says of it."""
    meshes = layer(shape.positions, shape.normals if shape.with_normals else None)
    try:
        ran = run_on(meshes, PIPELINE, target_vertices=asked)
    except Exception as failure:  # PyMeshLab's own; the others of this table are wanted nevertheless
        progress(str(failure).strip().splitlines()[-1])
        return None, {}
    told = {name: float(ran.report[name]) for name in TOLD if name in ran.report}
    mesh = PolygonMesh.of(ran)
    return (mesh if mesh.faces else None), {"seconds": ran.seconds} | told


def shown(figures: Figures) -> str:
    return "  ".join(f"{name} {number(figures[name])}" for name in SHOWN if name in figures) or "crash"


def worst_of(runs: list[Figures]) -> Figures:
    """Figure by figure; how the mesh hangs together as where it is wrong. None of them where one crashed."""
    if not all(runs):
        return {}
    wrong = max(runs, key=lambda figures: figures["wrong structure"])
    names = [name for name in runs[0] if all(name in figures for figures in runs)]
    return {
        name: wrong[name]
        if name in STRUCTURE
        else (min if name in LESS_IS_WORSE else max)(figures[name] for figures in runs)
        for name in names
    }


def run_at(name: str, shape: Shape, asked: int, settings: Settings) -> Run:
    run, structure_alone = Run(asked), asked >= STRUCTURE_ALONE

    def add(method: str, mesh: PolygonMesh | None, more: Figures) -> None:
        run.figures[method] = (whole_figures(shape, mesh, structure_alone) | more) if mesh else {}
        if mesh:
            run.meshes[method] = mesh
        progress(f"{name}, {asked or 'default'}, {method}: {shown(run.figures[method])}")

    mesh, more = our_mesh(shape, asked)
    add(OURS, mesh, more)
    if name in EXACT and len(settings.seeds) > 1:
        every = [run.figures[OURS]]
        for seed in settings.seeds[1:]:
            other = EXACT[name].shape(seed)
            again, more = our_mesh(other, asked)
            every.append((whole_figures(other, again, structure_alone) | more) if again else {})
        run.figures[WORST] = worst_of(every)
        progress(f"{name}, {asked or 'default'}, {WORST}: {shown(run.figures[WORST])}")
    if settings.peers and not structure_alone and mesh:
        for method in ROUTES:
            add(method, *route(shape, method, len(mesh.faces)))
        for figure in COMPARED:
            theirs = run.figures[QUADRIFLOW].get(figure, np.nan)
            run.figures[OURS][OVER_PEER.format(figure)] = run.figures[OURS][figure] / theirs
    return run


def write_pictures(name: str, shape: Shape, run: Run, folder: Path) -> None:
    """The methods side by side, a row per look at the shape."""
    rows = [
        [
            draw(run.meshes.get(method), look.camera, look.framed(shape.truth))
            for method in PICTURED
            if method in run.figures
        ]
        for look in looks_at(name)
    ]
    write_sheet(folder / f"{name.replace(' ', '_')}_{run.asked or 'default'}.png", rows)


_RUNS: dict[tuple[str, int], Run] = {}  # of this process: the last section sums them up


def runs_of(name: str, settings: Settings) -> list[Run]:
    """None where the shape is not there."""
    if settings.peers:
        check_packages()
    todo = [asked for asked in settings.targets if (name, asked) not in _RUNS]
    if todo:
        shape = EXACT[name].shape() if name in EXACT else real(name, settings.data)
        if shape is None:
            return []
        for asked in todo:
            run = _RUNS[name, asked] = run_at(name, shape, asked, settings)
            if settings.pictures:
                write_pictures(name, shape, run, settings.pictures)
    return [_RUNS[name, asked] for asked in settings.targets]


def columns_of(runs: list[Run]) -> list[str]:
    """Names of figures, in the order in which they come first."""
    every = [name for run in runs for figures in run.figures.values() for name in figures]
    return [name for name in dict.fromkeys(every) if "over" not in name]


def cell(figures: Figures, name: str) -> str:
    if not figures:
        return "crash"
    if name not in figures:
        return "–"
    value = figures[name]
    return str(int(value)) if float(value).is_integer() else number(value)


def figure_table(runs: list[Run]) -> str:
    columns = columns_of(runs)
    rows = [
        [str(run.asked or "default"), method, *(cell(figures, name) for name in columns)]
        for run in runs
        for method, figures in run.figures.items()
    ]
    return markdown_table(["asked", "method", *columns], rows)


HELD_HEADER = ["asked", "figure", "ours", "worst seed", "must", "aim", "met", *ROUTES]


def held_rows(name: str, run: Run) -> list[list[str]]:
    """Judged by the worst seed where there are several."""
    ours, rows = run.figures[OURS], []
    worst = run.figures.get(WORST, ours)
    for figure, target in targets_of(name, run.asked).items():
        if ours and figure not in ours:
            continue
        value = worst.get(figure, np.inf)
        peers = [cell(run.figures[method], figure) if method in run.figures else "–" for method in ROUTES]
        cells = [cell(figures, figure) for figures in (ours, worst)]
        rows.append([str(run.asked or "default"), figure, *cells, *verdict(value, target), *peers])
    return rows


def section_of(name: str) -> Callable[[Settings], str]:
    def write(settings: Settings) -> str:
        runs = runs_of(name, settings)
        if not runs:
            return "Skipped: `--data FOLDER` says where the scans are.\n"
        rows = [row for run in runs for row in held_rows(name, run)]
        return figure_table(runs) + "\n" + markdown_table(HELD_HEADER, rows)

    return write


NAMES = {name.replace(" ", "_"): name for name in [*REAL_SHAPES, "chameleon", *EXACT]}  # of an experiment, of a shape

HEADINGS = {"pin_0_1": "Pin, radius 0.1", "pin_0_05": "Pin, radius 0.05", "sparse_cap": "Sphere with a sparse cap"}

for _experiment, _name in NAMES.items():
    _heading = HEADINGS.get(_name, _name.replace("_", " ").capitalize())
    BENCHMARK.experiment(_experiment, _heading)(section_of(_name))


@BENCHMARK.experiment("missed", "What is missed")
def missed(settings: Settings) -> str:
    """Over all shapes; those that ran in this process are not run again."""
    rows, judged = [], 0
    for name in NAMES.values():
        for run in runs_of(name, settings):
            held = held_rows(name, run)
            judged += len(held)
            rows += [[name, *row] for row in held if "missed" in row[6]]
    return f"{len(rows)} of {judged} figures miss their must.\n\n" + markdown_table(["shape", *HELD_HEADER], rows)


@BENCHMARK.introduction
def introduction(settings: Settings) -> str:
    text = (
        f"`{PIPELINE}` with default parameters on points with normals (`many_parts`: points alone); `asked`: "
        "`target_vertices`. Distances in % of the diagonal of the points' bounding box. **c**: of the clean points from the "
        "mesh. **a**: of the mesh (20 000 points evenly over the faces, quads cut along the shorter diagonal; the largest "
        "over its vertices as well) from the true surface: the exact one, the file's own faces, or, of files without faces, "
        "the tangent plane of the nearest point within two local spacings, further off that point itself. **irregular**: "
        "inner vertices of a valence other than 4, per 1000. **quads**, **sj < 0** and **sj < .2** (scaled Jacobian of "
        "quads, the smallest corner): %. **folded**: faces that look against each of the eight points nearest to their middle, "
        "or against a neighbour over an edge (by more than 150 degrees, unless the surface turns as sharply there). "
        "**ratio**: 95th over 5th percentile of edge lengths. **parts**, **χ** (Euler characteristic), **rims**, "
        "**non-manifold** (edges and vertices): counted here; **wrong structure**: 1 unless all are right. **rim**: of the "
        "rim's vertices from the surface, in edges. **off**: of the rounded box's vertices from its surface, in spacings; "
        "**fillet angle**: mean, in degrees, of edges along its fillets to their axis. Further columns: what the filter says "
        f"itself. From {STRUCTURE_ALONE} vertices on the structure alone. Exact shapes: points of {settings.seeds_in_words}, must and "
        "aim judged by the worst seed, peers of seed 1.\n"
    )
    if settings.peers:
        text += (
            "\nPeers on the same points with normals, at our number of faces: PyMeshLab's screened Poisson reconstruction at "
            "depth 8 (of open surfaces what lies further than four spacings from the points is cut off), then quads by "
            "PyPI's `pyQuadriFlow`, or by `pynanoinstantmeshes` with its crease angle off (-1) and at 30 degrees. QuadriFlow is "
            "asked up to three times until it comes near our number; what it keeps of thin parts changes with the last "
            "digits of its input.\n"
        )
    return text


if __name__ == "__main__":
    main(BENCHMARK)
