# Text files of points: which columns are coordinates, normals and colours is found from header and content.
# SPDX-License-Identifier: GPL-3.0-or-later
"""Points from the text that scanners and programs write: xyz, txt, csv, pts, asc."""

from __future__ import annotations

import re
import warnings
from collections.abc import Sequence
from dataclasses import dataclass
from os import PathLike
from pathlib import Path

import numpy as np

SUFFIXES = (".xyz", ".txt", ".csv", ".pts", ".asc")

_LOOKED_AT = 200  # lines that decide what the columns are
_COMMENT = re.compile(r"^\s*(#|//|!|%|;)\s*")
_NUMBER = re.compile(r"^[+-]?(\d+\.?\d*|\.\d+)([eEdD][+-]?\d+)?$|^[+-]?(nan|inf|infinity)$", re.IGNORECASE)
_UNIT = 0.05  # by how much the length of a normal may be off 1
_MOST = 0.95  # share of the rows of which that must hold

_ROLES = {
    "x": "x y z".split(),
    "nx": "nx ny nz".split(),
    "red": "red green blue".split(),
}
_NAMES = {
    **{name: name for names in _ROLES.values() for name in names},
    **{"easting": "x", "northing": "y", "height": "z", "elevation": "z", "altitude": "z"},
    **{f"{axis}{suffix}": axis for axis in "xyz" for suffix in ("coord", "coordinate", "m")},
    **{f"{prefix}{axis}": f"n{axis}" for axis in "xyz" for prefix in ("normal", "norm", "normal_")},
    **{"r": "red", "g": "green", "b": "blue"},
}


@dataclass
class PointTable:
    """What a text file holds; N points."""

    positions: np.ndarray  # N x 3
    normals: np.ndarray | None  # N x 3, of any length
    colors: np.ndarray | None  # N x 3, 0..1
    columns: str  # in words: what each column was taken for


def read_points(file: str | PathLike[str]) -> PointTable:
    """Raises ``ValueError`` with the cause when the file is no table of points."""
    path = Path(file)
    with path.open(encoding="utf-8-sig", errors="replace") as stream:
        lines = stream.read().splitlines()
    start, names = _data_start(lines)
    if start is None:
        raise ValueError("no line of it begins with three numbers: it holds no points, or no text")
    separator, decimal_comma = _separator(lines[start])
    count = len(_fields(lines[start], separator))
    table = _parse(lines, start, separator, decimal_comma, count)
    roles = _roles_by_name(names, count) or _roles_by_content(table)
    return _as_points(table, roles)


def _is_number(word: str) -> bool:
    return bool(_NUMBER.match(word.replace(",", ".", 1)))


def _fields(line: str, separator: str | None) -> list[str]:
    return [field.strip().strip('"') for field in line.strip().rstrip(separator).split(separator)]


def _separator(line: str) -> tuple[str | None, bool]:
    """The separator (None: blanks), and whether numbers have a decimal comma."""
    line = line.strip()
    if ";" in line:
        return ";", "," in line
    words = line.split()
    if "," not in line:
        return None, False
    # "1,5 2,5 3,5" against "1, 2, 3" and "1,2,3"
    if len(words) >= 3 and all(_is_number(word) and word.count(",") <= 1 for word in words):
        return None, True
    return ",", False


def _numbers_in(line: str) -> int:
    """How many fields of a line are numbers; 0 when one of the first three is none."""
    separator, _ = _separator(line)
    good = [_is_number(field) for field in _fields(line, separator)]
    return sum(good) if len(good) >= 3 and all(good[:3]) else 0


def _data_start(lines: Sequence[str]) -> tuple[int | None, list[str]]:
    """The first line of numbers, and the names of the columns from the line before it, if it has any."""
    names: list[str] = []
    for place, line in enumerate(lines):
        if not _COMMENT.match(line) and _numbers_in(line) >= 3:
            return place, names
        bare = _COMMENT.sub("", line).strip()
        if bare:
            words = re.split(r"[\s,;]+", bare)
            names = [] if all(_is_number(word) for word in words) else [_plain(word) for word in words]
    return None, names


def _plain(name: str) -> str:
    """A column's name without units, quotes and capitals."""
    return re.sub(r"[\[(].*?[\])]|[^a-z0-9_]", "", name.lower()).strip("_")


