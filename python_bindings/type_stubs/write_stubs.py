# Writes the type stub of the package from the filters' own declarations: what editors and type checkers know of them.
# SPDX-License-Identifier: GPL-3.0-or-later
"""Run it after a change of parameters: python python_bindings/type_stubs/write_stubs.py"""

import os
import re
import sys
import tempfile
import textwrap
import xml.etree.ElementTree as ElementTree
from html import unescape
from pathlib import Path

os.environ["QT_HASH_SEED"] = "0"  # the order of the choices of a parameter in a filter script

import pymeshlab_curvature_lines as package  # noqa: E402

BINDINGS = Path(__file__).parents[1]
STUB = BINDINGS / "pymeshlab_curvature_lines" / "__init__.pyi"
sys.path.insert(0, str(BINDINGS / "filter_scripts"))
import write_scripts  # noqa: E402

WIDTH = 120
TYPES = {
    "RichBool": "bool",
    "RichInt": "int",
    "RichFloat": "float",
    "RichSaveFile": "str",
    "RichMesh": "int",  # id of a layer
    "RichColor": "pymeshlab.Color",
    "RichPosition": "ArrayLike",
    "RichDirection": "ArrayLike",
}
HEAD = '''\
# What the package binds to pymeshlab.MeshSet, for editors and type checkers. Written by type_stubs/write_stubs.py.
# SPDX-License-Identifier: GPL-3.0-or-later
from pathlib import Path
from typing import Literal

import pymeshlab
from numpy.typing import ArrayLike

from .files import load_cloud as load_cloud
from .files import save_mesh as save_mesh

__all__: list[str]
__version__: str

def plugin_path() -> Path:
    """The plugin's file, for ``pymeshlab.load_plugin``."""

def filters() -> dict[str, str]:
    """The names of the filters, each with one line about what it does."""

class MeshSet(pymeshlab.MeshSet):
    """``pymeshlab.MeshSet``, with the filters of this package by name and type; the same class when the program runs."""
'''


def declarations(name: str, folder: Path) -> list[ElementTree.Element]:
    """The parameters of a filter, as the host writes them into a script of what it did."""
    meshes = write_scripts.ellipsoid()
    if name == "generate_curvature_aligned_quad_mesh":
        meshes.generate_curvature_lines()
        meshes.clear_filter_script()
    given = {"image_file": str(folder / "image.png")} if name == "save_ray_traced_point_set_image" else {}
    meshes.apply_filter(name, **given)
    script = folder / "script.mlx"
    meshes.save_filter_script(str(script))
    return list(ElementTree.parse(script).getroot().iter("Param"))


def plain(html: str) -> str:
    """Without markup; the entries of a list one after another."""
    text = re.sub(r"</li>\s*<li>", "; ", html)
    text = re.sub(r"<ul>", " ", text)
    return " ".join(unescape(re.sub(r"<[^>]*>", "", text)).split())


def choices(parameter: ElementTree.Element) -> list[str]:
    return [parameter.attrib[f"enum_val{k}"] for k in range(int(parameter.attrib["enum_cardinality"]))]


def argument(parameter: ElementTree.Element) -> str:
    """``name: type = default``; no default where it depends on the layers."""
    kind, value = parameter.attrib["type"], parameter.attrib.get("value", "")
    if kind == "RichEnum":
        names = choices(parameter)
        listed = ", ".join(f'"{name}"' for name in names)
        return f'{parameter.attrib["name"]}: Literal[{listed}] = "{names[int(value)]}"'
    default = "..."
    if kind == "RichBool":
        default = value.capitalize()
    elif kind == "RichInt":
        default = value
    elif kind == "RichFloat":
        default = repr(float(value))
    return f"{parameter.attrib['name']}: {TYPES[kind]} = {default}"


def method(name: str, description: str, parameters: list[ElementTree.Element]) -> str:
    lines = [f"    def {name}(", "        self,"]
    if parameters:
        lines += ["        *,", *(f"        {argument(parameter)}," for parameter in parameters)]
    lines += ["    ) -> dict[str, float]:", f'        """{description}.']
    for parameter in parameters:
        text = f"{parameter.attrib['name']}: {plain(parameter.attrib['tooltip'])}"
        lines += ["", *textwrap.wrap(text, WIDTH, initial_indent=" " * 8, subsequent_indent=" " * 12)]
    return "\n".join([*lines, '        """', ""])


def stub() -> str:
    with tempfile.TemporaryDirectory() as folder:
        methods = [
            method(name, description, declarations(name, Path(folder)))
            for name, description in package.filters().items()
        ]
    return "\n".join([HEAD, *methods])


if __name__ == "__main__":
    STUB.write_text(stub())
    print(STUB)
