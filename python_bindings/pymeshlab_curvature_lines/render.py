# Pictures of layers without a screen: meshes with their polygon edges, lines by family, clouds by quality.
# SPDX-License-Identifier: GPL-3.0-or-later
"""Pictures of PyMeshLab layers; needs the optional dependency ``pip install pymeshlab-curvature-lines[render]``."""

from __future__ import annotations

from collections.abc import Sequence
from os import PathLike

import numpy as np
import pymeshlab
import pyvista
from vtkmodules.vtkCommonCore import vtkLogger

# Without an X server VTK finds another way to draw by itself, but says so each time.
vtkLogger.SetStderrVerbosity(vtkLogger.VERBOSITY_ERROR)

_SURFACE, _POINTS, _EDGES = "#d8dee6", "#5b7ba3", "#1f2d3d"
_FAMILIES = ["#c8442e", "#2e62c8"]  # along PD1, along PD2


def render(
    path: str | PathLike[str],
    *layers: pymeshlab.Mesh,
    view: Sequence[float] = (0.35, 0.3, 1.0),
    up: Sequence[float] = (0.0, 1.0, 0.0),
    size: tuple[int, int] = (1200, 900),
) -> None:
    """Writes one picture of the layers as a PNG file, seen from the direction ``view`` with ``up`` upwards.

    Meshes are drawn with the edges of their polygons, or plainly when lines lie on them; lines in red along the
    first principal direction and blue along the second; clouds coloured by their quality when they have one.
    """
    plotter = pyvista.Plotter(off_screen=True, window_size=size)
    plotter.set_background("white")
    with_lines = any(layer.edge_number() for layer in layers)
    for layer in layers:
        if layer.face_number():
            _add_mesh(plotter, layer, edges=not with_lines)
        elif layer.edge_number():
            _add_lines(plotter, layer)
        else:
            _add_cloud(plotter, layer)
    plotter.enable_anti_aliasing("ssaa")
    plotter.view_vector(view, viewup=up)
    plotter.camera.zoom(1.3)
    plotter.screenshot(str(path))
    plotter.close()


def _segments(points: np.ndarray, pairs: np.ndarray) -> pyvista.PolyData:
    return pyvista.PolyData(points, lines=np.insert(pairs, 0, 2, axis=1))


def _add_mesh(plotter: pyvista.Plotter, mesh: pymeshlab.Mesh, edges: bool) -> None:
    # The host's triangles for the filling: a renderer's own triangulation of concave polygons may fail.
    points = mesh.vertex_matrix()
    surface = pyvista.PolyData.from_regular_faces(points, mesh.face_matrix())
    plotter.add_mesh(surface, color=_SURFACE, ambient=0.15, specular=0.1)
    if edges:
        sides = np.concatenate([np.column_stack([ring, np.roll(ring, -1)]) for ring in mesh.polygonal_face_list()])
        plotter.add_mesh(_segments(points, np.unique(np.sort(sides, axis=1), axis=0)), color=_EDGES, line_width=1.5)


def _add_lines(plotter: pyvista.Plotter, lines: pymeshlab.Mesh) -> None:
    # Lifted a little, so that the mesh below does not swallow half of each line.
    points = lines.vertex_matrix() + 0.003 * lines.bounding_box().diagonal() * lines.vertex_normal_matrix()
    pairs = lines.edge_matrix()
    family = lines.vertex_custom_scalar_attribute_array("line_family")[pairs[:, 0]]
    for number, color in enumerate(_FAMILIES, start=1):
        if (chosen := pairs[family == number]).size:
            plotter.add_mesh(_segments(points, chosen), color=color, line_width=2.0)


def _add_cloud(plotter: pyvista.Plotter, cloud: pymeshlab.Mesh) -> None:
    points = pyvista.PolyData(cloud.vertex_matrix())
    normals = cloud.vertex_normal_matrix()
    if np.any(normals):
        points.point_data.active_normals = normals
    quality = cloud.vertex_scalar_array() if cloud.has_vertex_scalar() else np.zeros(cloud.vertex_number())
    if np.ptp(quality) > 0:
        # The host's own habit: the ramp ends at the tenth and ninetieth percentile.
        plotter.add_mesh(points, scalars=quality, clim=np.percentile(quality, [10, 90]), cmap="turbo", point_size=5)
    else:
        plotter.add_mesh(points, color=_POINTS, point_size=5)
