# Clouds from files, and meshes and lines into files that keep every digit.
# SPDX-License-Identifier: GPL-3.0-or-later
"""Reading any file as a cloud; writing polygons and lines without loss, and files whole or not at all."""

from __future__ import annotations

import os
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from os import PathLike
from pathlib import Path
from typing import TextIO

import numpy as np
import pymeshlab

from . import tables

_ID, _FAMILY = "line_id", "line_family"


def load_cloud(file: str | PathLike[str], tell: Callable[[str], None] | None = None) -> pymeshlab.MeshSet:
    """One layer of points with unit normals (those of the file, else those of its faces, else none) and its colours.

    ``tell``: hears what the columns of a text file were taken for. Raises ``ValueError`` for a file without points.
    """
    path = Path(file)
    if path.suffix.lower() in tables.SUFFIXES and not _is_point_set(path):
        table = tables.read_points(path)
        if tell:
            tell(f"{len(table.positions)} points; {table.columns}")
        return _layer(path.name, table.positions, table.normals, table.colors)
    source = pymeshlab.MeshSet()
    source.load_new_mesh(str(path))
    if source.mesh_number() > 1:
        source.generate_by_merging_visible_meshes(mergevertices=False)
    mesh = source.current_mesh()
    if mesh.vertex_number() == 0:
        raise ValueError("it holds no points")
    return _layer(mesh.label(), mesh.vertex_matrix(), mesh.vertex_normal_matrix(), None)


def _is_point_set(path: Path) -> bool:
    """Whether it is a point set of the Expe renderer, which has the suffix of tables (pts) and which the host reads."""
    with path.open("rb") as stream:
        return stream.read(5) == b"[Expe"


def _layer(
    label: str, positions: np.ndarray, normals: np.ndarray | None, colors: np.ndarray | None
) -> pymeshlab.MeshSet:
    more = {}
    if normals is not None:
        normals = np.nan_to_num(normals, nan=0.0, posinf=0.0, neginf=0.0)
        lengths = np.linalg.norm(normals, axis=1, keepdims=True)
        more["v_normals_matrix"] = np.divide(normals, lengths, out=np.zeros_like(normals), where=lengths > 0)
    if colors is not None:
        more["v_color_matrix"] = np.column_stack([colors, np.ones(len(colors))])
    cloud = pymeshlab.MeshSet()
    cloud.add_mesh(pymeshlab.Mesh(vertex_matrix=np.ascontiguousarray(positions), **more), label)
    return cloud


@contextmanager
def whole_file(file: str | PathLike[str]) -> Iterator[Path]:
    """A file beside this one to write to; it takes its place when all went well, and is gone otherwise."""
    path = Path(file)
    partial = path.with_name(f".{path.stem}.{os.getpid()}.partial{path.suffix}")
    try:
        yield partial
        partial.replace(path)
    finally:
        partial.unlink(missing_ok=True)


def save_mesh(mesh: pymeshlab.Mesh, file: str | PathLike[str]) -> None:
    """An OBJ file with every digit of the coordinates (the host's has those of single precision), polygons and edges.

    Edges go as pairs, because MeshLab reads no more than the first two points of a longer polyline; those of a line of
    curvature are a group of their own, ``line_ID_family_1`` along the first principal direction and ``_2`` along the
    second. Raises ``ValueError`` for files of another kind.
    """
    if Path(file).suffix.lower() != ".obj":
        raise ValueError(f"only OBJ files keep polygons and edges: {file}")
    with whole_file(file) as partial, partial.open("w", encoding="ascii", newline="\n") as stream:
        stream.write("# curvature-lines\n")
        _write_rows(stream, "v", mesh.vertex_matrix())
        normals = mesh.vertex_normal_matrix()
        has_normals = bool(normals.any())
        if has_normals:
            _write_rows(stream, "vn", normals)
        corner = "{0}//{0}" if has_normals else "{0}"
        for face in mesh.polygonal_face_list() if mesh.face_number() else ():
            stream.write("f " + " ".join(corner.format(vertex + 1) for vertex in face) + "\n")
        _write_edges(stream, mesh)


def _write_rows(stream: TextIO, key: str, values: np.ndarray) -> None:
    """The shortest decimals that give the same doubles back."""
    stream.writelines(f"{key} {x!r} {y!r} {z!r}\n" for x, y, z in values.tolist())


def _write_edges(stream: TextIO, mesh: pymeshlab.Mesh) -> None:
    if not mesh.edge_number():
        return
    edges = mesh.edge_matrix()
    try:
        lines = mesh.vertex_custom_scalar_attribute_array(_ID)[edges[:, 0]].astype(int)
    except pymeshlab.PyMeshLabException:
        lines = np.full(len(edges), -1)
    try:
        families = mesh.vertex_custom_scalar_attribute_array(_FAMILY)[edges[:, 0]].astype(int)
    except pymeshlab.PyMeshLabException:
        families = np.full(len(edges), -1)
    last = None
    for place in np.lexsort([np.arange(len(edges)), lines]):
        group = f"line_{lines[place]}" + (f"_family_{families[place]}" if families[place] >= 0 else "")
        if lines[place] >= 0 and group != last:
            stream.write(f"g {group}\n")
            last = group
        stream.write(f"l {edges[place, 0] + 1} {edges[place, 1] + 1}\n")
