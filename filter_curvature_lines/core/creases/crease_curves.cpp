// Lengths, normals and sides of creases.
// SPDX-License-Identifier: GPL-3.0-or-later
#include "crease_curves.h"

#include <Eigen/Core>

#include "point_cloud.h"

namespace curvature_lines {

double CreaseCurve::length() const
{
	double sum = 0.0;
	for (Index v = 1; v < size(); ++v)
		sum += (positions.col(v) - positions.col(v - 1)).norm();
	if (closed && size() > 2)
		sum += (positions.col(0) - positions.col(size() - 1)).norm();
	return sum;
}

Eigen::Vector3d CreaseCurve::normal(Index v) const
{
	return (left.col(v) + right.col(v)).normalized();
}

bool CreaseCurve::concave() const
{
	return angle.sum() < 0.0;
}

CreaseTotals totalsOf(const Creases& creases, double unit)
{
	CreaseTotals totals;
	for (const CreaseCurve& curve : creases.curves) {
		totals.length += unit * curve.length();
		totals.closed += curve.closed;
		totals.concave += curve.concave();
	}
	return totals;
}

} // namespace curvature_lines
