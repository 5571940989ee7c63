# Direction smoothing, lines of curvature, the quad mesh and the whole pipeline through the real plugin.
# SPDX-License-Identifier: GPL-3.0-or-later
import numpy as np
import pymeshlab
import pytest

from helpers import (
    CURVATURE,
    DENOISE,
    MESH,
    PIPELINE,
    SMOOTH,
    TRACE,
    analytic_surfaces,
    attribute,
    attributes,
    axis_angle,
    check_report,
    generate,
    layer,
    layer_of,
    polygon_topology,
    rms,
    snapshot,
)

MESH_COUNTS = [
    "vertices",
    "faces",
    "quads",
    "triangles",
    "euler_characteristic",
    "boundary_edges",
    "nonmanifold_edges",
    "components",
]
EPSILON = 0.005
QUICK = {"denoise": False, "reject_outliers": False}


@pytest.fixture(scope="module")
def traced(torus):
    """A document with the torus and its lines of curvature; tests that change it must not."""
    meshes = layer_of(torus)
    meshes.apply_filter(CURVATURE)
    report = meshes.apply_filter(TRACE, epsilon=EPSILON)
    return meshes, report


def retrace(torus, **parameters):
    meshes = layer_of(torus)
    return meshes, meshes.apply_filter(TRACE, **{"epsilon": EPSILON, **parameters})


def distances(name, positions):
    return np.linalg.norm(positions - analytic_surfaces.project(name, positions)["foot_points"], axis=1)


def check_mesh(meshes, report):
    """The polygons on the layer are what the dictionary says, counted from scratch."""
    mesh = meshes.current_mesh()
    polygons = mesh.polygonal_face_list()
    euler, boundary, nonmanifold = polygon_topology(polygons, mesh.vertex_number())
    sides = [len(polygon) for polygon in polygons]
    assert report["vertices"] == mesh.vertex_number() and report["faces"] == len(polygons)
    assert report["quads"] == sides.count(4) and report["triangles"] == sides.count(3)
    assert (report["euler_characteristic"], report["boundary_edges"], report["nonmanifold_edges"]) == (
        euler,
        boundary,
        nonmanifold,
    )
    np.testing.assert_allclose(np.linalg.norm(mesh.vertex_normal_matrix(), axis=1), 1.0, atol=1e-6)
    return mesh, polygons


# Direction smoothing


# Adaptive directions are means over large regions already: little is left to gain, nothing may be lost.
@pytest.mark.parametrize(("scale_mode", "allowed"), [("Paper", 0.95), ("Adaptive", 1.05)])
def test_smoothing_improves_directions_and_only_them(noisy_torus, scale_mode, allowed):
    meshes = layer_of(noisy_torus)
    meshes.apply_filter(CURVATURE, scale_mode=scale_mode)
    before, rough = attributes(meshes), meshes.current_mesh().vertex_curvature_principal_dir1_matrix()
    surface = np.cross(rough, meshes.current_mesh().vertex_curvature_principal_dir2_matrix())
    report = check_report(meshes.apply_filter(SMOOTH), "iterations")
    smooth = meshes.current_mesh().vertex_curvature_principal_dir1_matrix()
    clear = noisy_torus["k1"] - noisy_torus["k2"] > 1.0
    error_before, error_after = (rms(axis_angle(d, noisy_torus["d1"])[clear]) for d in (rough, smooth))
    assert error_after < allowed * error_before
    for name in ("curv_k1", "curv_k2", "curv_confidence"):
        np.testing.assert_array_equal(before[name], attribute(meshes, name))
    assert report["curvature_reused"] and report["energy_final"] < report["energy_initial"]
    other = meshes.current_mesh().vertex_curvature_principal_dir2_matrix()
    # tangent to the surface of the estimate, as before
    frames = np.stack([smooth, other, surface], axis=1)
    np.testing.assert_allclose(frames @ frames.transpose(0, 2, 1), np.tile(np.eye(3), (len(smooth), 1, 1)), atol=1e-9)


