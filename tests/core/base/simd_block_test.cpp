// Blocks of values: each operation is that of the four values, and the sum has one order.
// SPDX-License-Identifier: GPL-3.0-or-later
#include "simd_block.h"

#include <cmath>

#include <gtest/gtest.h>

#include "block_size.h"

namespace curvature_lines {
namespace {

using B = Block<BaselineArch>;

struct Values {
	double v[blockSize];

	explicit Values(const B& b) { b.storeTo(v); }
};

TEST(SimdBlock, ComputesValueByValue)
{
	// One more in front: memory is aligned for double only.
	const double a[1 + blockSize] = {0.0, 1.5, -2.0, 1e300, 0.1};
	const double b[1 + blockSize] = {0.0, 3.0, 7.0, 1e-300, 0.3};
	const B      x = B::at(a + 1), y = B::at(b + 1);
	const Values sum(x + y), difference(x - y), product(x * y), ratio(x / y);
	const Values chosen(ifLess(x, y, x, B(5.0))), broadcast(2.0 * x);
	B            changed = x;
	changed += y;
	changed -= 1.0;
	changed *= y;
	const Values inPlace(changed);
	for (int k = 0; k < blockSize; ++k) {
		const double p = a[1 + k], q = b[1 + k];
		EXPECT_EQ(sum.v[k], p + q);
		EXPECT_EQ(difference.v[k], p - q);
		EXPECT_EQ(product.v[k], p * q);
		EXPECT_EQ(ratio.v[k], p / q);
		EXPECT_EQ(chosen.v[k], p < q ? p : 5.0);
		EXPECT_EQ(broadcast.v[k], 2.0 * p);
		EXPECT_EQ(inPlace.v[k], ((p + q) - 1.0) * q);
		EXPECT_EQ(Values(B()).v[k], 0.0);
	}
}

// The order shows in what is lost: 1 beside 1e16 vanishes unless it is added to another 1 first.
TEST(SimdBlock, AddsInOneOrder)
{
	const double v[blockSize] = {1e16, 1.0, -1e16, 1.0};
	EXPECT_EQ(sumOf(B::at(v)), 2.0);
	const double w[blockSize] = {1e16, -1e16, 1.0, 1.0};
	EXPECT_EQ(sumOf(B::at(w)), (1e16 + 1.0) + (-1e16 + 1.0));
}

TEST(SimdBlock, ExponentialFunctionIsGoodForGaussianWeights)
{
	for (double x = 0.0; x < 20.0; x += 0.0137) {
		const Values found(expOfNegative(B(x)));
		const double error = x <= 5.0 ? 1e-9 : 1e-5;
		for (const double v : found.v)
			EXPECT_NEAR(v, x < 16.0 ? std::exp(-x) : 0.0, error * std::exp(-x)) << x;
	}
}

} // namespace
} // namespace curvature_lines
