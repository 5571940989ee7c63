# What scripts rely on: every filter with its menu name, and every parameter with its default and another value to try.
# The tests walk the filters the plugin brings; one that is missing here makes them fail.
# SPDX-License-Identifier: GPL-3.0-or-later
import functools
import tempfile
import xml.etree.ElementTree as ElementTree
from collections import namedtuple
from pathlib import Path

import numpy as np
import pymeshlab

from helpers import (
    CURVATURE,
    DENOISE,
    FEATURES,
    FILTERS,
    M_WEIGHTED,
    MESH,
    NORMALS,
    OUTLIERS,
    PIPELINE,
    PROJECT,
    RAY_TRACE,
    SMOOTH,
    TRACE,
    generate,
    layer_of,
)

Filter = namedtuple("Filter", "menu_name, parameters")
Choice = namedtuple("Choice", "labels, default", defaults=[0])  # an enum; default: index of a label
Number = namedtuple("Number", "default, other")
Flag = namedtuple("Flag", "default")
Layer = namedtuple("Layer", "default, other")  # id of a layer of document()
File = namedtuple("File", "suffix")
Color = namedtuple("Color", "default, other")  # red, green, blue, alpha
Point = namedtuple("Point", "default, other")

SCALARS = Choice(["Mean", "Gaussian", "K1", "K2", "Curvedness", "Shape Index", "Confidence"])
SCALES = Choice(["Adaptive", "Paper"])
QUADS = ["Pure", "Dominant", "Subdivided"]
CLOUD, OTHER_CLOUD, LINES = range(3)  # the layers of document()

CONTRACT = {
    NORMALS: Filter("Estimate and Orient Normals", {
        "orientation": Choice(["Automatic", "Viewpoint", "Up"]), "viewpoint": Point((0, 0, 0), (0, 0, 9)), "flip": Flag(False),
        "neighbors": Number(0, 30),
    }),
    CURVATURE: Filter("Robust Curvature (M-Estimation)", {
        "scale_mode": SCALES, "region_scale": Number(3.0, 4.0), "max_iterations": Number(30, 12), "feature_gate": Flag(True),
        "boundary_threshold": Number(2.5, 3.0), "correct_normals": Flag(False), "scalar": SCALARS, "colorize": Flag(True),
        "umbilic_ratio": Number(0.95, 0.9),
    }),
    OUTLIERS: Filter("Select Outliers by Robust Curvature", {
        "mode": Choice(["Robust", "Paper"]), "sensitivity": Number(3.5, 2.5), "vote_threshold": Number(0.5, 0.6), "rounds": Number(3, 2),
        "reject_unstructured": Flag(False), "delete_selected": Flag(False),
    }),
    DENOISE: Filter("Denoise Point Cloud by Robust Curvature", {
        "method": Choice(["Robust", "Paper"]), "noise": Number(0.0, 0.01), "radius": Number(0.0, 6.5), "iterations": Number(100, 5),
        "energy": Choice(["Square Root", "Squared"]), "optimizer": Choice(["L-BFGS-B", "Polak-Ribiere"]),
        "neighbors": Choice(["Six Sectors", "Nearest"]),
    }),
    SMOOTH: Filter("Smooth Principal Directions", {"alpha": Number(0.5, 0.7), "iterations": Number(100, 7)}),
    TRACE: Filter("Trace Lines of Curvature", {
        "method": Choice(["Traced Lines", "Position Field"]), "epsilon": Number(1e-5, 5e-3), "target_vertices": Number(0, 120),
        "min_spacing": Number(0.0, 0.15), "max_spacing": Number(0.0, 0.6), "tolerance": Number(0.01, 0.02),
        "projection": Choice(["Mixed", "Locally Optimal", "Weighted Average"]), "stop_factor": Number(0.7, 0.5),
        "umbilic_ratio": Number(0.95, 0.9), "smooth_directions": Flag(True),
    }),
    FEATURES: Filter("Extract Sharp Feature Lines", {
        "min_angle": Number(30.0, 40.0), "spacing": Number(0.0, 0.03), "denoise": Flag(True),
    }),
    MESH: Filter("Build Curvature-Aligned Quad Mesh", {
        "point_cloud": Layer(CLOUD, OTHER_CLOUD), "quads": Choice(QUADS, default=1), "triangulate": Flag(False), "close_holes": Flag(False),
        "texture_coordinates": Flag(False), "split_concave": Flag(True),
    }),
    PIPELINE: Filter("Surface Reconstruction: Curvature-Aligned Quads", {
        "method": Choice(["Position Field", "Traced Lines"]), "target_vertices": Number(0, 80), "epsilon": Number(0.0, 0.01),
        "anisotropy": Number(1.5, 1.2), "points_per_vertex": Number(24.0, 12.0), "hole_size": Number(8.0, 4.0),
        "quads": Choice(QUADS), "triangulate": Flag(False), "close_holes": Flag(False), "texture_coordinates": Flag(False),
        "reject_outliers": Flag(True), "reject_unstructured": Flag(False), "denoise": Flag(True), "smooth_directions": Flag(True),
        "estimate_normals": Choice(["If Missing", "Never", "Always"]), "scale_mode": SCALES, "keep_intermediate_layers": Flag(False),
    }),
    M_WEIGHTED: Filter("M-Weighted Curvature (Euler Least Squares)", {
        "bandwidth": Number(2.5, 3.0), "exponent": Number(2, 3), "neighbors": Number(60, 40),
        "weighting": Choice(["M", "Gaussian", "Unweighted"]), "scalar": SCALARS, "colorize": Flag(True), "umbilic_ratio": Number(0.95, 0.9),
    }),
    PROJECT: Filter("Curvature-Driven Projection", {
        "control_mesh": Layer(CLOUD, OTHER_CLOUD), "proxy_mesh": Layer(CLOUD, LINES), "bandwidth": Number(1.6, 2.0),
        "diffusion_steps": Number(10, 4), "diffusion_function": Choice(["Hermite", "Cutoff", "Rational"]), "resample": Number(1, 2),
    }),
    RAY_TRACE: Filter("Ray-Trace Point-Set Surface", {
        "image_file": File(".png"), "width": Number(533, 60), "height": Number(400, 40),
        "surface": Choice(["Curvature-Driven", "Moving Least Squares"]), "background": Color((255, 255, 255, 255), (10, 20, 30, 255)),
        "color_by": Choice(["Plain", "Curvature", "Vertex Colour"]), "lines": Layer(CLOUD, LINES),
        "camera": Choice(["Automatic", "Given"]), "camera_position": Point((0, 0, 2), (0, 1, 4)), "camera_target": Point((0, 0, 0), (0, 0.1, 0)),
        "camera_up": Point((0, 1, 0), (1, 0, 0)), "field_of_view": Number(30.0, 35.0),
    }),
}  # fmt: skip