def _parse(lines: Sequence[str], start: int, separator: str | None, decimal_comma: bool, count: int) -> np.ndarray:
    """Columns of numbers; NaN where a field is none."""
    rows = [(place, line) for place, line in enumerate(lines[start:], start + 1) if line.strip()]
    rows = [(place, line) for place, line in rows if not _COMMENT.match(line)]
    texts = [line.replace(",", ".") if decimal_comma else line for _, line in rows]
    texts = [re.sub(r"(?<=\d)[dD](?=[+-]?\d)", "e", text) if "d" in text.lower() else text for text in texts]
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("error")
            table = np.loadtxt(texts, delimiter=separator, comments=None, ndmin=2, quotechar='"')
    except (ValueError, UserWarning):
        table = _parse_slowly(rows, separator, decimal_comma, count)
    return table


def _parse_slowly(
    rows: Sequence[tuple[int, str]], separator: str | None, decimal_comma: bool, count: int
) -> np.ndarray:
    """Of tables with words among the numbers; names the line that is no row of the table."""
    table = np.full((len(rows), count), np.nan)
    for row, (place, line) in enumerate(rows):
        fields = _fields(line.replace(",", ".") if decimal_comma else line, separator)
        if len(fields) != count:
            raise ValueError(f"line {place} has {len(fields)} columns, the first points have {count}")
        for column, field in enumerate(fields):
            if _is_number(field):
                table[row, column] = float(re.sub("[dD]", "e", field))
            elif column < 3 and field:
                raise ValueError(f"line {place}: '{field}' is no number")
    return table


def _roles_by_name(names: Sequence[str], count: int) -> dict[str, list[int]]:
    """Columns of "x", "nx" and "red" with the two after each; empty when the names do not say where x, y, z are."""
    if len(names) != count:
        return {}
    known = [_NAMES.get(name, "") for name in names]
    roles = {}
    for first, members in _ROLES.items():
        if all(known.count(member) == 1 for member in members):
            roles[first] = [known.index(member) for member in members]
    return roles if "x" in roles else {}


def _roles_by_content(table: np.ndarray) -> dict[str, list[int]]:
    """The first three columns are coordinates; others are normals if they are of length 1, colours if whole and small."""
    roles = {"x": [0, 1, 2]}
    some = table[:: max(1, len(table) // 10000)]
    free = 3
    while free + 3 <= table.shape[1]:
        columns = list(range(free, free + 3))
        values = some[:, columns]
        if "nx" not in roles and _are_normals(values, table.shape[1]):
            roles["nx"] = columns
            free += 3
        elif "red" not in roles and _are_colors(values):
            roles["red"] = columns
            free += 3
        else:
            free += 1
    return roles


def _are_colors(values: np.ndarray) -> bool:
    finite = np.isfinite(values).all()
    return bool(finite and (values == np.round(values)).all() and values.min() >= 0 and values.max() <= 255)


def _are_normals(values: np.ndarray, columns: int) -> bool:
    """Of length 1; in a table of six columns of any length, where they are no whole numbers and look to all sides."""
    finite = np.isfinite(values).all(axis=1)
    lengths = np.linalg.norm(values[finite], axis=1)
    if not len(lengths):
        return False
    if np.mean(np.abs(lengths - 1.0) < _UNIT) > _MOST:
        return True
    whole = (values[finite] == np.round(values[finite])).all()
    return bool(columns == 6 and not whole and (values[finite].min(axis=0) < 0).any())


def _as_points(table: np.ndarray, roles: dict[str, list[int]]) -> PointTable:
    normals = table[:, roles["nx"]] if "nx" in roles else None
    colors = None
    if "red" in roles:
        colors = table[:, roles["red"]]
        colors = np.clip(np.nan_to_num(colors) / (255.0 if np.nanmax(colors, initial=0) > 1.0 else 1.0), 0.0, 1.0)
    words = {"x": "coordinates", "nx": "normals", "red": "colours"}
    used = [f"{words[role]} in columns {_span(columns)}" for role, columns in roles.items()]
    rest = sorted(set(range(table.shape[1])) - {column for columns in roles.values() for column in columns})
    if rest:
        used.append(f"column{'s' if len(rest) > 1 else ''} {_span(rest)} not used")
    return PointTable(table[:, roles["x"]], normals, colors, ", ".join(used))


def _span(columns: Sequence[int]) -> str:
    """Columns counted from 1."""
    if len(columns) > 1 and list(columns) == list(range(columns[0], columns[0] + len(columns))):
        return f"{columns[0] + 1} to {columns[-1] + 1}"
    return ", ".join(str(column + 1) for column in columns)
