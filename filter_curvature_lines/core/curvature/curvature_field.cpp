// Look-up of statistical weights, and scalars of the two curvatures.
// SPDX-License-Identifier: GPL-3.0-or-later
#include "curvature_field.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include "point_cloud.h"

namespace curvature_lines {

double StatisticalWeights::operator()(Index i, Index j) const
{
	const NeighborLists::Row row = neighbors[i];
	const Index*             at  = std::lower_bound(row.begin(), row.end(), j);
	return at != row.end() && *at == j ? values[at - neighbors.indices.data()] : 0.0;
}

double shapeIndex(double k1, double k2)
{
	return k1 == 0.0 && k2 == 0.0 ? 0.0 : 2.0 / EIGEN_PI * std::atan2(k1 + k2, k1 - k2);
}

double curvedness(double k1, double k2)
{
	return std::hypot(k1, k2) / std::sqrt(2.0);
}

void adoptWeights(
	const std::vector<std::vector<Index>>&  rows,
	const std::vector<std::vector<double>>& weights,
	CurvatureField&                         field)
{
	field.weights.neighbors = NeighborLists::fromRows(rows);
	field.weights.values.reserve(field.weights.neighbors.indices.size());
	for (std::size_t i = 0; i < rows.size(); ++i) { // always in this order
		field.weights.values.insert(
			field.weights.values.end(), weights[i].begin(), weights[i].end());
		for (std::size_t k = 0; k < rows[i].size(); ++k)
			field.confidence[rows[i][k]] += weights[i][k];
	}
}

} // namespace curvature_lines
