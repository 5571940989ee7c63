// Statistical weights as a table, and the scalars of two curvatures.
// SPDX-License-Identifier: GPL-3.0-or-later
#include <cmath>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include "curvature_field.h"
#include "point_cloud.h"

namespace curvature_lines {
namespace {

TEST(StatisticalWeights, AreThoseOfATableAndAddUpToTheConfidence)
{
	const Index                      n = 30;
	std::mt19937                     random(3);
	Eigen::MatrixXd                  table = Eigen::MatrixXd::Zero(n, n);
	std::vector<std::vector<Index>>  rows(n);
	std::vector<std::vector<double>> weights(n);
	for (Index i = 0; i < n; ++i)
		for (Index j = 0; j < n; ++j)
			if (i != j && random() % 3 == 0) {
				table(i, j) = 0.01 + double(random() % 100) / 101.0;
				rows[i].push_back(j);
				weights[i].push_back(table(i, j));
			}
	CurvatureField field;
	field.confidence.setZero(n);
	adoptWeights(rows, weights, field);
	for (Index i = 0; i < n; ++i)
		for (Index j = 0; j < n; ++j)
			EXPECT_EQ(field.weights(i, j), table(i, j));
	for (Index j = 0; j < n; ++j)
		EXPECT_NEAR(field.confidence[j], table.col(j).sum(), 1e-12);
}

TEST(ShapeIndex, TellsCapsSaddlesAndCups)
{
	EXPECT_DOUBLE_EQ(shapeIndex(2.0, 2.0), 1.0);
	EXPECT_DOUBLE_EQ(shapeIndex(2.0, 0.0), 0.5);
	EXPECT_DOUBLE_EQ(shapeIndex(2.0, -2.0), 0.0);
	EXPECT_DOUBLE_EQ(shapeIndex(0.0, -2.0), -0.5);
	EXPECT_DOUBLE_EQ(shapeIndex(-2.0, -2.0), -1.0);
	EXPECT_EQ(shapeIndex(0.0, 0.0), 0.0);
	for (double k1 = -2.0; k1 <= 2.0; k1 += 0.37)
		for (double k2 = -2.0; k2 <= k1; k2 += 0.41) {
			EXPECT_NEAR(shapeIndex(3.0 * k1, 3.0 * k2), shapeIndex(k1, k2), 1e-12);
			EXPECT_NEAR(shapeIndex(-k2, -k1), -shapeIndex(k1, k2), 1e-12); // the other side
			EXPECT_NEAR(curvedness(k1, k2), std::sqrt(0.5 * (k1 * k1 + k2 * k2)), 1e-12);
		}
}

} // namespace
} // namespace curvature_lines
