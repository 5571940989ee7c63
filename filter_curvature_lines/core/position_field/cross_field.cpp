// Smoothing by one complex linear solve, the smallest eigenvector where nothing is known, and the quarter
// turns between neighbouring frames.
// SPDX-License-Identifier: GPL-3.0-or-later
#include "cross_field.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include <Eigen/Geometry>
#include <Eigen/SparseCholesky>

#include "curvature_field.h"
#include "neighborhoods.h"
#include "point_cloud.h"
#include "scaffold.h"
#include "triangle_mesh.h"

namespace curvature_lines {

namespace {

using Eigen::Vector3d;
using SparseComplex = Eigen::SparseMatrix<Complex>;

constexpr double quarter = 0.5 * double(EIGEN_PI);
// Where k1 - k2 is below so many of its standard errors no direction is known: a 3-sigma test.
constexpr double sureErrors = 3.0;
// A direction whose k1 - k2 is this many errors is smoothed over about a cell of the mesh; the more exact
// it is, the less, down to 1 / sqrt(10), a third of a cell. Chosen among seven settings on noisy
// ellipsoids, seeds 1 to 10, where over-smoothing and noise both turn mesh edges near the umbilics.
constexpr double cellErrors = 18.0;
constexpr double mostTrust  = 10.0;
// Of a component, in cells of the mesh. Where directions are known in less than one, they are chance: four
// of 6316 points of a noisy sphere would bend the whole field, and 94 lines end in it instead of 5.
constexpr double fewestCells = 1.0;
// Added to the standard error, in curvatures over the diagonal: what errors leave out, such as corners
// nearby. By experiment: a smaller difference cannot be distinguished from flat.
constexpr double leastError = 0.02;
// |k1 - k2| over the RMS of both, below which a point is umbilic: about the 5 % of A09's ratio .95.
constexpr double leastRatio = 0.05;
// Numerical: keeps the matrix definite where nothing is known; the shift of the inverse iteration, over the
// weights (about 1), and its number of steps.
constexpr double regularization  = 1e-9;
constexpr double eigenShift      = 1e-8;
constexpr int    eigenIterations = 40;

// Angle of the arm d1 of the cross at one end of an edge, as seen in the frame at the other end.
double angleAcross(const CrossField& field, Index from, Index to)
{
	const Vector3d d =
		transported(field.d1.col(from), field.normals.col(from), field.normals.col(to));
	return std::atan2(d.dot(field.d2.col(to)), d.dot(field.d1.col(to)));
}

int quartersOf(double angle)
{
	return static_cast<int>(std::lround(angle / quarter)) & 3;
}

void turnFrame(CrossField& field, Index v, double angle)
{
	const Vector3d d1 = field.d1.col(v), d2 = field.d2.col(v);
	field.d1.col(v) = (std::cos(angle) * d1 + std::sin(angle) * d2).normalized();
	field.d2.col(v) = field.normals.col(v).cross(field.d1.col(v));
}

// sum w |z_to - exp(4 i a) z_from|^2, as a Hermitian matrix (lower half), with `diagonal` added.
SparseComplex
smoothness(const TriangleMesh& mesh, const CrossField& frames, const Eigen::VectorXd& diagonal)
{
	const Eigen::VectorXd                weights = mesh.cotangentWeights();
	Eigen::VectorXd                      sums    = diagonal;
	std::vector<Eigen::Triplet<Complex>> entries;
	entries.reserve(mesh.edgeCount() + mesh.vertexCount());
	for (Index e = 0; e < mesh.edgeCount(); ++e) {
		const TriangleMesh::Edge& edge = mesh.edges()[e];
		sums[edge.from] += weights[e];
		sums[edge.to] += weights[e];
		const double angle = 4.0 * angleAcross(frames, edge.from, edge.to);
		entries.emplace_back(edge.to, edge.from, -weights[e] * std::polar(1.0, angle));
	}
	for (Index v = 0; v < mesh.vertexCount(); ++v)
		entries.emplace_back(v, v, sums[v]);
	SparseComplex matrix(mesh.vertexCount(), mesh.vertexCount());
	matrix.setFromTriplets(entries.begin(), entries.end());
	return matrix;
}

using Solver = Eigen::SimplicialLDLT<SparseComplex, Eigen::Lower>;

Eigen::VectorXcd
smoothest(const TriangleMesh& mesh, const CrossField& frames, const std::vector<Index>& component)
{
	const Index      n = mesh.vertexCount();
	Solver           solver(smoothness(mesh, frames, Eigen::VectorXd::Constant(n, eigenShift)));
	Eigen::VectorXcd z(n);
	for (Index v = 0; v < n; ++v) // any start that is not orthogonal to the smoothest field
		z[v] = std::polar(1.0, double(2.0 * EIGEN_PI) * std::fmod(0.6180339887498949 * v, 1.0));
	std::vector<double> sum(n);
	for (int k = 0; k < eigenIterations; ++k) {
		z = solver.solve(z).eval();
		std::fill(sum.begin(), sum.end(), 0.0);
		for (Index v = 0; v < n; ++v)
			sum[component[v]] += std::norm(z[v]);
		for (Index v = 0; v < n; ++v)
			z[v] /= std::sqrt(sum[component[v]]) + 1e-300;
	}
	return z;
}

// Turns frames by quarters so that most edges join equal ones: later stages are cheaper, and solve for
// both families apart, where no frame is turned.
void comb(const TriangleMesh& mesh, CrossField& field)
{
	std::vector<std::vector<Index>> around(mesh.vertexCount());
	for (const TriangleMesh::Edge& edge : mesh.edges()) {
		around[edge.from].push_back(edge.to);
		around[edge.to].push_back(edge.from);
	}
	std::vector<char>  reached(mesh.vertexCount(), 0);
	std::vector<Index> queue;
	queue.reserve(mesh.vertexCount());
	std::size_t next = 0;
	for (Index start = 0; start < mesh.vertexCount(); ++start) {
		if (reached[start])
			continue;
		reached[start] = 1;
		queue.push_back(start);
		for (; next < queue.size(); ++next) {
			for (const Index w : around[queue[next]]) {
				if (std::exchange(reached[w], 1))
					continue;
				turnFrame(field, w, quarter * quartersOf(angleAcross(field, queue[next], w)));
				queue.push_back(w);
			}
		}
	}
}

} // namespace

Eigen::Vector3d transported(const Vector3d& d, const Vector3d& from, const Vector3d& to)
{
	const Vector3d axis = from.cross(to);
	const double   c    = std::max(from.dot(to), -1.0 + 1e-9);
	return c * d + axis.cross(d) + axis * (axis.dot(d) / (1.0 + c));
}

Complex turned(const Complex& z, int quarters)
{
	switch (quarters & 3) {
	case 1:
		return {-z.imag(), z.real()};
	case 2:
		return -z;
	case 3:
		return {z.imag(), -z.real()};
	default:
		return z;
	}
}

FamilyImage familyBehind(int turns, int f)
{
	switch (turns & 3) {
	case 1:
		return {1 - f, f == 0 ? 1 : -1};
	case 2:
		return {f, -1};
	case 3:
		return {1 - f, f == 0 ? -1 : 1};
	default:
		return {f, 1};
	}
}

std::array<int, 3> cornerTurns(const TriangleMesh& mesh, const CrossField& field, Index triangle)
{
	const auto along = [&](int c) {
		const int turns = field.turns[mesh.edgeOf(triangle, c)];
		return mesh.isForward(triangle, c) ? turns : -turns;
	};
	return {0, along(0) & 3, -along(2) & 3};
}

std::vector<Index> singularTriangles(const CrossField& field)
{
	std::vector<Index> result;
	for (std::size_t t = 0; t < field.index.size(); ++t)
		if (field.index[t] != 0)
			result.push_back(static_cast<Index>(t));
	return result;
}

DirectionGuide directionGuide(const Scaffold& scaffold, const CurvatureField& curvature)
{
	const TriangleMesh&    mesh = scaffold.mesh;
	const Index            n    = mesh.vertexCount();
	DirectionGuide         guide;
	const Eigen::Matrix3Xd fromTriangles = mesh.vertexNormals();
	guide.normals                        = fromTriangles;
	guide.directions.setZero(3, n);
	guide.weights.setZero(n);
	guide.onCrease.assign(n, 0);
	const Eigen::VectorXd areas = mesh.vertexAreas();
	const double cell = (scaffold.size.size() > 0 ? scaffold.size : scaffold.spacing).maxCoeff();
	for (Index v = 0; v < n; ++v) {
		const Index i = scaffold.source[v];
		if (i < 0)
			continue;
		guide.normals.col(v)    = curvature.d1.col(i).cross(curvature.d2.col(i)).normalized();
		guide.directions.col(v) = curvature.d1.col(i);
		const double difference = curvature.k1[i] - curvature.k2[i];
		const double size       = curvedness(curvature.k1[i], curvature.k2[i]);
		const double sure       = difference / (curvature.error[i] + leastError);
		if (curvature.status[i] == PointStatus::TooFewNeighbors || difference < leastRatio * size ||
		    sure < sureErrors)
			continue;
		const double ratio      = difference / size;
		const double confidence = std::min(mostTrust, sure / cellErrors);
		guide.weights[v]        = confidence * ratio * areas[v] / (cell * cell);
	}

	for (Index e = 0; e < mesh.edgeCount(); ++e)
		if (scaffold.creaseEdge[e])
			for (const Index v : {mesh.edges()[e].from, mesh.edges()[e].to}) {
				guide.onCrease[v]    = 1;
				guide.weights[v]     = 0.0;
				guide.normals.col(v) = fromTriangles.col(v);
			}
	for (Index v = 0; v < n; ++v) {
		Vector3d d = guide.directions.col(v);
		d -= d.dot(guide.normals.col(v)) * guide.normals.col(v);
		guide.directions.col(v) =
			d.norm() > 1e-6 ? d.normalized() : TangentFrame(guide.normals.col(v)).u;
	}
	return guide;
}

CrossField smoothCrossField(const TriangleMesh& mesh, const DirectionGuide& guide)
{
	const Index n = mesh.vertexCount();
	CrossField  field;
	field.normals  = guide.normals;
	field.d1       = guide.directions;
	field.onCrease = guide.onCrease;
	field.d2.resize(3, n);
	for (Index v = 0; v < n; ++v)
		field.d2.col(v) = field.normals.col(v).cross(field.d1.col(v));

	const std::vector<Index> component = mesh.components();
	Eigen::VectorXd          known     = Eigen::VectorXd::Zero(n); // cells, per component
	for (Index v = 0; v < n; ++v)
		known[component[v]] += guide.weights[v];
	const auto       guided    = [&](Index v) { return known[component[v]] >= fewestCells; };
	Eigen::VectorXcd z         = Eigen::VectorXcd::Zero(n);
	bool             anyGuided = false, allGuided = true;
	for (Index v = 0; v < n; ++v) {
		anyGuided = anyGuided || guided(v);
		allGuided = allGuided && guided(v);
	}
	if (anyGuided) {
		const Solver solver(smoothness(mesh, field, guide.weights.array() + regularization));
		z = solver.solve(Eigen::VectorXcd(guide.weights.cast<Complex>()));
	}
	if (!allGuided && n > 0) {
		const Eigen::VectorXcd free = smoothest(mesh, field, component);
		for (Index v = 0; v < n; ++v)
			if (!guided(v))
				z[v] = free[v];
	}
	for (Index v = 0; v < n; ++v)
		if (std::isfinite(std::abs(z[v])) && std::abs(z[v]) > 0.0)
			turnFrame(field, v, 0.25 * std::arg(z[v]));

	comb(mesh, field);
	field.turns.resize(mesh.edgeCount());
	for (Index e = 0; e < mesh.edgeCount(); ++e)
		field.turns[e] = static_cast<std::uint8_t>(
			quartersOf(angleAcross(field, mesh.edges()[e].from, mesh.edges()[e].to)));
	field.index.resize(mesh.triangleCount());
	for (Index t = 0; t < mesh.triangleCount(); ++t) {
		int sum = 0;
		for (int c = 0; c < 3; ++c)
			sum += mesh.isForward(t, c) ? field.turns[mesh.edgeOf(t, c)]
			                            : -field.turns[mesh.edgeOf(t, c)];
		field.index[t] = static_cast<std::uint8_t>(sum & 3);
	}
	return field;
}

// With z = exp(4 i angle) as in smoothness(), for small angles.
void smoothWithTurns(const TriangleMesh& mesh, const DirectionGuide& guide, CrossField& field)
{
	const Index                         n       = mesh.vertexCount();
	const Eigen::VectorXd               weights = mesh.cotangentWeights();
	Eigen::VectorXd                     sums    = guide.weights.array() + regularization;
	Eigen::VectorXd                     right   = Eigen::VectorXd::Zero(n);
	std::vector<Eigen::Triplet<double>> entries;
	entries.reserve(mesh.edgeCount() + n);
	for (Index e = 0; e < mesh.edgeCount(); ++e) {
		const TriangleMesh::Edge& edge = mesh.edges()[e];
		const double off      = angleAcross(field, edge.from, edge.to) - quarter * field.turns[e];
		const double residual = weights[e] * std::remainder(off, 2.0 * double(EIGEN_PI));
		sums[edge.from] += weights[e];
		sums[edge.to] += weights[e];
		right[edge.from] -= residual;
		right[edge.to] += residual;
		entries.emplace_back(edge.to, edge.from, -weights[e]);
	}
	for (Index v = 0; v < n; ++v) {
		const double angle = std::atan2(
			guide.directions.col(v).dot(field.d2.col(v)),
			guide.directions.col(v).dot(field.d1.col(v)));
		right[v] += guide.weights[v] * std::remainder(angle, quarter);
		entries.emplace_back(v, v, sums[v]);
	}
	Eigen::SparseMatrix<double> matrix(n, n);
	matrix.setFromTriplets(entries.begin(), entries.end());
	const Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>, Eigen::Lower> solver(matrix);
	const Eigen::VectorXd angles = solver.solve(right);
	for (Index v = 0; v < n; ++v)
		if (std::isfinite(angles[v]))
			turnFrame(field, v, angles[v]);
}

} // namespace curvature_lines