def test_an_estimate_with_other_options_is_not_taken_for_that_of_the_layer(noisy_torus):
    meshes, other = layer_of(noisy_torus), layer_of(noisy_torus)
    meshes.apply_filter(CURVATURE)
    # the same curvatures, other statistical weights
    other.apply_filter(CURVATURE, boundary_threshold=1.0)
    before = attributes(meshes)
    assert np.any(before["curv_confidence"] != attribute(other, "curv_confidence"))
    assert meshes.apply_filter(SMOOTH)["curvature_reused"]
    np.testing.assert_array_equal(before["curv_confidence"], attribute(meshes, "curv_confidence"))


def test_smoothness_zero_keeps_the_directions(noisy_torus):
    meshes = layer_of(noisy_torus)
    meshes.apply_filter(CURVATURE)
    rough = meshes.current_mesh().vertex_curvature_principal_dir1_matrix()
    report = meshes.apply_filter(SMOOTH, alpha=0.0)
    kept = meshes.current_mesh().vertex_curvature_principal_dir1_matrix()
    assert np.max(axis_angle(rough, kept)) < 1e-3 and report["mean_turn"] < 1e-3


def test_smoothing_computes_what_is_missing(noisy_torus):
    alone, chained = layer_of(noisy_torus), layer_of(noisy_torus)
    chained.apply_filter(CURVATURE)
    chained.apply_filter(SMOOTH)
    alone.apply_filter(SMOOTH)
    for name, values in attributes(chained).items():
        np.testing.assert_array_equal(values, attribute(alone, name))
    np.testing.assert_array_equal(
        alone.current_mesh().vertex_curvature_principal_dir1_matrix(),
        chained.current_mesh().vertex_curvature_principal_dir1_matrix(),
    )


# Lines


def test_lines_lie_on_the_torus_and_follow_its_directions(torus, traced):
    meshes, report = traced
    check_report(report, "lines", "vertices", "edges", "closed_lines", "lines_family_1", "lines_family_2")
    assert [mesh.label() for mesh in meshes][1] == "lines of curvature" and meshes.current_mesh_id() == 1
    mesh = meshes.current_mesh()
    assert (mesh.vertex_number(), mesh.edge_number()) == (report["vertices"], report["edges"])
    assert rms(distances("torus", mesh.vertex_matrix())) < 0.002 * analytic_surfaces.surface("torus").diagonal

    edges, family = mesh.edge_matrix(), attribute(meshes, "line_family")
    truth = analytic_surfaces.project("torus", mesh.vertex_matrix())
    along = mesh.vertex_matrix()[edges[:, 1]] - mesh.vertex_matrix()[edges[:, 0]]
    lengths = np.linalg.norm(along, axis=1)
    expected = np.where((family == 1)[:, None], truth["d1"], truth["d2"])[edges[:, 0]]
    sound = lengths > 0.1 * np.median(lengths)
    assert np.median(axis_angle(along / np.maximum(lengths, 1e-30)[:, None], expected)[sound]) < 0.1


def test_line_layer_attributes(traced):
    meshes, report = traced
    mesh = meshes.current_mesh()
    line, family = attribute(meshes, "line_id"), attribute(meshes, "line_family")
    assert set(np.unique(line)) == set(range(report["lines"])) and set(np.unique(family)) == {1.0, 2.0}
    firsts = np.unique(line, return_index=True)[1]
    assert np.sum(family[firsts] == 1) == report["lines_family_1"]
    assert np.sum(family[firsts] == 2) == report["lines_family_2"]
    edges = mesh.edge_matrix()
    assert np.all(line[edges[:, 0]] == line[edges[:, 1]])
    assert np.bincount(edges.ravel(), minlength=mesh.vertex_number()).max() == 2
    open_lines = report["lines"] - report["closed_lines"]
    assert report["vertices"] - report["edges"] == open_lines
    truth = analytic_surfaces.project("torus", mesh.vertex_matrix())
    curvature = np.where(family == 1, truth["k1"], truth["k2"])
    assert np.median(np.abs(mesh.vertex_scalar_array() - curvature)) < 0.1
    cosine = np.einsum("ij,ij->i", mesh.vertex_normal_matrix(), truth["normals"])
    assert np.median(cosine) > 0.999
    assert len(np.unique(mesh.vertex_color_matrix(), axis=0)) == 2


