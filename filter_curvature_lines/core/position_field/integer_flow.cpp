// Closest pairs of what does not close, over triangles and the quarter in which a unit is carried.
// SPDX-License-Identifier: GPL-3.0-or-later
#include "integer_flow.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <utility>
#include <vector>

#include <Eigen/Core>

#include "closest_pairs.h"
#include "cross_field.h"
#include "line_density.h"
#include "point_cloud.h"
#include "transition_circuit.h"
#include "triangle_mesh.h"

namespace curvature_lines {

namespace {

using Eigen::Vector3d;

// Of every step, in cells: without it paths through triangles that no line crosses would wander.
constexpr double leastStep = 1e-6;

// One unit of lines, i^quarter in the frame of corner 0 of a triangle, is carried from triangle to triangle: the
// translation of the side it leaves through changes by a unit, so that the sum of the triangle falls and that of the
// neighbour rises. Node 4 t + quarter of the graph: the unit is in triangle t. Its mirror is the unit that is missing there.
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
		m_flow.translations = std::move(translations);
		m_circuit.resize(mesh.triangleCount());
		for (Index t = 0; t < mesh.triangleCount(); ++t)
			update(t);
		buildGraph(density);
	}

	IntegerFlow result()
	{
		ClosestPairs      pairs(m_graph);
		std::vector<Unit> units = {{}}; // the members
		// The rims, whose count stays: they take as many as come.
		const Index rims = pairs.add(outside(), 1);
		for (Index t = 0; t < m_mesh.triangleCount(); ++t)
			for (int quarter = 0; quarter < quarters; ++quarter)
				if (countOf({t, quarter}) > 0) {
					pairs.add(nodesOf({t, quarter}), countOf({t, quarter}));
					units.push_back({t, quarter});
				}
		ClosestPairs::Pair pair;
		while (pairs.closest(m_options.longest, pair)) {
			apply(pair.path);
			for (const Index unit : {pair.first, pair.second})
				if (unit != rims)
					pairs.setCount(unit, countOf(units[unit]));
			++m_flow.paths;
			m_flow.length += pair.cost;
		}
		m_flow.left = static_cast<int>(
			std::count_if(m_circuit.begin(), m_circuit.end(), [](const TransitionCircuit& c) {
				return !c.isClosed();
			}));
		return std::move(m_flow);
	}

private:
	static constexpr int quarters = 4;

	// Of lines that end in a triangle.
	struct Unit {
		Index triangle = -1;
		int   quarter  = 0;
	};
	struct Step {
		Complex change;       // of the translation of the edge
		Index   next;         // triangle, their number: beyond a rim
		int     side    = -1; // of that triangle
		int     quarter = 0;  // in which the unit arrives
	};

	// Nodes of the units that are beyond a rim.
	std::vector<Index> outside() const
	{
		const Index first = quarters * m_mesh.triangleCount();
		return {first, first + 1, first + 2, first + 3};
	}

	void update(Index t) { m_circuit[t] = circuitOf(m_mesh, m_field, m_flow.translations, t); }

	// Units to be taken away. In a singular triangle what counts is whether there is an odd one; it has no sign there, and
	// where the frame turns by a quarter, no family either.
	int countOf(const Unit& unit) const
	{
		const TransitionCircuit& c = m_circuit[unit.triangle];
		if (c.index == 0)
			return std::max(0, int(std::lround(turned(c.sum, -unit.quarter).real())));
		if (c.index == 2)
			return int(unit.quarter < 2 && isOdd(unit.quarter == 0 ? c.sum.real() : c.sum.imag()));
		return int(unit.quarter == 0 && isOdd(c.sum.real() + c.sum.imag()));
	}
	std::vector<Index> nodesOf(const Unit& unit) const
	{
		const int   index = m_circuit[unit.triangle].index;
		const Index first = quarters * unit.triangle;
		if (index == 0)
			return {first + unit.quarter};
		if (index == 2)
			return {first + unit.quarter, first + unit.quarter + 2};
		return {first, first + 1, first + 2, first + 3};
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
		if (edge.isRim()) {
			step.next    = m_mesh.triangleCount();
			step.quarter = quarter;
			return true;
		}
		step.next = ahead ? edge.right : edge.left;
		step.side = 0;
		while (m_mesh.edgeOf(step.next, step.side) != e)
			++step.side;
		const int there = m_circuit[step.next].before[step.side];
		step.quarter    = (ahead ? unit + 2 + turns - there : unit - there) & 3;
		return true;
	}

