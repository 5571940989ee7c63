# The benchmarks run rarely, and what they import changes: all of them load, what they share does what their tables rest
# on, four small experiments run, and the page about them names every script, experiment and option.
# SPDX-License-Identifier: GPL-3.0-or-later
import importlib
import re

import numpy as np
import pytest

from helpers import CHECKOUT

pytest.importorskip("pymeshlab_curvature_lines", reason="tests a plugin file, not the package")

from clouds.whole_shapes import EXACT, Shape, from_tangent_planes  # noqa: E402
from figures.mesh import PolygonMesh  # noqa: E402
from figures.whole_mesh import folded_faces, scaled_jacobians  # noqa: E402
from harness import command_line  # noqa: E402
from harness.command_line import Benchmark, Settings, main  # noqa: E402
from harness.comparison import Case, Column, Comparison, Outcome, one, seed_rows  # noqa: E402
from harness.verdicts import Bound, Target, bound_cells, number, verdict  # noqa: E402

FOLDER = CHECKOUT / "benchmarks"
MODULES = sorted(
    ".".join(file.relative_to(FOLDER).with_suffix("").parts)
    for file in FOLDER.rglob("*.py")
    if file.name != "__init__.py"
)
TABLES = sorted(file.stem for file in (FOLDER / "results").glob("*.md"))


def test_there_are_modules_and_tables():
    assert len(MODULES) > 20 and len(TABLES) > 5


@pytest.mark.parametrize("module", MODULES)
def test_every_module_loads(module):
    importlib.import_module(module)


@pytest.mark.parametrize("table", TABLES)
def test_every_table_has_a_script_of_its_name(table):
    benchmark = importlib.import_module(table).BENCHMARK
    assert benchmark.name == table
    head = (FOLDER / "results" / f"{table}.md").read_text().splitlines()
    assert head[0] == f"# {benchmark.title}"
    assert head[2].startswith(f"Written by `.venv/bin/python benchmarks/{table}.py")


@pytest.mark.parametrize("table", TABLES)
def test_the_page_names_script_experiments_and_options(table):
    benchmark = importlib.import_module(table).BENCHMARK
    page = (FOLDER / "README.md").read_text()
    row = next(line for line in page.splitlines() if line.startswith(f"| `{table}.py`"))
    assert set(re.findall(r"`(\w+)`", row)) == set(benchmark.experiments)
    options = {command_line.OPTIONS[key][0] for key in benchmark.options} | ({"--data"} if benchmark.data else set())
    assert set(re.findall(r"--[a-z-]+", row)) == options


def test_number_and_verdict():
    assert [number(value) for value in (0.012345, 1234.0, float("nan"))] == ["0.0123", "1.23e+03", "–"]
    assert verdict(1.0, Target(2.0, 1.0)) == ["2", "1", "aim"]
    assert verdict(1.5, Target(2.0, 1.0)) == ["2", "1", "must"]
    assert verdict(2.5, Target(2.0, 1.0)) == ["2", "1", "**missed**"]
    assert verdict(95.0, Target(90.0, 99.0, at_least=True)) == ["90", "99", "must"]
    assert verdict(1.0, None) == ["–", "–", ""]
    assert bound_cells(Bound(0.5, at_least=True), 0.4, 0.6) == ["≥ 0.5", "**no**", "yes"]
    assert bound_cells(None, 0.4, 0.6) == ["–", "", ""]


def test_rows_of_seeds_are_judged_by_the_worst():
    outcome = Outcome()
    for error, share in ((1.0, 90.0), (3.0, 95.0), (2.0, 99.0)):
        outcome.add({"error": error, "share": share})
    assert seed_rows("torus", outcome, {"share": Target(92.0, 98.0, at_least=True)}) == [
        ["torus: error", "2", "3", "–", "–", ""],
        ["torus: share", "95", "90", "92", "98", "**missed**"],
    ]


def test_a_comparison_beside_peers():
    runs = []

    def peer(offset):
        def run(cloud):
            runs.append(offset)
            return cloud + offset

        return run

    columns = [
        one("near", peer(1.0)),
        Column("best", {"near": peer(1.0), "nearer": peer(0.5)}),
        one("crashes", lambda cloud: None),
        one("at times", lambda cloud: None if cloud == 2.0 else cloud),
    ]
    comparison = Comparison(lambda cloud: cloud, lambda: columns)
    cases = [
        Case("quick", float, {"error": Target(2.0, 1.0)}, quick=True),
        Case("one seed", float, one_seed=True),
    ]

    def figures(cloud, result):
        return {"error": result, "of no meaning": float("nan")}

    table = comparison.table(cases, Settings(seed_count=3), figures).splitlines()
    assert table[0] == "| cloud | figure | ours | worst seed | must | aim | met | near | best | crashes | at times |"
    assert table[2:] == [
        "| quick | error | 2 | 3 | 2 | 1 | must | 3 | 2.5 (nearer) | crash | 2 (crash: 1 of 3 seeds) |",
        "| one seed | error | 1 | 1 | – | – |  | 2 | 1.5 (nearer) | crash | 1 |",
    ]
    assert runs.count(1.0) == runs.count(0.5) == 4  # a method in two columns runs once a cloud

    alone = comparison.table(cases, Settings(quick=True, peers=False), figures).splitlines()
    assert alone[2:] == ["| quick | error | 1 | 1 | 2 | 1 | aim |"]


