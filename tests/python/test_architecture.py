# The rules of the two rings, read from the sources: rooms with one direction, no cycles, no host in core/, short
# functions, and a test file where its unit is.
# SPDX-License-Identifier: GPL-3.0-or-later
import re
from graphlib import CycleError, TopologicalSorter

import pytest

from helpers import CHECKOUT

CORE = CHECKOUT / "filter_curvature_lines/core"
PLUGIN = CHECKOUT / "filter_curvature_lines/plugin"
TESTS = CHECKOUT / "tests/core"

LONGEST_FUNCTION = 90  # lines between the braces

# Units without a test file of their own, with the one that tests them.
PARTS_OF_A_STAGE = {
    "normals/side_domains": "normals/normal_estimation",
    "normals/winding_field": "normals/normal_estimation",
    "cleaning/outlier_groups": "cleaning/outlier_rejection",
    "cleaning/robust_outliers": "cleaning/outlier_rejection",
    "fitting/face_projection": "cleaning/robust_denoising",
    "fitting/point_deviation": "cleaning/robust_denoising",
}
# Units with next to nothing that could be wrong by itself: results without functions, interfaces, a few short loops.
NOTHING_OF_THEIR_OWN = {
    "base/block_size",
    "base/simd_dispatch",
    "cleaning/outlier_result",
    "fitting/monomials",
    "lines/line_crossing",
    "position_field/phase_pins",
}


def rooms_of(text):
    """From each room to those on its link line, in the order of the file, which is lower rooms first."""
    return {
        name: rest.partition("LIBRARIES")[0].split()[1:]
        for name, rest in re.findall(r"^add_room\((\w+)([^)]*)\)", text, re.M)
    }


ROOMS = rooms_of((CORE / "CMakeLists.txt").read_text())


def sources(folder):
    return sorted(file for file in folder.rglob("*") if file.suffix in (".h", ".cpp"))


def unit_of(file):
    """Room and name. The loops of a unit for one set of instructions are part of it."""
    return f"{file.parent.name}/{re.sub('_(simd|avx2)$', '', file.stem)}"


UNITS = {unit_of(file) for file in sources(CORE)}


def includes(file):
    """What a file includes: own headers with quotes, others in angle brackets."""
    text = file.read_text()
    return re.findall(r'^\s*#\s*include\s*"(.+)"', text, re.M), re.findall(r"^\s*#\s*include\s*<(.+)>", text, re.M)


def uses(folder):
    """From each unit of a folder, header and source together, to the units of the folder that it includes."""
    home = {file.name: unit_of(file) for file in sources(folder)}
    graph = {unit: set() for unit in home.values()}
    for file in sources(folder):
        graph[unit_of(file)] |= {home[name] for name in includes(file)[0] if name in home} - {unit_of(file)}
    assert graph and any(graph.values())
    return graph


def cycle_in(graph):
    try:
        TopologicalSorter(graph).prepare()
    except CycleError as error:
        return " -> ".join(error.args[1])
    return None


def below(unit, graph):
    """The units that a unit includes, and those that these include, and so on."""
    found, new = set(), {unit}
    while new:
        found |= new
        new = set().union(*(graph[each] for each in new)) - found
    return found - {unit}


def functions(text):
    """(first line, lines of the body) of every function: its braces stand alone in their column, others do not."""
    lines = text.split("\n")
    number = 0
    while number < len(lines):
        if brace := re.fullmatch(r"(\t*)\{", lines[number]):
            end = next(i for i in range(number, len(lines)) if lines[i].startswith(brace[1] + "}"))
            yield number + 1, end - number - 1
            number = end
        number += 1


def test_what_reads_the_sources_finds_faults():
    assert rooms_of("add_room(a)\nadd_room(b USES a LIBRARIES x::y)\nadd_room(c USES b a)") == {
        "a": [],
        "b": ["a"],
        "c": ["b", "a"],
    }
    assert cycle_in({"a": {"b"}, "b": {"a"}, "c": set()})
    assert cycle_in({"a": {"b"}, "b": set()}) is None
    assert below("a", {"a": {"b"}, "b": {"c"}, "c": set(), "d": {"a"}}) == {"b", "c"}
    assert list(functions("int f()\n{\n\tif (x) {\n\t\ty();\n\t}\n}\nint g()\n{\n}")) == [(2, 3), (8, 0)]