def test_lines_carry_their_arc_length_and_whether_they_close(traced):
    meshes, report = traced
    mesh = meshes.current_mesh()
    line, closed = attribute(meshes, "line_id"), attribute(meshes, "line_closed")
    length, positions = attribute(meshes, "line_arc_length"), mesh.vertex_matrix()
    firsts = np.unique(line, return_index=True)[1]
    assert set(np.unique(closed)) <= {0.0, 1.0} and closed[firsts].sum() == report["closed_lines"]
    assert np.all(length[firsts] == 0.0)
    valence = np.bincount(mesh.edge_matrix().ravel(), minlength=len(line))
    for number in np.unique(line):
        own = line == number
        assert len(set(closed[own])) == 1 and np.sum(valence[own] == 1) == (0 if closed[own][0] else 2)
        steps = np.linalg.norm(np.diff(positions[own], axis=0), axis=1)
        np.testing.assert_allclose(np.diff(length[own]), steps, atol=1e-6)


def test_lines_of_the_position_field(torus):
    meshes, report = retrace(torus, method="Position Field", target_vertices=300)
    positions = meshes.current_mesh().vertex_matrix()
    assert rms(distances("torus", positions)) < 0.01
    assert report["lines_family_1"] > 0 and report["lines_family_2"] > 0
    assert abs(report["crossings"] - 300) < 60
    truth, family = analytic_surfaces.project("torus", positions), attribute(meshes, "line_family")
    ends = meshes.current_mesh().edge_matrix()
    along = positions[ends[:, 1]] - positions[ends[:, 0]]
    wanted = np.where(family[ends[:, :1]] == 1, truth["d1"][ends[:, 0]], truth["d2"][ends[:, 0]])
    assert np.median(axis_angle(along / np.linalg.norm(along, axis=1)[:, None], wanted)) < 0.1
    meshes.apply_filter(MESH, point_cloud=0)
    mesh = meshes.current_mesh()
    assert polygon_topology(mesh.polygonal_face_list(), mesh.vertex_number())[0] == 0


def test_lines_survive_an_obj_file(traced, tmp_path):
    meshes, report = traced
    file = str(tmp_path / "lines.obj")
    meshes.save_current_mesh(file)
    again = pymeshlab.MeshSet()
    again.load_new_mesh(file)
    mesh = again.current_mesh()
    assert (mesh.vertex_number(), mesh.edge_number()) == (report["vertices"], report["edges"])
    np.testing.assert_allclose(mesh.vertex_matrix(), meshes.current_mesh().vertex_matrix(), atol=1e-5)
    ends = [np.sort(m.edge_matrix(), axis=1) for m in (mesh, meshes.current_mesh())]
    assert {tuple(edge) for edge in ends[0]} == {tuple(edge) for edge in ends[1]}


def test_tracing_leaves_the_cloud_untouched(torus):
    meshes = layer_of(torus)
    before = snapshot(meshes)
    meshes.apply_filter(TRACE, epsilon=EPSILON)
    meshes.set_current_mesh(0)
    assert snapshot(meshes)[1 : len(before)] == before[1:]


def test_density_parameters(torus, traced):
    vertices = traced[1]["vertices"]
    assert retrace(torus, epsilon=0.02)[1]["vertices"] < vertices
    spacing = 0.6
    wide = retrace(torus, min_spacing=spacing, max_spacing=spacing)[1]
    assert wide["lines"] < traced[1]["lines"]
    aimed = retrace(torus, target_vertices=120)
    report = aimed[0].apply_filter(MESH)
    assert 0.6 * 120 < report["vertices"] < 1.6 * 120
    assert aimed[1]["epsilon"] != pytest.approx(EPSILON)


