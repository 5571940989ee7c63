# What stands in several files of the repository is the same in all of them, and every source names its licence.
# SPDX-License-Identifier: GPL-3.0-or-later
import re

from helpers import CHECKOUT

LICENCE = "SPDX-License-Identifier: GPL-3.0-or-later"
FOLDERS = [
    ".github",
    "benchmarks",
    "cmake",
    "docs",
    "filter_curvature_lines",
    "python_bindings",
    "sample_data",
    "scripts",
    "tests",
]


def found(pattern, page):
    first = re.search(pattern, (CHECKOUT / page).read_text(), re.MULTILINE)
    assert first, f"{page}: nothing like {pattern}"
    return first[1]


def test_one_version():
    version = found(r"^project\(filter_curvature_lines VERSION ([\d.]+)", "CMakeLists.txt")
    assert found(r"^version: ([\d.]+)$", "CITATION.cff") == version
    assert version in (CHECKOUT / "CHANGELOG.md").read_text()


def test_tools_have_one_version():
    for tool in ["clang-format", "ruff"]:
        pinned = found(rf'"{tool}==([\d.]+)"', "pyproject.toml")
        hooks = re.findall(rf"\[{tool}==([\d.]+)\]", (CHECKOUT / ".pre-commit-config.yaml").read_text())
        assert hooks and set(hooks) == {pinned}, tool


def test_every_source_names_its_licence_in_its_head():
    kinds = {".h", ".cpp", ".py", ".sh", ".cmake", ".yml"}
    sources = [file for folder in FOLDERS for file in (CHECKOUT / folder).rglob("*")]
    sources = [file for file in sources if file.suffix in kinds or file.name == "CMakeLists.txt"]
    assert kinds <= {file.suffix for file in sources}
    for file in sources:
        assert any(LICENCE in line for line in file.read_text().splitlines()[:12]), file
