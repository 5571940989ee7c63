# The filter scripts that come with the package: complete, up to date, and the same as the calls, on any model.
# SPDX-License-Identifier: GPL-3.0-or-later
import sys
import xml.etree.ElementTree as ElementTree

import pymeshlab
import pytest

from helpers import CHECKOUT, snapshot

FOLDER = CHECKOUT / "python_bindings/filter_scripts"
MODELS = ["torus_1600_noise1.ply", "helicoid_1730_noise0.5_outliers5.ply", "cube_600.ply"]
NAMES = sorted(file.stem for file in FOLDER.glob("*.mlx"))


@pytest.fixture(scope="module")
def written():
    pytest.importorskip("pymeshlab_curvature_lines", reason="tests a plugin file, not the package")
    sys.path.insert(0, str(FOLDER))
    import write_scripts

    return write_scripts


def parameters(file):
    """Per filter: its menu name, and name, type, value and choices of every parameter."""
    return [
        (entry.get("name"), sorted(sorted(parameter.attrib.items()) for parameter in entry.iter("Param")))
        for entry in ElementTree.parse(file).getroot().iter("filter")
    ]


def test_there_is_a_file_for_every_script(written):
    assert NAMES == sorted(written.SCRIPTS)


@pytest.mark.parametrize("name", NAMES)
def test_files_are_complete_and_up_to_date(written, name, tmp_path):
    stale = f"run {FOLDER.relative_to(CHECKOUT)}/write_scripts.py"
    assert parameters(FOLDER / f"{name}.mlx") == parameters(written.write(name, tmp_path)), stale


@pytest.mark.parametrize("model", MODELS)
@pytest.mark.parametrize("name", NAMES)
def test_script_does_what_the_calls_do(written, name, model):
    scripted, direct = pymeshlab.MeshSet(), pymeshlab.MeshSet()
    for meshes in (scripted, direct):
        meshes.load_new_mesh(str(CHECKOUT / "sample_data" / model))
    before = snapshot(scripted)
    scripted.load_filter_script(str(FOLDER / f"{name}.mlx"))
    scripted.apply_filter_script()
    for function, given in written.SCRIPTS[name]:
        direct.apply_filter(function, **given)
    assert snapshot(scripted) == snapshot(direct) != before


@pytest.mark.parametrize("name, layer", [("pipeline", "curvature-aligned mesh"), ("lines", "lines of curvature")])
def test_script_run_twice_adds_its_layers_again(name, layer):
    meshes = pymeshlab.MeshSet()
    meshes.load_new_mesh(str(CHECKOUT / "sample_data/torus_1600_noise1.ply"))
    meshes.load_filter_script(str(FOLDER / f"{name}.mlx"))
    meshes.apply_filter_script()
    meshes.set_current_mesh(0)
    meshes.apply_filter_script()
    assert [mesh.label().startswith(layer) for mesh in meshes] == [False, True, True]
