// Paragraphs that several filters' help texts share (HTML; the same text feeds MeshLab's dialogs
// and PyMeshLab's documentation).
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <QString>

namespace curvature_lines {

// Short: MeshLab shows all of it above the parameters, and a screen has only so many lines.
inline const QString helpInput =
	"<br><br><b>Input.</b> A point cloud with normals that point outward; of a mesh, the vertices. "
	"Points with non-finite coordinates or without a normal take no part. If most points have no "
	"normal, all are estimated, as by <i>Estimate and Orient Normals</i>.";

inline const QString helpConventions = "<br><br><b>Conventions.</b> Convex is positive: a unit "
									   "sphere has k1 = k2 = +1; k1 &gt;= k2; PD1, PD2 "
									   "and the normal of the fitted surface are orthogonal unit "
									   "vectors. Lengths are in the layer's units "
									   "(freeze its matrix first if that scales), curvatures in "
									   "1/length, spacings are distances between "
									   "neighbouring points.";

inline const QString helpChaining =
	"<br><br>Curvature that is already on the layer and still fits its points and normals is used; "
	"otherwise it is computed with default settings.";

inline const QString helpReference =
	"<br><br>See:<br><i>E. Kalogerakis, D. Nowrouzezahrai, P. Simari, K. Singh.</i><br>"
	"<b>\"Extracting lines of curvature from noisy point clouds\"</b><br>"
	"Computer-Aided Design 41(4), 2009.";

inline const QString helpReferenceTejada =
	"<br><br>See:<br><i>E. Tejada, J. P. Gois, L. G. Nonato, A. Castelo, T. Ertl.</i><br>"
	"<b>\"Curvature-driven modeling and rendering of point-based surfaces\"</b><br>"
	"SIBGRAPI 2006.";

} // namespace curvature_lines
