# Loads the curvature lines plugin into PyMeshLab and binds its filters as MeshSet methods, on import.
# SPDX-License-Identifier: GPL-3.0-or-later
"""Curvature, lines of curvature and curvature-aligned quad meshes from point clouds, in PyMeshLab.

>>> import pymeshlab, pymeshlab_curvature_lines
>>> ms = pymeshlab.MeshSet()
>>> ms.load_new_mesh("scan.ply")
>>> ms.generate_surface_reconstruction_curvature_aligned()
"""

from __future__ import annotations

from importlib.metadata import version
from pathlib import Path

__all__ = ["MeshSet", "__version__", "filters", "plugin_path"]
__version__: str = version("pymeshlab-curvature-lines")

_HOST = "2025.7"
_FILTERS = {
    "compute_curvature_robust_per_vertex": "Principal curvatures and directions of a noisy cloud, by M-estimation",
    "compute_selection_point_cloud_outliers_by_curvature": "Selects the points that do not lie on the surface",
    "apply_coord_point_cloud_robust_denoising": "Moves the points onto the surface and corrects the normals",
    "apply_curvature_direction_smoothing_per_vertex": "Smooths the principal directions where they are uncertain",
    "generate_curvature_lines": "Traces the lines of curvature as a new polyline layer",
    "generate_sharp_feature_lines": "Finds the sharp edges of the surface as a new polyline layer",
    "generate_curvature_aligned_quad_mesh": "Builds a quad-dominant mesh from a layer of curvature lines",
    "generate_surface_reconstruction_curvature_aligned": "From a cloud to a curvature-aligned quad mesh, in one step",
    "compute_curvature_m_weighted_per_vertex": "Principal curvatures and directions of a clean cloud, by Euler's theorem",
    "compute_curvature_driven_projection": "Moves vertices onto the smooth surface a cloud defines, or makes a cloud denser",
    "save_ray_traced_point_set_image": "Draws the surface between the points into a PNG file",
}


def plugin_path() -> Path:
    """The plugin's file, for ``pymeshlab.load_plugin``."""
    return Path(__file__).parent / "libfilter_curvature_lines.so"


def filters() -> dict[str, str]:
    """The names of the filters, each with one line about what it does."""
    return dict(_FILTERS)


def _load() -> type:
    # Before the import: a plugin in a host of another version would crash, not complain.
    host = version("pymeshlab")
    if host != _HOST and not host.startswith(_HOST + "."):
        raise ImportError(
            f"pymeshlab_curvature_lines needs pymeshlab {_HOST}, not {host}: pip install 'pymeshlab>=2025.7,<2025.8'"
        )
    import pymeshlab

    # Already there after importlib.reload or the user's own load_plugin; the host refuses to load a file twice.
    if _FILTERS.keys().isdisjoint(pymeshlab.filter_list()):
        try:
            pymeshlab.load_plugin(str(plugin_path()))
        except pymeshlab.PyMeshLabException as error:
            raise ImportError(f"pymeshlab {host} refuses {plugin_path()}: {error}") from None
    for name, description in _FILTERS.items():
        method = pymeshlab.bind_function(name)
        method.__doc__ = description
        setattr(pymeshlab.MeshSet, name, method)
    return pymeshlab.MeshSet


# PyMeshLab's own class, under a name that __init__.pyi can give types to.
MeshSet = _load()