@pytest.mark.parametrize(
    "parameters",
    [
        {"projection": "Locally Optimal"},
        {"projection": "Weighted Average"},
        {"tolerance": 0.001},
        {"smooth_directions": False},
    ],
)
def test_tracing_options_have_an_effect(torus, traced, parameters):
    meshes, report = retrace(torus, **parameters)
    default, other = traced[0].mesh(1).vertex_matrix(), meshes.mesh(1).vertex_matrix()
    assert default.shape != other.shape or np.any(default != other)
    assert rms(distances("torus", other)) < 0.01 * analytic_surfaces.surface("torus").diagonal


def test_smoothed_directions_of_the_layer_are_followed(noisy_torus):
    positions = []
    for smoothness in (0.1, 0.9):
        meshes = layer_of(noisy_torus)
        meshes.apply_filter(CURVATURE)
        meshes.apply_filter(SMOOTH, alpha=smoothness)
        report = meshes.apply_filter(TRACE, epsilon=0.01)
        assert report["curvature_reused"] and "seconds_smoothing" not in report
        positions.append(meshes.mesh(1).vertex_matrix())
    assert positions[0].shape != positions[1].shape or np.any(positions[0] != positions[1])


def test_stale_curvature_is_recomputed(torus):
    meshes = layer_of(torus)
    meshes.apply_filter(CURVATURE)
    meshes.compute_matrix_from_scaling_or_normalization(axisx=2, uniformflag=True, scalecenter="origin", freeze=True)
    report = meshes.apply_filter(TRACE, epsilon=EPSILON)
    assert not report["curvature_reused"]
    fresh = layer(2.0 * torus["positions"], torus["normals"])
    expected = fresh.apply_filter(TRACE, epsilon=EPSILON)
    assert (report["lines"], report["vertices"]) == (expected["lines"], expected["vertices"])


# Mesh


def test_mesh_of_the_torus(torus, traced):
    meshes, _ = retrace(torus)
    report = check_report(meshes.apply_filter(MESH), *MESH_COUNTS)
    mesh, polygons = check_mesh(meshes, report)
    assert mesh.label() == "curvature-aligned mesh" and meshes.current_mesh_id() == 2
    assert report["euler_characteristic"] == 0 and report["nonmanifold_edges"] == 0 and report["components"] == 1
    assert report["quads"] > 0.6 * report["faces"]
    assert rms(distances("torus", mesh.vertex_matrix())) < 0.002 * analytic_surfaces.surface("torus").diagonal
    truth = analytic_surfaces.project("torus", mesh.vertex_matrix())["normals"]
    assert np.all(np.einsum("ij,ij->i", mesh.vertex_normal_matrix(), truth) > 0.9)
    # counter-clockwise from outside
    centers = np.array([mesh.vertex_matrix()[face].mean(axis=0) for face in mesh.face_matrix()])
    outward = analytic_surfaces.project("torus", centers)["normals"]
    assert np.all(np.einsum("ij,ij->i", mesh.face_normal_matrix(), outward) > 0.5)


def test_triangulated_mesh_covers_the_same_surface(torus):
    meshes, _ = retrace(torus)
    polygonal = meshes.apply_filter(MESH)
    area = meshes.get_geometric_measures()["surface_area"]
    meshes.set_current_mesh(1)
    report = meshes.apply_filter(MESH, triangulate=True)
    check_mesh(meshes, report)
    assert report["triangles"] == report["faces"] and report["quads"] == 0
    assert report["euler_characteristic"] == polygonal["euler_characteristic"]
    assert meshes.get_geometric_measures()["surface_area"] == pytest.approx(area, rel=0.02)


def test_polygons_survive_an_obj_file(torus, tmp_path):
    meshes, _ = retrace(torus)
    report = meshes.apply_filter(MESH)
    meshes.save_current_mesh(str(tmp_path / "quads.obj"))
    faces = [line for line in (tmp_path / "quads.obj").read_text().splitlines() if line.startswith("f ")]
    sides = [len(line.split()) - 1 for line in faces]
    assert len(faces) == report["faces"] and sides.count(4) == report["quads"]


