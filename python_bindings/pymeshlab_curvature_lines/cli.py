# The command curvature-lines: a scan in, a curvature-aligned mesh, lines and a report out.
# SPDX-License-Identifier: GPL-3.0-or-later
"""Command line of the whole pipeline."""

from __future__ import annotations

import argparse
import re
import sys
import tempfile
from collections.abc import Sequence
from contextlib import nullcontext
from pathlib import Path

from . import __version__
from .pipeline import Reconstruction, load_cloud, reconstruct
from .progress import progress_bar
from .report import number, write_report

METHODS = {"position-field": "Position Field", "traced-lines": "Traced Lines"}
NORMALS = {"if-missing": "If Missing", "never": "Never", "always": "Always"}


def parser() -> argparse.ArgumentParser:
    """The command's options."""
    options = argparse.ArgumentParser(
        prog="curvature-lines",
        description="Turns a point cloud into a quad-dominant mesh aligned with its lines of curvature. "
        "Of a mesh only the vertices and their normals are used.",
        epilog="Exit status: 0 done, 1 failed, 2 wrong usage.",
    )
    options.add_argument("input", type=Path, metavar="INPUT", help="any file PyMeshLab reads")
    options.add_argument("-o", "--output", type=Path, required=True, metavar="OUTPUT.obj", help="the mesh")
    options.add_argument("--lines", type=Path, metavar="LINES.obj", help="the lines of curvature as well")
    options.add_argument("--report", type=Path, metavar="REPORT.html", help="counts, timings and a picture")
    options.add_argument("--method", choices=METHODS, default="position-field", help="how the mesh is found")
    options.add_argument("--target-vertices", type=int, default=0, metavar="N", help="0 (default): from the cloud")
    options.add_argument("--epsilon", type=float, default=0, metavar="E", help="chord error, fraction of the diagonal")
    options.add_argument("--normals", choices=NORMALS, default="if-missing", help="when to estimate normals")
    options.add_argument("--no-outliers", action="store_true", help="keep every point")
    options.add_argument("--no-denoise", action="store_true", help="keep every point where it is")
    options.add_argument("--no-smoothing", action="store_true", help="keep the directions as estimated")
    options.add_argument("--triangulate", action="store_true", help="triangles instead of polygons")
    options.add_argument("--close-holes", action="store_true")
    options.add_argument("--quiet", action="store_true", help="no progress bar, no table")
    options.add_argument("--version", action="version", version=f"%(prog)s {__version__}")
    return options


def main(arguments: Sequence[str] | None = None) -> int:
    """Runs the command; returns its exit status."""
    options = _checked(arguments)
    try:
        _run(options)
    except KeyboardInterrupt:
        print("curvature-lines: interrupted", file=sys.stderr)
        return 1
    except Exception as error:  # a user's file may make anything fail; the command says what, in one line
        print(f"curvature-lines: {_one_line(error)}", file=sys.stderr)
        return 1
    return 0


def _checked(arguments: Sequence[str] | None) -> argparse.Namespace:
    """Refuses what cannot end well before any work is done."""
    command = parser()
    options = command.parse_args(arguments)
    if not options.input.is_file():
        command.error(f"no such file: {options.input}")
    if options.target_vertices < 0:
        command.error("--target-vertices must not be negative")
    for file in filter(None, (options.output, options.lines, options.report)):
        if not file.absolute().parent.is_dir():
            command.error(f"no such folder: {file.parent}")
    if options.output.suffix.lower() != ".obj" and not options.triangulate:
        command.error(f"only OBJ files keep polygons: {options.output} (or add --triangulate)")
    if options.lines and options.lines.suffix.lower() != ".obj":
        command.error(f"only OBJ files keep lines: {options.lines}")
    return options


def _run(options: argparse.Namespace) -> None:
    parameters = {
        "method": METHODS[options.method],
        "target_vertices": options.target_vertices,
        "epsilon": options.epsilon,
        "estimate_normals": NORMALS[options.normals],
        "reject_outliers": not options.no_outliers,
        "denoise": not options.no_denoise,
        "smooth_directions": not options.no_smoothing,
        "triangulate": options.triangulate,
        "close_holes": options.close_holes,
    }
    cloud = load_cloud(options.input)
    with nullcontext() if options.quiet else progress_bar() as report:
        result = reconstruct(cloud, report, lines=options.lines is not None, **parameters)

    result.save(result.mesh, options.output)
    if options.lines:
        result.save(result.lines, options.lines)
    if not options.quiet:
        for name, value in result.counts.items():
            print(f"{name.replace('_', ' '):<28}{number(value):>12}")
    if options.report:
        tables = {"Counts": result.counts, "Seconds": result.seconds}
        write_report(options.report, options.input.name, tables, _picture(result))


def _picture(result: Reconstruction) -> bytes | None:
    """The mesh as PNG, when the optional renderer is installed."""
    try:
        from .render import render
    except ImportError:
        return None
    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder) / "mesh.png"
        render(file, result.layer(result.mesh))
        return file.read_bytes()


def _one_line(error: Exception) -> str:
    """What the host says after 'Details:', without its mark-up."""
    text = str(error).split("Details:")[-1] or type(error).__name__
    return " ".join(re.sub(r"<[^>]+>", " ", text).split())


if __name__ == "__main__":
    sys.exit(main())
