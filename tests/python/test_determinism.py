# The same result in every process and for any number of threads.
# SPDX-License-Identifier: GPL-3.0-or-later
import os
import subprocess
import sys
from pathlib import Path


CHAIN = """
import hashlib, tempfile, helpers
from pathlib import Path
helpers.load_plugin()
meshes = helpers.layer_of(helpers.generate("torus", 800, noise=0.003, outliers=0.02, seed=1, scanned=True))
for name, parameters in [
    (helpers.CURVATURE, {}),
    (helpers.OUTLIERS, {"delete_selected": True}),
    (helpers.DENOISE, {"method": "Paper", "iterations": 10}),
    (helpers.DENOISE, {}),
    (helpers.SMOOTH, {}),
    (helpers.TRACE, {"target_vertices": 100}),
    (helpers.MESH, {}),
]:
    meshes.apply_filter(name, **parameters)
    state = repr(helpers.snapshot(meshes)).encode()
    print(name, hashlib.sha256(state).hexdigest())
meshes = helpers.layer_of(helpers.generate("torus", 2000, noise=0.003, seed=2, scanned=True))
for name in (helpers.M_WEIGHTED, helpers.PROJECT):
    meshes.apply_filter(name)
    print(name, hashlib.sha256(repr(helpers.snapshot(meshes)).encode()).hexdigest())
for surface in ("Curvature-Driven", "Moving Least Squares"):
    with tempfile.TemporaryDirectory() as folder:
        image = Path(folder) / "image.png"
        meshes.apply_filter(helpers.RAY_TRACE, image_file=str(image), width=120, height=80, surface=surface)
        print(surface.replace(" ", "_"), hashlib.sha256(image.read_bytes()).hexdigest())
"""


def run(threads):
    environment = {**os.environ, "OMP_NUM_THREADS": str(threads)}
    result = subprocess.run(
        [sys.executable, "-c", CHAIN],
        cwd=Path(__file__).parent,
        env=environment,
        capture_output=True,
        text=True,
        timeout=300,
        check=True,
    )
    return [line for line in result.stdout.splitlines() if len(line.split()) == 2 and len(line.split()[1]) == 64]


def test_chain_is_the_same_on_one_thread_and_on_two():
    first = run(1)
    assert len(first) == 11 and len(set(first)) == 11
    assert run(2) == first
