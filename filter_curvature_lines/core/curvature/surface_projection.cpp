// Mixed Hermite, locally optimal (Lipman et al. 2007) and weighted-average projection, and interpolation of
// the curvature tensor (A09 section 5.1 steps 1-3; R07 section 5 steps 1-5).
// SPDX-License-Identifier: GPL-3.0-or-later
#include "surface_projection.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <vector>

#include <Eigen/Geometry>
#include <Eigen/LU>

#include "block_size.h"
#include "cloud_index.h"
#include "curvature_field.h"
#include "neighborhoods.h"
#include "point_cloud.h"
#include "quantile.h"
#include "sample_kernels.h"

namespace curvature_lines {

namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

// docs/method.md, "Projection onto the surface"; values without another reason by experiment (benchmarks/lines.py,
// "Projections").
// Points whose normals agree with a place's (dot product) are of its side of the surface; looked for among so many.
constexpr double sameSide       = 0.2;
constexpr Index  sideCandidates = 16;
// The second pass changes what the first leaves by second-order terms only.
constexpr int mixedPasses   = 2;
constexpr int optimalPasses = 5; // A09 section 5.1: "4-5 iterations"
// Radius of the support over the width of the kernel exp(-r^2): at the border the weight has fallen to .2 %.
constexpr double kernelRatio = 2.5;
// LOP: theta(r) = exp(-r^2 / (h/4)^2); plain averages shrink as much
constexpr double averageRatio   = 4.0;
constexpr double minRadiusRatio = 1e-6; // guards LOP's 1/r
// Tangent of the largest angle, 27 degrees, by which curvature may correct a normal.
constexpr double maxNormalTurn = 0.5;
// Weight of the directions over that of the tensors, in principalDirection(): decides only where the tensors cancel.
constexpr double flatShare = 1e-3;
// Added to the second moments in tensorAt(), as a share of the total weight: points on a line have no slope across.
constexpr double slopeRidge = 0.01;
// Heights over the fitted surfaces are noise up to mostNoise times their quantile noisyShare. The quantile is that high
// so that noise in a tenth of the cloud still counts; of a normal distribution both together are 2.5 x 1.645 = 4.1
// standard deviations.
constexpr double noisyShare = 0.9;
constexpr double mostNoise  = 2.5;
// Kernel widths from a place to the mean of the points around, over which the tensors are extrapolated.
constexpr double maxBeside = 1.0;

// Of the support at hand, one at a time in each thread.
struct SupportScratch {
	std::vector<Index>  points;
	std::vector<double> statistical, kernel, squaredDistance;
	std::vector<double> position[3];

	static SupportScratch& ofThisThread()
	{
		thread_local SupportScratch scratch;
		return scratch;
	}
	void clear()
	{
		points.clear();
		for (auto* array : {&statistical, &position[0], &position[1], &position[2]})
			array->clear();
	}
	void add(const PointCloud& cloud, Index j, double weight)
	{
		points.push_back(j);
		statistical.push_back(weight);
		for (int c = 0; c < 3; ++c)
			position[c].push_back(cloud.positions(c, j));
	}
	// Whole blocks, with points of weight 0.
	void pad()
	{
		const std::size_t padded = (points.size() + blockSize - 1) / blockSize * blockSize;
		for (auto* array : {&statistical, &position[0], &position[1], &position[2]})
			array->resize(padded, 0.0);
		kernel.resize(padded);
		squaredDistance.resize(padded);
	}
	void measureFrom(const Vector3d& center)
	{
		const double* const columns[3] = {
			position[0].data(), position[1].data(), position[2].data()};
		squaredDistances(
			columns,
			center.data(),
			static_cast<int>(squaredDistance.size()),
			squaredDistance.data());
	}
};

// The points with positive statistical weight at `closest`, and itself.
class Support {
public:
	Support(const PointCloud& cloud, const CurvatureField& field, Index closest) :
			m_cloud(cloud), m_heights(field.height), m_scratch(SupportScratch::ofThisThread())
	{
		const NeighborLists::Row row = field.weights.neighbors[closest];
		const double* const      weights =
			field.weights.values.data() + field.weights.neighbors.offsets[closest];
		const Vector3d normal = cloud.normals.col(closest);
		m_scratch.clear();
		m_scratch.add(cloud, closest, 1.0);
		for (Index k = 0; k < row.size(); ++k)
			if (row[k] != closest && cloud.normals.col(row[k]).dot(normal) > 0.0)
				m_scratch.add(cloud, row[k], weights[k]);
		m_scratch.pad();
		const Vector3d site = cloud.positions.col(closest);
		m_scratch.measureFrom(site);
		double weight = 0.0, moment = 0.0;
		for (std::size_t k = 0; k < m_scratch.points.size(); ++k) {
			weight += m_scratch.statistical[k];
			moment += m_scratch.statistical[k] * m_scratch.squaredDistance[k];
		}
		// Of the uniform disk with this second moment. Unlike the largest distance it hardly jumps
		// from one cell to the next, and with it what is interpolated.
		m_radius = std::sqrt(2.0 * moment / weight);
	}

