# Text files of points: layouts that scanners and programs write, each with what its columns are.
# SPDX-License-Identifier: GPL-3.0-or-later
import numpy as np
import pytest

tables = pytest.importorskip("pymeshlab_curvature_lines.tables", reason="tests a plugin file, not the package")

RANDOM = np.random.default_rng(1)
NORMALS = RANDOM.normal(size=(300, 3))
NORMALS /= np.linalg.norm(NORMALS, axis=1, keepdims=True)
POINTS = 10.0 * NORMALS + [403000.0, 5804900.0, 120.0]
COLORS = RANDOM.integers(0, 256, (300, 3))
INTENSITY = RANDOM.integers(0, 4096, 300)

# Name: columns, their format, what np.savetxt takes besides, roles of the columns.
LAYOUTS = {
    "coordinates": ([POINTS], "%.9f", {}, "x"),
    "normals": ([POINTS, NORMALS], "%.9f", {}, "xn"),
    "long_normals": ([POINTS, 7.5 * NORMALS], "%.9f", {}, "xn"),
    "colors": ([POINTS, COLORS], "%.9f %.9f %.9f %d %d %d", {}, "xc"),
    "colors_as_floats": ([POINTS, COLORS], "%.9f", {}, "xc"),
    "intensity": ([POINTS, INTENSITY], "%.9f", {}, "x"),
    "intensity_colors": ([POINTS, INTENSITY - 2048, COLORS], "%.9f", {}, "xc"),
    "colors_normals": ([POINTS, COLORS, NORMALS], "%.9f", {}, "xcn"),
    "normals_colors": ([POINTS, NORMALS, COLORS], "%.9f", {}, "xnc"),
    "count_first": ([POINTS, COLORS], "%.9f", {"header": "300", "comments": ""}, "xc"),
    "commas": ([POINTS, NORMALS], "%.9f", {"delimiter": ","}, "xn"),
    "commas_and_blanks": ([POINTS, NORMALS], "%.9f", {"delimiter": ", "}, "xn"),
    "semicolons": ([POINTS, NORMALS], "%.9f", {"delimiter": ";"}, "xn"),
    "tabs": ([POINTS, COLORS], "%.9f", {"delimiter": "\t"}, "xc"),
    "carriage_returns": ([POINTS, NORMALS], "%.9f", {"newline": "\r\n"}, "xn"),
    "named": ([POINTS, NORMALS], "%.9f", {"header": "X,Y,Z,Nx,Ny,Nz", "comments": "", "delimiter": ","}, "xn"),
    "named_in_a_comment": ([POINTS, COLORS], "%.9f", {"header": "x y z red green blue", "comments": "# "}, "xc"),
    "named_with_units": (
        [POINTS, COLORS],
        "%.9f",
        {"header": "X[m];Y[m];Z[m];R;G;B", "comments": "//", "delimiter": ";"},
        "xc",
    ),
    "exponents": ([POINTS, NORMALS], "%.16e", {}, "xn"),
}


@pytest.mark.parametrize("name", LAYOUTS)
def test_columns_are_found(name, tmp_path):
    columns, form, more, roles = LAYOUTS[name]
    file = tmp_path / "cloud.txt"
    np.savetxt(file, np.column_stack(columns), fmt=form, **more)
    read = tables.read_points(file)
    assert np.allclose(read.positions, POINTS, rtol=0, atol=1e-8)
    assert (read.normals is not None) == ("n" in roles)
    if "n" in roles:
        lengths = np.linalg.norm(read.normals, axis=1, keepdims=True)
        assert np.allclose(read.normals / lengths, NORMALS, atol=1e-7)
    assert (read.colors is not None) == ("c" in roles)
    if "c" in roles:
        assert np.allclose(255.0 * read.colors, COLORS, atol=1e-9)
    assert "coordinates in columns 1 to 3" in read.columns
    assert ("not used" in read.columns) == ("intensity" in name)


def test_named_columns_may_be_in_any_order(tmp_path):
    file = tmp_path / "cloud.csv"
    file.write_text(
        "\ufeffid;label;z;y;x\n" + "\n".join(f"{i};wall;{z};{y};{x}" for i, (x, y, z) in enumerate(POINTS.tolist())),
        encoding="utf-8",
    )
    with pytest.raises(ValueError, match="no line of it begins with three numbers"):
        tables.read_points(file)
    file.write_text(
        "id,z,y,x,label\n" + "\n".join(f"{i},{z},{y},{x},wall" for i, (x, y, z) in enumerate(POINTS.tolist()))
    )
    read = tables.read_points(file)
    assert np.array_equal(read.positions, POINTS)
    assert read.columns == "coordinates in columns 4, 3, 2, columns 1, 5 not used"


def test_decimal_commas(tmp_path):
    file = tmp_path / "cloud.asc"
    for separator in (" ", ";", "\t"):
        rows = (separator.join(f"{value:.6f}".replace(".", ",") for value in row) for row in POINTS)
        file.write_text("\n".join(rows))
        assert np.allclose(tables.read_points(file).positions, POINTS, atol=1e-5)


def test_comments_blank_lines_and_points_that_are_nowhere(tmp_path):
    file = tmp_path / "cloud.xyz"
    file.write_text("# scan 7\n\n1 2 3\n// more\n4 5 nan\n\n7 8 9\n")
    assert np.array_equal(tables.read_points(file).positions, [[1, 2, 3], [4, 5, np.nan], [7, 8, 9]], equal_nan=True)


@pytest.mark.parametrize(
    "text, words",
    [
        ("", "holds no points"),
        ("nothing here\n", "holds no points"),
        ("1 2\n3 4\n", "holds no points"),
        ("\x00\x01\x02", "holds no points"),
        ("1 2 3\n4 5\n", "line 2 has 2 columns, the first points have 3"),
        ("1 2 3\n4 five 6\n", "line 2: 'five' is no number"),
    ],
)
def test_what_is_no_table_of_points_is_refused(text, words, tmp_path):
    file = tmp_path / "cloud.xyz"
    file.write_text(text)
    with pytest.raises(ValueError, match=words):
        tables.read_points(file)
