# Everything a user does with the plugin in MeshLab's window; run.sh starts one scenario after another in the root.
# SPDX-License-Identifier: GPL-3.0-or-later
"""usage: tour.py SCENARIO: what it makes goes to the folder out, numbers to out/SCENARIO.json."""

from __future__ import annotations

import json
import os
import re
import shutil
import sys
import time
from pathlib import Path

from desktop import Desktop, Failure
from window import MeshLab

HERE = Path(__file__).parent
CLOUDS = HERE / "clouds"
OUT = HERE / "out"
EXTRA_PLUGINS = Path(os.environ["XDG_DATA_HOME"]) / "VCG/MeshLab_64bit_fp/MeshLabExtraPlugins/2025.07"
PLUGIN = "libfilter_curvature_lines.so"

POINTS = "Point Set"
CURVATURE = "Robust Curvature (M-Estimation)"
PIPELINE = "Surface Reconstruction: Curvature-Aligned Quads"
RAY_TRACING = "Ray-Trace Point-Set Surface"
MESHES = "Polygonal and Quad Mesh"
QUAD_MESH = "Build Curvature-Aligned Quad Mesh"
# In the order a user goes: layer, menu, filter, what is filled in, name of the pictures.
FILTERS = [
    ("cloud", POINTS, CURVATURE, {"Quality": "Curvedness"}, "curvature"),
    ("cloud", POINTS, "Select Outliers by Robust Curvature", {"Sensitivity (noise units)": 4}, "outliers"),
    ("cloud", POINTS, "Denoise Point Cloud by Robust Curvature", {}, "denoising"),
    ("cloud", POINTS, "Smooth Principal Directions", {"Smoothness (0 to 1)": 0.7}, "directions"),
    ("cloud", POINTS, "Trace Lines of Curvature", {"Target number of crossings (0: none)": 400}, "lines"),
    ("lines of curvature", MESHES, QUAD_MESH, {"Split concave faces": False}, "quad_mesh"),
    ("cube", POINTS, "Extract Sharp Feature Lines", {"Smallest angle (degrees)": 40}, "sharp_features"),
    (
        "cloud",
        POINTS,
        PIPELINE,
        {"Target number of vertices (0: automatic)": 500, "Keep intermediate layers": True},
        "pipeline",
    ),
    ("cloud", POINTS, "M-Weighted Curvature (Euler Least Squares)", {"Quality": "Shape Index"}, "m_weighted"),
    ("cloud", POINTS, "Curvature-Driven Projection", {"Points per vertex (1: move)": 4}, "projection"),
    ("cloud", POINTS, RAY_TRACING, {"Image file": OUT / "ray_traced.png", "Colour": "Curvature"}, "ray_tracing"),
]

SAVED_AS_OBJ = ("lines", "quad_mesh", "sharp_features", "pipeline")
SCRIPTS = {
    "cleaning": (2, "cloud", "ply"),
    "lines": (4, "lines of curvature", "obj"),
    "pipeline": (1, "curvature-aligned mesh", "obj"),
}


def numbers(log: str) -> dict[str, float]:
    """What the last filter wrote into MeshLab's log."""
    last = re.split(r"Applied filter[^\n]*\n", log.strip() + "\n")[-2]
    return {key: float(value) for key, value in re.findall(r"(\w+): (-?[\d.e+-]+)$", last, re.MULTILINE)}


def every_filter(desktop: Desktop) -> dict:
    """Each filter from its menu, by its dialog; what it made is saved."""
    meshlab = MeshLab(desktop, OUT / "filters.log", CLOUDS / "cloud.ply", CLOUDS / "cube.ply")
    results = {}
    for layer, menu, name, values, picture in FILTERS:
        meshlab.choose_layer(layer)
        dialog = meshlab.filter(menu, name)
        dialog.screenshot(f"dialog_{picture}")
        for label, value in values.items():
            dialog.set(label, value)
        if message := dialog.apply():
            raise Failure(f"'{name}' said: {message}")
        dialog.close()
        desktop.screenshot(f"after_{picture}")
        results[picture] = numbers(meshlab.log())
        print(f"{name}: {len(results[picture])} numbers in the log")
        if picture == "curvature":
            meshlab.export(OUT / "curvature.ply", "curv_k1", "curv_k2")
        elif picture in SAVED_AS_OBJ:
            meshlab.export(OUT / f"{picture}.obj")
    return results


