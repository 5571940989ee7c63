# What MeshLab's window saved, read again: as many lines and faces as it told, and PyMeshLab's own numbers.
# SPDX-License-Identifier: GPL-3.0-or-later
"""usage: check_saved.py FOLDER (as run.sh left it)"""

import json
import struct
import sys
from pathlib import Path

import numpy as np
import pymeshlab
import pymeshlab_curvature_lines  # noqa: F401

CHECKOUT = Path(__file__).resolve().parents[2]
CLOUD = CHECKOUT / "sample_data/torus_1600_noise1.ply"
FOLDER = Path(sys.argv[1])
PLY_TYPES = {"float": "f4", "double": "f8", "uchar": "u1", "int": "i4", "uint": "u4", "short": "i2", "char": "i1"}


def obj(file: Path) -> dict[str, int]:
    """Vertices, faces, four-sided faces and edges of an OBJ file."""
    rows = [line.split() for line in file.read_text().splitlines()]
    faces = [row for row in rows if row and row[0] == "f"]
    return {
        "vertices": sum(row[:1] == ["v"] for row in rows),
        "faces": len(faces),
        "quads": sum(len(face) == 5 for face in faces),
        "edges": sum(row[:1] == ["l"] for row in rows),
    }


def ply(file: Path) -> np.ndarray:
    """The vertices of a binary PLY file with scalar properties, by name."""
    header, _, data = file.read_bytes().partition(b"end_header\n")
    words = [line.split() for line in header.decode().splitlines()]
    count = next(int(row[2]) for row in words if row[:2] == ["element", "vertex"])
    end = next((k for k, row in enumerate(words) if row[:2] == ["element", "face"]), len(words))
    fields = [(row[2], "<" + PLY_TYPES[row[1]]) for row in words[:end] if row[0] == "property"]
    return np.frombuffer(data, np.dtype(fields), count)


def cloud() -> pymeshlab.MeshSet:
    meshes = pymeshlab.MeshSet()
    meshes.load_new_mesh(str(CLOUD))
    return meshes


def same(what: str, saved: float, expected: float, tolerance: float = 0.0) -> None:
    assert abs(saved - expected) <= tolerance * abs(expected), f"{what}: {saved}, expected {expected}"


def check_every_filter(told: dict) -> None:
    for name in ("lines", "quad_mesh", "sharp_features", "pipeline"):
        saved = obj(FOLDER / f"{name}.obj")
        for count in saved.keys() & told[name].keys():
            same(f"{name} {count}", saved[count], told[name][count])
    saved = ply(FOLDER / "curvature.ply")
    meshes = cloud()
    meshes.compute_curvature_robust_per_vertex()
    for name in ("curv_k1", "curv_k2"):
        exact = meshes.current_mesh().vertex_custom_scalar_attribute_array(name)
        assert np.median(np.abs(saved[name] - exact)) < 1e-3 * np.ptp(exact), name  # single beside double precision
    header = (FOLDER / "ray_traced.png").read_bytes()[:24]
    assert struct.unpack(">II", header[16:]) == (533, 400)


def check_scripts(_: dict) -> None:
    for name in ("lines", "pipeline", "cleaning"):
        saved = FOLDER / f"script_{name}.obj"
        counts = obj(saved) if saved.exists() else {"vertices": len(ply(saved.with_suffix(".ply"))), "edges": 0}
        meshes = cloud()
        meshes.load_filter_script(str(CHECKOUT / f"python_bindings/filter_scripts/{name}.mlx"))
        meshes.apply_filter_script()
        # Rounding to single precision moves a point in a thousand across a threshold, and lines with it, not more.
        mesh = meshes.current_mesh()
        same(f"{name}.mlx vertices", counts["vertices"], mesh.vertex_number(), 0.05)
        same(f"{name}.mlx edges", counts["edges"], mesh.edge_number(), 0.05)


CHECKS = {"every_filter": check_every_filter, "scripts": check_scripts}
for scenario, check in CHECKS.items():
    file = FOLDER / f"{scenario}.json"
    if file.exists():
        check(json.loads(file.read_text()))
        print(f"{scenario}: what was saved is right")