def cells_of(meshes, report):
    """Texture coordinates in cells, corners of triangles: F x 3 x 2."""
    mesh = meshes.current_mesh()
    corners = mesh.wedge_tex_coord_matrix()
    assert corners.shape == (3 * mesh.face_number(), 2) and 0 <= corners.min() and corners.max() <= 1
    return report["texture_cells"] * corners.reshape(-1, 3, 2)


@pytest.mark.parametrize("triangulate", [False, True])
def test_every_quad_has_a_cell_of_the_texture(torus, triangulate):
    meshes = layer_of(torus)
    report = meshes.apply_filter(PIPELINE, texture_coordinates=True, triangulate=triangulate, **QUICK)
    cells = cells_of(meshes, report)
    assert report["texture_charts"] >= 1
    assert np.abs(cells - np.round(cells)).max() < 1e-4  # quads only: whole numbers
    a, b = cells[:, 1] - cells[:, 0], cells[:, 2] - cells[:, 0]
    assert np.allclose(a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0], 1.0, atol=1e-4)  # half a cell each, none turned over
    places = np.floor(cells.mean(axis=1)).astype(int)
    assert np.unique(places, axis=0, return_counts=True)[1].tolist() == [2] * (meshes.current_mesh().face_number() // 2)


def test_seams_of_the_texture_are_at_creases():
    cloud = generate("cube", 2400, noise=0.001, seed=4)
    meshes = layer_of(cloud)
    report = meshes.apply_filter(PIPELINE, texture_coordinates=True, reject_outliers=False)
    assert report["texture_charts"] == 6
    # a chart is flat: faces whose cells touch look to one side of the cube
    mesh = meshes.current_mesh()
    sides = np.round(mesh.face_normal_matrix()).astype(int)
    places = {
        tuple(place): side for place, side in zip(np.floor(cells_of(meshes, report).mean(axis=1)), sides.tolist())
    }
    for (x, y), side in places.items():
        assert places.get((x + 1, y), side) == side and places.get((x, y + 1), side) == side


def test_no_texture_coordinates_unless_asked_for(torus):
    meshes = layer_of(torus)
    report = meshes.apply_filter(PIPELINE, **QUICK)
    assert "texture_charts" not in report and not meshes.current_mesh().has_wedge_tex_coord()


def test_texture_of_a_mesh_from_lines_with_other_faces_than_quads(torus):
    meshes, _ = retrace(torus)
    report = meshes.apply_filter(MESH, texture_coordinates=True)
    cells = cells_of(meshes, report)
    check_mesh(meshes, report)
    a, b = cells[:, 1] - cells[:, 0], cells[:, 2] - cells[:, 0]
    assert report["quads"] < report["faces"]
    assert np.all(a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0] > 0)  # none is turned over
    assert report["texture_charts"] < report["faces"] / 4


@pytest.mark.parametrize(
    "ending, triangulate, kept", [("ply", False, True), ("ply", True, True), ("obj", True, True), ("obj", False, False)]
)
def test_files_that_keep_texture_coordinates(torus, tmp_path, ending, triangulate, kept):
    """What the guide's table says. If OBJ files of polygons ever keep theirs, the guide and the help can say so."""
    meshes = layer_of(torus)
    meshes.apply_filter(PIPELINE, texture_coordinates=True, triangulate=triangulate, target_vertices=150, **QUICK)
    expected = meshes.current_mesh().wedge_tex_coord_matrix()
    file = str(tmp_path / f"textured.{ending}")
    meshes.save_current_mesh(file)
    loaded = pymeshlab.MeshSet()
    loaded.load_new_mesh(file)
    found = loaded.current_mesh().wedge_tex_coord_matrix()
    assert found.shape == expected.shape and np.allclose(found, expected, atol=1e-6) == kept


def test_lines_survive_an_obj_file_but_not_their_attributes(traced, tmp_path):
    meshes, report = traced
    meshes.save_current_mesh(str(tmp_path / "lines.obj"))
    loaded = pymeshlab.MeshSet()
    loaded.load_new_mesh(str(tmp_path / "lines.obj"))
    assert loaded.current_mesh().edge_number() == report["edges"]
    with pytest.raises(pymeshlab.PyMeshLabException, match="line_id"):
        loaded.add_mesh(meshes.mesh(0))
        loaded.set_current_mesh(0)
        loaded.apply_filter(MESH, point_cloud=1)


