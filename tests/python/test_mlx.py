# Names and defaults that scripts rely on, of every filter the plugin brings; and filter scripts: what was saved after
# a run does the same again.
# SPDX-License-Identifier: GPL-3.0-or-later
import numpy as np
import pymeshlab
import pytest

from filter_table import (
    CONTRACT,
    Choice,
    Color,
    File,
    Flag,
    Layer,
    Number,
    Point,
    case_id,
    cases,
    declared,
    document,
    entries,
    files_of,
    values,
    written,
)
from helpers import CURVATURE, DENOISE, FILTERS, MESH, OUTLIERS, SMOOTH, TRACE, attribute, layer_of, snapshot

KINDS = {
    Choice: ["RichEnum"],
    Number: ["RichInt", "RichFloat"],
    Flag: ["RichBool"],
    Layer: ["RichMesh"],
    File: ["RichSaveFile"],
    Color: ["RichColor"],
    Point: ["RichPosition", "RichDirection"],
}


def test_the_contract_lists_every_filter():
    assert FILTERS and set(FILTERS) == set(CONTRACT)
    assert set(FILTERS) <= set(pymeshlab.filter_list())


@pytest.mark.parametrize("name", FILTERS)
def test_names_defaults_and_labels_are_those_of_the_contract(name):
    menu_name, parameters = declared(name)
    assert menu_name == CONTRACT[name].menu_name
    # MeshLab's window runs a script as it is: every parameter must be there
    assert parameters.keys() == CONTRACT[name].parameters.keys() == document(name).filter_parameter_values(name).keys()
    for key, expected in CONTRACT[name].parameters.items():
        script = parameters[key]
        assert script["type"] in KINDS[type(expected)], key
        if isinstance(expected, Choice):
            assert [script[f"enum_val{k}"] for k in range(int(script["enum_cardinality"]))] == expected.labels, key
            assert script["value"] == str(expected.default), key
        elif isinstance(expected, Color):
            assert written(expected, pymeshlab.Color(*expected.default), script), key
        elif not isinstance(expected, File):
            assert written(expected, expected.default, script), key


def test_values_to_try_are_no_defaults():
    for name, (_, parameters) in CONTRACT.items():
        for key, parameter in parameters.items():
            if isinstance(parameter, Choice):
                assert len(set(parameter.labels)) == len(parameter.labels) > 1, (name, key)
            elif not isinstance(parameter, (Flag, File)):
                assert parameter.default != parameter.other, (name, key)


@pytest.mark.parametrize("name, turn", cases(), ids=case_id)
def test_a_saved_script_holds_what_was_given_and_does_the_same_again(name, turn, tmp_path):
    given = values(name, turn, tmp_path)
    pictures = [tmp_path / given[key] for key in files_of(name, tmp_path)]
    direct, scripted = document(name), document(name)
    before = snapshot(direct)
    direct.apply_filter(name, **given)
    first = [file.read_bytes() for file in pictures]
    for file in pictures:
        file.unlink()

    script = tmp_path / "script.mlx"
    direct.save_filter_script(str(script))
    ((menu_name, parameters),) = entries(script)
    assert menu_name == CONTRACT[name].menu_name
    assert parameters.keys() == CONTRACT[name].parameters.keys()
    for key, value in given.items():
        assert written(CONTRACT[name].parameters[key], value, parameters[key]), (key, value, parameters[key])

    scripted.load_filter_script(str(script))
    scripted.apply_filter_script()
    assert snapshot(scripted) == snapshot(direct)
    assert [file.read_bytes() for file in pictures] == first
    assert pictures or snapshot(direct) != before

    scripted.save_filter_script(str(tmp_path / "again.mlx"))
    assert entries(tmp_path / "again.mlx") == entries(script)


CHAINS = {
    "lines_and_mesh": [(SMOOTH, {"alpha": 0.7}), (TRACE, {"target_vertices": 120}), (MESH, {"triangulate": True})],
    "cleaning_and_curvature": [
        (OUTLIERS, {"delete_selected": True}),
        (DENOISE, {"radius": 6.5}),
        (CURVATURE, {"correct_normals": True}),
    ],
}


@pytest.mark.parametrize("chain", CHAINS)
def test_script_of_several_filters_does_what_the_calls_did(noisy_torus, tmp_path, chain):
    direct, scripted = layer_of(noisy_torus), layer_of(noisy_torus)
    for name, parameters in CHAINS[chain]:
        direct.apply_filter(name, **parameters)
    direct.save_filter_script(str(tmp_path / "chain.mlx"))
    scripted.load_filter_script(str(tmp_path / "chain.mlx"))
    scripted.apply_filter_script()
    assert snapshot(scripted) == snapshot(direct)


def test_script_that_leaves_parameters_out_takes_the_defaults(noisy_torus, tmp_path):
    (tmp_path / "short.mlx").write_text(
        '<!DOCTYPE FilterScript><FilterScript><filter name="Robust Curvature (M-Estimation)">'
        '<Param name="scale_mode" type="RichEnum" value="1" enum_cardinality="2" enum_val0="Adaptive" enum_val1="Paper"/>'
        '<Param name="region_scale" type="RichFloat" value="4"/></filter></FilterScript>'
    )
    scripted, direct = layer_of(noisy_torus), layer_of(noisy_torus)
    scripted.load_filter_script(str(tmp_path / "short.mlx"))
    scripted.apply_filter_script()
    direct.apply_filter(CURVATURE, scale_mode="Paper", region_scale=4.0)
    assert np.array_equal(attribute(scripted, "curv_k1"), attribute(direct, "curv_k1"))


def test_default_layer_of_the_mesh_filter(torus):
    meshes = layer_of(torus)
    assert meshes.filter_parameter_values(MESH)["point_cloud"] == 0
    meshes.apply_filter(TRACE, epsilon=0.02)
    assert meshes.current_mesh_id() == 1 and meshes.filter_parameter_values(MESH)["point_cloud"] == 0
