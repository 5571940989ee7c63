# The pictures in docs/: `.venv/bin/python docs/make_pictures.py pipeline` after scripts/demo.sh, and
# `.venv/bin/python docs/make_pictures.py gallery FOLDER` with a folder of scans (docs/gallery.md says which).
# SPDX-License-Identifier: GPL-3.0-or-later
"""Writes docs/pipeline.png from out/bunny_{cloud,lines,mesh}.png, or docs/gallery_*.png from scans."""

import argparse
from pathlib import Path

import pymeshlab
import pymeshlab_curvature_lines  # noqa: F401
from PIL import Image
from pymeshlab_curvature_lines.render import render

CHECKOUT = Path(__file__).resolve().parent.parent
DOCS, OUT = CHECKOUT / "docs", CHECKOUT / "out"
PANEL, SMALL_PANEL = (900, 780), (560, 485)  # in the small one the dots of selected points are larger
RANGE_MAP, ANGEL, DRAGON = "meshlab_lato270_rawscan.ply", "angel_rawscan.obj", "dragon_vrip.ply"
FANDISK, TWELVE = "fandisk_noise0.3.obj", "twelve_impulsive0.5.obj"
FANDISK_CLEAN = "fandisk_clean.obj"
TRACED = (1066, 800)
COW, BUNNY, ARMADILLO = "cow_loop2_46433_derived.ply", "bunny_oriented.ply", "armadillo.obj"
HORSE, CHAMELEON = "horse_oriented.ply", "chameleon.pts"
SAMPLES = Path(pymeshlab.__file__).parent / "tests" / "sample_meshes"
HAND, TOOTH = "hand_closed.obj", "tooth_pongo_EM.ply"
TRACED_CROSSINGS = 4000
EPSILONS, LEAST_SPACING, MOST_SPACING = (1e-5, 1e-4, 1e-3), 0.003, 0.5  # the latter two in diagonals
ENDS = ("lines", "rims", "creases", "umbilics")
Y_UP = (0.0, 1.0, 0.0)
VIEWS = {
    FANDISK: ((-0.6, 0.5, 1.0), Y_UP),
    TWELVE: ((0.4, 0.3, 1.0), Y_UP),
    COW: ((0.6, 0.4, 1.0), Y_UP),
    BUNNY: ((0.2, 0.2, 1.0), Y_UP),
    ARMADILLO: ((0.3, 0.2, -1.0), Y_UP),
    HAND: ((0.2, 0.1, 1.0), Y_UP),
    HORSE: ((1.0, 0.4, -0.3), (0.0, 0.0, 1.0)),
    CHAMELEON: ((1.0, 0.3, 0.3), Y_UP),
    TOOTH: ((0.3, -0.7, 1.0), (0.0, 0.0, 1.0)),
}