def test_mesh_finds_its_cloud_among_others(torus):
    meshes = layer_of(generate("sphere", 500, seed=1))
    meshes.add_mesh(pymeshlab.Mesh(vertex_matrix=torus["positions"], v_normals_matrix=torus["normals"]))
    meshes.apply_filter(TRACE, epsilon=EPSILON)
    found = meshes.apply_filter(MESH)
    meshes.set_current_mesh(2)
    named = meshes.apply_filter(MESH, point_cloud=1)
    assert {k: v for k, v in found.items() if "seconds" not in k} == {
        k: v for k, v in named.items() if "seconds" not in k
    }


# Pipeline


def test_pipeline_on_a_dirty_scan():
    cloud = generate("torus", 2000, noise=0.0025, outliers=0.03, seed=4, scanned=True)
    meshes = layer_of(cloud)
    before = snapshot(meshes)
    report = check_report(
        meshes.apply_filter(PIPELINE),
        *("outliers", "creases", "cones", "line_ends", "dropped_components", "repaired_components", *MESH_COUNTS),
    )
    assert snapshot(meshes)[1 : len(before)] == before[1:]
    assert meshes.mesh_number() == 2 and meshes.current_mesh().label() == "curvature-aligned mesh"
    mesh, _ = check_mesh(meshes, report)
    assert report["nonmanifold_edges"] == 0 and not report["normals_estimated"]
    assert report["euler_characteristic"] == 0 and report["boundary_edges"] == 0 and report["components"] == 1
    assert report["quads"] >= 0.95 * report["faces"]
    # Small clouds get up to one vertex per four points, but no more than 500 vertices that way.
    assert 0.93 * 500 < report["vertices"] < 1.07 * 500
    assert rms(distances("torus", mesh.vertex_matrix())) < 0.0025 * analytic_surfaces.surface("torus").diagonal
    assert {"seconds_curvature", "seconds_outliers", "seconds_denoising", "seconds_creases", "seconds_mesh"} <= set(
        report
    )


@pytest.mark.parametrize(
    "surface, points, euler, rims",
    [
        ("torus", 3000, 0, 0),
        ("sphere", 3000, 2, 0),
        ("cylinder", 4000, 0, 2),
        ("helicoid", 4000, 1, 1),
        ("cube", 6000, 2, 0),
    ],
)
def test_pipeline_topology(surface, points, euler, rims):
    meshes = layer_of(generate(surface, points, seed=6))
    report = meshes.apply_filter(PIPELINE, target_vertices=400, **QUICK)
    mesh, _ = check_mesh(meshes, report)
    assert report["euler_characteristic"] == euler and report["boundary_loops"] == rims
    assert report["components"] == 1 and report["nonmanifold_edges"] == 0 and report["nonmanifold_vertices"] == 0
    assert 380 <= report["vertices"] <= 420
    # The rims of the helicoid run at 45 degrees to its lines of curvature, which leaves triangles along them.
    assert report["quads"] > (0.85 if surface == "helicoid" else 0.95) * report["faces"]
    diagonal = analytic_surfaces.surface(surface).diagonal
    assert rms(distances(surface, mesh.vertex_matrix())) < 0.002 * diagonal
    assert report["creases"] == (12 if surface == "cube" else 0)


def rod_on_a_ball(points, radius):
    """A ball of radius 1 with a rod of length 1 on top, evenly sampled; outward normals."""
    random = np.random.default_rng(5)
    ball, shaft = 4 * np.pi, 2 * np.pi * radius
    share = random.random(points) * (ball + shaft) < ball
    outward = random.normal(size=(points, 3))
    outward /= np.linalg.norm(outward, axis=1)[:, None]
    angle, height = random.uniform(0, 2 * np.pi, points), random.uniform(1, 2, points)
    around = np.column_stack([np.cos(angle), np.sin(angle), np.zeros(points)])
    positions = np.where(share[:, None], outward, radius * around + np.outer(height, [0, 0, 1]))
    normals = np.where(share[:, None], outward, around)
    outside = ~share | (np.hypot(outward[:, 0], outward[:, 1]) > radius) | (outward[:, 2] < 0)
    return positions[outside], normals[outside]


