# Filter scripts: what was saved after a run does the same again.
# SPDX-License-Identifier: GPL-3.0-or-later
import xml.etree.ElementTree as ElementTree

import pymeshlab
import pytest

from helpers import (
    CURVATURE,
    DENOISE,
    FEATURES,
    M_WEIGHTED,
    MESH,
    OUTLIERS,
    PIPELINE,
    SMOOTH,
    TRACE,
    attribute,
    layer_of,
    snapshot,
)

CHAINS = {
    "curvature": [(CURVATURE, {"scalar": "Shape Index", "correct_normals": True})],
    "published_curvature": [
        (CURVATURE, {"scale_mode": "Paper", "scalar": "Shape Index", "region_scale": 4.0, "correct_normals": True})
    ],
    "m_weighted_curvature": [(M_WEIGHTED, {"bandwidth": 3.0, "weighting": "Gaussian", "scalar": "K1", "colorize": False})],
    "outliers": [(OUTLIERS, {"mode": "Paper", "vote_threshold": 0.6, "delete_selected": True})],
    "denoising": [(DENOISE, {"noise": 0.01, "radius": 6.5})],
    "published_denoising": [
        (DENOISE, {"method": "Paper", "iterations": 5, "energy": "Squared", "neighbors": "Nearest"})
    ],
    "lines_and_mesh": [(SMOOTH, {"alpha": 0.7}), (TRACE, {"target_vertices": 120}), (MESH, {"triangulate": True})],
    "sharp_features": [(FEATURES, {"min_angle": 40.0, "spacing": 0.03, "denoise": False})],
    "pipeline": [(PIPELINE, {"target_vertices": 80, "denoise": False, "reject_outliers": False, "keep_intermediate_layers": True})],
}


@pytest.mark.parametrize("chain", CHAINS)
def test_script_does_what_the_calls_did(noisy_torus, tmp_path, chain):
    direct, scripted = layer_of(noisy_torus), layer_of(noisy_torus)
    for name, parameters in CHAINS[chain]:
        direct.apply_filter(name, **parameters)
    direct.save_filter_script(str(tmp_path / "chain.mlx"))
    scripted.load_filter_script(str(tmp_path / "chain.mlx"))
    scripted.apply_filter_script()
    assert snapshot(scripted) == snapshot(direct)


def test_script_is_complete_and_keyed_by_menu_names(noisy_torus, tmp_path):
    meshes = layer_of(noisy_torus)
    meshes.apply_filter(CURVATURE)
    meshes.save_filter_script(str(tmp_path / "script.mlx"))
    entry = ElementTree.parse(tmp_path / "script.mlx").getroot().find("filter")
    assert entry.get("name") == "Robust Curvature (M-Estimation)"
    # MeshLab's window runs a script as it is: every parameter must be there
    names = {parameter.get("name") for parameter in entry.iter("Param")}
    assert names == set(meshes.filter_parameter_values(CURVATURE))


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
    assert (attribute(scripted, "curv_k1") == attribute(direct, "curv_k1")).all()


NAMES = {
    CURVATURE: "Robust Curvature (M-Estimation)",
    OUTLIERS: "Select Outliers by Robust Curvature",
    DENOISE: "Denoise Point Cloud by Robust Curvature",
    SMOOTH: "Smooth Principal Directions",
    TRACE: "Trace Lines of Curvature",
    MESH: "Build Curvature-Aligned Quad Mesh",
    PIPELINE: "Surface Reconstruction: Curvature-Aligned Quads",
    FEATURES: "Extract Sharp Feature Lines",
    M_WEIGHTED: "M-Weighted Curvature (Euler Least Squares)",
}
PARAMETERS = {
    CURVATURE: {"scale_mode": 0, "region_scale": 3.0, "max_iterations": 30, "feature_gate": True, "correct_normals": False, "scalar": 0,
                "colorize": True, "boundary_threshold": 2.5, "umbilic_ratio": 0.95},
    OUTLIERS: {"mode": 0, "sensitivity": 3.5, "vote_threshold": 0.5, "rounds": 3, "delete_selected": False},
    DENOISE: {"method": 0, "noise": 0.0, "radius": 0.0, "iterations": 100, "energy": 0, "optimizer": 0, "neighbors": 0},
    SMOOTH: {"alpha": 0.5},
    TRACE: {"method": 0, "stop_factor": 0.7, "epsilon": 1e-5, "target_vertices": 0, "min_spacing": 0.0, "max_spacing": 0.0, "tolerance": 0.01,
            "projection": 0, "umbilic_ratio": 0.95, "smooth_directions": True},
    MESH: {"triangulate": False, "split_concave": True, "close_holes": False},
    PIPELINE: {"method": 0, "target_vertices": 0, "anisotropy": 1.5, "triangulate": False, "close_holes": False, "reject_outliers": True,
               "denoise": True, "smooth_directions": True, "estimate_normals": 0, "scale_mode": 0, "keep_intermediate_layers": False},
    FEATURES: {"min_angle": 30.0, "spacing": 0.0, "denoise": True},
    M_WEIGHTED: {"bandwidth": 2.5, "exponent": 2, "neighbors": 60, "weighting": 0, "scalar": 0, "colorize": True, "umbilic_ratio": 0.95},
}


@pytest.mark.parametrize("name", NAMES)
def test_names_and_defaults_that_scripts_rely_on(torus, name, tmp_path):
    assert name in pymeshlab.filter_list()
    defaults = layer_of(torus).filter_parameter_values(name)
    for parameter, value in PARAMETERS[name].items():
        assert defaults[parameter] == pytest.approx(value), parameter


@pytest.mark.parametrize(
    "name, parameter, labels",
    [
        (CURVATURE, "scale_mode", ["Adaptive", "Paper"]),
        (PIPELINE, "scale_mode", ["Adaptive", "Paper"]),
        (OUTLIERS, "mode", ["Robust", "Paper"]),
        (DENOISE, "method", ["Robust", "Paper"]),
    ],
)
def test_modes_have_their_places_in_the_enum(noisy_torus, name, parameter, labels, tmp_path):
    meshes = layer_of(noisy_torus)
    meshes.apply_filter(name)
    meshes.save_filter_script(str(tmp_path / "script.mlx"))
    script = ElementTree.parse(tmp_path / "script.mlx").getroot()
    mode = next(entry for entry in script.iter("Param") if entry.get("name") == parameter)
    assert mode.get("value") == "0"
    assert [mode.get(f"enum_val{k}") for k in range(int(mode.get("enum_cardinality")))] == labels


def test_default_layer_of_the_mesh_filter(torus):
    meshes = layer_of(torus)
    assert meshes.filter_parameter_values(MESH)["point_cloud"] == 0
    meshes.apply_filter(TRACE, epsilon=0.02)
    assert meshes.current_mesh_id() == 1 and meshes.filter_parameter_values(MESH)["point_cloud"] == 0
