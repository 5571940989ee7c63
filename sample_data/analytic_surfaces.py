# Seeded oriented clouds of analytic surfaces with ground truth, in Python: the C++ generator through ctypes.
# Also a command that writes such a cloud as PLY.
# SPDX-License-Identifier: GPL-3.0-or-later
"""Analytic surfaces and clouds sampled from them.

>>> cloud = generate("torus", 2000, noise=0.01, seed=1)
>>> truth = project("torus", cloud["positions"])
>>> distance = np.linalg.norm(cloud["positions"] - truth["foot_points"], axis=1)

Outward normals, convex is positive, k1 >= k2. What the surfaces are is said in analytic_surfaces.h.
"""

from __future__ import annotations

import argparse
import ctypes
import os
from dataclasses import dataclass
from functools import lru_cache
from pathlib import Path

import numpy as np

INLIER, FAR_OUTLIER, NEAR_OUTLIER = 0, 1, 2

LIBRARY_VARIABLE = "CURVATURE_LINES_SAMPLES_LIBRARY"
_CHECKOUT = Path(__file__).resolve().parent.parent
_BUILD_TREES = ("release", "debug")
_TRUTH_VECTORS = ("foot_points", "normals", "d1", "d2")
_TRUTH_SCALARS = ("k1", "k2", "rim_distance", "feature_distance")


@dataclass(frozen=True)
class Surface:
    """What a whole surface is: corners of its bounding box, openness, topology."""

    name: str
    lower: np.ndarray
    upper: np.ndarray
    closed: bool
    euler_characteristic: int

    @property
    def diagonal(self) -> float:
        return float(np.linalg.norm(self.upper - self.lower))


def surface_names() -> list[str]:
    """All names that the other functions take."""
    library, names = _library(), []
    while (name := library.samples_surface_name(len(names))) is not None:
        names.append(name.decode())
    return names


def surface(name: str) -> Surface:
    corners = np.empty((2, 3))
    closed, euler = ctypes.c_bool(), ctypes.c_int()
    found = _library().samples_surface_properties(
        name.encode(), _doubles(corners), ctypes.byref(closed), ctypes.byref(euler)
    )
    if not found:
        raise _unknown(name)
    return Surface(name, corners[0], corners[1], closed.value, euler.value)


def project(name: str, points: np.ndarray) -> dict[str, np.ndarray]:
    """Exact surface at the foot points of arbitrary points (N x 3).

    Keys: ``foot_points``, ``normals``, ``d1``, ``d2`` (N x 3), ``k1``, ``k2``, ``rim_distance`` and
    ``feature_distance`` (N): the distances within the surface to the rim of an open surface and to the nearest
    sharp edge or jump of curvature, infinite where there is none.
    """
    points = np.ascontiguousarray(points, dtype=np.float64)
    if points.ndim != 2 or points.shape[1] != 3:
        raise ValueError(f"points must be N x 3, not {points.shape}")
    truth, buffers = _truth_buffers(len(points))
    if not _library().samples_project(name.encode(), len(points), _doubles(points), ctypes.byref(buffers)):
        raise _unknown(name)
    return truth


def generate(
    name: str,
    points: int,
    *,
    noise: float = 0.0,
    outliers: float = 0.0,
    near_outliers: float = 0.0,
    seed: int = 0,
    regular: bool = False,
) -> dict[str, np.ndarray]:
    """A cloud of about ``points`` inliers and the truth at the foot point of every point.

    noise: standard deviation per coordinate as a fraction of the surface's bounding-box diagonal.
    outliers, near_outliers: shares of the cloud, far ones uniform in 1.2 times the bounding box, near ones in
    clusters 3 to 8 noise units off the surface. regular: evenly spaced instead of area-uniform random points.

    Keys: those of :func:`project`, ``positions`` (N x 3) and ``label`` (N: INLIER, FAR_OUTLIER, NEAR_OUTLIER).
    """
    if name not in surface_names():
        raise _unknown(name)
    library = _library()
    cloud = library.samples_generate(name.encode(), points, noise, outliers, near_outliers, seed, regular)
    if not cloud:
        raise ValueError("points must be positive, noise not negative, outlier shares within [0, 1)")
    try:
        count = library.samples_size(cloud)
        positions, label = np.empty((count, 3)), np.empty(count, dtype=np.intc)
        truth, buffers = _truth_buffers(count)
        library.samples_copy(
            cloud,
            name.encode(),
            _doubles(positions),
            label.ctypes.data_as(ctypes.POINTER(ctypes.c_int)),
            ctypes.byref(buffers),
        )
    finally:
        library.samples_release(cloud)
    return {"positions": positions, "label": label, **truth}


