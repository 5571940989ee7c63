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

    def compute_normals_robust_point_cloud(
        self,
        *,
        orientation: Literal["Automatic", "Viewpoint", "Up"] = "Automatic",
        viewpoint: ArrayLike = ...,
        flip: bool = False,
        neighbors: int = 0,
    ) -> dict[str, float]:
        """Normals of a cloud that has none, outward also on thin walls.

        orientation: Closed parts get outward normals by winding numbers. Open ones get one side, and this tells which.
            Automatic: either one; Viewpoint: the one that looks at Viewpoint, as of a scanner; Up: the one that looks
            along +z, as of terrain

        viewpoint: Viewpoint: where the surface was seen from, in the layer's coordinates.

        flip: Turn all normals round at the end.

        neighbors: Points each plane is fitted to (0 = automatic: 25, and more as far as the cloud is noisy; at most
            1000).
        """

    def compute_curvature_robust_per_vertex(
        self,
        *,
        scale_mode: Literal["Adaptive", "Paper"] = "Adaptive",
        region_scale: float = 3.0,
        max_iterations: int = 30,
        feature_gate: bool = True,
        boundary_threshold: float = 2.5,
        correct_normals: bool = False,
        scalar: Literal["Mean", "Gaussian", "K1", "K2", "Curvedness", "Shape Index", "Confidence"] = "Mean",
        colorize: bool = True,
        umbilic_ratio: float = 0.95,
    ) -> dict[str, float]:
        """Principal curvatures and directions of a noisy cloud, by M-estimation.

        scale_mode: How large the region is that each estimate looks at. Adaptive: found from the cloud, around every
            point: as large as the noise asks for and as small as the shape does; Paper: a fixed number of local point
            spacings, as published

        region_scale: With Scale Paper only: radius of the operating region around each point, in local point spacings
            (1 to 20). Larger regions resist more noise and blur more detail.

        max_iterations: With Scale Paper only: largest number of reweighting iterations per point (1 to 1000).

        feature_gate: With Scale Paper only: keep only neighbours that agree with the point itself before the fit, so
            that the other side of a sharp edge has no influence.

        boundary_threshold: A sixth of the tangent plane counts as empty when its closest point is farther than this
            many median point spacings (1 to 100); two neighbouring empty sixths make a boundary point.

        correct_normals: Replace the normals by those of the fitted surface; PD1 and PD2 are then tangent to them. (With
            Scale Paper the curvature is estimated once more with the corrected normals; the adaptive estimate does not
            depend on the given ones beyond their side.)

        scalar: What is stored as vertex quality. Mean: (k1 + k2) / 2; Gaussian: k1 k2; K1, K2: the larger and the
            smaller principal curvature; Curvedness: sqrt((k1^2 + k2^2) / 2); Shape Index: +1 convex cap, 0 saddle, -1
            concave cup; Confidence: how much the neighbours' estimates rely on the point

        colorize: With Mean, by both principal curvatures at once: convex red, saddle green, concave blue, flat white.
            With the other scalars, by MeshLab's quality ramp between the 10th and the 90th percentile.

        umbilic_ratio: A point is umbilic, without principal directions of its own, when the smaller curvature is more
            than this share of the larger one (0 to 1).
        """

    def compute_selection_point_cloud_outliers_by_curvature(
        self,
        *,
        mode: Literal["Robust", "Paper"] = "Robust",
        sensitivity: float = 3.5,
        vote_threshold: float = 0.5,
        rounds: int = 3,
        reject_unstructured: bool = False,
        delete_selected: bool = False,
    ) -> dict[str, float]:
        """Selects the points that do not lie on the surface.

        mode: What counts as a vote against a point. Robust: its height above the surfaces its neighbours fitted; Paper:
            it relies on neighbours that do not rely on it (published rule; it sees wrong normals only)

        sensitivity: Robust mode: heights above this many noise units are votes against the point (0.5 to 100). Smaller
            values reject more.

        vote_threshold: A point is an outlier when more than this share of the votes is against it (0 to 1).

        rounds: How often at most the estimate is repeated without the outliers found so far (1 to 20).

        reject_unstructured: Robust mode: select also points that form no surface which the cloud could resolve.
            Otherwise they stay, and the report says how many there are.

        delete_selected: Delete the selected points (and faces that use them) at once.
        """

    def apply_coord_point_cloud_robust_denoising(
        self,
        *,
        method: Literal["Robust", "Paper"] = "Robust",
        noise: float = 0.0,
        radius: float = 0.0,
        iterations: int = 100,
        energy: Literal["Square Root", "Squared"] = "Square Root",
        optimizer: Literal["L-BFGS-B", "Polak-Ribiere"] = "L-BFGS-B",
        neighbors: Literal["Six Sectors", "Nearest"] = "Six Sectors",
    ) -> dict[str, float]:
        """Moves the points onto the surface and corrects the normals.

        method: How the points are moved. Robust: onto the surfaces their neighbours fit, at a radius found from the
            cloud; edges stay sharp. Needs no curvature; Paper: all at once, so that the triangles of each point with
            its neighbours agree with the corrected normals (a global energy, as published)

        noise: Robust: standard deviation of the points from the surface, a length in the layer's units (0 = automatic,
            at most half the bounding-box diagonal).

        radius: Robust: size of the fitted pieces of surface, in local point spacings (0 = automatic, at least 2.5 and
            at most 100). Larger ones remove more noise and more detail.

        iterations: Paper: largest number of iterations of the optimiser (1 to 10000).

        energy: Paper: power of the disagreement between triangle and normal. Square Root: as published in 2009,
            respects edges; Squared: smoother, removes more noise on smooth surfaces

        optimizer: Paper: L-BFGS-B (2009), or Polak-Ribiere conjugate gradients (2007).

        neighbors: Paper: the six neighbours of each point: the closest in each sixth of the tangent plane, or the six
            nearest.
        """

    def apply_curvature_direction_smoothing_per_vertex(
        self,
        *,
        alpha: float = 0.5,
        iterations: int = 100,
    ) -> dict[str, float]:
        """Smooths the principal directions where they are uncertain.

        alpha: 0 keeps the directions, 1 gives the smoothest field.

        iterations: Largest number of iterations of the optimiser (1 to 10000).
        """

    def generate_curvature_lines(
        self,
        *,
        method: Literal["Traced Lines", "Position Field"] = "Traced Lines",
        epsilon: float = 1e-05,
        target_vertices: int = 0,
        min_spacing: float = 0.0,
        max_spacing: float = 0.0,
        tolerance: float = 0.01,
        projection: Literal["Mixed", "Locally Optimal", "Weighted Average"] = "Mixed",
        stop_factor: float = 0.7,
        umbilic_ratio: float = 0.95,
        smooth_directions: bool = True,
    ) -> dict[str, float]:
        """Traces the lines of curvature as a new polyline layer.

        method: Traced Lines: one line after the other follows the directions, as published; they are where the lines of
            curvature are; Position Field: the lines of the mesh that Surface Reconstruction makes, all at once and
            evenly spaced; clean the cloud first. The parameters below do not concern it, except epsilon and the target
            number

        epsilon: Sets the density of the lines: neighbouring lines are as far apart as a chord that leaves the surface
            by this fraction of the bounding-box diagonal (1e-9 to 0.5).

        target_vertices: If not 0, the chord error is found so that the lines cross in about so many points: the
            vertices of the mesh to come (at most 10000000).

        min_spacing: Lines of one family are never closer than this, in the layer's units; 0 = automatic, from the point
            spacing.

        max_spacing: The distance between lines where the surface is flat, in the layer's units; 0 = automatic.

        tolerance: Relative error per step; smaller values trace in smaller steps (1e-6 to 1).

        projection: How line points are kept on the surface. Mixed: mean of point average and tangent planes, whose
            errors cancel; Locally Optimal: as published in 2009; Weighted Average: as published in 2007

        stop_factor: A line ends where it comes closer to the next one than this times the distance new lines keep (0.1
            to 1). Small values let lines run on through narrow places: gaps are less even, and the mesh between the
            lines has more quads (0.5: about 99 %).

        umbilic_ratio: A point is umbilic, without principal directions of its own, when the smaller curvature is more
            than this share of the larger one (0 to 1).

        smooth_directions: Smooth the principal directions first, unless those on the layer are smoothed already. The
            layer keeps its own.
        """

    def generate_sharp_feature_lines(
        self,
        *,
        min_angle: float = 30.0,
        spacing: float = 0.0,
        denoise: bool = True,
    ) -> dict[str, float]:
        """Finds the sharp edges of the surface as a new polyline layer.

        min_angle: A line is kept if somewhere the normals of its two faces differ by this many degrees (5 to 150); from
            there it is followed until six tenths of it are left. Lower values find softer edges, and more that noise
            makes up.

        spacing: Distance between the vertices of the lines, in the layer's units; 0 = automatic, 0.7 times the point
            spacing.

        denoise: Search a denoised copy of the points (as Denoise Point Cloud by Robust Curvature makes it). Without,
            the points and their normals are taken as they are: for clouds denoised before, and exact ones.
        """

    def generate_curvature_aligned_quad_mesh(
        self,
        *,
        point_cloud: int = ...,
        quads: Literal["Pure", "Dominant", "Subdivided"] = "Dominant",
        triangulate: bool = False,
        close_holes: bool = False,
        texture_coordinates: bool = False,
        split_concave: bool = True,
    ) -> dict[str, float]:
        """Builds a quad-dominant mesh from a layer of curvature lines.

        point_cloud: The layer the lines were traced on. It is found by itself when the lines were traced in this
            session.

        quads: Which faces the mesh has. Pure: quads only, with few irregular vertices; Dominant: quads, and triangles
            and pentagons where lines end, which follow the directions most closely; Subdivided: quads only, from a
            coarser mesh, each of whose faces is divided from its centre

        triangulate: Cut all faces into triangles, for programs that know no others.

        close_holes: Fill holes that are small against the mesh.

        texture_coordinates: Give the corners of the faces texture coordinates (of wedges, between 0 and 1) along the
            two families of lines: every quad is a square cell, all cells are equally large, and 'texture_cells' of them
            fill a side of the texture. The mesh is cut into 'texture_charts' pieces that do not overlap, with seams at
            sharp creases (Position Field) and from irregular vertices on; other faces than quads fill a cell each. Save
            the mesh as PLY, or with Triangulate as OBJ: hosts write wrong texture coordinates into OBJ files of
            polygons.

        split_concave: Cut faces with a reflex corner into convex ones.
        """

    def generate_surface_reconstruction_curvature_aligned(
        self,
        *,
        method: Literal["Position Field", "Traced Lines"] = "Position Field",
        target_vertices: int = 0,
        epsilon: float = 0.0,
        anisotropy: float = 1.5,
        points_per_vertex: float = 24.0,
        hole_size: float = 8.0,
        quads: Literal["Pure", "Dominant", "Subdivided"] = "Pure",
        triangulate: bool = False,
        close_holes: bool = False,
        texture_coordinates: bool = False,
        reject_outliers: bool = True,
        reject_unstructured: bool = False,
        denoise: bool = True,
        smooth_directions: bool = True,
        estimate_normals: Literal["If Missing", "Never", "Always"] = "If Missing",
        scale_mode: Literal["Adaptive", "Paper"] = "Adaptive",
        keep_intermediate_layers: bool = False,
    ) -> dict[str, float]:
        """From a cloud to a curvature-aligned quad mesh, in one step.

        method: How the mesh is found. Position Field: on a triangulation of the cleaned points, by two phases that
            follow the principal directions; rims and sharp creases become edges, and every face is certified to be a
            disk; Traced Lines: between traced lines of curvature, as published

        target_vertices: About how many vertices the mesh gets (at most 10000000, and four per point); 0 = automatic:
            from Chord error if that is set, else from the size of the cloud.

        epsilon: Sets the density of the lines if no target number is given: how far the chord between two lines leaves
            the surface, as a fraction of the bounding-box diagonal (0 = automatic, at most 0.5).

        anisotropy: Position Field: by how much lines may run closer across strong bends than along (1 to 10; 1 = not at
            all).

        points_per_vertex: Position Field with a target number of vertices: a cloud with more points per vertex is
            thinned to so many, evenly and not below 20000 points, once its outliers are out (0 = use all points, which
            takes longer). Keep all to have all in the cleaned cloud.

        hole_size: Position Field: gaps of the cloud up to so many point spacings across are closed (1 to 1000); wider
            ones get a rim. Less than 8 may open sparse parts; holes smaller than about two edges of the mesh cannot be
            seen in it.

        quads: Which faces the mesh has. Pure: quads only, with few irregular vertices; Dominant: quads, and triangles
            and pentagons where lines end, which follow the directions most closely; Subdivided: quads only, from a
            coarser mesh, each of whose faces is divided from its centre

        triangulate: Cut all faces into triangles, for programs that know no others.

        close_holes: Fill holes that are small against the mesh.

        texture_coordinates: Give the corners of the faces texture coordinates (of wedges, between 0 and 1) along the
            two families of lines: every quad is a square cell, all cells are equally large, and 'texture_cells' of them
            fill a side of the texture. The mesh is cut into 'texture_charts' pieces that do not overlap, with seams at
            sharp creases (Position Field) and from irregular vertices on; other faces than quads fill a cell each. Save
            the mesh as PLY, or with Triangulate as OBJ: hosts write wrong texture coordinates into OBJ files of
            polygons.

        reject_outliers: Leave outliers out.

        reject_unstructured: With Reject outliers: leave out also points that form no surface which the cloud could
            resolve. Otherwise they stay, and the report says how many there are.

        denoise: Move the points onto the surface. Switch it off for exact data.

        smooth_directions: Traced Lines: smooth the field of principal directions before tracing. A position field
            always is, as far as the directions are uncertain.

        estimate_normals: Whether to compute normals from the positions (plane fits, their sides by winding numbers). If
            Missing: when most points have none; Never: use those of the layer; Always: replace those of the layer

        scale_mode: How large the region is that each estimate looks at. Adaptive: found from the cloud, around every
            point: as large as the noise asks for and as small as the shape does; Paper: a fixed number of local point
            spacings, as published

        keep_intermediate_layers: Add the cleaned cloud, with its curvature and how far each point moved, and the lines
            as layers of their own.
        """

    def compute_curvature_m_weighted_per_vertex(
        self,
        *,
        bandwidth: float = 2.5,
        exponent: int = 2,
        neighbors: int = 60,
        weighting: Literal["M", "Gaussian", "Unweighted"] = "M",
        scalar: Literal["Mean", "Gaussian", "K1", "K2", "Curvedness", "Shape Index", "Confidence"] = "Mean",
        colorize: bool = True,
        umbilic_ratio: float = 0.95,
    ) -> dict[str, float]:
        """Principal curvatures and directions of a clean cloud, by Euler's theorem.

        bandwidth: Length h of the weights, in local point spacings (0.5 to 20). The weight is largest at h times the
            root of the exponent. Larger resists more noise and blurs more detail.

        exponent: With M weights, the power xi of x^(2 xi) exp(-x^2 / h^2) (1 to 10): the larger, the less the closest
            points count.

        neighbors: Nearest points looked at around each point (6 to 1000).

        weighting: How much a neighbour counts by its distance x. M: x^(2 xi) exp(-x^2 / h^2), little where close, as
            published; Gaussian: exp(-x^2 / h^2), for comparison: noise makes close points wild; Unweighted: all
            neighbours alike

        scalar: What is stored as vertex quality. Mean: (k1 + k2) / 2; Gaussian: k1 k2; K1, K2: the larger and the
            smaller principal curvature; Curvedness: sqrt((k1^2 + k2^2) / 2); Shape Index: +1 convex cap, 0 saddle, -1
            concave cup; Confidence: how much the neighbours' estimates rely on the point

        colorize: With Mean, by both principal curvatures at once: convex red, saddle green, concave blue, flat white.
            With the other scalars, by MeshLab's quality ramp between the 10th and the 90th percentile.

        umbilic_ratio: A point is umbilic, without principal directions of its own, when the smaller curvature is more
            than this share of the larger one (0 to 1).
        """

    def compute_curvature_driven_projection(
        self,
        *,
        control_mesh: int = ...,
        proxy_mesh: int = ...,
        bandwidth: float = 1.6,
        diffusion_steps: int = 10,
        diffusion_function: Literal["Hermite", "Cutoff", "Rational"] = "Hermite",
        resample: int = 1,
    ) -> dict[str, float]:
        """Moves vertices onto the smooth surface a cloud defines, or makes a cloud denser.

        control_mesh: The cloud that defines the surface; it needs oriented normals and stays as it is, unless it is
            projected onto its own surface.

        proxy_mesh: The layer whose vertices move onto the surface.

        bandwidth: Of the Gaussian weights, in local spacings of the control points (0.5 to 20). Larger removes more
            noise and blurs more detail.

        diffusion_steps: Largest number of steps that move a point onto the surface along the normal (1 to 1000); it
            stops when nothing moves.

        diffusion_function: What a control point says about where the surface is. Hermite: the mean of its own height
            and that of its tangent plane, which does not shrink the surface; Cutoff, Rational: its height, none or less
            of it where the surface bends much towards it, as published: shrinks bends by a share of the spacing

        resample: 1: the vertices move. More (up to 100): so many points around each vertex, projected, as a new layer:
            a denser cloud on the same surface.
        """

    def save_ray_traced_point_set_image(
        self,
        *,
        image_file: str = ...,
        width: int = 533,
        height: int = 400,
        surface: Literal["Curvature-Driven", "Moving Least Squares"] = "Curvature-Driven",
        background: pymeshlab.Color = ...,
        color_by: Literal["Plain", "Curvature", "Vertex Colour"] = "Plain",
        lines: int = ...,
        camera: Literal["Automatic", "Given"] = "Automatic",
        camera_position: ArrayLike = ...,
        camera_target: ArrayLike = ...,
        camera_up: ArrayLike = ...,
        field_of_view: float = 30.0,
    ) -> dict[str, float]:
        """Draws the surface between the points into a PNG file.

        image_file: Where the picture goes: a PNG file, replaced if it exists.

        width: 1 to 8192.

        height: 1 to 8192.

        surface: The surface between the points. Curvature-Driven: quadrics of principal curvatures and directions;
            Moving Least Squares: complete quadrics over fitted planes; needs normals for the side only

        background: Colour where nothing is.

        color_by: Plain: one light grey; Curvature: convex red, saddle green, concave blue, flat white; Vertex Colour:
            that of the layer, as other filters leave it

        lines: The layer whose lines (of curvature, or any edges) are drawn on the surface, in the colours of its
            vertices. Leave the cloud's own layer here, as it is at first, to draw none.

        camera: Automatic: sees all points, from the side their normals face. Given: by the parameters below.

        camera_position: In the layer's coordinates.

        camera_target: What is in the middle of the picture.

        camera_up: What is up in the picture.

        field_of_view: Across the shorter side of the picture, in degrees (1 to 150).
        """
