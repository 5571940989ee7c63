// Rims of scaffolds against the true ones of open surfaces.
// SPDX-License-Identifier: GPL-3.0-or-later
#include "rim_fit.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "analytic_surfaces.h"
#include "even_sizes.h"
#include "point_cloud.h"
#include "rims.h"
#include "scaffold.h"

namespace curvature_lines::test {
namespace {

using Eigen::Vector3d;

constexpr int points = 10000;

struct Fitted {
	Scaffold         scaffold;
	std::vector<Rim> rims;
};

// Points that noise moves within the surface alone, as denoising leaves them.
Fitted fitted(const std::string& name, double noise, int seed)
{
	samples::SampleRequest request;
	request.surface                    = name;
	request.points                     = points;
	request.noise                      = noise;
	request.seed                       = seed;
	const samples::SampleCloud sample  = samples::generate(request);
	const auto&                surface = samples::surface(name);
	PointCloud                 cloud{sample.positions, sample.normals};
	for (Index i = 0; i < cloud.size(); ++i) {
		const Vector3d n   = sample.normals.col(i),
					   off = sample.positions.col(i) - sample.footPoints.col(i);
		cloud.positions.col(i) -= off.dot(n) * n;
	}
	Fitted result{buildScaffold(cloud, {}, test::evenSizes(cloud, 1000.0)), {}};
	result.rims      = findRims(result.scaffold.mesh);
	const auto truth = samples::groundTruth(surface, result.scaffold.mesh.vertices);
	fitRims(result.rims, cloud, truth.normals, noise * surface.diagonal(), result.scaffold);
	return result;
}

struct Errors {
	double rms = 0.0, most = 0.0;
};

// Of the height of the cylinder's two rims, in spacings of the points.
Errors cylinderErrors(const Fitted& found, double spacing)
{
	Errors errors;
	Index  count = 0;
	for (const Rim& rim : found.rims)
		for (const Index v : rim.vertices) {
			const double off = (std::abs(found.scaffold.mesh.vertices(2, v)) - 1.0) / spacing;
			errors.rms += off * off;
			errors.most = std::max(errors.most, std::abs(off));
			++count;
		}
	errors.rms = std::sqrt(errors.rms / count);
	return errors;
}

TEST(RimFit, FindsTheCylindersRims)
{
	const double spacing = std::sqrt(2.0 * double(EIGEN_PI) / points);
	for (int seed = 1; seed <= 3; ++seed) {
		const Fitted exact = fitted("cylinder", 0.0, seed);
		ASSERT_EQ(exact.rims.size(), 2u);
		EXPECT_LT(cylinderErrors(exact, spacing).rms, 0.2) << seed;
		EXPECT_LT(cylinderErrors(exact, spacing).most, 0.6) << seed;
		EXPECT_LT(cylinderErrors(fitted("cylinder", 0.0025, seed), spacing).most, 0.8) << seed;
	}
}

TEST(RimFit, PutsCornersWhereTheSidesMeet)
{
	const double spacing = std::sqrt(2.96 * double(EIGEN_PI) / points);
	for (const double noise : {0.0, 0.0025})
		for (int seed = 1; seed <= 3; ++seed) {
			const Fitted found = fitted("helicoid", noise, seed);
			ASSERT_EQ(found.rims.size(), 1u);
			const Rim& rim = found.rims[0];
			ASSERT_EQ(std::count(rim.corner.begin(), rim.corner.end(), 1), 4) << seed;
			for (Index k = 0; k < rim.size(); ++k)
				if (rim.isCorner(k)) {
					const Vector3d p = found.scaffold.mesh.vertices.col(rim.at(k));
					const Vector3d corner(
						std::copysign(1.0, p.x()),
						0.0,
						std::copysign(0.5 * double(EIGEN_PI), p.z()));
					EXPECT_LT((p - corner).norm() / spacing, noise > 0.0 ? 1.2 : 0.6)
						<< noise << ' ' << seed;
				}
		}
}

TEST(RimFit, LeavesAClosedSurfaceAlone)
{
	Fitted found = fitted("sphere", 0.0, 1);
	EXPECT_TRUE(found.rims.empty());
}

} // namespace
} // namespace curvature_lines::test