SHAPES = {FEATURES: "cube"}  # that have what the filter looks for; else a torus


@functools.cache
def clouds(surface):
    return [generate(surface, 600, noise=0.005, outliers=0.01, seed=seed, scanned=True) for seed in (2, 3)]


def document(name, change=lambda cloud: cloud):
    """What the filter is run on: two clouds, and lines of the first where it takes layers. Each cloud goes through `change`."""
    cloud, other = (change(cloud) for cloud in clouds(SHAPES.get(name, "torus")))
    meshes = layer_of(cloud)
    if any(isinstance(parameter, Layer) for parameter in CONTRACT[name].parameters.values()):
        meshes.add_mesh(pymeshlab.Mesh(other["positions"], v_normals_matrix=other["input_normals"]))
        meshes.set_current_mesh(CLOUD)
        meshes.apply_filter(TRACE, epsilon=0.01, smooth_directions=False)
        meshes.set_current_mesh(LINES if name == MESH else CLOUD)
        meshes.clear_filter_script()
    return meshes


def files_of(name, folder):
    """Values of the parameters that name files; they have no default."""
    parameters = CONTRACT[name].parameters.items()
    return {key: str(folder / f"{key}{value.suffix}") for key, value in parameters if isinstance(value, File)}


def another(parameter, turn):
    """A value that is not the default; of an enum, its label number `turn`, round and round."""
    if isinstance(parameter, Choice):
        return parameter.labels[turn % len(parameter.labels)]
    if isinstance(parameter, Flag):
        return not parameter.default
    if isinstance(parameter, Color):
        return pymeshlab.Color(*parameter.other)
    return np.array(parameter.other, dtype=float) if isinstance(parameter, Point) else parameter.other


def turns(name):
    """So many that every label of every enum has its turn."""
    return max([1, *(len(value.labels) for value in CONTRACT[name].parameters.values() if isinstance(value, Choice))])


def values(name, turn, folder):
    """Nothing at its default but the enums whose turn it is; turn None: all defaults."""
    given = files_of(name, folder)
    if turn is not None:
        given = {
            key: given.get(key) or another(parameter, turn) for key, parameter in CONTRACT[name].parameters.items()
        }
    return given


def cases():
    """(filter, turn) for all filters the plugin brings, known here or not."""
    return [(name, turn) for name in FILTERS for turn in ([None, *range(turns(name))] if name in CONTRACT else [None])]


def case_id(value):
    return {None: "defaults"}.get(value, str(value))


def written(parameter, value, script):
    """Whether the entry of a filter script holds the value."""
    if isinstance(parameter, Choice):
        return parameter.labels[int(script["value"])] == value
    if isinstance(parameter, Color):
        return [int(script[key]) for key in "rgba"] == [value.red(), value.green(), value.blue(), value.alpha()]
    if isinstance(parameter, Point):
        return np.allclose([float(script[key]) for key in "xyz"], value)
    if isinstance(parameter, Flag):
        return script["value"] == str(value).lower()
    if isinstance(parameter, File):
        return script["value"] == value
    return np.isclose(float(script["value"]), value, rtol=1e-6, atol=0.0)


def entries(script):
    """Per filter of a filter script: its menu name, and the attributes of every parameter by its name."""
    return [
        (entry.get("name"), {parameter.get("name"): parameter.attrib for parameter in entry.iter("Param")})
        for entry in ElementTree.parse(script).getroot().iter("filter")
    ]


@functools.cache
def declared(name):
    """The parameters as the host declares them: it writes them into a script of what it did."""
    with tempfile.TemporaryDirectory() as folder:
        meshes = document(name)
        meshes.apply_filter(name, **files_of(name, Path(folder)))
        meshes.save_filter_script(folder + "/script.mlx")
        return entries(folder + "/script.mlx")[0]
