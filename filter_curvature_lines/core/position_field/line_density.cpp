// Anisotropy, the least-squares correction of the density, and the count.
// SPDX-License-Identifier: GPL-3.0-or-later
#include "line_density.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>
#include <vector>

#include <Eigen/Geometry>
#include <Eigen/SparseCholesky>

#include "cross_field.h"
#include "curvature_field.h"
#include "point_cloud.h"
#include "scaffold.h"
#include "triangle_mesh.h"

namespace curvature_lines {

namespace {

using Eigen::Vector3d;
using SparseReal = Eigen::SparseMatrix<double>;

// Added to curvatures before their ratio is taken, over their RMS: flat parts have no preferred direction.
// By experiment.
constexpr double curvatureFloor = 0.1;
// Weight of the gradient of the correction (logarithm of the density): keeps its solve well-posed. By
// experiment.
constexpr double stiffness = 1e-3;
// The correction changes the density by no more than a factor of 2: without a bound cells shrink at
// singular points of spheres, and spacing grows at the tips of ellipsoids.
const double mostCorrection = std::log(2.0);
// Area of a triangle over the square of a side, below which it has none: far above rounding errors.
constexpr double leastTriangle = 1e-9;
// On limbs lines get no farther apart than by 15 %.
const double mostOnLimb = std::log(1.15);
// Weight of a crease vertex in the mean of a triangle: its cross lies between two faces and is wrong for both.
constexpr double creaseShare = 1e-3;

// |normal curvature| along both arms of the cross at every vertex, floored.
LineDensity
bending(const Scaffold& scaffold, const CrossField& field, const CurvatureField& curvature)
{
	const Index n   = scaffold.mesh.vertexCount();
	LineDensity k   = LineDensity::Zero(2, n);
	double      sum = 0.0, count = 0.0;
	for (Index v = 0; v < n; ++v) {
		const Index i = scaffold.source[v];
		if (i < 0)
			continue;
		const double k1 = curvature.k1[i], k2 = curvature.k2[i];
		const double c = field.d1.col(v).dot(curvature.d1.col(i));
		k.col(v) << std::abs(k1 * c * c + k2 * (1.0 - c * c)),
			std::abs(k2 * c * c + k1 * (1.0 - c * c));
		sum += 0.5 * (k1 * k1 + k2 * k2);
		count += 1.0;
	}
	return k.array() + curvatureFloor * std::sqrt(sum / std::max(count, 1.0)) + 1e-12;
}

// Log scales of both families at every vertex that make the fields of gradients nearly free of curl: one
// line ends per unit of curl.
LineDensity correction(
	const TriangleMesh& mesh, const CrossField& field, const LineDensity& density, double evenness)
{
	const Index                         n    = mesh.vertexCount();
	const Eigen::VectorXcd              rise = expectedRise(mesh, field, density);
	const Eigen::VectorXd               area = mesh.vertexAreas();
	std::vector<Eigen::Triplet<double>> entries;
	entries.reserve(18 * mesh.triangleCount() + 2 * n);
	Eigen::VectorXd right = Eigen::VectorXd::Zero(2 * n);
	for (Index t = 0; t < mesh.triangleCount(); ++t) {
		const TriangleField tri = triangleField(mesh, field, density, t);
		// The circulation, every side turned into the frame of corner 0.
		Complex circulation = 0.0;
		for (int c = 0; c < 3; ++c) {
			const Index   e    = mesh.edgeOf(t, c);
			const Complex side = mesh.isForward(t, c) ? rise[e] : -turned(rise[e], field.turns[e]);
			circulation += turned(side, -tri.turns[c]);
		}
		for (int f = 0; f < 2; ++f) {
			const double   nu = tri.target[f].norm() + 1e-300;
			const Vector3d d  = tri.target[f] / nu;
			const double   curl =
				(f == 0 ? circulation.real() : circulation.imag()) / nu / (tri.area + 1e-300);
			const double fit = field.index[t] == 0 ? tri.area : 0.0;
			Vector3d     across;
			for (int c = 0; c < 3; ++c)
				across[c] = tri.gradient.col(c).cross(d).dot(tri.normal);
			std::array<Index, 3> unknown;
			for (int c = 0; c < 3; ++c)
				unknown[c] = 2 * mesh.triangles()[t][c] + familyBehind(tri.turns[c], f).family;
			for (int a = 0; a < 3; ++a) {
				right[unknown[a]] -= fit * across[a] * curl;
				for (int b = 0; b < 3; ++b)
					entries.emplace_back(
						unknown[a],
						unknown[b],
						fit * across[a] * across[b] +
							stiffness * tri.area * tri.gradient.col(a).dot(tri.gradient.col(b)));
			}
		}
	}
	// In cells: where these are small, even spacing costs as much as elsewhere.
	const Eigen::VectorXd cells = area.cwiseProduct(density.colwise().prod().transpose());
	for (Index v = 0; v < n; ++v)
		for (int f = 0; f < 2; ++f)
			entries.emplace_back(2 * v + f, 2 * v + f, evenness * cells[v] / cells.sum() + 1e-300);
	SparseReal matrix(2 * n, 2 * n);
	matrix.setFromTriplets(entries.begin(), entries.end());
	const Eigen::SimplicialLDLT<SparseReal> solver(matrix);
	Eigen::VectorXd                         scales = solver.solve(right);
	if (solver.info() != Eigen::Success || !scales.allFinite())
		scales.setZero();
	LineDensity  result = Eigen::Map<LineDensity>(scales.data(), 2, n);
	const double mean   = 0.5 * result.colwise().sum().dot(area.transpose()) / area.sum();
	return (result.array() - mean).cwiseMax(-mostCorrection).cwiseMin(mostCorrection);
}

// Crossings and rim vertices of expectedVertices().
std::pair<double, double>
countsOf(const TriangleMesh& mesh, const CrossField& field, const LineDensity& density)
{
	const Eigen::VectorXd area   = mesh.vertexAreas();
	double                inside = 0.0, onRims = 0.0;
	for (Index v = 0; v < mesh.vertexCount(); ++v)
		inside += area[v] * density(0, v) * density(1, v);
	for (Index e = 0; e < mesh.edgeCount(); ++e) {
		const TriangleMesh::Edge& edge = mesh.edges()[e];
		if (!edge.isRim())
			continue;
		const Vector3d along = mesh.along(e);
		for (const Index v : {edge.from, edge.to})
			onRims += 0.5 * (density(0, v) * std::abs(along.dot(field.d1.col(v))) +
			                 density(1, v) * std::abs(along.dot(field.d2.col(v))));
	}
	return {inside, onRims};
}

} // namespace

TriangleField triangleField(
	const TriangleMesh& mesh, const CrossField& field, const LineDensity& density, Index triangle)
{
	TriangleField   result;
	const Triangle& t    = mesh.triangles()[triangle];
	const Vector3d  area = mesh.areaVector(triangle);
	result.area          = area.norm();
	result.normal =
		result.area > 0.0 ? Vector3d(area / result.area) : Vector3d(field.normals.col(t[0]));
	result.turns  = cornerTurns(mesh, field, triangle);
	result.target = {Vector3d::Zero(), Vector3d::Zero()};
	double sum    = 0.0;
	for (int c = 0; c < 3; ++c) {
		const Vector3d opposite =
			mesh.vertices.col(t[(c + 2) % 3]) - mesh.vertices.col(t[(c + 1) % 3]);
		// A triangle without area, as of three samples of a crease, has no say: its gradients are infinite.
		const bool flat = result.area <= leastTriangle * opposite.squaredNorm();
		result.gradient.col(c).setZero();
		if (!flat)
			result.gradient.col(c) = result.normal.cross(opposite) / (2.0 * result.area);
		const Index                   v      = t[c];
		const Vector3d                normal = field.normals.col(v);
		const std::array<Vector3d, 2> arms   = {
            transported(field.d1.col(v), normal, result.normal) * density(0, v),
            transported(field.d2.col(v), normal, result.normal) * density(1, v)};
		const double weight = field.onCrease[v] ? creaseShare : 1.0;
		for (int f = 0; f < 2; ++f) {
			const FamilyImage image = familyBehind(result.turns[c], f);
			result.target[f] += weight * image.sign * arms[image.family];
		}
		sum += weight;
	}
	for (Vector3d& target : result.target)
		target /= sum;
	return result;
}

Eigen::VectorXcd
expectedRise(const TriangleMesh& mesh, const CrossField& field, const LineDensity& density)
{
	const auto at = [&](Index v, const Vector3d& step) -> Complex {
		return {
			density(0, v) * field.d1.col(v).dot(step), density(1, v) * field.d2.col(v).dot(step)};
	};
	Eigen::VectorXcd rise(mesh.edgeCount());
	for (Index e = 0; e < mesh.edgeCount(); ++e) {
		const auto&    edge      = mesh.edges()[e];
		const Vector3d step      = mesh.along(e);
		const bool     skipStart = field.onCrease[edge.from] && !field.onCrease[edge.to];
		const bool     skipEnd   = field.onCrease[edge.to] && !field.onCrease[edge.from];
		const double   share     = skipStart ? 0.0 : skipEnd ? 1.0 : 0.5;
		rise[e]                  = share * at(edge.from, step) +
		          (1.0 - share) * turned(at(edge.to, step), -int(field.turns[e]));
	}
	return rise;
}

double
expectedVertices(const TriangleMesh& mesh, const CrossField& field, const LineDensity& density)
{
	const auto [inside, onRims] = countsOf(mesh, field, density);
	return inside + onRims;
}

LineDensity lineDensity(
	const Scaffold&           scaffold,
	const CrossField&         field,
	const CurvatureField&     curvature,
	const LineDensityOptions& options)
{
	const TriangleMesh& mesh = scaffold.mesh;
	const double        area = mesh.vertexAreas().sum();
	LineDensity         density =
		LineDensity::Constant(2, mesh.vertexCount(), std::sqrt(options.targetVertices / area));
	if (scaffold.size.size() > 0)
		density = scaffold.size.cwiseInverse().transpose().replicate(2, 1);
	if (options.anisotropy > 1.0) {
		const LineDensity bends = bending(scaffold, field, curvature);
		const double      most  = std::sqrt(options.anisotropy);
		for (Index v = 0; v < mesh.vertexCount(); ++v) {
			const double a =
				std::clamp(std::pow(bends(0, v) / bends(1, v), 0.25), 1.0 / most, most);
			density(0, v) *= a;
			density(1, v) /= a;
		}
	}
	LineDensity scales = correction(mesh, field, density, options.evenness);
	// Lines around a thin limb stay as close as they are wanted: half as many would be none.
	for (Index v = 0; v < mesh.vertexCount() && !scaffold.onLimb.empty(); ++v)
		if (scaffold.onLimb[v])
			scales.col(v) = scales.col(v).cwiseMax(-mostOnLimb);
	density.array() *= scales.array().exp();
	// inside g^2 + onRims g = target for the common factor g.
	const auto [inside, onRims] = countsOf(mesh, field, density);
	const double half           = 0.5 * onRims / inside;
	density *= std::sqrt(half * half + options.targetVertices / inside) - half;
	return density;
}

} // namespace curvature_lines
