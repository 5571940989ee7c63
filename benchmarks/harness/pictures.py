# Pictures of polygon meshes side by side: flat faces, the edges of the polygons, one camera for a row.
# SPDX-License-Identifier: GPL-3.0-or-later
from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Protocol

import numpy as np

SURFACE, EDGES = "#d8dee6", "#1f2d3d"
PANEL = (560, 470)  # pixels
MARGIN = 1.05
COLORS = 64  # enough for greys


class Drawn(Protocol):
    """A mesh of polygons: vertices (N x 3), triangles of the faces (M x 3), edges as pairs of vertices."""

    @property
    def vertices(self) -> np.ndarray: ...
    @property
    def triangles(self) -> np.ndarray: ...
    @property
    def edges(self) -> Iterable[tuple[int, int]]: ...


@dataclass(frozen=True)
class Camera:
    """Parallel projection; the picture is filled by some points."""

    view: tuple[float, float, float]  # from the shape to the viewer
    up: tuple[float, float, float]


def draw(mesh: Drawn | None, camera: Camera, framed: np.ndarray) -> np.ndarray:
    """Pixels (height x width x 3); white without a mesh. ``framed``: N x 3."""
    width, height = PANEL
    if mesh is None:
        return np.full((height, width, 3), 255, np.uint8)
    import pyvista
    from vtkmodules.vtkCommonCore import vtkLogger

    # Without an X server VTK finds another way to draw by itself, but says so each time.
    vtkLogger.SetStderrVerbosity(vtkLogger.VERBOSITY_ERROR)
    plotter = pyvista.Plotter(off_screen=True, window_size=[width, height])
    plotter.set_background("white")
    faces = pyvista.PolyData.from_regular_faces(mesh.vertices, mesh.triangles)
    plotter.add_mesh(faces, color=SURFACE, ambient=0.15, specular=0.1)
    pairs = np.array(list(mesh.edges), dtype=int)
    lines = pyvista.PolyData(mesh.vertices, lines=np.insert(pairs, 0, 2, axis=1))
    plotter.add_mesh(lines, color=EDGES, line_width=1.5)
    plotter.enable_anti_aliasing("ssaa")
    forward = -np.array(camera.view) / np.linalg.norm(camera.view)
    right = np.cross(forward, camera.up)
    right /= np.linalg.norm(right)
    frame = np.array([right, np.cross(right, forward), forward])
    seen = framed @ frame.T
    low, high = seen.min(axis=0), seen.max(axis=0)
    center, half = (low + high) / 2.0 @ frame, (high - low) / 2.0
    plotter.camera.parallel_projection = True
    plotter.camera.focal_point = center
    plotter.camera.position = center - float(np.linalg.norm(np.ptp(mesh.vertices, axis=0))) * 2.0 * forward
    plotter.camera.up = frame[1]
    plotter.camera.parallel_scale = MARGIN * max(half[1], half[0] * height / width)
    plotter.reset_camera_clipping_range()
    pixels = plotter.screenshot(return_img=True)
    plotter.close()
    return np.asarray(pixels)


def write_sheet(path: Path, rows: Sequence[Sequence[np.ndarray]]) -> None:
    """Panels in rows as one PNG file, in few colours so that it stays small."""
    from PIL import Image

    sheet = np.concatenate([np.concatenate(list(row), axis=1) for row in rows], axis=0)
    picture = Image.fromarray(sheet).quantize(COLORS, method=Image.Quantize.MAXCOVERAGE, dither=Image.Dither.NONE)
    path.parent.mkdir(parents=True, exist_ok=True)
    picture.save(path, optimize=True)
