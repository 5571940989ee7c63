# From a cloud to lines and mesh: what the command line and the demo have in common.
# SPDX-License-Identifier: GPL-3.0-or-later
"""Running the whole pipeline on a cloud, and saving what comes out."""

from __future__ import annotations

from collections.abc import Callable
from contextlib import nullcontext
from dataclasses import dataclass
from os import PathLike
from pathlib import Path

import pymeshlab

from .files import save_mesh, whole_file
from .progress import progress

Report = Callable[[str, int], None]

_SAVED_ATTRIBUTE = "__ca_vs__"  # how the host calls "save this scalar attribute of vertices"

TOLD_UNCOVERED = 0.001  # share of the points, as the filter's own warnings


@dataclass
class Reconstruction:
    """What the pipeline made of a cloud; the layers live in ``meshset``."""

    meshset: pymeshlab.MeshSet
    cleaned: int  # layer ids
    lines: int | None  # when asked for
    mesh: int
    counts: dict[str, float]  # as the filter returned them, without the timings
    seconds: dict[str, float]  # per stage, and "total"

    def layer(self, number: int) -> pymeshlab.Mesh:
        return self.meshset.mesh(number)

    def save(self, number: int, file: str | PathLike[str]) -> None:
        """OBJ in double precision; other formats as the host writes them."""
        if Path(file).suffix.lower() == ".obj":
            save_mesh(self.meshset.mesh(number), file)
            return
        self.meshset.set_current_mesh(number)
        with whole_file(file) as partial:
            self.meshset.save_current_mesh(str(partial))

    def save_curvature(self, file: str | PathLike[str]) -> None:
        """The cleaned cloud as a PLY file, with its normals and every ``curv_*`` attribute."""
        self.meshset.set_current_mesh(self.cleaned)
        offered = self.meshset.filter_parameter_values("ply")
        attributes = {name: True for name in offered if name.startswith(_SAVED_ATTRIBUTE)}
        with whole_file(file) as partial:
            self.meshset.save_current_mesh(
                str(partial), save_vertex_normal=True, save_vertex_quality=True, **attributes
            )

    def losses(self) -> list[str]:
        """What the mesh does not show or shows wrong, in sentences; none when all is well."""
        counts, found = self.counts, []
        if counts["uncovered_share"] > TOLD_UNCOVERED:
            share = 100 * counts["uncovered_share"]
            found.append(
                f"{share:.2g} % of the points are farther than two edges from the mesh; try more target vertices"
            )
        if counts["folded_faces"]:
            found.append(f"{counts['folded_faces']:.0f} faces are folded over; try more target vertices")
        if counts["dropped_components"]:
            found.append(
                f"{counts['dropped_components']:.0f} pieces were too small for faces; try more target vertices"
            )
        return found

    def parameters(self, given: dict[str, object]) -> dict[str, object]:
        """All parameters of the whole pipeline: those given, and the defaults of the rest."""
        values = self.meshset.filter_parameter_values("generate_surface_reconstruction_curvature_aligned")
        return values | given | {"keep_intermediate_layers": True}


def reconstruct(
    cloud: pymeshlab.MeshSet, report: Report | None = None, *, lines: bool = False, **parameters: object
) -> Reconstruction:
    """Runs the whole pipeline on the current layer; ``parameters`` are the filter's own.

    ``lines``: lines of curvature of the cleaned cloud as well, about as dense as those of the mesh.
    """
    with progress(cloud, report) if report else nullcontext():
        result = cloud.generate_surface_reconstruction_curvature_aligned(keep_intermediate_layers=True, **parameters)
        layers = {layer.label(): layer.id() for layer in cloud}
        if lines and "lines of curvature" not in layers:
            cloud.set_current_mesh(layers["cleaned cloud"])
            traced = cloud.generate_curvature_lines(target_vertices=result["vertices"])
            layers["lines of curvature"] = cloud.current_mesh_id()
            result |= {"lines": traced["lines"], "seconds_lines": traced["seconds_total"]}
    prefix = "seconds_"
    return Reconstruction(
        cloud,
        layers["cleaned cloud"],
        layers.get("lines of curvature") if lines else None,
        layers["curvature-aligned mesh"],
        counts={name: value for name, value in result.items() if not name.startswith(prefix)},
        seconds={name.removeprefix(prefix): value for name, value in result.items() if name.startswith(prefix)},
    )