	double radius() const { return m_radius; }

	// Of the surface that was fitted around p_j, or p_j where none was.
	Vector3d surfacePoint(Index j) const
	{
		if (m_heights.size() == 0)
			return m_cloud.positions.col(j);
		return m_cloud.positions.col(j) + m_heights[j] * m_cloud.normals.col(j);
	}

	// Weights statistical x Gaussian of the distance to `center`. The Gaussian is relative to that of the
	// closest point, so far from the cloud it does not become 0 everywhere.
	void weigh(const Vector3d& center, double ratio)
	{
		const double sharpness = m_radius > 1e-100 ? ratio * ratio / (m_radius * m_radius) : 0.0;
		m_scratch.measureFrom(center);
		const auto   first     = m_scratch.squaredDistance.begin();
		const double reference = *std::min_element(first, first + m_scratch.points.size());
		gaussianWeights(
			m_scratch.squaredDistance.data(),
			m_scratch.statistical.data(),
			reference,
			sharpness,
			static_cast<int>(m_scratch.kernel.size()),
			m_scratch.kernel.data());
	}

	// visit(j, weight, squared distance to the centre of the weights)
	template<class Visit>
	void forEach(const Visit& visit) const
	{
		for (std::size_t k = 0; k < m_scratch.points.size(); ++k)
			visit(m_scratch.points[k], m_scratch.kernel[k], m_scratch.squaredDistance[k]);
	}

private:
	const PointCloud&      m_cloud;
	const Eigen::VectorXd& m_heights;
	SupportScratch&        m_scratch;
	double                 m_radius = 0.0;
};

// Weighted means over the support, seen from c.
struct Means {
	double   weight = 0.0;
	Vector3d normal = Vector3d::Zero(); // unit
	Vector3d offset = Vector3d::Zero(); // of c from the mean point
	// mean height of c above the points' own tangent planes
	double planeHeights = 0.0;

