# One self-contained HTML page about a reconstruction: pictures, histograms, counts, timings, parameters, versions.
# SPDX-License-Identifier: GPL-3.0-or-later
"""The report of the command line."""

from __future__ import annotations

import platform
from base64 import b64encode
from collections.abc import Mapping
from html import escape
from importlib.metadata import version
from os import PathLike

import numpy as np

from .files import whole_file
from .pipeline import Reconstruction

_PAGE = """<!DOCTYPE html>
<html lang="en">
<meta charset="utf-8">
<meta name="viewport" content="width=device-width">
<title>{title}</title>
<style>
body {{ font: 16px/1.5 sans-serif; max-width: 72rem; margin: 2rem auto; padding: 0 1rem; color: #1f2d3d }}
.row {{ display: flex; flex-wrap: wrap; gap: 1rem 2rem; align-items: flex-start }}
.row > * {{ flex: 1 1 20rem; margin: 0 }}
figure img, figure svg {{ width: 100%; height: auto; border: 1px solid #d8dee6; box-sizing: border-box }}
figcaption {{ color: #5b6b7c }}
table {{ border-collapse: collapse; margin: 1rem 0 }}
caption {{ font-weight: bold; text-align: left }}
td, th {{ border-bottom: 1px solid #d8dee6; padding: 0.1rem 0; text-align: left; font-weight: normal }}
td {{ text-align: right; padding-left: 1rem; font-variant-numeric: tabular-nums }}
</style>
<h1>{title}</h1>
<p>{summary}</p>
<div class="row">{pictures}</div>
<h2>Curvature and cleaning</h2>
<div class="row">{histograms}</div>
<h2>Numbers</h2>
<div class="row">{tables}</div>
</html>
"""
_BARS, _WIDTH, _HEIGHT = 60, 420, 200


def number(value: object) -> str:
    """An int in full, a float with four significant digits, anything else as it is."""
    if isinstance(value, bool) or not isinstance(value, (int, float)):
        return str(value)
    return str(value) if isinstance(value, int) else f"{value:.4g}"


def write_report(
    path: str | PathLike[str],
    title: str,
    result: Reconstruction,
    parameters: Mapping[str, object],
    pictures: Mapping[str, bytes],
) -> None:
    """Writes the page; ``parameters`` are the filter's, ``pictures`` maps captions to the contents of PNG files."""
    counts = result.counts
    cloud = result.layer(result.cleaned)
    curvature = [cloud.vertex_custom_scalar_attribute_array(f"curv_k{k}") for k in (1, 2)]
    moved = cloud.vertex_custom_scalar_attribute_array("moved")
    summary = (
        f"{counts['points']} points, {counts['outliers']} of them outliers, became {counts['faces']} faces, "
        f"{100 * counts['quads'] / max(1, counts['faces']):.1f} % of them quads, Euler characteristic "
        f"{counts['euler_characteristic']}, in {result.seconds['total']:.1f} seconds."
    )
    versions = {name: version(name) for name in ("pymeshlab-curvature-lines", "pymeshlab", "numpy")}
    versions |= {"Python": platform.python_version(), "system": f"{platform.system()} {platform.machine()}"}
    tables = {"Counts": counts, "Seconds": result.seconds, "Parameters": parameters, "Versions": versions}
    page = _PAGE.format(
        title=escape(title),
        summary=escape(summary),
        pictures="".join(_figure(caption, _image(data)) for caption, data in pictures.items()),
        histograms=_figure(
            "Principal curvatures k1 (red) and k2 (blue), 1 / length; convex is positive", _histogram(*curvature)
        )
        + _figure("How far points moved when the cloud was denoised, in its units", _histogram(moved)),
        tables="".join(_table(caption, rows) for caption, rows in tables.items()),
    )
    with whole_file(path) as partial:
        partial.write_text(page, encoding="utf-8")


def _figure(caption: str, content: str) -> str:
    return f"<figure>{content}<figcaption>{escape(caption)}</figcaption></figure>\n"


def _image(data: bytes) -> str:
    return f'<img alt="" src="data:image/png;base64,{b64encode(data).decode()}">'


def _histogram(*series: np.ndarray) -> str:
    """Drawn in the page itself; the axis leaves out the outermost half per cent on each side."""
    values = np.concatenate(series)
    low, high = np.percentile(values, (0.5, 99.5)) if len(values) else (0.0, 0.0)
    if not high > low:
        low, high = low - 0.5, low + 0.5
    bins = [np.histogram(one, _BARS, (low, high))[0] for one in series]
    tallest = max(1, max(counts.max() for counts in bins))
    bar, floor = _WIDTH / _BARS, _HEIGHT - 24
    shapes = []
    for counts, color in zip(bins, ("#c8442e", "#2e62c8")):
        heights = counts * (floor - 20) / tallest
        shapes += [
            f'<rect x="{k * bar:.1f}" y="{floor - height:.1f}" width="{bar:.1f}" height="{height:.1f}" '
            f'fill="{color}" fill-opacity="0.6"/>'
            for k, height in enumerate(heights)
            if height
        ]
    labels = "".join(
        f'<text x="{place * _WIDTH:.0f}" y="{_HEIGHT - 8}" text-anchor="{anchor}">{number(float(low + place * (high - low)))}</text>'
        for place, anchor in ((0.0, "start"), (0.5, "middle"), (1.0, "end"))
    )
    return (
        f'<svg viewBox="-8 0 {_WIDTH + 16} {_HEIGHT}" font-size="12" fill="#1f2d3d">'
        f'<text x="0" y="14">{tallest} points</text>{"".join(shapes)}'
        f'<path d="M0 {floor}H{_WIDTH}" stroke="#1f2d3d"/>{labels}</svg>'
    )


def _table(caption: str, rows: Mapping[str, object]) -> str:
    body = "".join(
        f"<tr><th>{escape(name.replace('_', ' '))}</th><td>{escape(number(value))}</td></tr>\n"
        for name, value in rows.items()
    )
    return f"<table>\n<caption>{escape(caption)}</caption>\n{body}</table>"
