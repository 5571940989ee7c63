// Gaussian sums over control points against plain loops, and the same bits for every instruction set.
// SPDX-License-Identifier: GPL-3.0-or-later
#include "gaussian_sums.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include <Eigen/Core>
#include <gtest/gtest.h>

#include "analytic_surfaces.h"
#include "block_size.h"
#include "gaussian_sums_simd.h"
#include "local_polynomial.h"
#include "sample_kernels.h"
#include "simd_block.h"

namespace curvature_lines {
namespace {

using Eigen::Vector3d;

template<class T>
bool sameBits(const T& a, const T& b)
{
	const auto* p = reinterpret_cast<const unsigned char*>(&a);
	return std::equal(p, p + sizeof(T), reinterpret_cast<const unsigned char*>(&b));
}

constexpr double sharpness = 2.5, farAway = 1e30;

// Random control points with normals, filled up with points far away.
struct Points {
	int                   size, padded;
	std::vector<double>   rows;
	std::vector<Vector3d> p, n;

	explicit Points(int count) :
			size(count), padded((count + blockSize - 1) / blockSize * blockSize),
			rows(std::size_t(6) * padded, farAway)
	{
		samples::Random random(count, 0);
		for (int k = 0; k < count; ++k) {
			p.emplace_back(random.normal(), random.normal(), random.normal());
			n.emplace_back(random.normal(), random.normal(), random.normal());
			for (int c = 0; c < 3; ++c) {
				rows[std::size_t(c) * padded + k]     = p[k][c];
				rows[std::size_t(3 + c) * padded + k] = n[k][c];
			}
		}
	}
	ControlColumns columns() const { return {rows.data(), padded}; }
	static double weightAt(const Vector3d& d)
	{
		const double t = sharpness * d.squaredNorm();
		return t < 16.0 ? std::exp(-t) : 0.0;
	}
};

TEST(GaussianSums, ArePlainSumsAndTheSameOnEveryProcessor)
{
	const Vector3d place(0.1, 0.2, -0.1);
	for (const int count : {1, 4, 30, 101}) {
		const Points    points(count);
		double          weight = 0.0, plane = 0.0;
		Vector3d        offset = Vector3d::Zero(), normal = offset;
		Eigen::Matrix3d square = Eigen::Matrix3d::Zero();
		for (int k = 0; k < count; ++k) {
			const Vector3d d = points.p[k] - place;
			const double   w = Points::weightAt(d);
			weight += w;
			offset += w * d;
			normal += w * points.n[k];
			plane += w * d.dot(points.n[k]);
			square += w * d * d.transpose();
		}
		const GaussianNormalSums a = gaussianNormalSums(points.columns(), place.data(), sharpness);
		const GaussianPlaneSums  b = gaussianPlaneSums(points.columns(), place.data(), sharpness);
		EXPECT_NEAR(a.weight, weight, 1e-8);
		EXPECT_NEAR(b.weight, weight, 1e-8);
		EXPECT_NEAR(a.plane, plane, 1e-8);
		EXPECT_LT((Vector3d(a.offset) - offset).norm(), 1e-8);
		EXPECT_LT((Vector3d(b.offset) - offset).norm(), 1e-8);
		EXPECT_LT((Vector3d(a.normal) - normal).norm(), 1e-8);
		const double expected[6] = {
			square(0, 0), square(0, 1), square(0, 2), square(1, 1), square(1, 2), square(2, 2)};
		for (int m = 0; m < 6; ++m)
			EXPECT_NEAR(b.square[m], expected[m], 1e-8);
		EXPECT_TRUE(sameBits(
			a, simd::gaussianNormalSums<BaselineArch>(points.columns(), place.data(), sharpness)));
		EXPECT_TRUE(sameBits(
			b, simd::gaussianPlaneSums<BaselineArch>(points.columns(), place.data(), sharpness)));
	}
}

TEST(GaussianSums, SamplesAreCoordinatesInTheFrame)
{
	const Points       points(22);
	const FrameColumns frame{{0.1, 0.0, 0.2}, {2.0, 0.0, 0.0}, {0.0, 0.0, 3.0}, {0.0, -1.0, 0.0}};
	LocalSamples<1>    samples;
	samples.resize(points.padded);
	toGaussianSamples(points.columns(), frame, sharpness, samples.columns());
	for (int k = 0; k < points.size; ++k) {
		const Vector3d d = points.p[k] - Vector3d(frame.origin);
		EXPECT_NEAR(samples.x[k], 2.0 * d.x(), 1e-14);
		EXPECT_NEAR(samples.y[k], 3.0 * d.z(), 1e-14);
		EXPECT_NEAR(samples.value[0][k], -d.y(), 1e-14);
		EXPECT_NEAR(samples.weight[k], Points::weightAt(d), 1e-9);
	}
	for (int k = points.size; k < points.padded; ++k)
		EXPECT_EQ(samples.weight[k], 0.0);
}

TEST(GaussianSums, EulerMomentsAreThoseOfTheAngles)
{
	samples::Random random(5, 0);
	LocalSamples<1> samples;
	samples.reserve(23);
	double normal[5] = {}, spread[5] = {}, rhs[3] = {}, squares = 0.0, count = 0.0;
	for (int s = 0; s < 23; ++s) {
		const double angle = random.uniform(0.0, 2.0 * EIGEN_PI), r = random.uniform(0.2, 1.0);
		const double z = 0.1 * random.normal(), w = s % 4 == 1 ? 0.0 : random.uniform(0.1, 1.0);
		samples.add(r * std::cos(angle), r * std::sin(angle), w, Eigen::Matrix<double, 1, 1>(z));
		const double c = std::cos(2.0 * angle), sine = std::sin(2.0 * angle);
		const double k      = -2.0 * z / (r * r + z * z);
		const double row[5] = {1.0, c, sine, c * c, c * sine};
		for (int m = 0; m < 5; ++m) {
			normal[m] += w * row[m];
			spread[m] += w * w * row[m];
		}
		for (int m = 0; m < 3; ++m)
			rhs[m] += w * k * row[m];
		squares += w * k * k;
		count += w > 0.0;
	}
	samples.add(0.0, 0.0, 1.0, Eigen::Matrix<double, 1, 1>(0.5)); // at the origin: does not count
	samples.pad();
	const EulerMoments m = eulerMomentsOf(samples.columns());
	for (int k = 0; k < 5; ++k) {
		EXPECT_NEAR(m.normal[k], normal[k], 1e-13);
		EXPECT_NEAR(m.spread[k], spread[k], 1e-13);
	}
	for (int k = 0; k < 3; ++k)
		EXPECT_NEAR(m.rhs[k], rhs[k], 1e-13);
	EXPECT_NEAR(m.squares, squares, 1e-13);
	EXPECT_EQ(m.count, count);
	EXPECT_TRUE(sameBits(m, simd::eulerMomentsOf<BaselineArch>(samples.columns())));
}

} // namespace
} // namespace curvature_lines
