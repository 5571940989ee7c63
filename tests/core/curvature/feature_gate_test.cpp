// Which points of a region belong to the middle one's face: all of a smooth surface, one side of an edge; and normals
// that the points around set right.
// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "analytic_surfaces.h"
#include "feature_gate.h"
#include "neighborhoods.h"
#include "operating_region.h"
#include "point_cloud.h"

namespace curvature_lines {
namespace {

using Eigen::Vector3d;

PointCloud cloudOf(const char* surface, int points)
{
	samples::SampleRequest request;
	request.surface   = surface;
	request.points    = points;
	request.seed      = 3;
	const auto sample = samples::generate(request);
	return {sample.positions, sample.normals};
}

OperatingRegion regionAt(const PointCloud& cloud, Index i, double spacing)
{
	OperatingRegion region;
	region.collect(
		cloud, NeighborSearch(cloud.positions), i, cloud.normals.col(i), spacing, 3.0, 6, 0);
	return region;
}

// That of the whole cloud, from some of its points.
double commonScaleOf(const PointCloud& cloud, double spacing)
{
	std::vector<CentreFits> fits;
	FeatureGate             gate;
	for (Index i = 0; i < cloud.size(); i += 40)
		fits.push_back(gate.fitCentre(regionAt(cloud, i, spacing), VariationModel::Zero(), {}));
	return commonCentreScale(fits);
}

GateResult gateOf(const OperatingRegion& region, double commonScale)
{
	FeatureGate      gate;
	const CentreFits fits = gate.fitCentre(region, VariationModel::Zero(), {});
	EXPECT_TRUE(fits.valid);
	return gate.select(region, fits, commonScale);
}

TEST(FeatureGate, KeepsTheWholeRegionOfASmoothSurface)
{
	const PointCloud torus   = cloudOf("torus", 4000);
	const double     common  = commonScaleOf(torus, 0.05);
	double           consent = 0.0;
	for (Index i = 0; i < 4000; i += 100) {
		const OperatingRegion region = regionAt(torus, i, 0.05);
		const GateResult      result = gateOf(region, common);
		ASSERT_FALSE(result.members.empty());
		EXPECT_EQ(result.members[0], 0);
		consent += result.consent / 40.0;
	}
	EXPECT_GT(consent, 0.9);
}

TEST(FeatureGate, KeepsToOneSideOfAnEdge)
{
	const PointCloud cube   = cloudOf("cube", 4000);
	const double     common = commonScaleOf(cube, 0.04);
	int              tried = 0, foreign = 0, members = 0;
	for (Index i = 0; i < 4000; ++i) {
		// close to one edge and away from the others
		Vector3d toFaces = Vector3d::Constant(0.5) - cube.positions.col(i).cwiseAbs();
		std::sort(toFaces.data(), toFaces.data() + 3);
		if (toFaces[1] > 0.03 || toFaces[2] < 0.25)
			continue;
		const OperatingRegion region = regionAt(cube, i, 0.04);
		const GateResult      result = gateOf(region, common);
		++tried;
		members += static_cast<int>(result.members.size());
		for (const Index m : result.members)
			foreign += cube.normals.col(region.points[m]).dot(cube.normals.col(i)) < 0.5;
		EXPECT_LT(result.consent, 0.9);
		EXPECT_GT(result.consent, 0.2);
	}
	ASSERT_GT(tried, 50);
	EXPECT_LT(foreign, 0.02 * members);
}

TEST(FeatureGate, OfTooFewPointsKeepsAll)
{
	PointCloud few;
	few.positions.resize(3, 4);
	few.positions << 0, 1, 0, 1, 0, 0, 1, 1, 0, 0, 0, 0;
	few.normals                  = Vector3d::UnitZ().replicate(1, 4);
	const OperatingRegion region = regionAt(few, 0, 1.0);
	FeatureGate           gate;
	const CentreFits      fits = gate.fitCentre(region, VariationModel::Zero(), {});
	EXPECT_FALSE(fits.valid);
	EXPECT_EQ(static_cast<Index>(gate.select(region, fits, 0.1).members.size()), region.size());
}

TEST(FeatureGate, TheCommonScaleIsTheMedianOfTheFits)
{
	std::vector<CentreFits> fits(5);
	for (int k = 0; k < 5; ++k) {
		fits[k].valid  = true;
		fits[k].sigmas = {0.0, 0.1 * (k + 1), 1.0};
	}
	EXPECT_NEAR(commonCentreScale(fits), 0.3, 1e-12);
	fits[4].valid = fits[3].valid = false;
	EXPECT_NEAR(commonCentreScale(fits), 0.2, 1e-12);
	EXPECT_GT(commonCentreScale({}), 0.0);
}

TEST(NormalConsensus, SetsAWrongNormalRight)
{
	PointCloud            sphere = cloudOf("sphere", 3000);
	const Index           i      = 5;
	const Vector3d        truth  = sphere.normals.col(i);
	const NormalConsensus right  = normalConsensus(regionAt(sphere, i, 0.06));
	EXPECT_GT(right.ownSupport, 0.9);
	EXPECT_GT(right.normal.dot(truth), 0.95);
	sphere.normals.col(i)       = truth.unitOrthogonal();
	const NormalConsensus wrong = normalConsensus(regionAt(sphere, i, 0.06));
	EXPECT_LT(wrong.ownSupport, 0.1);
	EXPECT_GT(wrong.normal.dot(truth), 0.95);
}

} // namespace
} // namespace curvature_lines
