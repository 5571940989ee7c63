# The demo: clouds in, meshes, lines and pictures in out/, and a table of what was found and how long it took.
# SPDX-License-Identifier: GPL-3.0-or-later
"""usage: scripts/demo.sh [FILE ...]"""

import sys
from pathlib import Path

import pymeshlab
from pymeshlab_curvature_lines.files import load_cloud
from pymeshlab_curvature_lines.pipeline import Reconstruction, reconstruct
from pymeshlab_curvature_lines.progress import progress_bar
from pymeshlab_curvature_lines.render import render

CHECKOUT = Path(__file__).resolve().parent.parent
SCANS = Path(pymeshlab.__file__).parent / "tests" / "sample_meshes"
SAMPLES = [
    SCANS / "bunny.obj",
    SCANS / "rangemaps" / "face000.ply",
    SCANS / "chameleon.pts",
    CHECKOUT / "sample_data" / "helicoid_1730_noise0.5_outliers5.ply",  # an open surface with outliers
]


def run(file: Path, out: Path) -> Reconstruction:
    cloud = load_cloud(file)
    with progress_bar(f"{file.stem[:20]:<22}") as report:
        result = reconstruct(cloud, report, lines=True)
    result.save(result.mesh, out / f"{file.stem}_mesh.obj")
    result.save(result.lines, out / f"{file.stem}_lines.obj")
    mesh, lines = result.layer(result.mesh), result.layer(result.lines)
    render(out / f"{file.stem}_cloud.png", result.layer(result.cleaned))
    render(out / f"{file.stem}_lines.png", mesh, lines)
    render(out / f"{file.stem}_mesh.png", mesh)
    return result


def table(header: list[str], rows: list[list[str]]) -> str:
    widths = [max(map(len, column)) for column in zip(header, *rows)]
    lines = ("  ".join(cell.rjust(width) for cell, width in zip(row, widths)) for row in [header, *rows])
    return "\n".join(lines)


def main() -> int:
    files = [Path(name) for name in sys.argv[1:]] or SAMPLES
    if missing := [file for file in files if not file.is_file()]:
        print(f"demo: no such file: {missing[0]}", file=sys.stderr)
        return 2
    out = CHECKOUT / "out"
    out.mkdir(exist_ok=True)
    results = {file.stem: run(file, out) for file in files}

    columns = ["points", "outliers", "lines", "vertices", "faces", "quads", "euler_characteristic"]
    print(
        "\n"
        + table(
            ["", *columns[:-2], "% quads", "Euler", "seconds"],
            [
                [name]
                + [str(found.counts[column]) for column in columns[:-2]]
                + [f"{100 * found.counts['quads'] / found.counts['faces']:.1f}"]
                + [str(found.counts["euler_characteristic"]), f"{found.seconds['total']:.1f}"]
                for name, found in results.items()
            ],
        )
    )
    stages = list(dict.fromkeys(stage for found in results.values() for stage in found.seconds if stage != "total"))
    print(
        "\nseconds per stage\n"
        + table(
            ["", *stages],
            [[name] + [f"{found.seconds.get(stage, 0):.2f}" for stage in stages] for name, found in results.items()],
        )
    )
    print(f"\nmeshes, lines and pictures: {out.relative_to(CHECKOUT)}/")
    return 0


if __name__ == "__main__":
    sys.exit(main())
