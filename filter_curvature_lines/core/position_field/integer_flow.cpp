// Shortest paths between what does not close, over triangles and the quarter in which a unit is carried.
// SPDX-License-Identifier: GPL-3.0-or-later
#include "integer_flow.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <queue>
#include <tuple>
#include <utility>
#include <vector>

#include <Eigen/Core>

#include "cross_field.h"
#include "line_density.h"
#include "point_cloud.h"
#include "shortest_paths.h"
#include "transition_circuit.h"
#include "triangle_mesh.h"

namespace curvature_lines {

namespace {

using Eigen::Vector3d;

// Costs of paths differ from each other by rounding only.
constexpr double sameCost = 1e-9;
// Of every step, in cells: without it paths through triangles that no line crosses would wander.
constexpr double leastStep = 1e-6;

// One unit of lines, i^quarter in the frame of corner 0 of a triangle, is carried from triangle to triangle: the
// translation of the side it leaves through changes by a unit, so that the sum of the triangle falls and that of the
// neighbour rises.
class Flow {
public:
	Flow(
		const TriangleMesh&       mesh,
		const CrossField&         field,
		const LineDensity&        density,
		const HeldIncreases&      held,
		Eigen::VectorXcd          translations,
		const IntegerFlowOptions& options) :
			m_mesh(mesh), m_field(field), m_held(held), m_options(options)
	{
		const Index triangles = mesh.triangleCount();
		m_flow.translations   = std::move(translations);
		m_circuit.resize(triangles);
		m_cost.resize(triangles);
		for (Index t = 0; t < triangles; ++t) {
			update(t);
			const TriangleField tri = triangleField(mesh, field, density, t);
			const Vector3d centre = mesh.vertices(Eigen::all, mesh.triangles()[t]).rowwise().mean();
			const double   times  = isOnLimb(mesh.triangles()[t]) ? options.limbCost : 1.0;
			for (int c = 0; c < 3; ++c) {
				const Index    e = mesh.edgeOf(t, c);
				const Vector3d step =
					mesh.vertices.col(mesh.edges()[e].from) + 0.5 * mesh.along(e) - centre;
				const double u = tri.target[0].dot(step), v = tri.target[1].dot(step);
				m_cost[t][c] = {
					times * std::hypot(u, options.along * v) + leastStep,
					times * std::hypot(v, options.along * u) + leastStep};
			}
		}
	}

	IntegerFlow result()
	{
		using Source =
			std::tuple<double, Index, int>; // cost of the way from there, triangle, quarter
		std::priority_queue<Source, std::vector<Source>, std::greater<>> sources;
		for (Index t = 0; t < m_mesh.triangleCount(); ++t)
			for (int q = 0; q < states; ++q)
				if (isSource(t, q))
					sources.emplace(0.0, t, q);
		while (!sources.empty()) {
			const auto [cost, t, q] = sources.top();
			sources.pop();
			if (!isSource(t, q))
				continue;
			const Way way = shortestFrom(t, q);
			if (way.state < 0 || way.cost > m_options.longest)
				continue;
			if (way.cost > cost + sameCost) { // by now others may be closer
				sources.emplace(way.cost, t, q);
				continue;
			}
			apply(way);
			++m_flow.paths;
			m_flow.length += way.cost;
			if (isSource(t, q))
				sources.emplace(0.0, t, q);
		}
		m_flow.left = static_cast<int>(
			std::count_if(m_circuit.begin(), m_circuit.end(), [](const TransitionCircuit& c) {
				return !c.isClosed();
			}));
		return std::move(m_flow);
	}

private:
	static constexpr int states = 4; // of a triangle: quarters

	struct Step {
		Complex change;       // of the translation of the edge
		Index   next;         // triangle, -1: beyond a rim
		int     side    = -1; // of that
		int     quarter = 0;  // in which the unit arrives
	};
	struct Way {
		double cost  = std::numeric_limits<double>::infinity();
		Index  state = -1; // where it ends
		int    rim   = -1; // the side of its triangle that it leaves through
	};

	bool isOnLimb(const Triangle& corners) const
	{
		return !m_options.onLimb.empty() &&
		       std::any_of(corners.begin(), corners.end(), [&](Index v) {
				   return m_options.onLimb[v] != 0;
			   });
	}

	void update(Index t) { m_circuit[t] = circuitOf(m_mesh, m_field, m_flow.translations, t); }

	// A unit i^quarter is to be taken away from the triangle.
	bool isSource(Index t, int quarter) const
	{
		const TransitionCircuit& c = m_circuit[t];
		if (c.index == 0)
			return turned(c.sum, -quarter).real() > 0.5;
		if (c.index == 2)
			return isOdd(quarter & 1 ? c.sum.imag() : c.sum.real());
		return isOdd(c.sum.real() + c.sum.imag());
	}
	bool isSink(Index t, int quarter) const { return isSource(t, (quarter + 2) & 3); }

