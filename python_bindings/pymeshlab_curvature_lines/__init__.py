# Loads the curvature lines plugin into PyMeshLab and binds its filters as MeshSet methods, on import.
# SPDX-License-Identifier: GPL-3.0-or-later
"""Curvature, lines of curvature and curvature-aligned quad meshes from point clouds, in PyMeshLab.

>>> import pymeshlab, pymeshlab_curvature_lines
>>> ms = pymeshlab.MeshSet()
>>> ms.load_new_mesh("scan.ply")
>>> ms.generate_surface_reconstruction_curvature_aligned()
"""

from __future__ import annotations

import ctypes
from importlib.metadata import version
from pathlib import Path

from .signatures import filters_of

__all__ = ["MeshSet", "__version__", "filters", "load_cloud", "plugin_path", "save_mesh"]
__version__: str = version("pymeshlab-curvature-lines")

_HOST = "2025.7"


def plugin_path() -> Path:
    """The plugin's file, for ``pymeshlab.load_plugin``."""
    return Path(__file__).parent / "libfilter_curvature_lines.so"


def filters() -> dict[str, str]:
    """The names of the filters, each with one line about what it does."""
    # The plugin lists them itself; it finds the libraries it needs because the host has loaded them.
    listing = ctypes.CDLL(str(plugin_path())).curvature_lines_filters
    listing.restype = ctypes.c_char_p
    return dict(line.split("\t") for line in listing().decode().splitlines())


def _load() -> type:
    # Before the import: a plugin in a host of another version would crash, not complain.
    host = version("pymeshlab")
    if host != _HOST and not host.startswith(_HOST + "."):
        raise ImportError(
            f"pymeshlab_curvature_lines needs pymeshlab {_HOST}, not {host}: pip install 'pymeshlab>=2025.7,<2025.8'"
        )
    import pymeshlab

    try:
        descriptions = filters()
        # Already there after importlib.reload or the user's own load_plugin; the host refuses to load a file twice.
        if descriptions.keys().isdisjoint(pymeshlab.filter_list()):
            pymeshlab.load_plugin(str(plugin_path()))
    except (OSError, pymeshlab.PyMeshLabException) as error:
        raise ImportError(f"pymeshlab {host} refuses {plugin_path()}: {error}") from None
    described = filters_of(Path(__file__).with_suffix(".pyi"))
    for name, description in descriptions.items():
        method = pymeshlab.bind_function(name)
        method.__doc__ = description
        if name in described:  # a plugin of another version may have others
            method.__signature__, method.__doc__ = described[name]
            method.__name__ = method.__qualname__ = name
        setattr(pymeshlab.MeshSet, name, method)
    return pymeshlab.MeshSet


# PyMeshLab's own class, under a name that __init__.pyi can give types to.
MeshSet = _load()

# After the host is known to be the right one.
from .files import load_cloud, save_mesh  # noqa: E402