def test_pipeline_meshes_a_rod_and_tells_what_is_missing():
    positions, normals = rod_on_a_ball(8000, 0.08)
    meshes = layer(positions, normals)
    report = check_report(
        meshes.apply_filter(PIPELINE, target_vertices=60, **QUICK),
        *("folded_faces", "limb_vertices", "warnings", "caps"),
    )
    # Four edges around the rod and no fewer: more than sixty vertices, and told.
    assert report["limb_vertices"] > 20 and report["vertices"] > 70
    # The ball is left with some forty vertices, whose faces cut off a fifth of its radius; the rod has all of its length.
    assert report["uncovered_share"] < 0.001 and report["largest_gap"] < 0.2
    # The rod is open at its end.
    mesh = meshes.current_mesh()
    assert mesh.vertex_matrix()[:, 2].max() > 1.9
    # Nothing of the kind of a shape that asks for nothing.
    calm = layer_of(generate("sphere", 3000, seed=6)).apply_filter(PIPELINE, target_vertices=300, **QUICK)
    assert calm["limb_vertices"] == calm["folded_faces"] == calm["warnings"] == calm["uncovered_share"] == 0


def test_pipeline_on_a_grid_is_the_same_every_time():
    """Where all triangles are equally good nothing but the points may decide."""
    u, v = (a.ravel() for a in np.meshgrid(np.arange(200) * np.pi / 100, np.arange(100) * np.pi / 50, indexing="ij"))
    normals = np.c_[np.cos(v) * np.cos(u), np.cos(v) * np.sin(u), np.sin(v)]
    points = 0.4 * normals + np.c_[np.cos(u), np.sin(u), 0.0 * u]
    results = []
    for _ in range(2):
        meshes = pymeshlab.MeshSet()
        meshes.add_mesh(pymeshlab.Mesh(vertex_matrix=points, v_normals_matrix=normals))
        meshes.apply_filter(PIPELINE, **QUICK)
        results.append(meshes.current_mesh().vertex_matrix())
    assert np.array_equal(*results)


def test_pipeline_anisotropy(torus):
    even, uneven = (layer_of(torus).apply_filter(PIPELINE, anisotropy=a, target_vertices=200, **QUICK) for a in (1, 3))
    assert even["euler_characteristic"] == uneven["euler_characteristic"] == 0
    assert even["faces"] != uneven["faces"]
    with pytest.raises(pymeshlab.PyMeshLabException, match="nisotropy"):
        layer_of(torus).apply_filter(PIPELINE, anisotropy=0.5)


def test_pipeline_hole_size():
    """A torus with a hole thirteen spacings wide: a rim, or none."""
    count, golden = 6000, (1 + 5**0.5) / 2
    points, normals = [], []
    for i, a in enumerate(np.linspace(-np.pi, np.pi, 4 * count, endpoint=False)):  # evenly by area, by rejection
        t = 2 * np.pi * ((i / golden) % 1)
        if (i * 0.754877666) % 1 < (1 + 0.4 * np.cos(t)) / 1.4:
            n = np.array([np.cos(a) * np.cos(t), np.sin(a) * np.cos(t), np.sin(t)])
            points.append(np.array([np.cos(a), np.sin(a), 0]) + 0.4 * n)
            normals.append(n)
    points, normals = np.array(points), np.array(normals)
    spacing = np.sqrt(4 * np.pi**2 * 0.4 / len(points))
    outside = np.linalg.norm(points - [1.4, 0, 0], axis=1) > 6.5 * spacing
    rims = []
    for size in (8, 30):
        meshes = pymeshlab.MeshSet()
        meshes.add_mesh(pymeshlab.Mesh(vertex_matrix=points[outside], v_normals_matrix=normals[outside]))
        result = meshes.apply_filter(PIPELINE, hole_size=size, target_vertices=1500, **QUICK)
        rims.append((result["euler_characteristic"], result["boundary_edges"] > 0))
    assert rims == [(-1, True), (0, False)]


