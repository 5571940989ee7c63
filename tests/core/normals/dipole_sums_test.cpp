// The treecode against sums over all points.
// SPDX-License-Identifier: GPL-3.0-or-later
#include "dipole_sums.h"

#include <cmath>
#include <random>

#include <Eigen/Core>
#include <gtest/gtest.h>

#include "analytic_surfaces.h"

using namespace curvature_lines;

namespace {

samples::SampleCloud sample(const char* surface)
{
	samples::SampleRequest request;
	request.surface = surface;
	request.points  = 2000;
	request.seed    = 3;
	return samples::generate(request);
}

} // namespace

// Brute force in double precision.
TEST(DipoleSums, AgreeWithTheSumsOverAllPoints)
{
	const auto                cloud = sample("ellipsoid");
	const DipoleSums          sums(cloud.positions);
	const DipoleSums::Vectors dipoles  = cloud.normals.cast<float>();
	const double              width    = 0.05;
	const Eigen::VectorXf     fast     = sums.winding(dipoles, float(width), {});
	const DipoleSums::Vectors gradient = sums.gradient(dipoles, float(width), {});
	const Eigen::VectorXf     ones     = Eigen::VectorXf::Ones(cloud.positions.cols());
	const DipoleSums::Vectors adjoint  = sums.adjoint(ones, float(width), {});
	double error = 0.0, size = 0.0, gradientError = 0.0, gradientSize = 0.0, adjointError = 0.0,
		   adjointSize = 0.0;
	for (Eigen::Index i = 0; i < cloud.positions.cols(); i += 10) {
		double          all   = 0.0;
		Eigen::Vector3d slope = Eigen::Vector3d::Zero(), back = Eigen::Vector3d::Zero();
		for (Eigen::Index j = 0; j < cloud.positions.cols(); ++j) {
			const Eigen::Vector3d d = cloud.positions.col(j) - cloud.positions.col(i);
			const double          l = d.norm();
			if (l <= width)
				continue;
			const Eigen::Vector3d m = cloud.normals.col(j);
			all += d.dot(m) / (l * l * l);
			slope += m / std::pow(l, 3) - 3.0 * d * d.dot(m) / std::pow(l, 5);
			back -= d / (l * l * l);
		}
		error += std::pow(fast[i] - all, 2);
		size += all * all;
		gradientError += (gradient.col(i).cast<double>() - slope).squaredNorm();
		gradientSize += slope.squaredNorm();
		adjointError += (adjoint.col(i).cast<double>() - back).squaredNorm();
		adjointSize += back.squaredNorm();
	}
	EXPECT_LT(std::sqrt(error / size), 0.03);
	EXPECT_LT(std::sqrt(gradientError / gradientSize), 0.05);
	EXPECT_LT(std::sqrt(adjointError / adjointSize), 0.03);
}
