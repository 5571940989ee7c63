# Clouds as layers, snapshots of layers, and the dictionaries every filter returns. The benchmarks use it too
# (benchmarks/harness/shared.py).
# SPDX-License-Identifier: GPL-3.0-or-later
import os
import sys
from pathlib import Path

import numpy as np
import pymeshlab

CHECKOUT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(CHECKOUT / "sample_data"))

import analytic_surfaces  # noqa: E402

NORMALS = "compute_normals_robust_point_cloud"
CURVATURE = "compute_curvature_robust_per_vertex"
OUTLIERS = "compute_selection_point_cloud_outliers_by_curvature"
DENOISE = "apply_coord_point_cloud_robust_denoising"
SMOOTH = "apply_curvature_direction_smoothing_per_vertex"
TRACE = "generate_curvature_lines"
FEATURES = "generate_sharp_feature_lines"
MESH = "generate_curvature_aligned_quad_mesh"
PIPELINE = "generate_surface_reconstruction_curvature_aligned"
M_WEIGHTED = "compute_curvature_m_weighted_per_vertex"
PROJECT = "compute_curvature_driven_projection"
RAY_TRACE = "save_ray_traced_point_set_image"

OK, BOUNDARY, TOO_FEW, UMBILIC, ISOLATED, INVALID = range(6)
ATTRIBUTES = ["curv_k1", "curv_k2", "curv_confidence", "curv_error", "curv_scale", "curv_feature", "curv_status"]


def load_plugin():
    """That of the installed package, or the file that CURVATURE_LINES_PLUGIN names. Returns the filters it brings."""
    if plugin := os.environ.get("CURVATURE_LINES_PLUGIN"):
        before = set(pymeshlab.filter_list())
        pymeshlab.load_plugin(plugin)
        return sorted(set(pymeshlab.filter_list()) - before)
    import pymeshlab_curvature_lines

    return list(pymeshlab_curvature_lines.filters())


FILTERS = load_plugin()
SURFACES = [PROJECT, RAY_TRACE]  # of points: they take the layers of clouds as parameters
# All others but the one that takes lines, so that a new filter is among them
ON_CLOUDS = [name for name in FILTERS if name not in (MESH, *SURFACES)]

NEED_NORMALS = [name for name in ON_CLOUDS + SURFACES if name != NORMALS]


def generate(name, points, *, scanned=False, **options):
    """A cloud of an analytic surface with its truth; scanned: normals fitted to the noisy points."""
    cloud = analytic_surfaces.generate(name, points, **options)
    cloud["input_normals"] = cloud["normals"]
    if scanned:
        cloud["input_normals"] = analytic_surfaces.plane_fit_normals(cloud["positions"], cloud["normals"])
    return cloud


def layer(positions, normals=None):
    """A MeshSet whose one layer is this cloud."""
    meshes = pymeshlab.MeshSet()
    positions = np.asarray(positions, dtype=float).reshape(-1, 3)
    if normals is None:
        meshes.add_mesh(pymeshlab.Mesh(vertex_matrix=positions))
    else:
        meshes.add_mesh(pymeshlab.Mesh(vertex_matrix=positions, v_normals_matrix=np.asarray(normals, dtype=float)))
    return meshes


def layer_of(cloud):
    return layer(cloud["positions"], cloud["input_normals"])


def attribute(meshes, name):
    return meshes.current_mesh().vertex_custom_scalar_attribute_array(name)


def attributes(meshes):
    return {name: attribute(meshes, name) for name in ATTRIBUTES}


def _optional(read, *arguments):
    """A component the layer may lack: the host says so by throwing."""
    try:
        return read(*arguments).tobytes()
    except Exception:
        return None


def snapshot(meshes):
    """All that a user can see of the layers, byte for byte."""
    state = [meshes.current_mesh_id() if meshes.mesh_number() else None]
    for mesh in meshes:
        state += [mesh.label(), mesh.has_vertex_scalar(), mesh.has_vertex_color()]
        state += [
            array.tobytes()
            for array in (
                mesh.vertex_matrix(),
                mesh.vertex_normal_matrix(),
                mesh.vertex_scalar_array(),
                mesh.vertex_color_matrix(),
                mesh.vertex_selection_array(),
                mesh.edge_matrix(),
                mesh.face_matrix(),
                mesh.face_normal_matrix(),
                mesh.transform_matrix(),
            )
        ]
        state += [
            _optional(mesh.vertex_curvature_principal_dir1_matrix),
            _optional(mesh.vertex_curvature_principal_dir2_matrix),
        ]
        state += [
            _optional(mesh.vertex_custom_scalar_attribute_array, name)
            for name in [*ATTRIBUTES, "line_id", "line_family", "line_closed", "line_arc_length"]
        ]
    return state


def check_report(report, *counts):
    """Plain numbers under plain names; times of stages that add up to less than the whole."""
    assert all(type(value) in (int, float, bool) for value in report.values()), report
    assert np.all(np.isfinite(list(report.values())))
    for name in ("points", *counts) if "points" in report else counts:
        assert type(report[name]) is int, name
    seconds = {key: value for key, value in report.items() if key.startswith("seconds_")}
    stages = sum(value for key, value in seconds.items() if key != "seconds_total")
    assert 0.0 <= stages <= seconds["seconds_total"] * 1.01 + 1e-3
    return report


def rms(values):
    return float(np.sqrt(np.mean(np.square(values))))


def axis_angle(a, b):
    """Angle between lines along a and b, radians."""
    return np.arccos(np.clip(np.abs(np.einsum("ij,ij->i", a, b)), 0.0, 1.0))


def polygon_topology(polygons, vertices):
    """Euler characteristic, number of edges with one face, and with more than two, counted from scratch."""
    sides = np.array([sorted(side) for polygon in polygons for side in zip(polygon, np.roll(polygon, -1))], dtype=int)
    edges, uses = np.unique(sides, axis=0, return_counts=True)
    return vertices - len(edges) + len(polygons), int(np.sum(uses == 1)), int(np.sum(uses > 2))
