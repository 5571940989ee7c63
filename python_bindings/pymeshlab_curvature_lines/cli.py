# The command curvature-lines: scans in; curvature-aligned meshes, lines, curvature and reports out.
# SPDX-License-Identifier: GPL-3.0-or-later
"""Command line of the whole pipeline."""

from __future__ import annotations

import argparse
import re
import sys
import tempfile
from collections.abc import Iterator, Sequence
from contextlib import nullcontext
from pathlib import Path
from typing import NamedTuple

import pymeshlab

from . import __version__, tables
from .files import load_cloud
from .pipeline import Reconstruction, reconstruct
from .progress import progress_bar
from .report import number, write_report

METHODS = {"position-field": "Position Field", "traced-lines": "Traced Lines"}
QUADS = {"pure": "Pure", "dominant": "Dominant", "subdivided": "Subdivided"}
NORMALS = {"if-missing": "If Missing", "never": "Never", "always": "Always"}
# What holds points: files that PyMeshLab reads, and text.
SUFFIXES = [*".ply .obj .off .stl .ptx .e57 .3ds .3mf .gts .ctm .dae .vmi .wrl .gltf .glb".split(), *tables.SUFFIXES]
MOST_VERTICES = 10_000_000  # as the filter's own bound

_DESCRIPTION = """\
Turns point clouds into quad-dominant meshes aligned with their lines of curvature: leaves outliers out, removes
noise, estimates principal curvatures and directions, and builds the mesh. Of a mesh only the vertices and their
normals are used. Normals should point outward; without any, they are estimated."""

_EXAMPLES = """\
examples:
  curvature-lines scan.ply -o quads.obj --report scan.html
      the mesh, and a page with pictures and histograms to judge it by
  curvature-lines scan.ply -o quads.obj --target-vertices 2000
      about so many vertices; without, the cloud decides
  curvature-lines part.stl -o part.obj --no-outliers --no-denoise
      for exact data: every point stays where it is
  curvature-lines scan.ply -o quads.obj --lines lines.obj --curvature points.ply
      lines of curvature as polylines; the cleaned points with curv_k1, curv_k2, …
  curvature-lines scans/ more.ply -o results/ --report results/
      every cloud of a folder: results/NAME_quads.obj and results/NAME.html; --lines
      and --curvature take folders then, too

Quads and lines need OBJ files: PLY drops polygons and edges.
exit status: 0 done, 1 something failed (a folder's other clouds are still done), 2 wrong usage"""


class Job(NamedTuple):
    """One cloud, and the files to write."""

    cloud: Path
    mesh: Path
    lines: Path | None
    curvature: Path | None
    report: Path | None


def parser() -> argparse.ArgumentParser:
    """The command's options."""
    options = argparse.ArgumentParser(
        prog="curvature-lines",
        description=_DESCRIPTION,
        epilog=_EXAMPLES,
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )
    options.add_argument(
        "input",
        type=Path,
        nargs="+",
        metavar="INPUT",
        help="files that PyMeshLab reads, tables of points as text (xyz, txt, csv, pts, asc), or folders of them",
    )
    files = options.add_argument_group("files to write (folders, when there are several clouds)")
    files.add_argument("-o", "--output", type=Path, required=True, metavar="OUTPUT.obj", help="the mesh")
    files.add_argument("--lines", type=Path, metavar="LINES.obj", help="lines of curvature, about as dense as the mesh")
    files.add_argument(
        "--curvature", type=Path, metavar="POINTS.ply", help="the cleaned points with the curv_* attributes"
    )
    files.add_argument(
        "--report",
        type=Path,
        metavar="REPORT.html",
        help="pictures, histograms, counts, parameters, versions; one file, opens offline",
    )
    mesh = options.add_argument_group("the mesh")
    mesh.add_argument(
        "--target-vertices",
        type=int,
        default=0,
        metavar="N",
        help="about how many vertices; 0 (default): from the cloud",
    )
    mesh.add_argument(
        "--epsilon",
        type=float,
        default=0,
        metavar="E",
        help="instead: chord error between lines, as a fraction of the bounding box's diagonal",
    )
    mesh.add_argument(
        "--method",
        choices=METHODS,
        default="position-field",
        help="position-field (default): most quads, certain topology; traced-lines: as published",
    )
    mesh.add_argument(
        "--quads",
        choices=QUADS,
        default="pure",
        help="pure (default): quads only; dominant: and other faces where lines end; subdivided: a coarser mesh, divided",
    )
    mesh.add_argument(
        "--triangulate", action="store_true", help="triangles instead of polygons; the output may then be any format"
    )
    mesh.add_argument("--close-holes", action="store_true", help="fill holes that are small against the mesh")
    cloud = options.add_argument_group("the cloud")
    cloud.add_argument(
        "--normals", choices=NORMALS, default="if-missing", help="when to estimate normals (default: if-missing)"
    )
    cloud.add_argument("--no-outliers", action="store_true", help="keep every point")
    cloud.add_argument("--no-denoise", action="store_true", help="keep every point where it is")
    cloud.add_argument("--no-smoothing", action="store_true", help="keep the directions as estimated (traced-lines)")
    options.add_argument("--quiet", action="store_true", help="no progress bar, no table")
    options.add_argument("--version", action="version", version=f"%(prog)s {__version__}")
    return options


