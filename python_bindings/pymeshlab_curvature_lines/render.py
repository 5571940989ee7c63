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

_SURFACE, _POINTS, _EDGES, _SELECTED = "#d8dee6", "#a9bfd8", "#1f2d3d", "#e0201b"
_FAMILIES = ["#c8442e", "#2e62c8"]  # along PD1, along PD2
_LEGEND = {"title": "", "vertical": True, "position_x": 0.93, "position_y": 0.3, "width": 0.03, "height": 0.4}


def render(
    path: str | PathLike[str],
    *layers: pymeshlab.Mesh,
    view: Sequence[float] | None = None,
    up: Sequence[float] | None = None,
    size: tuple[int, int] = (1200, 900),
    framed: np.ndarray | None = None,
    mesh_edges: bool = True,
) -> None:
    """Writes one picture of the layers as a PNG file.

    Meshes are drawn with the edges of their polygons, or plainly when lines lie on them; lines in red along the
    first principal direction and blue along the second; clouds as small discs, coloured by their quality when they
    have one; selected vertices as red dots. ``view`` points from the model to the viewer; the default looks along the
    model's thinnest side. ``framed``: points that fill the picture, those of the layers by default.
    """
    plotter = pyvista.Plotter(off_screen=True, window_size=size)
    plotter.set_background("white")
    with_lines = any(layer.edge_number() for layer in layers)
    for layer in layers:
        if layer.face_number():
            _add_mesh(plotter, layer, edges=mesh_edges and not with_lines)
        elif layer.edge_number():
            _add_lines(plotter, layer)
        else:
            _add_cloud(plotter, layer)
        if (selected := layer.vertex_selection_array()).any():
            plotter.add_points(layer.vertex_matrix()[selected], color=_SELECTED, point_size=9, lighting=False)
    plotter.enable_anti_aliasing("ssaa")
    if framed is None:
        framed = np.concatenate([layer.vertex_matrix() for layer in layers])
    _place_camera(plotter, framed, view, up)
    plotter.screenshot(str(path))
    plotter.close()


def _place_camera(
    plotter: pyvista.Plotter, points: np.ndarray, view: Sequence[float] | None, up: Sequence[float] | None
) -> None:
    """Parallel projection, filling the picture."""
    thinnest = int(np.argmin(np.ptp(points, axis=0)))
    axes = np.eye(3)
    # Most scans stand upright along y.
    up = np.asarray(up if up is not None else axes[2 if thinnest == 1 else 1], dtype=float)
    if view is None:
        view = axes[thinnest] + 0.3 * up + 0.35 * np.cross(up, axes[thinnest])
    forward = -np.asarray(view, dtype=float) / np.linalg.norm(view)
    right = np.cross(forward, up)
    right /= np.linalg.norm(right)
    frame = np.array([right, np.cross(right, forward), forward])
    seen = points @ frame.T
    low, high = seen.min(axis=0), seen.max(axis=0)
    center = (low + high) / 2 @ frame
    half_width, half_height, depth = (high - low) / 2
    width, height = plotter.window_size

    camera = plotter.camera
    camera.parallel_projection = True
    camera.focal_point = center
    camera.position = center - (depth + np.linalg.norm(high - low)) * forward
    camera.up = frame[1]
    camera.parallel_scale = max(1.05 * half_height, 1.2 * half_width * height / width)
    plotter.reset_camera_clipping_range()


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
    # Lifted a little, so that a mesh below does not swallow half of each line.
    points = lines.vertex_matrix() + 0.003 * lines.bounding_box().diagonal() * lines.vertex_normal_matrix()
    pairs = lines.edge_matrix()
    family = lines.vertex_custom_scalar_attribute_array("line_family")[pairs[:, 0]]
    for number, color in enumerate(_FAMILIES, start=1):
        if (chosen := pairs[family == number]).size:
            plotter.add_mesh(_segments(points, chosen), color=color, line_width=2.5)


def _add_cloud(plotter: pyvista.Plotter, cloud: pymeshlab.Mesh) -> None:
    """Discs that just cover the surface, so that what lies behind stays hidden."""
    positions = cloud.vertex_matrix()
    near = min(4, len(positions) - 1)  # the fourth neighbour tells the spacing of grids and random clouds alike
    some = positions[:: max(1, len(positions) // 300)]
    spacings = [np.partition(np.sum((positions - point) ** 2, axis=1), near)[near] for point in some]
    disc = pyvista.Disc(inner=0, outer=0.8 * np.sqrt(np.median(spacings)), r_res=1, c_res=8)
    points = pyvista.PolyData(positions)
    points["normal"] = cloud.vertex_normal_matrix()
    quality = cloud.vertex_scalar_array() if cloud.has_vertex_scalar() else np.zeros(len(positions))
    points["quality"] = quality
    discs = points.glyph(orient="normal", scale=False, geom=disc.rotate_y(-90))  # glyphs turn their x axis
    style = {"ambient": 0.3, "diffuse": 0.7}
    if np.ptp(quality) > 0:
        # The host's own habit: the ramp ends at the tenth and ninetieth percentile.
        ends = np.percentile(quality, [10, 90])
        plotter.add_mesh(discs, scalars="quality", clim=ends, cmap="turbo", scalar_bar_args=_LEGEND, **style)
    else:
        plotter.add_mesh(discs, color=_POINTS, **style)
