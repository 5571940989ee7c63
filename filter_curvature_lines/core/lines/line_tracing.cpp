// Lines of curvature traced on the cloud in order of confidence (A09 section 5.1; R07 section 5).
// SPDX-License-Identifier: GPL-3.0-or-later
#include "line_tracing.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <utility>
#include <vector>

#include <Eigen/Geometry>

#include "curvature_field.h"
#include "line_network.h"
#include "line_registry.h"
#include "line_spacing.h"
#include "neighborhoods.h"
#include "point_cloud.h"
#include "progress.h"
#include "surface_flow.h"
#include "umbilics.h"
#include "voronoi_cells.h"

namespace curvature_lines {

namespace {

using Eigen::Vector3d;

// A09 section 5.1 leaves these open; all by experiment on tori, where without a test against itself one
// line wound 4000 steps. Length at which a line is given up, in diagonals of the bounding box: a safeguard
// against lines that never end.
constexpr double mostLength = 10.0;
// A line closes that comes back to its start in about its own direction: cosine of 60 degrees.
constexpr double closingCosine = 0.5;
// Parts of a line nearer than this along itself do not stop it, and from this far on it heads for its start
// to close; in d.
constexpr double ownArc = 3.0;
// Parts of itself stop a line at this share of the distance at which others do, so that it closes before it
// is stopped.
constexpr double ownDistance = 0.9;
// A line that closes misses its start sideways; the offset is spread over so many times its length, a turn
// of 2 degrees.
constexpr double closingSpread = 30.0;
// Bisections of the last step before a rim: it is met within 1 / 32 of a step.
constexpr int   rimBisections = 5;
constexpr Index reportEvery   = 1024; // points or seeds between reports of progress

using Points = std::vector<FlowPoint>;

struct TracedLine {
	Index                  seed; // its place among the seeds
	Index                  size; // points
	bool                   closed;
	std::array<LineEnd, 2> ends;
};

// The lines of one family. Those of the other do not matter to it.
class FamilyTracer {
public:
	FamilyTracer(
		int                         family,
		const PointCloud&           cloud,
		const MinimumNeighborhoods& minimum,
		const NeighborLists&        proximity,
		const SurfaceFlow&          flow,
		const LineTracingOptions&   options,
		const LineSpacing&          spacing) :
			m_family(family), m_cloud(cloud), m_flow(flow), m_options(options),
			m_diagonal(spacing.diagonal), m_distance(spacing.distance[family - 1]),
			m_registry(cloud, minimum, proximity)
	{
	}

	void run(const std::vector<Index>& seeds, const Progress& progress);

	const std::vector<TracedLine>& lines() const { return m_lines; }
	const Points& points() const { return m_points; }
	const LineRegistry& registry() const { return m_registry; }

private:
	void traceThrough(Index seed, Index place, const Progress& progress);
	LineEnd traceHalf(const FlowPoint& start, Points& half, const Progress& progress);
	void stepUpToRim(const FlowPoint& from, Points& half);
	bool occupied(const FlowPoint& point, bool approachesStart);
	void registerSegment(const FlowPoint& from, const FlowPoint& to);
	void closeUp(const FlowPoint& start, Points& half);

	Index currentLine() const { return static_cast<Index>(m_lines.size()); }
	double distance(Index cell) const { return m_distance[cell]; }

	const int                  m_family;
	const PointCloud&          m_cloud;
	const SurfaceFlow&         m_flow;
	const LineTracingOptions&  m_options;
	const double               m_diagonal;
	const std::vector<double>& m_distance;
	LineRegistry               m_registry;

	// of the half line being traced: +1, then -1: arc lengths of the second are negative
	double m_side = 1.0;

