# Hashes of everything the filters leave in the layers and return, on eight clouds: two states of the code that print the
# same lines compute the same, to the last bit. For changes that are to change nothing.
# SPDX-License-Identifier: GPL-3.0-or-later
"""usage: output_hashes.py --write FILE | --compare FILE [CLOUD ...]; a line of the file is: cloud, chain, hash."""

from __future__ import annotations

import argparse
import hashlib
import tempfile
from collections.abc import Iterable, Iterator
from pathlib import Path

import numpy as np
import pymeshlab

from clouds.scans import loaded
from harness.shared import MESHLAB_SAMPLES, helpers

Cloud = tuple[np.ndarray, np.ndarray]  # positions and normals, N x 3 each
Step = tuple[str, dict]  # a filter and its parameters


def generated(surface: str, points: int, **options) -> Cloud:
    cloud = helpers.generate(surface, points, **options)
    return cloud["positions"], cloud["input_normals"]


def scan(name: str, every: int = 1) -> Cloud:
    """Vertices of a mesh that comes with PyMeshLab, without its faces; all, or one in `every`."""
    meshes = loaded(MESHLAB_SAMPLES / name)
    if meshes.current_mesh().face_number():
        meshes.compute_normal_per_vertex()
    mesh = meshes.current_mesh()
    return mesh.vertex_matrix()[::every], mesh.vertex_normal_matrix()[::every]


CLOUDS = {
    "torus": lambda: generated("torus", 1600, noise=0.005, outliers=0.02, seed=1, scanned=True),
    "ellipsoid": lambda: generated("ellipsoid", 3000, noise=0.0025, seed=2),
    "helicoid": lambda: generated("helicoid", 1700, noise=0.005, seed=3, scanned=True),
    "cube": lambda: generated("cube", 2400, noise=0.0025, seed=4, scanned=True),
    "cylinder": lambda: generated("cylinder", 1500, noise=0.002, seed=5),
    "sphere": lambda: generated("sphere", 1200, noise=0.0025, seed=6),
    "chameleon": lambda: scan("chameleon.pts"),
    "face": lambda: scan("rangemaps/face000.ply", every=4),
}

# Chains of filters, each on a layer of its own.
CHAINS: dict[str, list[Step]] = {
    "curvature": [(helpers.CURVATURE, {"correct_normals": True, "scalar": "Curvedness"})],
    "published_curvature": [(helpers.CURVATURE, {"scale_mode": "Paper", "correct_normals": True})],
    "ungated_curvature": [(helpers.CURVATURE, {"scale_mode": "Paper", "feature_gate": False})],
    "outliers": [(helpers.OUTLIERS, {"delete_selected": True})],
    "published_outliers": [(helpers.OUTLIERS, {"mode": "Paper"})],
    "denoising": [(helpers.DENOISE, {})],
    "published_denoising": [(helpers.DENOISE, {"method": "Paper", "iterations": 10})],
    "conjugate_denoising": [
        (
            helpers.DENOISE,
            {
                "method": "Paper",
                "iterations": 5,
                "optimizer": "Polak-Ribiere",
                "energy": "Squared",
                "neighbors": "Nearest",
            },
        )
    ],
    "lines": [(helpers.SMOOTH, {}), (helpers.TRACE, {"target_vertices": 200}), (helpers.MESH, {})],
    "lines_epsilon": [
        (helpers.TRACE, {"epsilon": 1e-3, "projection": "Weighted Average", "smooth_directions": False}),
        (helpers.MESH, {"triangulate": True}),
    ],
    "field_lines": [(helpers.TRACE, {"method": "Position Field", "target_vertices": 300})],
    "features": [(helpers.FEATURES, {})],
    "pipeline": [(helpers.PIPELINE, {"keep_intermediate_layers": True})],
    "pipeline_epsilon": [(helpers.PIPELINE, {"epsilon": 1e-3, "denoise": False, "close_holes": True})],
    "pipeline_normals": [
        (helpers.PIPELINE, {"estimate_normals": "Always", "target_vertices": 300, "reject_outliers": False})
    ],
    "traced_pipeline": [(helpers.PIPELINE, {"method": "Traced Lines", "keep_intermediate_layers": True})],
    "published_pipeline": [
        (helpers.PIPELINE, {"method": "Traced Lines", "scale_mode": "Paper", "target_vertices": 200})
    ],
    "paper_scale_field": [(helpers.PIPELINE, {"scale_mode": "Paper", "target_vertices": 250})],
    "m_weighted": [(helpers.M_WEIGHTED, {})],
    "projection": [(helpers.PROJECT, {})],
}


def results(report: dict | None) -> dict:
    return {key: value for key, value in (report or {}).items() if not key.startswith("seconds_")}


def run(meshes: pymeshlab.MeshSet, steps: list[Step]) -> str:
    said: list[dict | str] = []
    for name, parameters in steps:
        try:
            said.append(results(meshes.apply_filter(name, **parameters)))
        except pymeshlab.PyMeshLabException as error:
            said.append(str(error))
            break
    state = repr(said).encode() + repr(helpers.snapshot(meshes)).encode()
    return hashlib.sha256(state).hexdigest()


def image(meshes: pymeshlab.MeshSet, surface: str) -> str:
    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder) / "image.png"
        meshes.apply_filter(helpers.RAY_TRACE, image_file=str(file), width=120, height=90, surface=surface)
        return hashlib.sha256(file.read_bytes()).hexdigest()


def lines(clouds: Iterable[str]) -> Iterator[str]:
    for cloud in clouds:
        positions, normals = CLOUDS[cloud]()
        for chain, steps in CHAINS.items():
            yield f"{cloud} {chain} {run(helpers.layer(positions, normals), steps)}"
        for surface in ("Curvature-Driven", "Moving Least Squares"):
            yield f"{cloud} image_{surface.split()[0]} {image(helpers.layer(positions, normals), surface)}"


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__)
    what = parser.add_mutually_exclusive_group(required=True)
    what.add_argument("--write", type=Path, metavar="FILE")
    what.add_argument("--compare", type=Path, metavar="FILE", help="says which lines differ from those written before")
    parser.add_argument("clouds", nargs="*", metavar="CLOUD", help=", ".join(CLOUDS))
    arguments = parser.parse_args()
    found = list(lines(arguments.clouds or CLOUDS))
    if arguments.write:
        arguments.write.write_text("\n".join(found) + "\n")
        return 0
    before = set(arguments.compare.read_text().splitlines())
    different = [line for line in found if line not in before]
    for line in different:
        print("different:", line.rsplit(" ", 1)[0])
    print(f"{len(different)} of {len(found)} differ")
    return 1 if different else 0


if __name__ == "__main__":
    raise SystemExit(main())
