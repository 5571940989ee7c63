# The clouds that most tests use; the helpers load the plugin.
# SPDX-License-Identifier: GPL-3.0-or-later
import pytest

from helpers import generate


@pytest.fixture(scope="session")
def torus():
    return generate("torus", 1600, seed=1)


@pytest.fixture(scope="session")
def noisy_torus():
    """Half a percent of noise, normals as of a scan."""
    return generate("torus", 1600, noise=0.005, seed=2, scanned=True)