def write_strips(name: str, rows: list[list[Path]], width: int, few_colors: bool = True) -> None:
    """Rows of pictures of one size as one picture, in few enough colours to stay small unless these would show."""
    pictures = [[Image.open(path).convert("RGB") for path in row] for row in rows]
    across, down = pictures[0][0].size
    sheet = Image.new("RGB", (across * len(pictures[0]), down * len(pictures)), "white")
    for line, row in enumerate(pictures):
        for place, picture in enumerate(row):
            sheet.paste(picture, (across * place, down * line))
    sheet = sheet.resize((width, width * sheet.height // sheet.width), Image.Resampling.LANCZOS)
    if few_colors:
        sheet = sheet.quantize(200, method=Image.Quantize.MAXCOVERAGE, dither=Image.Dither.NONE)
    sheet.save(DOCS / f"{name}.png", optimize=True)


def pipeline() -> None:
    pictures = [Image.open(OUT / f"bunny_{stage}.png").convert("RGB") for stage in ("cloud", "lines", "mesh")]
    # Margins are cut alike so that the three stay in register.
    box = (190, 0, 1010, 900)
    width, height = box[2] - box[0], box[3] - box[1]
    strip = Image.new("RGB", (width * len(pictures), height), "white")
    for place, picture in enumerate(pictures):
        strip.paste(picture.crop(box), (place * width, 0))
    strip.resize((strip.width // 2, strip.height // 2), Image.Resampling.LANCZOS).save(
        DOCS / "pipeline.png", optimize=True
    )


def loaded(path: Path) -> pymeshlab.MeshSet:
    meshes = pymeshlab.MeshSet()
    meshes.load_new_mesh(str(path))
    meshes.meshing_remove_unreferenced_vertices()
    meshes.compute_normal_per_vertex()
    return meshes


def forget_triangles(meshes: pymeshlab.MeshSet) -> None:
    cloud = meshes.current_mesh()
    meshes.add_mesh(pymeshlab.Mesh(cloud.vertex_matrix(), v_normals_matrix=cloud.vertex_normal_matrix()))


def cleaning(path: Path) -> list[Path]:
    """The surface as it came with its outliers in red, and without them after denoising.

    The filters see points only. The triangles show what became of them, unless too few are left to.
    """
    view, up = VIEWS.get(path.name, (None, None))
    before, after = OUT / f"{path.stem}_before.png", OUT / f"{path.stem}_after.png"
    meshes = loaded(path)
    if path.name == TWELVE:
        forget_triangles(meshes)
    framed = meshes.current_mesh().vertex_matrix()
    style = {"view": view, "up": up, "size": PANEL, "framed": framed, "mesh_edges": False}
    meshes.compute_selection_point_cloud_outliers_by_curvature()
    outliers = int(meshes.current_mesh().vertex_selection_array().sum())
    render(before, meshes.current_mesh(), **style)
    meshes.meshing_remove_selected_vertices()
    report = meshes.apply_coord_point_cloud_robust_denoising()
    render(after, meshes.current_mesh(), **style)
    print(
        f"{path.name}: {outliers} of {len(framed)} points are outliers, the others moved {report['moved_rms']:.3g} (RMS)"
    )
    return [before, after]


def rejected(path: Path) -> list[Path]:
    """The points as they come from both sides, those that the filter selects in red."""
    meshes = pymeshlab.MeshSet()
    meshes.load_new_mesh(str(path))
    if meshes.current_mesh().face_number() > 0:
        meshes.meshing_remove_unreferenced_vertices()
        meshes.compute_normal_per_vertex()
        forget_triangles(meshes)
    report = meshes.compute_selection_point_cloud_outliers_by_curvature()
    print(f"{path.name}: {report['outliers']} of {report['points']} points are selected")
    pictures = []
    for side, sign in (("front", 1.0), ("back", -1.0)):
        pictures.append(OUT / f"{path.stem}_rejected_{side}.png")
        view, up = VIEWS.get(path.name, ((0.0, 0.0, 1.0), Y_UP))
        view = tuple(sign * along if upwards == 0.0 else along for along, upwards in zip(view, up, strict=True))
        render(pictures[-1], meshes.current_mesh(), view=view, up=up, size=SMALL_PANEL)
    return pictures


def curvature(path: Path) -> Path:
    """The points alone, coloured by their mean curvature."""
    meshes = loaded(path)
    forget_triangles(meshes)
    meshes.compute_curvature_robust_per_vertex()
    picture = OUT / f"{path.stem}_curvature.png"
    render(picture, meshes.current_mesh(), size=PANEL)
    return picture


def ray_traced(path: Path) -> list[Path]:
    """The surface between the points alone: plain, and by its curvature."""
    meshes = loaded(path) if path.name != BUNNY else pymeshlab.MeshSet()
    if path.name == BUNNY:  # comes as points with normals
        meshes.load_new_mesh(str(path))
    forget_triangles(meshes)
    pictures = []
    for color in ("Plain", "Curvature"):
        picture = OUT / f"{path.stem}_{color.lower()}.png"
        report = meshes.save_ray_traced_point_set_image(
            image_file=str(picture), width=TRACED[0], height=TRACED[1], color_by=color
        )
        print(f"{path.name}, {color}: {report['hits']} pixels in {report['seconds_total']:.1f} s")
        pictures.append(picture)
    return pictures


def quads(path: Path) -> Path:
    """The mesh that the whole pipeline makes of the points alone."""
    meshes = pymeshlab.MeshSet()
    meshes.load_new_mesh(str(path))
    if meshes.current_mesh().face_number():
        meshes = loaded(path)
        forget_triangles(meshes)
    report = meshes.generate_surface_reconstruction_curvature_aligned()
    print(
        f"{path.name}: {report['quads']} of {report['faces']} faces are quads, V - E + F = {report['euler_characteristic']}"
    )
    view, up = VIEWS.get(path.name, (None, None))
    picture = OUT / f"{path.stem}_quads.png"
    render(picture, meshes.current_mesh(), view=view, up=up, size=PANEL)
    return picture


def bounded_to(diagonal: float, epsilon: float) -> dict[str, float]:
    return {"epsilon": epsilon, "min_spacing": LEAST_SPACING * diagonal, "max_spacing": MOST_SPACING * diagonal}


def lines_of_curvature(path: Path, epsilon: float | None = None) -> Path:
    """Both families traced on the points alone, drawn over them."""
    meshes = pymeshlab.MeshSet()
    meshes.load_new_mesh(str(path))
    if meshes.current_mesh().face_number():
        meshes = loaded(path)
        forget_triangles(meshes)
    cloud = meshes.current_mesh_id()
    diagonal = meshes.current_mesh().bounding_box().diagonal()
    asked = bounded_to(diagonal, epsilon) if epsilon else {"target_vertices": TRACED_CROSSINGS}
    report = meshes.generate_curvature_lines(**asked)
    print(
        f"{path.name}: {report['crossings']} crossings, {report['lines']} lines, {report['closed_lines']} closed, ends {[report[f'ends_at_{what}'] for what in ENDS]} at {ENDS}"
    )
    view, up = VIEWS.get(path.name, (None, None))
    picture = OUT / f"{path.stem}_lines{epsilon or ''}.png"
    render(picture, meshes.mesh(cloud), meshes.current_mesh(), view=view, up=up, size=PANEL)
    return picture


def gallery(folder: Path, topics: list[str]) -> None:
    OUT.mkdir(exist_ok=True)
    if "scans" in topics:
        write_strips("gallery_scans", [cleaning(folder / name) for name in (RANGE_MAP, ANGEL)], 1400)
    if "meshes" in topics:
        write_strips("gallery_meshes", [cleaning(folder / name) for name in (FANDISK, TWELVE)], 1200)
    if "rejected" in topics:
        shapes = (folder / BUNNY, folder / HORSE, folder / RANGE_MAP, SAMPLES / CHAMELEON)
        rows = [rejected(shape) for shape in shapes]
        write_strips("gallery_rejected", [[*rows[0], *rows[1]], [*rows[2], *rows[3]]], 2240)
    if "ray_tracing" in topics:
        shapes = [ray_traced(folder / name) for name in (FANDISK_CLEAN, BUNNY, DRAGON)]
        columns = [list(column) for column in zip(*shapes, strict=True)]
        write_strips("gallery_ray_tracing", columns, 1500, few_colors=False)
    if "curvature" in topics:
        write_strips("gallery_curvature", [[curvature(folder / name) for name in (RANGE_MAP, ANGEL, DRAGON)]], 1600)
    if "lines" in topics:
        rows = [(HAND, TOOTH), (RANGE_MAP, BUNNY)]
        write_strips("gallery_lines", [[lines_of_curvature(folder / name) for name in row] for row in rows], 1800)
    if "epsilon" in topics:
        write_strips("gallery_epsilon", [[lines_of_curvature(folder / COW, epsilon) for epsilon in EPSILONS]], 2100)
    if "quads" in topics:
        rows = [(BUNNY, ARMADILLO, COW), (HAND, TOOTH, ANGEL)]
        write_strips("gallery_quads", [[quads(folder / name) for name in row] for row in rows], 1800)


def main() -> None:
    topics = ["scans", "meshes", "rejected", "curvature", "ray_tracing", "lines", "epsilon", "quads"]
    parser = argparse.ArgumentParser(description=__doc__)
    kinds = parser.add_subparsers(dest="kind", required=True)
    kinds.add_parser("pipeline", help="from what scripts/demo.sh left in out/")
    of_scans = kinds.add_parser("gallery", help="from a folder of scans")
    of_scans.add_argument("folder", type=Path)
    of_scans.add_argument("topics", nargs="*", metavar="TOPIC", help=f"{', '.join(topics)}; default: all")
    given = parser.parse_args()
    if given.kind == "pipeline":
        pipeline()
    else:
        gallery(given.folder, given.topics or topics)


if __name__ == "__main__":
    main()