	Points                  m_points; // of all finished lines
	std::vector<TracedLine> m_lines;
};

bool FamilyTracer::occupied(const FlowPoint& point, bool approachesStart)
{
	const double   d = distance(point.cell);
	ProximityQuery query;
	query.position  = point.position;
	query.normal    = point.normal;
	query.cell      = point.cell;
	query.radius    = m_options.stopFactor * d;
	query.line      = currentLine();
	query.ownRadius = ownDistance * query.radius;
	if (m_side > 0.0) {
		query.ownFrom = approachesStart ? ownArc * d : -HUGE_VAL;
		query.ownTo   = point.arc - ownArc * d;
	}
	else { // all of the first half counts, or the second would run along it
		query.ownFrom = point.arc + ownArc * d;
		query.ownTo   = HUGE_VAL;
	}
	return m_registry.occupied(query);
}

void FamilyTracer::registerSegment(const FlowPoint& from, const FlowPoint& to)
{
	m_registry.add(
		{from.position,
	     to.position,
	     (from.normal + to.normal).normalized(),
	     from.cell,
	     to.cell,
	     currentLine(),
	     0.5 * (from.arc + to.arc)});
}

// A step that ended beyond a rim or crease, again as far as it goes this side of it.
void FamilyTracer::stepUpToRim(const FlowPoint& from, Points& half)
{
	const double step = m_flow.step(from.cell);
	FlowPoint    best, tried;
	double       reached = 0.0, beyond = 1.0;
	for (int k = 0; k < rimBisections; ++k) {
		const double middle = 0.5 * (reached + beyond);
		if (m_flow.sampleAt(from.position + middle * step * from.direction, from, tried) &&
		    !m_flow.leftCloud(tried)) {
			reached = middle;
			best    = tried;
		}
		else {
			beyond = middle;
		}
	}
	const double moved = reached > 0.0 ? (best.position - from.position).dot(from.direction) : 0.0;
	best.arc           = from.arc + m_side * moved;
	if (moved <= m_flow.leastStep(from.cell) || occupied(best, false))
		return;
	registerSegment(from, best);
	half.push_back(best);
}

// Follows the field from `start` (not stored) until one of the stops of A09 section 5.1 and of ours: None if
// the line came back to its start.
LineEnd FamilyTracer::traceHalf(const FlowPoint& start, Points& half, const Progress& progress)
{
	FlowPoint front = start, next;
	while (std::abs(front.arc) < mostLength * m_diagonal) {
		const bool onwards = m_flow.advance(front, m_side, next);
		if (!onwards || m_flow.leftCloud(next)) {
			stepUpToRim(front, half);
			return !onwards || m_flow.isCrease(next.cell) ? LineEnd::Crease : LineEnd::Rim;
		}
		if (m_flow.endsAtUmbilic(front, next))
			return LineEnd::Umbilic;
		// A line that comes back next to its start would be stopped by it. The offset is noise, and closing
		// is better than two ends side by side. It is less than the room other lines leave.
		const Vector3d toStart    = start.position - next.position;
		const double   ahead      = toStart.dot(next.direction);
		const double   aside      = (toStart - ahead * next.direction).norm();
		const double   step       = (next.position - front.position).norm();
		const double   d          = std::max(distance(next.cell), 2.0 * step);
		const bool     approaches = m_side > 0.0 && next.arc > 2.0 * step && ahead > 0.0 &&
		                        ahead < ownArc * d &&
		                        aside < ownDistance * m_options.stopFactor * d &&
		                        next.direction.dot(start.direction) > closingCosine;
		if (occupied(next, approaches))
			return LineEnd::Line;
		registerSegment(front, next);
		half.push_back(next);
		if (approaches && ahead < 2.0 * step)
			return LineEnd::None;
		front = next;
		if (half.size() % reportEvery == 0)
			progress.report(0.0);
	}
	return LineEnd::Length;
}

// The sideways offset of a closed line's end from its start, spread over the last stretch.
void FamilyTracer::closeUp(const FlowPoint& start, Points& half)
{
	const FlowPoint last  = half.back();
	const Vector3d  gap   = start.position - last.position;
	const Vector3d  aside = gap - gap.dot(last.direction) * last.direction;
	const double    from  = std::max(0.0, last.arc - closingSpread * aside.norm());
	for (FlowPoint& point : half) {
		if (point.arc <= from)
			continue;
		FlowPoint moved = point;
		if (m_flow.sampleAt(
				point.position + (point.arc - from) / (last.arc - from) * aside, point, moved)) {
			moved.arc = point.arc;
			point     = moved;
		}
	}
}

void FamilyTracer::traceThrough(Index seed, Index place, const Progress& progress)
{
	FlowPoint start;
	start.cell      = seed;
	start.normal    = m_cloud.normals.col(seed);
	m_side          = 1.0;
	start.family    = m_family;
	start.direction = m_flow.directionAt(seed, m_family);
	if (!m_flow.sampleAt(m_cloud.positions.col(seed), start, start))
		return;
	ProximityQuery query;
	query.position = start.position;
	query.normal   = start.normal;
	query.cell     = start.cell;
	query.radius   = distance(start.cell);
	if (m_registry.occupied(query))
		return;

	const Index            known = m_registry.size();
	Points                 line;
	std::array<LineEnd, 2> ends;
	ends[1]           = traceHalf(start, line, progress);
	const bool closed = ends[1] == LineEnd::None;
	if (closed) {
		ends[0] = LineEnd::None;
		closeUp(start, line);
		line.insert(line.begin(), start);
	}
	else {
		FlowPoint back = start;
		back.direction = -start.direction;
		m_side         = -1.0;
		Points second;
		ends[0] = traceHalf(back, second, progress);
		std::reverse(second.begin(), second.end());
		second.push_back(start);
		line.insert(line.begin(), second.begin(), second.end());
	}
	m_registry.truncate(known);
	if (line.back().arc - line.front().arc < distance(seed))
		return; // too short to cross two lines of the other family
	for (std::size_t k = 0; k + 1 < line.size(); ++k)
		registerSegment(line[k], line[k + 1]);
	if (closed) {
		FlowPoint end = start;
		end.arc       = line.back().arc + (start.position - line.back().position).norm();
		registerSegment(line.back(), end);
	}
	m_points.insert(m_points.end(), line.begin(), line.end());
	m_lines.push_back({place, static_cast<Index>(line.size()), closed, ends});
}

void FamilyTracer::run(const std::vector<Index>& seeds, const Progress& progress)
{
	const auto count = static_cast<Index>(seeds.size());
	for (Index k = 0; k < count; ++k) {
		const Progress here = progress.sub(double(k) / count, 1.0, "Tracing lines");
		if (k % reportEvery == 0)
			here.report(0.0);
		traceThrough(seeds[k], k, here);
	}
}

bool isSeed(const CurvatureField& field, const UmbilicRegions& umbilics, Index i)
{
	const PointStatus status = field.status[i];
	if (status == PointStatus::TooFewNeighbors || status == PointStatus::Isolated ||
	    status == PointStatus::Invalid)
		return false;
	return !umbilics.singular[i] && (!umbilics.umbilic[i] || umbilics.region[i] >= 0);
}

std::vector<Index> seedsByConfidence(const CurvatureField& field, const UmbilicRegions& umbilics)
{
	std::vector<Index> seeds;
	for (Index i = 0; i < field.size(); ++i)
		if (isSeed(field, umbilics, i))
			seeds.push_back(i);
	std::stable_sort(seeds.begin(), seeds.end(), [&](Index a, Index b) {
		return field.confidence[a] > field.confidence[b];
	});
	return seeds;
}

// In the order of their seeds, the first family first.
LineNetwork merged(const std::array<FamilyTracer, 2>& families)
{
	const auto count =
		static_cast<Index>(families[0].points().size() + families[1].points().size());
	LineNetwork network;
	network.vertices.resize(3, count);
	network.normals.resize(3, count);
	network.curvature.resize(count);
	std::array<std::size_t, 2> line = {0, 0}, point = {0, 0};
	Index                      vertex = 0;
	const auto                 more   = [&](int f) { return line[f] < families[f].lines().size(); };
	while (more(0) || more(1)) {
		const bool          second = !more(0) || (more(1) && families[1].lines()[line[1]].seed <
                                                        families[0].lines()[line[0]].seed);
		const FamilyTracer& family = families[second];
		const TracedLine&   next   = family.lines()[line[second]++];
		for (Index k = 0; k < next.size; ++k, ++vertex) {
			const FlowPoint& from        = family.points()[point[second]++];
			network.vertices.col(vertex) = from.position;
			network.normals.col(vertex)  = from.normal;
			network.curvature[vertex]    = from.curvature;
		}
		network.offsets.push_back(vertex);
		network.family.push_back(second ? 2 : 1);
		network.closed.push_back(next.closed);
		network.ends.push_back(next.ends);
	}
	return network;
}

// A network whose number of crossings is within this of the target (logarithm of their ratio) is not traced
// again; and so often at most. Each attempt is corrected by the ratio of the one before. By experiment.
constexpr double targetTolerance = 0.08;
constexpr int    targetRounds    = 3;

} // namespace

LineNetwork traceLines(
	const PointCloud&           cloud,
	const CurvatureField&       field,
	const MinimumNeighborhoods& minimum,
	const UmbilicRegions&       umbilics,
	const VoronoiCells&         cells,
	const LineTracingOptions&   options,
	const Progress&             progress)
{
	const std::vector<Index> seeds     = seedsByConfidence(field, umbilics);
	const NeighborLists      proximity = proximityGraph(minimum);
	const SurfaceFlow        flow(
        cloud, field, minimum, umbilics, cells, {options.tolerance, options.projection});
	LineNetwork best;
	double      bestMiss = HUGE_VAL, wanted = options.targetVertices;
	const int   rounds = options.targetVertices > 0 ? targetRounds : 1;
	for (int round = 0; round < rounds; ++round) {
		const LineSpacing spacing = chooseLineSpacing(cloud, field, minimum, options, wanted);
		std::array<FamilyTracer, 2> families = {
			FamilyTracer(1, cloud, minimum, proximity, flow, options, spacing),
			FamilyTracer(2, cloud, minimum, proximity, flow, options, spacing)};
		parallelTasks(
			2,
			progress.sub(double(round) / rounds, double(round + 1) / rounds, "Tracing lines"),
			[&](Index f, const Progress& part) { families[f].run(seeds, part); });
		LineNetwork network = merged(families);
		network.epsilon     = spacing.epsilon;
		network.crossings =
			families[0].registry().countCrossings(families[1].registry(), cloud.normals);
		if (options.targetVertices <= 0)
			return network;
		const double found = std::max<Index>(1, network.crossings);
		const double miss  = std::abs(std::log(found / options.targetVertices));
		if (miss < bestMiss) {
			bestMiss = miss;
			best     = std::move(network);
		}
		if (bestMiss < targetTolerance)
			break;
		wanted *= options.targetVertices / found;
	}
	return best;
}

} // namespace curvature_lines