def scripts(desktop: Desktop) -> dict:
    """The filter scripts that come with the package."""
    results = {}
    for name, (filters, layer, suffix) in SCRIPTS.items():
        meshlab = MeshLab(desktop, OUT / "scripts.log", CLOUDS / "cloud.ply")
        if message := meshlab.apply_script(HERE / f"scripts/{name}.mlx", filters):
            raise Failure(f"{name}.mlx said: {message}")
        meshlab.choose_layer(layer)
        meshlab.export(OUT / f"script_{name}.{suffix}")
        desktop.screenshot(f"script_{name}")
        results[name] = numbers(meshlab.log())
        print(f"{name}.mlx: {filters} filters applied")
        desktop.stop(meshlab.process)
    return results


def errors(desktop: Desktop) -> dict:
    """What cannot work ends in a message, and MeshLab lives on."""
    meshlab = MeshLab(desktop, OUT / "errors.log", CLOUDS / "no_normals.ply")
    expected: list[tuple[str, str, dict, str]] = [(POINTS, PIPELINE, {"Estimate normals": "Never"}, "no normals")]
    expected.append((MESHES, QUAD_MESH, {}, "holds no lines"))
    expected.append((POINTS, PIPELINE, {"Anisotropy (1: square faces)": 99}, "allowed are values from 1 to 10"))
    expected.append((POINTS, RAY_TRACING, {"Image file": ""}, "file"))
    messages = {}
    for menu, name, values, word in expected:
        dialog = meshlab.filter(menu, name)
        for label, value in values.items():
            dialog.set(label, value)
        message = dialog.apply(picture=f"error_{len(messages)}")
        dialog.close()
        if not message or word not in message:
            raise Failure(f"'{name}' said {message!r}, not '{word}'")
        print(f"{name}: {' '.join(re.sub('<[^>]*>', ' ', message).split())}")
        messages[f"{name} {len(messages)}"] = message
    dialog = meshlab.filter(POINTS, PIPELINE)
    if message := dialog.apply():
        raise Failure(f"'{PIPELINE}' no longer runs: {message}")
    return messages


def large(desktop: Desktop) -> dict:
    """200 000 points: the bar moves, and the window answers."""
    meshlab = MeshLab(desktop, OUT / "large.log", CLOUDS / "large.ply")
    results = {}
    for name, picture in ((CURVATURE, "large_curvature"), (PIPELINE, "large_pipeline")):
        moves: list[tuple[float, int]] = [(time.monotonic(), 0)]

        def watch(percent: int) -> None:
            if percent != moves[-1][1]:
                moves.append((time.monotonic(), percent))
                if 40 <= percent <= 60:
                    desktop.screenshot(f"progress_{picture}")

        dialog = meshlab.filter(POINTS, name)
        if message := dialog.apply(900, watch):
            raise Failure(f"'{name}' said: {message}")
        dialog.close()
        desktop.screenshot(picture)
        told = numbers(meshlab.log())
        still = max(after - before for (before, _), (after, _) in zip(moves, moves[1:]))
        print(
            f"{name}: {told['seconds_total']:.1f} s, the bar moved {len(moves)} times and stood still {still:.1f} s at most"
        )
        if len(moves) < 10:
            raise Failure(f"the progress bar showed {moves} only")
        results[picture] = told | {"progress_moves": len(moves), "progress_longest_still": still}
    return results


def plugin_info(desktop: Desktop) -> dict:
    """Without the folder of extra plugins: loaded by the user, in Help, Plugin Info."""
    shutil.rmtree(EXTRA_PLUGINS)
    meshlab = MeshLab(desktop, OUT / "plugin_info.log", CLOUDS / "cloud.ply")
    meshlab.load_plugin(HERE / PLUGIN)
    if message := meshlab.filter(POINTS, CURVATURE).apply():
        raise Failure(f"'{CURVATURE}' said: {message}")
    return numbers(meshlab.log())


SCENARIOS = {scenario.__name__: scenario for scenario in (every_filter, scripts, errors, large, plugin_info)}


def main() -> None:
    name = sys.argv[1]
    EXTRA_PLUGINS.mkdir(parents=True)
    shutil.copy(HERE / PLUGIN, EXTRA_PLUGINS)
    with Desktop(OUT) as desktop:
        try:
            results = SCENARIOS[name](desktop)
        except Exception:
            desktop.screenshot(f"failure_{name}")
            raise
    (OUT / f"{name}.json").write_text(json.dumps(results, indent="\t"))


if __name__ == "__main__":
    main()
