// Thickness over width of neighbourhoods of growing size, and what most of a point's neighbours say.
// SPDX-License-Identifier: GPL-3.0-or-later
#include "unstructured_points.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numeric>
#include <utility>
#include <vector>

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>

#include "cloud_index.h"
#include "neighborhoods.h"
#include "point_cloud.h"
#include "progress.h"
#include "quantile.h"

namespace curvature_lines {

namespace {

using Eigen::Matrix3Xd;
using Eigen::Vector3d;

// Points of the neighbourhoods. The largest a cloud has are a sixth of it.
constexpr std::array<Index, 6> sizes     = {16, 40, 100, 250, 600, 1500};
constexpr Index                fewest    = 14; // of them on one side: a quadric has 6 unknowns
constexpr Index                partOfAll = 6;
// Deviation of the points from a quadric over the radius of the disk they would fill. By experiment: .25 to .5 for random
// points of a volume; at most .2 at the edges of exact shapes; .2 to .27 with noise of two spacings, from 600 points on.
constexpr double thick = 0.27;
// In two neighbouring sizes, the smallest ones at which two fifths of the cloud are below usualSurface, where it is so many times
// thinner: the blades of grass on a flat ground. Wider neighbourhoods of grass are mostly ground.
constexpr double      thickBesideThin = 0.15;
constexpr double      timesThicker    = 3.0;
constexpr double      usualSurface    = 0.08;
constexpr std::size_t sizesBesideThin = 2;
constexpr Index       places          = 200; // whose share is told
constexpr Index       judges          = 120; // of them, that tell what is usual
constexpr double      quietShare      = 0.4; // of the judges: a third of a cloud may be grass
constexpr Index       neighbors       = 24;
constexpr int         passes          = 3;
constexpr int         rounds          = 3;
constexpr double      most            = 0.6; // of the neighbours

// From the quadric of least squares over the points' own plane, tilted once.
double thickness(const Matrix3Xd& points)
{
	const auto n = points.cols();
	if (n < fewest)
		return std::numeric_limits<double>::infinity();
	const Vector3d                                 mean     = points.rowwise().mean();
	const Matrix3Xd                                centered = points.colwise() - mean;
	Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> axes;
	axes.computeDirect(centered * centered.transpose() / double(n));
	Eigen::Matrix3d frame; // rows: u, v, n
	frame << axes.eigenvectors().col(2).transpose(), axes.eigenvectors().col(1).transpose(),
		axes.eigenvectors().col(0).transpose();
	// Points of a disk have this deviation along any line in it; a strip is as wide as its shorter side.
	const double radius = 2.0 * std::sqrt(std::max(axes.eigenvalues()[1], 0.0));
	const double scale  = 2.0 * std::sqrt(std::max(axes.eigenvalues()[2], 0.0));
	if (!(radius > 1e-6 * scale) || !(scale > 0.0))
		return std::numeric_limits<double>::infinity();
	double least = std::numeric_limits<double>::infinity();
	for (int tilt = 0; tilt < 2; ++tilt) {
		const Matrix3Xd             local = frame * centered / scale;
		Eigen::Matrix<double, 6, 6> moments;
		Eigen::Matrix<double, 6, 1> right, term;
		moments.setZero();
		right.setZero();
		const auto monomials = [&](Eigen::Index k) {
			const double x = local(0, k), y = local(1, k);
			term << 1.0, x, y, x * x, x * y, y * y;
		};
		for (Eigen::Index k = 0; k < n; ++k) {
			monomials(k);
			moments += term * term.transpose();
			right += local(2, k) * term;
		}
		const Eigen::Matrix<double, 6, 1> fit = moments.ldlt().solve(right);
		double                            sum = 0.0;
		for (Eigen::Index k = 0; k < n; ++k) {
			monomials(k);
			const double rest = local(2, k) - fit.dot(term);
			sum += rest * rest;
		}
		least                 = std::min(least, std::sqrt(sum / double(n - 6)) * scale / radius);
		const Vector3d normal = frame.transpose() * Vector3d(-fit[1], -fit[2], 1.0).normalized();
		const TangentFrame tilted(normal);
		frame << tilted.u.transpose(), tilted.v.transpose(), tilted.n.transpose();
	}
	return least;
}

class Neighborhoods {
public:
	explicit Neighborhoods(const CloudIndex& index) : m_index(index), m_cloud(index.cloud()) {}
	// What is usual for the points of the sample.
	void measure(const std::vector<Index>& sample)
	{
		if (sample.empty())
			return;
		std::vector<double> thickness(sample.size());
		for (std::size_t s = 0; s < sizes.size(); ++s) {
			parallelFor(static_cast<Index>(sample.size()), {}, [&](Index k) {
				thickness[k] = thicknessAt(sample[k], sizes[s]);
			});
			m_usual[s] = quantileInPlace(thickness, quietShare);
			if (m_usual[s] < usualSurface) {
				m_first = s;
				for (++s; s < std::min(m_first + sizesBesideThin, sizes.size()); ++s) {
					parallelFor(static_cast<Index>(sample.size()), {}, [&](Index k) {
						thickness[k] = thicknessAt(sample[k], sizes[s]);
					});
					m_usual[s] = quantileInPlace(thickness, quietShare);
				}
				return;
			}
		}
	}
	void adopt(const Neighborhoods& other)
	{
		m_usual = other.m_usual;
		m_first = other.m_first;
	}