	double averageHeight() const { return normal.dot(offset); }
};

enum class Norm { Squares, Absolute };
enum class Data { Points, FittedSurface };

Means meansAt(
	const PointCloud& cloud,
	Support&          support,
	const Vector3d&   c,
	double            ratio,
	Data              data = Data::Points,
	Norm              norm = Norm::Squares)
{
	Means        means;
	const double floor =
		std::max(minRadiusRatio * support.radius(), std::numeric_limits<double>::min());
	support.weigh(c, ratio);
	support.forEach([&](Index j, double w, double d2) {
		if (norm == Norm::Absolute)
			w /= std::max(std::sqrt(d2), floor);
		const Vector3d p =
			data == Data::Points ? Vector3d(cloud.positions.col(j)) : support.surfacePoint(j);
		const Vector3d d = c - p;
		means.weight += w;
		means.normal += w * cloud.normals.col(j);
		means.offset += w * d;
		means.planeHeights += w * cloud.normals.col(j).dot(d);
	});
	means.normal.normalize(); // never 0: all normals lie in one open half space
	means.offset /= means.weight;
	means.planeHeights /= means.weight;
	return means;
}

// On a curved surface the average of the points lies k s^2 / 2 inside and that of their tangent
// planes as far outside: projecting along half of each normal, n_j, and half of the mean one
// cancels the two. What is averaged are not the points but the surfaces fitted around them, at the scale the
// noise asks for: the published projections leave a quarter of the noise, this a tenth.
Vector3d projectMixed(const PointCloud& cloud, Support& support, Vector3d c)
{
	for (int pass = 0; pass < mixedPasses; ++pass) {
		const Means means = meansAt(cloud, support, c, kernelRatio, Data::FittedSurface);
		c -= 0.5 * (means.planeHeights + means.averageHeight()) * means.normal;
	}
	return c;
}

// x <- sum_j p_j theta(r_j)/r_j / sum_j theta(r_j)/r_j, from the theta-weighted mean. Only the
// component along the normal is applied: the rest slides the point towards the data by up to a
// spacing.
Vector3d projectLocallyOptimal(const PointCloud& cloud, Support& support, Vector3d c)
{
	for (int pass = 0; pass <= optimalPasses; ++pass) {
		const Norm  norm  = pass == 0 ? Norm::Squares : Norm::Absolute;
		const Means means = meansAt(cloud, support, c, averageRatio, Data::Points, norm);
		c -= means.averageHeight() * means.normal;
	}
	return c;
}

Vector3d projectToAverage(const PointCloud& cloud, Support& support, const Vector3d& c)
{
	const Means means = meansAt(cloud, support, c, averageRatio);
	return c - means.averageHeight() * means.normal;
}

bool hasCurvature(PointStatus status)
{
	return status != PointStatus::TooFewNeighbors && status != PointStatus::Invalid;
}

// The mean of the normals belongs to the mean of the points, which is beside c by a share of the
// spacing. So each point gives the normal that its own curvature predicts at c: n_j + dN_j (c -
// p_j). The support is weighted about c, here and in tensorAt().
Vector3d normalAt(
	const PointCloud& cloud, const CurvatureField& field, const Support& support, const Vector3d& c)
{
	Vector3d mean = Vector3d::Zero(), turn = Vector3d::Zero();
	support.forEach([&](Index j, double w, double) {
		mean += w * cloud.normals.col(j);
		if (!hasCurvature(field.status[j]))
			return;
		const Vector3d d = c - cloud.positions.col(j);
		turn += (w * field.k1[j] * field.d1.col(j).dot(d)) * field.d1.col(j);
		turn += (w * field.k2[j] * field.d2.col(j).dot(d)) * field.d2.col(j);
	});
	turn *= std::min(1.0, maxNormalTurn * mean.norm() / std::max(turn.norm(), 1e-300));
	return (mean + turn).normalized();
}

// exp(2 i angle) of a direction tangent at m, after the smallest rotation that takes m to frame.n.
// Projecting it instead would shorten it, and with it the curvature, by the square of the cosine.
Vector2d doubledAngle(const TangentFrame& frame, const Vector3d& m, const Vector3d& direction)
{
	const double   cosine  = std::max(frame.n.dot(m), -0.999);
	const Vector3d rotated = direction - frame.n.dot(direction) / (1.0 + cosine) * (m + frame.n);
	const Vector2d d       = frame.toPlane(rotated);
	return {d.x() * d.x() - d.y() * d.y(), 2.0 * d.x() * d.y()};
}

// k1 e1 e1^T + k2 e2 e2^T in the tangent plane at c: the isotropic part, and the deviator as a vector of
// twice the angle, of length k1 - k2.
struct TensorAt {
	double   mean = 0.0, magnitude = 0.0;
	Vector2d deviator = Vector2d::Zero(), line = Vector2d::Zero();
	Vector2d beside = Vector2d::Zero(); // mean of the points, in kernel widths
};

// A plane through the values, read at c. Their weighted mean would belong to the mean of the points, which
// is beside c by a share of the spacing: the lines of an exact field were a quarter of a degree off.
TensorAt tensorAt(
	const PointCloud&     cloud,
	const CurvatureField& field,
	const Support&        support,
	const Vector3d&       c,
	const TangentFrame&   frame)
{
	using Values                        = Eigen::Matrix<double, 1, 6>;
	Eigen::Matrix3d             moments = Eigen::Matrix3d::Zero();
	Eigen::Matrix<double, 3, 6> sums    = Eigen::Matrix<double, 3, 6>::Zero();
	const double scale = support.radius() > 1e-100 ? kernelRatio / support.radius() : 0.0;
	support.forEach([&](Index j, double w, double) {
		if (!hasCurvature(field.status[j]))
			return;
		const Vector2d line       = doubledAngle(frame, cloud.normals.col(j), field.d1.col(j));
		const double   difference = field.k1[j] - field.k2[j];
		const Vector2d at         = scale * frame.toPlane(cloud.positions.col(j) - c);
		const Vector3d basis(1.0, at.x(), at.y());
		Values         values;
		values << 0.5 * (field.k1[j] + field.k2[j]), std::abs(field.k1[j]) + std::abs(field.k2[j]),
			difference * line.transpose(), line.transpose();
		moments += w * basis * basis.transpose();
		sums += w * basis * values;
	});
	TensorAt t;
	if (moments(0, 0) > 0.0) {
		Values         values = sums.row(0) / moments(0, 0);
		const Vector2d beside = moments.row(0).tail<2>().transpose() / moments(0, 0);
		if (beside.norm() < maxBeside) {
			moments.diagonal().tail<2>().array() += slopeRidge * moments(0, 0);
			values = (moments.inverse() * sums).row(0);
		}
		t = {
			values[0],
			std::max(0.0, values[1]),
			values.segment<2>(2).transpose(),
			values.tail<2>().transpose(),
			beside.allFinite() ? beside : Vector2d(Vector2d::Zero())};
	}
	return t;
}

// Where k1 - k2 vanishes (planes, umbilic regions) the tensor has no directions but the field may
// still have: a small share of the plain mean of its lines takes over, without a jump.
Vector3d principalDirection(
	const TensorAt& t, const TangentFrame& frame, double radius, const Vector3d& fallback)
{
	const double   scale   = t.magnitude + (radius > 0.0 ? 1e-6 / radius : 1.0);
	const Vector2d doubled = t.deviator + flatShare * scale * t.line;
	if (doubled.norm() > 1e-6 * flatShare * scale) {
		const double angle = 0.5 * std::atan2(doubled.y(), doubled.x());
		return frame.toSpace({std::cos(angle), std::sin(angle)});
	}
	const Vector3d tangent = fallback - fallback.dot(frame.n) * frame.n;
	return tangent.norm() > 1e-6 ? Vector3d(tangent.normalized()) : frame.u;
}

Vector3d
projectedPosition(const PointCloud& cloud, Support& support, const Vector3d& c, ProjectionKind kind)
{
	switch (kind) {
	case ProjectionKind::LocallyOptimal:
		return projectLocallyOptimal(cloud, support, c);
	case ProjectionKind::WeightedAverage:
		return projectToAverage(cloud, support, c);
	case ProjectionKind::Mixed:
		break;
	}
	return projectMixed(cloud, support, c);
}

} // namespace

