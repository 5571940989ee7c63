# The package binds what the plugin brings: neither less nor more.
# SPDX-License-Identifier: GPL-3.0-or-later
import os
import subprocess
import sys

import pytest

# In a process of its own: the plugin is already loaded in this one.
SCRIPT = """
import inspect, pydoc
import pymeshlab
MESH = "generate_curvature_aligned_quad_mesh"  # which has defaults on a layer of lines only
def sphere():
    meshes = pymeshlab.MeshSet()
    meshes.create_sphere()
    return meshes
before = set(pymeshlab.filter_list())
import pymeshlab_curvature_lines as package
brought = set(pymeshlab.filter_list()) - before
assert brought == set(package.filters()), brought ^ set(package.filters())
for name, description in package.filters().items():
    method = getattr(pymeshlab.MeshSet, name)
    assert description and method.__doc__.splitlines()[0] == f"{description}.", name
    # help() and "?" show every parameter with its default and what it does.
    shown, help_text = inspect.signature(method).parameters, pydoc.plain(pydoc.render_doc(method))
    defaults = sphere().filter_parameter_values(name) if name != MESH else {}
    assert set(defaults) <= set(shown) and len(shown) > 1, name
    for parameter in list(shown)[1:]:
        assert f"{parameter}:" in method.__doc__ and parameter in help_text, (name, parameter)
        default = defaults.get(parameter)
        if type(default) is type(shown[parameter].default) and type(default) is not str:  # of choices the host knows the number
            assert abs(shown[parameter].default - default) <= 1e-6 * abs(default), (name, parameter)
print(len(brought))
"""


@pytest.mark.skipif("CURVATURE_LINES_PLUGIN" in os.environ, reason="tests a plugin file, not the package")
def test_every_filter_is_a_method_with_a_description():
    done = subprocess.run([sys.executable, "-c", SCRIPT], capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    assert int(done.stdout) >= 11
