# The Python examples of the README and the user guide run as they stand, one page after another.
# SPDX-License-Identifier: GPL-3.0-or-later
import re

import pymeshlab
import pytest

from helpers import ATTRIBUTES, CHECKOUT, layer

# The files the examples name, and the sample clouds that stand in for them.
SAMPLES = {"scan.ply": "torus_1600_noise1.ply", "part.ply": "cube_600.ply"}
PAGES = ["README.md", "docs/guide.md"]


def examples(page):
    return re.findall(r"^```python\n(.*?)^```", (CHECKOUT / page).read_text(), re.MULTILINE | re.DOTALL)


@pytest.mark.parametrize("page", PAGES)
def test_examples_run_one_after_another(page, tmp_path, monkeypatch):
    pytest.importorskip("pymeshlab_curvature_lines", reason="tests a plugin file, not the package")
    monkeypatch.chdir(tmp_path)
    for name, sample in SAMPLES.items():
        (tmp_path / name).write_bytes((CHECKOUT / "sample_data" / sample).read_bytes())
    found = examples(page)
    assert found
    names = {}
    for number, source in enumerate(found, start=1):
        exec(compile(source, f"{page}, example {number}", "exec"), names)
    made = {file.name for file in tmp_path.iterdir()} - SAMPLES.keys()
    assert made and all((tmp_path / name).stat().st_size > 0 for name in made)


def test_the_guide_names_every_filter():
    import pymeshlab_curvature_lines as package

    guide = (CHECKOUT / "docs/guide.md").read_text()
    for name in package.filters():
        assert name in guide, name
        assert name in pymeshlab.filter_list()


def test_the_pages_name_only_parameters_and_attributes_that_exist():
    meshes = layer([[0, 0, 0]])
    filters = pytest.importorskip("pymeshlab_curvature_lines").filters()
    known = {name for each in filters for name in (each, *meshes.filter_parameter_values(each))}
    known |= {*ATTRIBUTES, "line_id", "line_family", "line_closed", "line_arc_length", "moved", "normal_doubt"}
    known |= {"debootstrap", "libgl1", "libopengl0"}
    known |= {
        "uncovered_share",
        "largest_gap",
        "folded_faces",
        "limb_vertices",
        "bounded_target",
        "quad_share",
        "cones",
        "inverted_repaired",
        "dropped_components",
        "doubled_share",
        "doubtful_share",
        "normals_disagreeing",
        "normals_estimated",
        "normals_torn",
        "open_share",
        "unstructured_share",
        "warnings",
        "texture_cells",
        "texture_charts",
        "save_wedge_texcoord",
    }  # returned
    for page in PAGES:
        prose = re.sub(r"^```.*?^```", "", (CHECKOUT / page).read_text(), flags=re.MULTILINE | re.DOTALL)
        named = set(re.findall(r"`([a-z_]+\d?)`", prose))
        assert named and named <= known, page


def test_links_lead_somewhere():
    followed = 0
    for page in ["README.md", "docs/guide.md", "docs/gallery.md", "docs/contributing.md", "docs/method.md"]:
        file = CHECKOUT / page
        for target in re.findall(r"\]\(([^)#]+)\)", file.read_text()):
            if "://" not in target:
                assert (file.parent / target).exists(), f"{page}: {target}"
                followed += 1
    assert followed > 20


def test_the_map_for_contributors_shows_rooms_and_units_as_they_are():
    page = (CHECKOUT / "docs/contributing.md").read_text()
    rows = re.findall(r"^\| `(\w+)` \|[^|]+\|([^|]*)\|([^|]+)\|$", page, re.MULTILINE)
    link_lines = (CHECKOUT / "filter_curvature_lines/core/CMakeLists.txt").read_text()
    uses = re.findall(r"^add_room\((\w+)(?: USES([\w ]+?))?(?: LIBRARIES.*)?\)", link_lines, re.MULTILINE)
    assert len(uses) > 5
    assert [(name, used.replace(",", "").split()) for name, used, _ in rows] == [(n, u.split()) for n, u in uses]
    for name, _, units in rows:
        headers = {file.stem for file in (CHECKOUT / "filter_curvature_lines/core" / name).glob("*.h")}
        assert headers
        # The loops of a unit for one set of instructions are part of it.
        assert set(re.findall(r"`(\w+)`", units)) == {re.sub("_simd$", "", stem) for stem in headers}, name


def test_the_method_names_units_that_exist():
    page = (CHECKOUT / "docs/method.md").read_text()
    core = CHECKOUT / "filter_curvature_lines/core"
    rooms = "|".join(folder.name for folder in core.iterdir() if folder.is_dir())
    named = set(re.findall(rf"`((?:{rooms})/[a-z_]+)`", page))
    assert len(named) > 50
    missing = [unit for unit in sorted(named) if not list(core.glob(f"{unit}.*"))]
    assert not missing