PointCloud onFittedSurface(const PointCloud& cloud, const CurvatureField& field)
{
	PointCloud fitted = cloud;
	if (field.height.size() == 0)
		return fitted;
	std::vector<double> sizes(field.height.size());
	for (std::size_t i = 0; i < sizes.size(); ++i)
		sizes[i] = std::abs(field.height[i]);
	const double most = mostNoise * quantile(sizes, noisyShare);
	for (std::size_t i = 0; i < sizes.size(); ++i)
		if (sizes[i] <= most)
			fitted.positions.col(i) += field.height[i] * cloud.normals.col(i);
	return fitted;
}

Index closestOnSide(const CloudIndex& index, const Vector3d& position, const Vector3d& normal)
{
	const std::vector<Index> near = index.search().nearest(position, sideCandidates);
	for (const Index i : near)
		if (index.cloud().normals.col(i).dot(normal) > sameSide)
			return i;
	return near[0];
}

SurfaceSample projectToSurface(
	const PointCloud&     cloud,
	const CurvatureField& field,
	const Vector3d&       position,
	Index                 closest,
	ProjectionKind        kind)
{
	Support        support(cloud, field, closest);
	const Vector3d site   = cloud.positions.col(closest);
	const bool     usable = (position - site).squaredNorm() < 1e100; // false for NaN as well
	const Vector3d start  = usable ? position : site;

	SurfaceSample sample;
	sample.closest  = closest;
	sample.position = projectedPosition(cloud, support, start, kind);
	support.weigh(sample.position, kernelRatio);
	sample.normal = normalAt(cloud, field, support, sample.position);

	const TangentFrame frame(sample.normal);
	const TensorAt     t          = tensorAt(cloud, field, support, sample.position, frame);
	const double       difference = t.deviator.norm();
	sample.k1                     = t.mean + 0.5 * difference;
	sample.k2                     = t.mean - 0.5 * difference;
	sample.d1      = principalDirection(t, frame, support.radius(), field.d1.col(closest));
	sample.d2      = sample.normal.cross(sample.d1);
	sample.inwards = frame.toSpace(t.beside);
	return sample;
}

} // namespace curvature_lines