def test_pipeline_keeps_intermediate_layers(torus):
    meshes = layer_of(torus)
    meshes.apply_filter(PIPELINE, keep_intermediate_layers=True, **QUICK)
    labels = [mesh.label() for mesh in meshes]
    assert labels[1:] == ["cleaned cloud", "lines of curvature", "curvature-aligned mesh"]
    assert meshes.current_mesh_id() == 3
    cleaned = meshes.mesh(1)
    truth = analytic_surfaces.project("torus", cleaned.vertex_matrix())
    k1 = cleaned.vertex_custom_scalar_attribute_array("curv_k1")
    assert np.median(np.abs(k1 - truth["k1"])) < 0.1
    assert cleaned.vertex_curvature_principal_dir1_matrix().shape == (cleaned.vertex_number(), 3)


def test_pipeline_keeps_traced_lines(torus):
    meshes = layer_of(torus)
    meshes.apply_filter(PIPELINE, method="Traced Lines", keep_intermediate_layers=True, **QUICK)
    labels = [mesh.label() for mesh in meshes]
    assert labels[1:] == ["cleaned cloud", "lines of curvature", "curvature-aligned mesh"]
    assert meshes.current_mesh_id() == 3
    meshes.set_current_mesh(2)
    report = meshes.apply_filter(MESH)
    assert report["vertices"] == meshes.mesh(3).vertex_number()


@pytest.mark.parametrize(
    "choice, normals, estimated", [("If Missing", False, True), ("If Missing", True, False), ("Always", True, True)]
)
def test_pipeline_estimates_normals(torus, choice, normals, estimated):
    meshes = layer(torus["positions"], torus["normals"] if normals else None)
    report = meshes.apply_filter(PIPELINE, estimate_normals=choice, **QUICK)
    assert report["normals_estimated"] is estimated and report["faces"] > 50
    truth = analytic_surfaces.project("torus", meshes.current_mesh().vertex_matrix())["normals"]
    assert np.all(np.einsum("ij,ij->i", meshes.current_mesh().vertex_normal_matrix(), truth) > 0.5)


def test_pipeline_without_normals_is_refused_when_told_not_to_estimate(torus):
    meshes = layer(torus["positions"])
    with pytest.raises(pymeshlab.PyMeshLabException, match="Compute normals for point sets"):
        meshes.apply_filter(PIPELINE, estimate_normals="Never")
    assert meshes.mesh_number() == 1


def test_pipeline_density(torus):
    counts = []
    for parameters in ({"target_vertices": 60}, {"target_vertices": 200}, {"epsilon": 0.02}):
        counts.append(layer_of(torus).apply_filter(PIPELINE, **QUICK, **parameters)["vertices"])
    assert 40 < counts[0] < 90 and 130 < counts[1] < 300 and counts[2] < counts[1]


def test_pipeline_with_the_published_scale(noisy_torus):
    meshes, default = layer_of(noisy_torus), layer_of(noisy_torus)
    report = meshes.apply_filter(PIPELINE, scale_mode="Paper")
    check_mesh(meshes, report)
    default.apply_filter(PIPELINE)
    assert meshes.current_mesh().vertex_matrix().tobytes() != default.current_mesh().vertex_matrix().tobytes()


def test_chain_of_single_filters(noisy_torus):
    meshes = layer_of(noisy_torus)
    for name, parameters in [
        (DENOISE, {}),
        (CURVATURE, {}),
        (SMOOTH, {}),
        (TRACE, {"target_vertices": 120}),
        (MESH, {}),
    ]:
        report = meshes.apply_filter(name, **parameters)
    mesh, _ = check_mesh(meshes, report)
    assert meshes.mesh_number() == 3 and report["nonmanifold_edges"] == 0
    noise = rms(distances("torus", noisy_torus["positions"]))
    assert rms(distances("torus", mesh.vertex_matrix())) < 0.5 * noise