def main(arguments: Sequence[str] | None = None) -> int:
    """Runs the command; returns its exit status."""
    command = parser()
    options = command.parse_args(arguments)
    if options.target_vertices < 0:
        command.error("--target-vertices must not be negative")
    if options.target_vertices > MOST_VERTICES:
        command.error(f"--target-vertices may be {MOST_VERTICES} at most")
    try:
        jobs = list(_jobs(options))
    except ValueError as error:
        command.error(str(error))
    status = 0
    for job in jobs:
        try:
            _run(job, options)
        except KeyboardInterrupt:
            print("curvature-lines: interrupted", file=sys.stderr)
            return 1
        except Exception as error:  # a user's file may make anything fail; the command says what, in one line
            print(f"curvature-lines: {job.cloud.name}: {_one_line(error)}", file=sys.stderr)
            status = 1
    return status


def _jobs(options: argparse.Namespace) -> Iterator[Job]:
    """Refuses, by ValueError, what cannot end well before any work is done."""
    # The host changes the working directory when a file cannot be read.
    options.input = [given.absolute() for given in options.input]
    for name in ("output", "lines", "curvature", "report"):
        if given := getattr(options, name):
            setattr(options, name, given.absolute())
    clouds: list[Path] = []
    for given in options.input:
        found = [given]
        if given.is_dir():
            found = sorted(file for file in given.iterdir() if file.suffix.lower() in SUFFIXES)
        elif not given.is_file():
            raise ValueError(f"no such file or folder: {given}")
        if not found:
            raise ValueError(f"no point clouds in {given} ({' '.join(SUFFIXES)})")
        clouds += found
    if len(options.input) > 1 or options.input[0].is_dir():
        yield from _jobs_into_folders(clouds, options)
        return
    for file in filter(None, (options.output, options.lines, options.curvature, options.report)):
        if file.is_dir():
            raise ValueError(f"a folder, not a file: {file}")
        if not file.parent.is_dir():
            raise ValueError(f"no such folder: {file.parent}")
    if options.output.suffix.lower() != ".obj" and not options.triangulate:
        raise ValueError(f"only OBJ files keep polygons: {options.output} (or add --triangulate)")
    if options.lines and options.lines.suffix.lower() != ".obj":
        raise ValueError(f"only OBJ files keep lines: {options.lines}")
    if options.curvature and options.curvature.suffix.lower() != ".ply":
        raise ValueError(f"only PLY files keep the attributes: {options.curvature}")
    job = Job(clouds[0], options.output, options.lines, options.curvature, options.report)
    _refuse_overwriting([job])
    yield job


