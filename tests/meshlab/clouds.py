# The clouds of the tour that sample_data/ does not hold: a large one, and one without normals.
# SPDX-License-Identifier: GPL-3.0-or-later
"""usage: clouds.py FOLDER"""

import sys
from pathlib import Path

import pymeshlab

sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "sample_data"))
import analytic_surfaces  # noqa: E402

folder = Path(sys.argv[1])


def save(name: str, points: int, normals: bool) -> None:
    cloud = analytic_surfaces.generate("torus", points, noise=0.002, seed=3)
    meshes = pymeshlab.MeshSet()
    meshes.add_mesh(pymeshlab.Mesh(cloud["positions"], v_normals_matrix=cloud["normals"]))
    meshes.save_current_mesh(str(folder / name), save_vertex_normal=normals, save_vertex_color=False)


save("large.ply", 200_000, normals=True)
save("no_normals.ply", 1_000, normals=False)