	// The triangle that gave away a unit of one quarter takes it back in another, in which it has been turned on the way.
	bool closesItself(Index t, int gone, int back) const
	{
		const TransitionCircuit& c = m_circuit[t];
		if (c.index == 0 && ((gone ^ back) & 3) == 2)
			return turned(c.sum, -gone).real() > 1.5;
		return (c.index & 1) == 0 && ((gone ^ back) & 1) != 0 && isSink(t, back);
	}

	// Whether the unit may leave through side c, and how.
	bool leaves(Index t, int quarter, int c, Step& step) const
	{
		const Index              e     = m_mesh.edgeOf(t, c);
		const TriangleMesh::Edge edge  = m_mesh.edges()[e];
		const int                turns = m_field.turns[e];
		const bool               ahead = m_mesh.isForward(t, c);
		// The sum holds i^-before n of a side that runs forwards, and -i^(turns - before) n of one that runs backwards.
		const int before = m_circuit[t].before[c];
		const int unit   = (ahead ? before + quarter + 2 : before + quarter - turns) & 3;
		if (m_held[e][unit & 1])
			return false;
		step.change = turned(1.0, unit);
		step.next   = ahead ? edge.right : edge.left;
		if (step.next < 0)
			return true;
		step.side = 0;
		while (m_mesh.edgeOf(step.next, step.side) != e)
			++step.side;
		const int there = m_circuit[step.next].before[step.side];
		step.quarter    = (ahead ? unit + 2 + turns - there : unit - there) & 3;
		return true;
	}

	Way shortestFrom(Index start, int quarter)
	{
		m_paths.start(states * m_mesh.triangleCount());
		m_paths.reach(states * start + quarter, 0.0, -1);
		Way best; // to a rim
		while (m_paths.isOpen()) {
			const auto [cost, state] = m_paths.nearest();
			if (!m_paths.take())
				continue;
			if (cost >= best.cost || cost > m_options.longest)
				break;
			const Index t = state / states;
			const int   q = state % states;
			if (t != start ? isSink(t, q) : closesItself(t, quarter, q))
				return {cost, state, -1};
			if (m_circuit[t].index != 0)
				for (int k = 1; k < states; ++k)
					if (m_circuit[t].index != 2 || k == 2)
						m_paths.reach(
							states * t + ((q + k) & 3), cost + m_options.atSingular, state);
			for (int c = 0; c < 3; ++c) {
				Step step;
				if (!leaves(t, q, c, step))
					continue;
				// In the frame of corner 0, in which the unit is.
				const double half = m_cost[t][c][q & 1];
				if (step.next >= 0)
					m_paths.reach(
						states * step.next + step.quarter,
						cost + half + m_cost[step.next][step.side][step.quarter & 1],
						state);
				else if (cost + half < best.cost)
					best = {cost + half, state, c};
			}
		}
		return best;
	}

	void apply(const Way& way)
	{
		Step               step;
		std::vector<Index> touched = {way.state / states};
		if (way.rim >= 0 && leaves(way.state / states, way.state % states, way.rim, step))
			m_flow.translations[m_mesh.edgeOf(way.state / states, way.rim)] += step.change;
		for (Index to = way.state, from = m_paths.before(to); from >= 0;
		     to = from, from = m_paths.before(to)) {
			const Index t = from / states;
			touched.push_back(t);
			for (int c = 0; c < 3 && t != to / states; ++c) {
				if (!leaves(t, from % states, c, step) || step.next != to / states ||
				    step.quarter != to % states)
					continue;
				m_flow.translations[m_mesh.edgeOf(t, c)] += step.change;
				break;
			}
		}
		for (const Index t : touched)
			update(t);
	}

	const TriangleMesh&       m_mesh;
	const CrossField&         m_field;
	const HeldIncreases&      m_held;
	const IntegerFlowOptions& m_options;

	IntegerFlow                    m_flow;
	std::vector<TransitionCircuit> m_circuit;
	std::vector<std::array<std::array<double, 2>, 3>>
				  m_cost;  // per triangle, side, family: of half a step
	ShortestPaths m_paths; // nodes: states
};

} // namespace

IntegerFlow closeTranslations(
	const TriangleMesh&       mesh,
	const CrossField&         field,
	const LineDensity&        density,
	const HeldIncreases&      held,
	Eigen::VectorXcd          translations,
	const IntegerFlowOptions& options)
{
	return Flow(mesh, field, density, held, std::move(translations), options).result();
}

} // namespace curvature_lines