def _jobs_into_folders(clouds: list[Path], options: argparse.Namespace) -> Iterator[Job]:
    names = [cloud.stem for cloud in clouds]
    if twice := {name for name in names if names.count(name) > 1}:
        raise ValueError(f"clouds of the same name would overwrite each other's results: {', '.join(sorted(twice))}")
    for folder in filter(None, (options.output, options.lines, options.curvature, options.report)):
        if folder.is_file() or folder.suffix:
            raise ValueError(f"several clouds need a folder to write to, not a file: {folder}")
        if not folder.parent.is_dir():
            raise ValueError(f"no such folder: {folder.parent}")
        for given in options.input:
            if given.is_dir() and given.resolve() == folder.resolve():
                raise ValueError(f"results in the folder of the clouds would be the next run's input: {folder}")
    jobs = [
        Job(
            cloud,
            options.output / f"{cloud.stem}_quads.obj",
            options.lines and options.lines / f"{cloud.stem}_lines.obj",
            options.curvature and options.curvature / f"{cloud.stem}_curvature.ply",
            options.report and options.report / f"{cloud.stem}.html",
        )
        for cloud in clouds
    ]
    _refuse_overwriting(jobs)
    yield from jobs


def _refuse_overwriting(jobs: Sequence[Job]) -> None:
    """No result may take the place of a cloud, nor of another result; names may differ and be the same file."""
    clouds = {job.cloud.resolve() for job in jobs}
    written: set[Path] = set()
    for file in (file for job in jobs for file in job[1:] if file):
        place = file.resolve()
        if place in clouds or any(place.exists() and place.samefile(cloud) for cloud in clouds):
            raise ValueError(f"would overwrite the input: {file}")
        if place in written:
            raise ValueError(f"would overwrite another result: {file}")
        written.add(place)


def _run(job: Job, options: argparse.Namespace) -> None:
    parameters = {
        "method": METHODS[options.method],
        "target_vertices": options.target_vertices,
        "epsilon": options.epsilon,
        "estimate_normals": NORMALS[options.normals],
        "reject_outliers": not options.no_outliers,
        "denoise": not options.no_denoise,
        "smooth_directions": not options.no_smoothing,
        "quads": QUADS[options.quads],
        "triangulate": options.triangulate,
        "close_holes": options.close_holes,
        "scale_mode": "Adaptive",
    }
    cloud = load_cloud(job.cloud, None if options.quiet else lambda what: print(f"{job.cloud.name}: {what}"))
    title = f"{job.cloud.stem[:20]:<22}" if job.mesh != options.output else ""
    with nullcontext() if options.quiet else progress_bar(title) as report:
        result = reconstruct(cloud, report, lines=job.lines is not None, **parameters)

    for file in filter(None, job[1:]):
        file.parent.mkdir(exist_ok=True)
    result.save(result.mesh, job.mesh)
    if job.lines:
        result.save(result.lines, job.lines)
    if job.curvature:
        result.save_curvature(job.curvature)
    for sentence in result.losses():
        print(f"curvature-lines: {job.cloud.name}: {sentence}", file=sys.stderr)
    if not options.quiet:
        for name, value in result.counts.items():
            print(f"{name.replace('_', ' '):<28}{number(value):>12}")
    if job.report:
        used = result.parameters(parameters)
        write_report(job.report, job.cloud.name, result, used, _pictures(result))


def _pictures(result: Reconstruction) -> dict[str, bytes]:
    """Of the cleaned cloud and the mesh, as PNG, when the optional renderer is installed."""
    try:
        from .render import render
    except ImportError:
        return {}
    pictures = {"The cleaned cloud, coloured by mean curvature": result.cleaned, "The mesh": result.mesh}
    if result.lines is not None:
        pictures["Lines of curvature, red along the larger curvature"] = result.lines
    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder) / "picture.png"

        def picture(*layers: pymeshlab.Mesh) -> bytes:
            render(file, *layers, size=(800, 600))
            return file.read_bytes()

        mesh = result.layer(result.mesh)
        shown = {result.lines: [mesh]} if result.lines is not None else {}
        return {
            caption: picture(*shown.get(number, []), result.layer(number))
            for caption, number in pictures.items()
            if result.layer(number).vertex_number()
        }


def _one_line(error: Exception) -> str:
    """What the host says after 'Details:', without its mark-up."""
    text = str(error).split("Details:")[-1] or type(error).__name__
    return " ".join(re.sub(r"<[^>]+>", " ", text).split())


if __name__ == "__main__":
    sys.exit(main())
