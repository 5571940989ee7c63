# One self-contained HTML page about a reconstruction: counts, timings and a picture.
# SPDX-License-Identifier: GPL-3.0-or-later
"""The report of the command line."""

from __future__ import annotations

from base64 import b64encode
from html import escape
from os import PathLike
from pathlib import Path

_PAGE = """<!DOCTYPE html>
<html lang="en">
<meta charset="utf-8">
<title>{title}</title>
<style>
body {{ font: 16px/1.5 sans-serif; max-width: 60rem; margin: 2rem auto; padding: 0 1rem; color: #1f2d3d }}
img {{ width: 100%; border: 1px solid #d8dee6 }}
table {{ border-collapse: collapse; margin: 1rem 0 }}
caption {{ font-weight: bold; text-align: left }}
td, th {{ border-bottom: 1px solid #d8dee6; padding: 0.2rem 1rem 0.2rem 0; text-align: left; font-weight: normal }}
td {{ text-align: right; font-variant-numeric: tabular-nums }}
</style>
<h1>{title}</h1>
{picture}{tables}
</html>
"""


def number(value: float) -> str:
    """An int in full, a float with four significant digits."""
    return str(value) if isinstance(value, int) else f"{value:.4g}"


def write_report(
    path: str | PathLike[str], title: str, tables: dict[str, dict[str, float]], picture: bytes | None
) -> None:
    """Writes the page; ``tables`` maps captions to rows, ``picture`` is a PNG file's content."""
    image = f'<img alt="" src="data:image/png;base64,{b64encode(picture).decode()}">\n' if picture else ""
    Path(path).write_text(
        _PAGE.format(
            title=escape(title),
            picture=image,
            tables="\n".join(_table(caption, rows) for caption, rows in tables.items()),
        ),
        encoding="utf-8",
    )


def _table(caption: str, rows: dict[str, float]) -> str:
    body = "".join(
        f"<tr><th>{escape(name.replace('_', ' '))}</th><td>{number(value)}</td></tr>\n" for name, value in rows.items()
    )
    return f"<table>\n<caption>{escape(caption)}</caption>\n{body}</table>"