	// Of the k nearest points that are of the point's sheet; infinite where the cloud is too small for k.
	double thicknessAt(Index i, Index k) const
	{
		if (k * partOfAll > m_cloud.size())
			return std::numeric_limits<double>::infinity();
		std::vector<Index> sheet;
		for (const Index j : m_index.search().nearest(m_cloud.positions.col(i), k))
			if (m_cloud.normals.cols() == 0 ||
			    m_cloud.normals.col(i).dot(m_cloud.normals.col(j)) > 0.0)
				sheet.push_back(j);
		return thickness(columnsOf(m_cloud.positions, sheet));
	}
	bool unstructured(Index i) const
	{
		std::array<double, sizes.size()> found;
		found.fill(-1.0);
		const auto at = [&](std::size_t s) {
			if (found[s] < 0.0)
				found[s] = thicknessAt(i, sizes[s]);
			return found[s];
		};
		const auto all = [&](std::size_t begin, std::size_t end, const auto& limit) {
			bool any = false;
			for (std::size_t s = begin; s < end; ++s) {
				if (std::isinf(at(s)))
					continue;
				if (at(s) <= limit(s))
					return false;
				any = true;
			}
			return any;
		};
		const auto beside = [&](std::size_t s) {
			return std::max(thickBesideThin, timesThicker * m_usual[s]);
		};
		return all(m_first, std::min(m_first + sizesBesideThin, sizes.size()), beside) ||
		       all(0, sizes.size(), [](std::size_t) { return thick; });
	}

private:
	const CloudIndex&                m_index;
	const PointCloud&                m_cloud;
	std::array<double, sizes.size()> m_usual{};
	std::size_t m_first = sizes.size(); // size at which most of it is a surface
};

std::vector<Index> sampleOf(const CloudIndex& index, Index most)
{
	const Index count = std::min(most, index.size());
	return {index.shuffled().begin(), index.shuffled().begin() + count};
}

std::vector<char>
findOnce(const CloudIndex& index, const Neighborhoods& at, const Progress& progress)
{
	std::vector<char> flagged(index.size());
	parallelForPoints(index.search(), progress, [&](Index i) { flagged[i] = at.unstructured(i); });
	for (int pass = 0; pass < passes; ++pass) {
		const std::vector<char> before = flagged;
		parallelForPoints(index.search(), {}, [&](Index i) {
			const std::vector<Index> near =
				index.search().nearest(index.cloud().positions.col(i), neighbors);
			const auto count =
				std::count_if(near.begin(), near.end(), [&](Index j) { return before[j] != 0; });
			flagged[i] = double(count) > most * double(near.size());
		});
	}
	return flagged;
}

} // namespace

// Blades that stand a little apart from the others are only seen when these are gone.
std::vector<char> findUnstructured(const CloudIndex& index, const Progress& progress)
{
	Neighborhoods whole(index);
	whole.measure(sampleOf(index, judges));
	std::vector<char>  flagged(index.size(), 0);
	CloudIndex         rest = index;
	std::vector<Index> kept(index.size());
	std::iota(kept.begin(), kept.end(), 0);
	for (int round = 0; round < rounds; ++round) {
		Neighborhoods at(rest);
		at.adopt(whole);
		const std::vector<char> more = findOnce(
			rest,
			at,
			progress.sub(
				double(round) / rounds, double(round + 1) / rounds, "Finding hair and grass"));
		std::vector<Index> left, which;
		for (Index k = 0; k < rest.size(); ++k) {
			flagged[kept[k]] = more[k];
			if (!more[k]) {
				left.push_back(kept[k]);
				which.push_back(k);
			}
		}
		if (left.size() == kept.size() || left.empty())
			break;
		kept = std::move(left);
		rest = rest.part(which);
	}
	progress.report(1.0);
	return flagged;
}

double unstructuredShare(
	const CloudIndex& index, const std::vector<char>& rejected, const Progress& progress)
{
	if (index.size() == 0)
		return 0.0;
	Neighborhoods at(index);
	at.measure(sampleOf(index, judges));
	const std::vector<Index> sample = sampleOf(index, places);
	std::vector<char>        flagged(sample.size(), 0);
	parallelFor(static_cast<Index>(sample.size()), progress, [&](Index k) {
		if (rejected.empty() || !rejected[sample[k]])
			flagged[k] = at.unstructured(sample[k]);
	});
	return double(std::count(flagged.begin(), flagged.end(), char(1))) / double(flagged.size());
}

} // namespace curvature_lines
