// Both principal curvatures as one colour (Rusinkiewicz 2004; A09 figs. 2, 3).
// SPDX-License-Identifier: GPL-3.0-or-later
#include "curvature_colors.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include <Eigen/Core>

namespace curvature_lines {

namespace {

constexpr double pi            = 3.14159265358979323846;
constexpr double scaleQuantile = 0.1;  // of |k|: the gentlest bends still show some colour
constexpr double scaleFactor   = 0.01; // over that quantile
constexpr double scaleCap      = 0.05; // of the model radius, for shapes that are mostly flat
constexpr double contrast      = 10.0;

// Length that makes k * scale dimensionless.
double featureScale(const Eigen::VectorXd& k1, const Eigen::VectorXd& k2, double modelRadius)
{
	std::vector<double> sizes;
	sizes.reserve(2 * k1.size());
	for (Eigen::Index i = 0; i < k1.size(); ++i) {
		sizes.push_back(std::abs(k1[i]));
		sizes.push_back(std::abs(k2[i]));
	}
	const auto quantile = sizes.begin() + static_cast<long>(scaleQuantile * (sizes.size() - 1));
	std::nth_element(sizes.begin(), quantile, sizes.end());
	const double cap = scaleCap * modelRadius;
	return *quantile * cap > scaleFactor ? scaleFactor / *quantile : cap;
}

// Full-value colour; hue in [0, 2 pi).
Eigen::Vector3d fromHue(double hue, double saturation)
{
	Eigen::Vector3d color;
	for (int channel = 0; channel < 3; ++channel) {
		const double sextant  = std::fmod(hue * 3.0 / pi + 6.0 - 2.0 * channel + 2.0, 6.0);
		const double strength = std::clamp(2.0 - std::abs(sextant - 2.0), 0.0, 1.0);
		color[channel]        = 1.0 - saturation * (1.0 - strength);
	}
	return color;
}

} // namespace

Eigen::Matrix3Xd
curvatureColors(const Eigen::VectorXd& k1, const Eigen::VectorXd& k2, double modelRadius)
{
	Eigen::Matrix3Xd colors(3, k1.size());
	if (k1.size() == 0)
		return colors;
	const double gain = std::pow(contrast * featureScale(k1, k2, modelRadius), 2);
	for (Eigen::Index i = 0; i < k1.size(); ++i) {
		const double mean = 0.5 * (k1[i] + k2[i]), gaussian = k1[i] * k2[i];
		const double square = mean * mean;
		const double hue =
			4.0 / 3.0 * std::abs(std::atan2(square - gaussian, mean < 0.0 ? -square : square));
		const double saturation = 2.0 / pi * std::atan((2.0 * square - gaussian) * gain);
		colors.col(i)           = fromHue(hue, saturation);
	}
	return colors;
}

} // namespace curvature_lines