@pytest.fixture
def benchmark(monkeypatch):
    """One of two sections, and the result files it writes instead of real ones."""
    made = Benchmark("made", "Made", options=("quick", "peers", "seeds", "targets", "scale_mode"), data="nothing is")
    made.introduction(lambda settings: f"Over {settings.seeds_in_words}.\n")
    made.experiment("first", "First")(lambda settings: f"{settings.parameters}\n")
    made.experiment("second", "Second")(lambda settings: f"{settings.peers}\n")
    made.written = []
    monkeypatch.setattr(command_line, "write_result", lambda *words: made.written.append(words))
    return made


def test_the_whole_benchmark_writes_its_file(benchmark):
    main(
        benchmark, ["--data", "scans", "--without-peers", "--scale-mode", "Paper", "--seeds", "3", "--targets", "0,300"]
    )
    body = "Over seeds 1 to 3.\n\n## First\n\n{'scale_mode': 'Paper'}\n\n## Second\n\nFalse\n"
    command = "made.py --data FOLDER --without-peers --scale-mode Paper --seeds 3 --targets 0,300"
    assert benchmark.written == [("made", command, "Made", body)]


@pytest.mark.parametrize(("arguments", "headings"), [(["second"], ["Second"]), (["--quick"], ["First", "Second"])])
def test_a_part_of_it_goes_to_the_screen(benchmark, capsys, arguments, headings):
    main(benchmark, arguments)
    assert re.findall("## (.*)", capsys.readouterr().out) == headings
    assert not benchmark.written


def test_an_experiment_that_does_not_exist(benchmark, capsys):
    with pytest.raises(SystemExit):
        main(benchmark, ["third"])
    assert "no experiment is called third" in capsys.readouterr().err


@pytest.mark.parametrize("name", EXACT)
def test_points_of_an_exact_shape_lie_on_it(name):
    shape = EXACT[name].shape()
    step = 0.01 * shape.diagonal
    assert shape.distance(shape.truth).max() < 1e-9 * shape.diagonal
    moved = shape.distance(shape.truth + step * shape.normals)
    assert np.median(moved) == pytest.approx(step, rel=0.01) and moved.max() < 1.02 * step


FLAT_GRID = np.array([[x, y, 0.0] for y in range(9) for x in range(9)])


def cells(moved=()):
    """A mesh of the squares of the grid, some of its vertices (index, position) elsewhere."""
    vertices = FLAT_GRID.copy()
    for vertex, position in moved:
        vertices[vertex] = position
    faces = [np.array([i, i + 1, i + 10, i + 9]) + 9 * j for j in range(8) for i in range(8)]
    return PolygonMesh(vertices, faces)


def test_folded_faces_and_jacobians_of_a_flat_grid():
    up = np.tile([0.0, 0.0, 1.0], (len(FLAT_GRID), 1))
    shape = Shape(FLAT_GRID, up, from_tangent_planes(FLAT_GRID, up))
    assert not folded_faces(shape, cells()).any()
    assert scaled_jacobians(cells()) == pytest.approx(1.0)
    # Vertex 40 is the middle one; beyond the opposite corner of one of its squares, that square is turned over.
    across = cells([(40, [5.6, 5.6, 0.0])])
    assert np.flatnonzero(folded_faces(shape, across)).tolist() == [36]
    assert scaled_jacobians(across)[36] < 0.0 < scaled_jacobians(across)[0]


@pytest.mark.parametrize(
    ("table", "arguments", "rows"),
    [
        ("curvature", ["random_normals", "--quick", "--without-peers"], 2),
        ("paper_figures", ["edge", "--quick"], 6),
        ("quad_mesh", ["small", "--quick", "--without-peers"], 26),
        ("real_shapes", ["capsule", "--quick", "--without-peers"], 5),
    ],
)
def test_a_small_experiment_runs(table, arguments, rows, capsys):
    main(importlib.import_module(table).BENCHMARK, arguments)
    lines = [line for line in capsys.readouterr().out.splitlines() if line.startswith("| ")]
    lines = [line for line in lines if "---" not in line and "figure" not in line]
    assert len(lines) == rows
    assert not any("crash" in line for line in lines)
