# The package binds what the plugin brings: neither less nor more.
# SPDX-License-Identifier: GPL-3.0-or-later
import os
import subprocess
import sys

import pytest

# In a process of its own: the plugin is already loaded in this one.
SCRIPT = """
import pymeshlab
before = set(pymeshlab.filter_list())
import pymeshlab_curvature_lines as package
brought = set(pymeshlab.filter_list()) - before
assert brought == set(package.filters()), brought ^ set(package.filters())
for name, description in package.filters().items():
    assert description and getattr(pymeshlab.MeshSet, name).__doc__ == description
print(len(brought))
"""


@pytest.mark.skipif("CURVATURE_LINES_PLUGIN" in os.environ, reason="tests a plugin file, not the package")
def test_every_filter_is_a_method_with_a_description():
    done = subprocess.run([sys.executable, "-c", SCRIPT], capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    assert int(done.stdout) >= 11