	bool isOnLimb(const Triangle& corners) const
	{
		return !m_options.onLimb.empty() &&
		       std::any_of(corners.begin(), corners.end(), [&](Index v) {
				   return m_options.onLimb[v] != 0;
			   });
	}

	// Of half a step, from the centre of a triangle to the middle of a side, for the units of either family.
	std::array<double, 2> halfCost(const TriangleField& tri, Index t, int c) const
	{
		const Index    e      = m_mesh.edgeOf(t, c);
		const Triangle corner = m_mesh.triangles()[t];
		const Vector3d step = m_mesh.vertices.col(m_mesh.edges()[e].from) + 0.5 * m_mesh.along(e) -
		                      m_mesh.vertices(Eigen::all, corner).rowwise().mean();
		const double times = isOnLimb(corner) ? m_options.limbCost : 1.0;
		const double u = tri.target[0].dot(step), v = tri.target[1].dot(step);
		return {
			times * std::hypot(u, m_options.along * v) + leastStep,
			times * std::hypot(v, m_options.along * u) + leastStep};
	}

	void buildGraph(const LineDensity& density)
	{
		const Index triangles = m_mesh.triangleCount();
		m_half.resize(triangles);
		for (Index t = 0; t < triangles; ++t) {
			const TriangleField tri = triangleField(m_mesh, m_field, density, t);
			for (int c = 0; c < 3; ++c)
				m_half[t][c] = halfCost(tri, t, c);
		}
		std::array<std::vector<MirrorGraph::Edge>, quarters> fromOutside;
		for (Index node = 0; node < quarters * triangles; ++node) {
			const Index t = node / quarters;
			const int   q = node % quarters;
			Step        step;
			for (int c = 0; c < 3; ++c) {
				if (!leaves(t, q, c, step))
					continue;
				const bool   out  = step.next == triangles;
				const double cost = m_half[t][c][q & 1] +
				                    (out ? 0.0 : m_half[step.next][step.side][step.quarter & 1]);
				m_graph.edges.push_back({quarters * step.next + step.quarter, cost});
				if (out)
					fromOutside[q].push_back({node, cost});
			}
			// Lines of one family go on as the other, or come back, around a singular point.
			if (m_circuit[t].index != 0)
				for (int k = 1; k < quarters; ++k)
					if (m_circuit[t].index != 2 || k == 2)
						m_graph.edges.push_back(
							{quarters * t + ((q + k) & 3), m_options.atSingular});
			m_graph.first.push_back(static_cast<Index>(m_graph.edges.size()));
		}
		for (const auto& edges : fromOutside) {
			m_graph.edges.insert(m_graph.edges.end(), edges.begin(), edges.end());
			m_graph.first.push_back(static_cast<Index>(m_graph.edges.size()));
		}
	}

	// Over the side that leads from node to node, of two rims the cheaper one.
	void carry(Index from, Index to)
	{
		const Index t = from / quarters;
		const int   q = from % quarters;
		Step        step, best;
		int         side = -1;
		for (int c = 0; c < 3; ++c) {
			if (!leaves(t, q, c, step))
				continue;
			if (quarters * step.next + step.quarter != to ||
			    (side >= 0 && m_half[t][c][q & 1] >= m_half[t][side][q & 1]))
				continue;
			best = step;
			side = c;
		}
		if (side >= 0)
			m_flow.translations[m_mesh.edgeOf(t, side)] += best.change;
	}

	void apply(const std::vector<Index>& path)
	{
		for (std::size_t i = 1; i < path.size(); ++i)
			if (path[i] / quarters != path[i - 1] / quarters)
				carry(path[i - 1], path[i]);
		for (const Index node : path)
			if (node < outside().front())
				update(node / quarters);
	}

	const TriangleMesh&       m_mesh;
	const CrossField&         m_field;
	const HeldIncreases&      m_held;
	const IntegerFlowOptions& m_options;

	IntegerFlow                                       m_flow;
	std::vector<TransitionCircuit>                    m_circuit;
	std::vector<std::array<std::array<double, 2>, 3>> m_half; // per triangle, side, family
	MirrorGraph                                       m_graph;
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