def plane_fit_normals(positions: np.ndarray, outward: np.ndarray, neighbors: int = 25) -> np.ndarray:
    """Normals of planes fitted to the nearest neighbours (Hoppe 1992), as a scan would come with.

    MeshLab's own filter estimates them; ``outward`` (N x 3, the true normals) only says which side is outside.
    """
    import pymeshlab

    meshes = pymeshlab.MeshSet()
    meshes.add_mesh(pymeshlab.Mesh(vertex_matrix=positions))
    meshes.compute_normal_for_point_clouds(k=neighbors, smoothiter=0)
    normals = meshes.current_mesh().vertex_normal_matrix()
    normals /= np.linalg.norm(normals, axis=1, keepdims=True)
    inward = np.einsum("ij,ij->i", normals, outward) < 0.0
    normals[inward] *= -1.0
    return normals


def write_ply(path: str | os.PathLike, positions: np.ndarray, normals: np.ndarray) -> None:
    """Binary PLY with normals."""
    import pymeshlab

    meshes = pymeshlab.MeshSet()
    meshes.add_mesh(pymeshlab.Mesh(vertex_matrix=positions, v_normals_matrix=normals))
    meshes.save_current_mesh(
        os.fspath(path), save_vertex_normal=True, save_vertex_color=False, save_vertex_quality=False
    )


class _TruthBuffers(ctypes.Structure):
    _fields_ = [(name, ctypes.POINTER(ctypes.c_double)) for name in _TRUTH_VECTORS + _TRUTH_SCALARS]


def _truth_buffers(count: int) -> tuple[dict[str, np.ndarray], _TruthBuffers]:
    truth = {name: np.empty((count, 3)) for name in _TRUTH_VECTORS}
    truth.update({name: np.empty(count) for name in _TRUTH_SCALARS})
    return truth, _TruthBuffers(*(_doubles(array) for array in truth.values()))


def _doubles(array: np.ndarray):
    return array.ctypes.data_as(ctypes.POINTER(ctypes.c_double))


def _unknown(name: str) -> ValueError:
    return ValueError(f"no analytic surface is called {name!r}; there are {', '.join(surface_names())}")


def _library_path() -> Path:
    if chosen := os.environ.get(LIBRARY_VARIABLE):
        return Path(chosen)
    for tree in _BUILD_TREES:
        path = _CHECKOUT / "build" / tree / "sample_data" / "libanalytic_surfaces.so"
        if path.exists():
            return path
    raise FileNotFoundError(
        "libanalytic_surfaces.so is not built: run `cmake --preset release && cmake --build --preset release`, "
        f"or name it in {LIBRARY_VARIABLE}"
    )


@lru_cache(maxsize=None)
def _library() -> ctypes.CDLL:
    library = ctypes.CDLL(os.fspath(_library_path()))
    doubles, text, count, number = (
        ctypes.POINTER(ctypes.c_double),
        ctypes.c_char_p,
        ctypes.c_int,
        ctypes.c_double,
    )
    truth, cloud = ctypes.POINTER(_TruthBuffers), ctypes.c_void_p
    signatures = {
        "samples_surface_name": (text, [count]),
        "samples_surface_properties": (
            ctypes.c_bool,
            [text, doubles, ctypes.POINTER(ctypes.c_bool), ctypes.POINTER(ctypes.c_int)],
        ),
        "samples_project": (ctypes.c_bool, [text, count, doubles, truth]),
        "samples_generate": (cloud, [text, count, number, number, number, ctypes.c_uint64, ctypes.c_bool]),
        "samples_size": (count, [cloud]),
        "samples_copy": (None, [cloud, text, doubles, ctypes.POINTER(ctypes.c_int), truth]),
        "samples_release": (None, [cloud]),
    }
    for name, (result, arguments) in signatures.items():
        function = getattr(library, name)
        function.restype, function.argtypes = result, arguments
    return library


def main(arguments: list[str] | None = None) -> None:
    parser = argparse.ArgumentParser(description="Write a sampled analytic surface with normals as PLY.")
    parser.add_argument("surface", choices=surface_names())
    parser.add_argument("points", type=int, help="number of inliers")
    parser.add_argument("-o", "--output", required=True, metavar="FILE.ply")
    parser.add_argument("--noise", type=float, default=0.0, help="fraction of the bounding-box diagonal")
    parser.add_argument("--outliers", type=float, default=0.0, help="share of far outliers")
    parser.add_argument("--near-outliers", type=float, default=0.0, help="share of outliers near the surface")
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument("--regular", action="store_true", help="even grid instead of random points")
    parser.add_argument(
        "--fit-normals", type=int, default=0, metavar="K", help="normals of planes through K points, not the true ones"
    )
    given = parser.parse_args(arguments)
    cloud = generate(
        given.surface,
        given.points,
        noise=given.noise,
        outliers=given.outliers,
        near_outliers=given.near_outliers,
        seed=given.seed,
        regular=given.regular,
    )
    normals = cloud["normals"]
    if given.fit_normals:
        normals = plane_fit_normals(cloud["positions"], normals, given.fit_normals)
    write_ply(given.output, cloud["positions"], normals)
    print(f"{given.output}: {len(normals)} points of {given.surface}")


if __name__ == "__main__":
    main()
