// The loops over samples: against plain sums in long double, and the same bits for every instruction set.
// SPDX-License-Identifier: GPL-3.0-or-later
#include "sample_kernels.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <type_traits>
#include <vector>

#include <gtest/gtest.h>

#include "analytic_surfaces.h"
#include "block_size.h"
#include "local_polynomial.h"
#include "local_surface.h"
#include "neighborhoods.h"
#include "sample_kernels_simd.h"
#include "simd_block.h"

namespace curvature_lines {
namespace {

using samples::Random;

template<class T>
bool sameBits(const T& a, const T& b)
{
	static_assert(std::is_trivially_copyable_v<T>);
	const auto* p = reinterpret_cast<const unsigned char*>(&a);
	return std::equal(p, p + sizeof(T), reinterpret_cast<const unsigned char*>(&b));
}

template<int Values>
LocalSamples<Values> randomSamples(int count, int seed)
{
	Random               random(seed, 0);
	LocalSamples<Values> result;
	result.reserve(count);
	for (int s = 0; s < count; ++s) {
		Eigen::Matrix<double, Values, 1> value;
		for (int c = 0; c < Values; ++c)
			value[c] = random.normal();
		const double x = random.uniform(-0.7, 0.7), y = random.uniform(-0.7, 0.7);
		result.add(x, y, s % 5 == 2 ? 0.0 : random.uniform(0.1, 1.0), value);
	}
	result.pad();
	return result;
}

// Moments of which nothing is unset, so that they compare as bytes.
template<class Arch, int Degree, int Values>
std::vector<double> listOf(LocalSamples<Values>& samples, bool chosen)
{
	const Moments<Degree, Values> m =
		chosen ? momentsOf<Degree, Values>(samples.columns())
			   : simd::momentsOf<Arch, Degree, Values>(samples.columns());
	std::vector<double> list{m.squares};
	for (int a = 0; a <= 2 * Degree; ++a)
		for (int b = 0; a + b <= 2 * Degree; ++b)
			list.push_back(m.weighted[a][b]);
	for (int a = 0; a <= Degree; ++a)
		for (int b = 0; a + b <= Degree; ++b)
			for (int c = 0; c < Values; ++c)
				list.push_back(m.products[a][b][c]);
	return list;
}

template<int Degree, int Values>
void expectMoments(int count)
{
	LocalSamples<Values> samples = randomSamples<Values>(count, 10 * Degree + Values);
	std::vector<double>  expected;
	const auto           sum = [&](auto term) {
        long double total = 0.0L;
        for (int s = 0; s < count; ++s)
            total += static_cast<long double>(samples.weight[s]) * term(s);
        expected.push_back(static_cast<double>(total));
	};
	const auto power = [&](int s, int a, int b) {
		return std::pow(static_cast<long double>(samples.x[s]), a) *
		       std::pow(static_cast<long double>(samples.y[s]), b);
	};
	sum([&](int s) {
		long double squares = 0.0L;
		for (int c = 0; c < Values; ++c)
			squares += static_cast<long double>(samples.value[c][s]) * samples.value[c][s];
		return squares;
	});
	for (int a = 0; a <= 2 * Degree; ++a)
		for (int b = 0; a + b <= 2 * Degree; ++b)
			sum([&](int s) { return power(s, a, b); });
	for (int a = 0; a <= Degree; ++a)
		for (int b = 0; a + b <= Degree; ++b)
			for (int c = 0; c < Values; ++c)
				sum([&](int s) { return power(s, a, b) * samples.value[c][s]; });
	const std::vector<double> found = listOf<BaselineArch, Degree, Values>(samples, true);
	ASSERT_EQ(found.size(), expected.size());
	for (std::size_t k = 0; k < found.size(); ++k)
		EXPECT_NEAR(found[k], expected[k], 1e-14 * (count + 1)) << k << " of " << count;
	EXPECT_EQ(found, (listOf<BaselineArch, Degree, Values>(samples, false)));
}

TEST(SampleKernels, MomentsArePlainSumsAndTheSameOnEveryProcessor)
{
	for (const int count : {0, 1, 3, 4, 5, 17, 256}) {
		expectMoments<1, 1>(count);
		expectMoments<2, 1>(count);
		expectMoments<4, 1>(count);
		expectMoments<1, 3>(count);
		expectMoments<2, 3>(count);
		expectMoments<3, 3>(count);
		expectMoments<2, 10>(count);
	}
}

TEST(SampleKernels, DistancesAreThoseFromThePolynomial)
{
	LocalSamples<3>             samples = randomSamples<3>(42, 1);
	Random                      random(2, 0);
	PolynomialFit<2, 3>         polynomial;
	Eigen::Matrix<double, 6, 3> c;
	for (int k = 0; k < c.size(); ++k)
		c(k) = random.normal();
	polynomial.coefficients = c;
	std::vector<double> found(44), other(44);
	const double        largest = distancesFrom<2, 3>(c.data(), samples.columns(), found.data());
	double              most    = 0.0;
	for (int s = 0; s < 42; ++s) {
		const Eigen::Vector3d value(samples.value[0][s], samples.value[1][s], samples.value[2][s]);
		const double          distance = (value - polynomial(samples.x[s], samples.y[s])).norm();
		EXPECT_NEAR(found[s], samples.weight[s] > 0.0 ? distance : 0.0, 1e-14) << s;
		most = std::max(most, found[s]);
	}
	EXPECT_EQ(largest, most);
	const double squared =
		simd::distancesFrom<BaselineArch, 2, 3>(c.data(), samples.columns(), other.data());
	EXPECT_EQ(std::sqrt(squared), largest);
	for (int s = 0; s < 42; ++s)
		EXPECT_EQ(std::sqrt(other[s]), found[s]);
}

// A ball of points with normals, some of which oppose, padded with points outside.
struct Ball {
	int                 size;
	std::vector<double> position[3], normal[3], robust;