def test_rooms_are_the_folders_of_core():
    assert len(ROOMS) > 5 and len(UNITS) > 50
    assert {file.parent for file in sources(CORE)} == {CORE / name for name in ROOMS}
    headers = [file.name for file in (*sources(CORE), *sources(PLUGIN)) if file.suffix == ".h"]
    assert len(headers) == len(set(headers)), "an include names a header without its room"


def test_a_room_lists_only_lower_rooms():
    lower = set()
    for name, used in ROOMS.items():
        assert set(used) <= lower, name
        lower.add(name)


@pytest.mark.parametrize("room", ROOMS)
def test_a_room_includes_what_its_link_line_lists(room):
    home = {file.name: file.parent.name for file in sources(CORE)}
    files = sources(CORE / room)
    assert files
    for file in files:
        for name in includes(file)[0]:
            assert name in home, f"{file.name}: {name} is no header of core/"
            assert home[name] in (room, *ROOMS[room]), f"{file.name}: {name} is in {home[name]}"


@pytest.mark.parametrize("room", ROOMS)
def test_a_room_needs_every_room_on_its_link_line(room):
    home = {file.name: file.parent.name for file in sources(CORE)}
    used = {home[name] for file in sources(CORE / room) for name in includes(file)[0]}
    assert set(ROOMS[room]) <= used


@pytest.mark.parametrize("ring", [CORE, PLUGIN], ids=["core", "plugin"])
def test_no_cycle_between_files(ring):
    assert cycle_in(uses(ring)) is None


def test_core_knows_no_host():
    found = {name for file in sources(CORE) for name in includes(file)[1]}
    assert "vector" in found and "Eigen/Dense" in found
    hosts = re.compile(r"(Q[A-Z]|Qt|vcg/|wrap/|common/|meshlab)")
    assert not [name for name in found if hosts.match(name)]


def test_the_seam_computes_nothing():
    found = {name for file in sources(PLUGIN) for name in includes(file)[1]}
    assert any(name.startswith("common/") for name in found)
    numerical = re.compile(r"(CGAL/|LBFGS|dlib/|nanoflann|boost/math/|omp\.h|Eigen/(?!Core|Geometry))")
    assert not [name for name in found if numerical.match(name)]


@pytest.mark.parametrize("ring", [CORE, PLUGIN], ids=["core", "plugin"])
def test_functions_fit_in_a_page_or_two(ring):
    found = [(lines, f"{file.name}:{first}") for file in sources(ring) for first, lines in functions(file.read_text())]
    assert len(found) > 50
    assert not [each for each in sorted(found) if each[0] > LONGEST_FUNCTION]


def test_test_files_stand_where_their_units_do():
    files = sorted(TESTS.rglob("*_test.cpp"))
    assert len(files) > 30
    for file in files:
        assert f"{file.parent.name}/{file.stem.removesuffix('_test')}" in UNITS, file.name


def test_every_unit_has_a_test():
    tested = {f"{file.parent.name}/{file.stem.removesuffix('_test')}" for file in TESTS.rglob("*_test.cpp")}
    listed = NOTHING_OF_THEIR_OWN | PARTS_OF_A_STAGE.keys()
    assert not UNITS - tested - listed, "units without a test"
    assert not listed - UNITS, "listed, but not there"
    assert not listed & tested, "listed, but tested: take them off the list"
    graph = uses(CORE)
    for unit, stage in PARTS_OF_A_STAGE.items():
        included = includes(TESTS / f"{stage}_test.cpp")[0]
        assert unit in below(stage, graph) or f"{unit.split('/')[1]}.h" in included, f"{stage} does not test {unit}"


@pytest.mark.parametrize("file", sorted(TESTS.rglob("*.h")), ids=lambda file: file.stem)
def test_headers_of_tests_are_used(file):
    assert any(file.name in includes(user)[0] for user in TESTS.rglob("*_test.cpp"))