	explicit Ball(int count) : size(count), robust(count + blockSize, 0.5)
	{
		Random random(count, 0);
		for (int c = 0; c < 3; ++c) {
			position[c].assign(count + blockSize, 2.0);
			normal[c].assign(count + blockSize, 0.0);
			for (int k = 0; k < count; ++k) {
				position[c][k] = random.uniform(-0.7, 0.7);
				normal[c][k]   = random.normal();
			}
		}
	}
	OrientedColumns columns() const
	{
		return {
			{position[0].data(), position[1].data(), position[2].data()},
			{normal[0].data(), normal[1].data(), normal[2].data()},
			size};
	}
	Eigen::Vector3d p(int k) const { return {position[0][k], position[1][k], position[2][k]}; }
	Eigen::Vector3d n(int k) const { return {normal[0][k], normal[1][k], normal[2][k]}; }
};

FrameColumns columnsOfFrame(const TangentFrame& frame, const Eigen::Vector3d& origin)
{
	FrameColumns result;
	for (int c = 0; c < 3; ++c) {
		result.origin[c] = origin[c];
		result.u[c]      = frame.u[c];
		result.v[c]      = frame.v[c];
		result.n[c]      = frame.n[c];
	}
	return result;
}

TEST(SampleKernels, PlaneMomentsCountThePointsThatDoNotOppose)
{
	const Ball            ball(61);
	const Eigen::Vector3d side   = Eigen::Vector3d(0.2, -0.5, 0.8).normalized();
	const PlaneMoments    m      = planeMomentsOf(ball.columns(), side.data());
	double                weight = 0.0;
	Eigen::Vector3d       offset = Eigen::Vector3d::Zero(), normal = offset;
	Eigen::Matrix3d       square = Eigen::Matrix3d::Zero();
	for (int k = 0; k < ball.size; ++k) {
		if (ball.n(k).dot(side) < 0.0)
			continue;
		const double w = ballKernel(ball.p(k).squaredNorm());
		weight += w;
		offset += w * ball.p(k);
		normal += w * ball.n(k);
		square += w * ball.p(k) * ball.p(k).transpose();
	}
	EXPECT_GT(weight, 1.0);
	EXPECT_NEAR(m.weight, weight, 1e-13);
	for (int r = 0, entry = 0; r < 3; ++r) {
		EXPECT_NEAR(m.offset[r], offset[r], 1e-13);
		EXPECT_NEAR(m.normal[r], normal[r], 1e-13);
		for (int c = 0; c <= r; ++c, ++entry)
			EXPECT_NEAR(m.square[entry], square(r, c), 1e-13);
	}
	EXPECT_TRUE(sameBits(m, simd::planeMomentsOf<BaselineArch>(ball.columns(), side.data())));
}

TEST(SampleKernels, HeightsAndNormalsAreCoordinatesInTheFrame)
{
	const Ball            ball(38);
	const TangentFrame    frame(Eigen::Vector3d(0.3, 0.4, 0.6).normalized());
	const Eigen::Vector3d origin(0.1, -0.05, 0.02);
	LocalSamples<1>       heights;
	LocalSamples<3>       normals;
	heights.resize(ball.size);
	normals.resize(ball.size);
	const int used = toHeights(
		ball.columns(), columnsOfFrame(frame, origin), ball.robust.data(), heights.columns());
	const int usedNormals = toNormals(
		ball.columns(), columnsOfFrame(frame, Eigen::Vector3d::Zero()), normals.columns());
	int expected = 0, expectedNormals = 0;
	for (int k = 0; k < ball.size; ++k) {
		const Eigen::Vector3d d       = ball.p(k) - origin;
		const bool            opposes = ball.n(k).dot(frame.n) < 0.0;
		const double          w       = opposes ? 0.0 : 0.5 * ballKernel(d.squaredNorm());
		EXPECT_NEAR(heights.weight[k], w, 1e-15);
		EXPECT_NEAR(heights.x[k], d.dot(frame.u), 1e-15);
		EXPECT_NEAR(heights.y[k], d.dot(frame.v), 1e-15);
		EXPECT_NEAR(heights.value[0][k], d.dot(frame.n), 1e-15);
		expected += w > 0.0;
		const double wn = opposes ? 0.0 : ballKernel(ball.p(k).squaredNorm());
		EXPECT_NEAR(normals.weight[k], wn, 1e-15);
		EXPECT_NEAR(normals.x[k], ball.p(k).dot(frame.u), 1e-15);
		EXPECT_NEAR(normals.y[k], ball.p(k).dot(frame.v), 1e-15);
		EXPECT_NEAR(normals.value[0][k], ball.n(k).dot(frame.u), 1e-14);
		EXPECT_NEAR(normals.value[1][k], ball.n(k).dot(frame.v), 1e-14);
		EXPECT_NEAR(normals.value[2][k], ball.n(k).dot(frame.n), 1e-14);
		expectedNormals += wn > 0.0;
	}
	EXPECT_EQ(used, expected);
	EXPECT_EQ(usedNormals, expectedNormals);
	EXPECT_LT(used, ball.size);
}

TEST(SampleKernels, GaussianWeightsAreThoseOfTheExponentialFunction)
{
	const int           size = 60; // whole blocks
	std::vector<double> x(size), y(size), z(size), squared(size), factor(size), weight(size),
		other(size);
	Random random(3, 0);
	for (int k = 0; k < size; ++k) {
		x[k]      = random.uniform(-1.0, 1.0);
		y[k]      = random.uniform(-1.0, 1.0);
		z[k]      = random.uniform(-1.0, 1.0);
		factor[k] = random.uniform();
	}
	const double* const position[3] = {x.data(), y.data(), z.data()};
	const double        center[3]   = {0.2, 0.1, -0.3};
	squaredDistances(position, center, size, squared.data());
	double least = squared[0];
	for (int k = 0; k < size; ++k) {
		const Eigen::Vector3d d(x[k] - center[0], y[k] - center[1], z[k] - center[2]);
		EXPECT_NEAR(squared[k], d.squaredNorm(), 1e-15);
		least = std::min(least, squared[k]);
	}
	gaussianWeights(squared.data(), factor.data(), least, 12.0, size, weight.data());
	int cut = 0;
	for (int k = 0; k < size; ++k) {
		const double t = 12.0 * (squared[k] - least);
		EXPECT_NEAR(weight[k], t < 16.0 ? factor[k] * std::exp(-t) : 0.0, 1e-9);
		cut += t >= 16.0;
	}
	EXPECT_GT(cut, 0);
	simd::gaussianWeights<BaselineArch>(
		squared.data(), factor.data(), least, 12.0, size, other.data());
	EXPECT_EQ(weight, other);
}

} // namespace
} // namespace curvature_lines
