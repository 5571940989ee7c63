// Lines of curvature traced on the cloud in order of confidence (A09 section 5.1; R07 section 5).
// SPDX-License-Identifier: GPL-3.0-or-later
#include "line_tracing.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Geometry>

#include "line_registry.h"
#include "line_spacing.h"

namespace curvature_lines {

namespace {

using Eigen::Vector3d;

constexpr double MinStep = 0.05, MaxStep = 0.5; // of the local spacing
constexpr double StartStep       = 0.25;        // at least, of the local spacing: see Tracer()
constexpr double SharpTurnCosine = 0.5;         // 60 degrees in one step
constexpr double BridgeCosine    = 0.94;        // 20 degrees at the border of an umbilical region
constexpr double CloudReach      = 1.5;         // local spacings from the closest point
constexpr double VoidWidth       = 2.5;         // local spacings that gaps between points of a random cloud may have
constexpr double VoidSlack       = 1.5;         // local spacings to the closest point beyond one
constexpr double CreaseCosine    = 0.8;         // normals of points next to each other
constexpr double MaxLength       = 10.0;        // diagonals
constexpr double OwnArc          = 3.0;   // own parts closer than this along the line do not count, in d
constexpr double OwnDistance     = 0.9;   // own parts nearer than this stop the line, in stop distances
constexpr double ClosingSpread   = 30.0;  // the offset is spread over so many times its length
constexpr int    RimBisections   = 5;
constexpr Index  ReportEvery     = 1024;

struct FlowPoint {
	Vector3d position, normal, direction; // direction of travel
	double   curvature = 0.0;             // along the line
	Index    cell      = -1;
	double   arc       = 0.0;
	Vector3d inwards   = Vector3d::Zero(); // as SurfaceSample
};

// The axes of an umbilical region come in arbitrary order; that of most of its border keeps the families apart.
std::vector<char> swappedRegions(
	const PointCloud&           cloud,
	const CurvatureField&       field,
	const MinimumNeighborhoods& minimum,
	const UmbilicRegions&       umbilics)
{
	std::vector<double> votes(umbilics.regions, 0.0);
	for (Index i = 0; i < cloud.size(); ++i) {
		const Index region = umbilics.region[i];
		if (region < 0)
			continue;
		for (Index j : minimum.neighbors[i])
			if (!umbilics.umbilic[j] && cloud.normals.col(i).dot(cloud.normals.col(j)) > SharpTurnCosine)
				votes[region] += std::abs(umbilics.d1.col(i).dot(field.d1.col(j))) -
								 std::abs(umbilics.d1.col(i).dot(field.d2.col(j)));
	}
	std::vector<char> swapped(votes.size());
	for (std::size_t r = 0; r < votes.size(); ++r)
		swapped[r] = votes[r] < 0.0;
	return swapped;
}

class Tracer {
public:
	Tracer(
		const PointCloud&           cloud,
		const CurvatureField&       field,
		const MinimumNeighborhoods& minimum,
		const UmbilicRegions&       umbilics,
		const VoronoiCells&         cells,
		const LineTracingOptions&   options,
		const LineSpacing&          spacing);

	LineNetwork run(const Progress& progress);

private:
	using Points = std::vector<FlowPoint>;

	bool               isSeed(Index i) const;
	std::vector<Index> seedsByConfidence() const;
	void               traceThrough(Index seed, const Progress& progress);
	LineEnd            traceHalf(const FlowPoint& start, Points& half, const Progress& progress);
	bool               advance(const FlowPoint& from, FlowPoint& to) const;
	void               reachOut(const FlowPoint& from, Points& half);
	bool     sampleAt(const Vector3d& position, const FlowPoint& previous, FlowPoint& result) const;
	Vector3d directionOf(const SurfaceSample& sample, Index cell) const;
	Vector3d regionDirection(Index cell) const;
	bool     leftCloud(const FlowPoint& point) const;
	LineEnd  edgeAt(Index cell) const;
	bool     endsAtUmbilic(const FlowPoint& from, const FlowPoint& to) const;
	bool     occupied(const FlowPoint& point, bool approachesStart);
	void     registerSegment(const FlowPoint& from, const FlowPoint& to);
	void     closeUp(const FlowPoint& start, Points& half);
	void     append(const Points& line, bool closed, const std::array<LineEnd, 2>& ends);

	Index  currentLine() const { return static_cast<Index>(m_network.family.size()); }
	double distance(Index cell) const { return m_spacing.distance[m_family - 1][cell]; }

	const PointCloud&           m_cloud;
	const CurvatureField&       m_field;
	const MinimumNeighborhoods& m_minimum;
	const UmbilicRegions&       m_umbilics;
	const VoronoiCells&         m_cells;
	const LineTracingOptions&   m_options;
	const LineSpacing&          m_spacing;
	std::vector<double>         m_step;    // N: step before adaptation
	std::vector<char>           m_swapped; // per umbilical region: its d1 continues the d2 around it
	LineRegistry                m_registry;

	// The half line being traced.
	int    m_family = 1;
	double m_side   = 1.0; // +1, then -1: arc lengths of the second half are negative

	std::vector<FlowPoint> m_points; // of all finished lines
	LineNetwork            m_network;
};

Tracer::Tracer(
	const PointCloud&           cloud,
	const CurvatureField&       field,
	const MinimumNeighborhoods& minimum,
	const UmbilicRegions&       umbilics,
	const VoronoiCells&         cells,
	const LineTracingOptions&   options,
	const LineSpacing&          spacing) :
		m_cloud(cloud),
		m_field(field),
		m_minimum(minimum),
		m_umbilics(umbilics),
		m_cells(cells),
		m_options(options),
		m_spacing(spacing),
		m_step(cloud.size()),
		m_swapped(swappedRegions(cloud, field, minimum, umbilics)),
		m_registry(cloud, minimum)
{
	for (Index i = 0; i < cloud.size(); ++i) {
		double nearest2 = HUGE_VAL;
		for (Index j : cells.neighbors(i))
			nearest2 = std::min(nearest2, (cells.site(j) - cells.site(i)).squaredNorm());
		const double local = minimum.spacing[i] > 0.0 ? minimum.spacing[i] : minimum.medianSpacing;
		// A09 starts with half the distance to the nearest point. In random clouds that is often next to
		// nothing, and what a change of the support moves a projected point weighs more than the step.
		m_step[i] = std::clamp(0.5 * std::sqrt(nearest2), StartStep * local, MaxStep * local);
	}
}

bool Tracer::isSeed(Index i) const
{
	const PointStatus status = m_field.status[i];
	if (status == PointStatus::TooFewNeighbors || status == PointStatus::Isolated ||
		status == PointStatus::Invalid)
		return false;
	return !m_umbilics.singular[i] && (!m_umbilics.umbilic[i] || m_umbilics.region[i] >= 0);
}

std::vector<Index> Tracer::seedsByConfidence() const
{
	std::vector<Index> seeds;
	for (Index i = 0; i < m_cloud.size(); ++i)
		if (isSeed(i))
			seeds.push_back(i);
	std::stable_sort(seeds.begin(), seeds.end(), [&](Index a, Index b) {
		return m_field.confidence[a] > m_field.confidence[b];
	});
	return seeds;
}

Vector3d Tracer::regionDirection(Index cell) const
{
	const bool first = (m_family == 1) != bool(m_swapped[m_umbilics.region[cell]]);
	return (first ? m_umbilics.d1 : m_umbilics.d2).col(cell);
}

// The tensor says nothing in umbilical regions; there the axes of the region lead.
Vector3d Tracer::directionOf(const SurfaceSample& sample, Index cell) const
{
	if (m_umbilics.region[cell] < 0)
		return m_family == 1 ? sample.d1 : sample.d2;
	const Vector3d axis = regionDirection(cell);
	return (axis - axis.dot(sample.normal) * sample.normal).normalized();
}

bool Tracer::sampleAt(const Vector3d& position, const FlowPoint& previous, FlowPoint& result) const
{
	const Index         closest = m_cells.locate(position, previous.cell);
	const SurfaceSample sample =
		projectToSurface(m_cloud, m_field, position, closest, m_options.projection);
	result.position  = sample.position;
	result.normal    = sample.normal;
	result.cell      = m_cells.locate(sample.position, closest);
	result.curvature = m_family == 1 ? sample.k1 : sample.k2;
	result.direction = directionOf(sample, closest);
	// Principal directions have no sign: the line keeps its own.
	if (result.direction.dot(previous.direction) < 0.0)
		result.direction = -result.direction;
	result.inwards = sample.inwards;
	return result.direction.dot(previous.direction) > SharpTurnCosine &&
		   result.normal.dot(previous.normal) > SharpTurnCosine;
}

// One step of the second-order scheme A09 uses for its error estimate: along the mean of the directions at
// both ends. The published backward step bends every line inwards by its own error, and closed lines miss
// their start.
bool Tracer::advance(const FlowPoint& from, FlowPoint& to) const
{
	double    step = m_step[from.cell];
	FlowPoint predicted;
	if (!sampleAt(from.position + step * from.direction, from, predicted))
		return false;
	// Delta = |c' - c''| / |c' - c_{i-1}|, with c' along the new direction and c'' along the mean.
	const double delta = 0.5 * (predicted.direction - from.direction).norm();
	if (delta > m_options.tolerance) {
		const double least = MinStep * m_minimum.spacing[from.cell];
		step = std::min(step, std::max(least, step * std::sqrt(m_options.tolerance / delta)));
		if (!sampleAt(from.position + step * from.direction, from, predicted))
			return false;
	}
	const Vector3d chord = 0.5 * step * (from.direction + predicted.direction);
	if (!sampleAt(from.position + chord, from, to))
		return false;
	const double moved = (to.position - from.position).dot(chord) / chord.norm();
	to.arc             = from.arc + m_side * moved;
	return moved > 0.2 * step; // the projection may not undo the step
}

bool Tracer::leftCloud(const FlowPoint& point) const
{
	const double distance = (point.position - m_cloud.positions.col(point.cell)).norm();
	const double local    = m_minimum.spacing[point.cell];
	if (distance > CloudReach * local)
		return true;
	const double aside = point.inwards.norm();
	if (aside < rimOffset || point.inwards.dot(point.direction) > 0.0)
		return false;
	// All points lie behind. At a rim there are none beyond, either.
	const Vector3d beyond = point.position - VoidWidth * local / aside * point.inwards;
	const Index    next   = m_cells.locate(beyond, point.cell);
	const double   around = VoidSlack * std::max(local, m_minimum.spacing[next]);
	return (beyond - m_cells.site(next)).norm() > around ||
		   m_cloud.normals.col(next).dot(point.normal) < SharpTurnCosine;
}

// What ends the surface where the points are all on one side.
LineEnd Tracer::edgeAt(Index cell) const
{
	for (Index j : m_cells.neighbors(cell)) {
		const bool near = (m_cells.site(j) - m_cells.site(cell)).norm() < VoidWidth * m_minimum.spacing[cell];
		const double cosine = m_cloud.normals.col(j).dot(m_cloud.normals.col(cell));
		if (near && cosine < CreaseCosine && cosine > -SharpTurnCosine) // not the other side of a sheet
			return LineEnd::Crease;
	}
	return LineEnd::Rim;
}

// A09 ends lines at umbilics and, from inside a region, at its border, because directions jump there. Where
// they do not (flat parts that go over into singly curved ones, patches that only noise made umbilic) the line
// goes on; ending it would tear the mesh.
bool Tracer::endsAtUmbilic(const FlowPoint& from, const FlowPoint& to) const
{
	if (m_umbilics.singular[to.cell])
		return true;
	const bool border = m_umbilics.region[from.cell] != m_umbilics.region[to.cell];
	const bool single = m_umbilics.umbilic[to.cell] && m_umbilics.region[to.cell] < 0;
	return (border || single) && to.direction.dot(from.direction) < BridgeCosine;
}

bool Tracer::occupied(const FlowPoint& point, bool approachesStart)
{
	const double   d = distance(point.cell);
	ProximityQuery query;
	query.position  = point.position;
	query.normal    = point.normal;
	query.cell      = point.cell;
	query.radius    = m_options.stopFactor * d;
	query.line      = currentLine();
	query.ownRadius = OwnDistance * query.radius;
	if (m_side > 0.0) {
		query.ownFrom = approachesStart ? OwnArc * d : -HUGE_VAL;
		query.ownTo   = point.arc - OwnArc * d;
	}
	else { // all of the first half counts, or the second would run along it
		query.ownFrom = point.arc + OwnArc * d;
		query.ownTo   = HUGE_VAL;
	}
	return m_registry.occupied(m_family, query);
}

void Tracer::registerSegment(const FlowPoint& from, const FlowPoint& to)
{
	m_registry.add(
		m_family,
		{from.position,
		 to.position,
		 (from.normal + to.normal).normalized(),
		 from.cell,
		 to.cell,
		 currentLine(),
		 0.5 * (from.arc + to.arc)});
}

// A step that ended beyond a rim or crease, again as far as it goes this side of it.
void Tracer::reachOut(const FlowPoint& from, Points& half)
{
	const double step = m_step[from.cell];
	FlowPoint    best, tried;
	double       reached = 0.0, beyond = 1.0;
	for (int k = 0; k < RimBisections; ++k) {
		const double middle = 0.5 * (reached + beyond);
		if (sampleAt(from.position + middle * step * from.direction, from, tried) && !leftCloud(tried)) {
			reached = middle;
			best    = tried;
		}
		else {
			beyond = middle;
		}
	}
	const double moved = reached > 0.0 ? (best.position - from.position).dot(from.direction) : 0.0;
	best.arc           = from.arc + m_side * moved;
	if (moved <= MinStep * m_minimum.spacing[from.cell] || occupied(best, false))
		return;
	registerSegment(from, best);
	half.push_back(best);
}

// Follows the field from `start` (not stored) until one of the stops of A09 section 5.1 and of ours: None if
// the line came back to its start.
LineEnd Tracer::traceHalf(const FlowPoint& start, Points& half, const Progress& progress)
{
	FlowPoint front = start, next;
	while (std::abs(front.arc) < MaxLength * m_spacing.diagonal) {
		const bool onwards = advance(front, next);
		if (!onwards || leftCloud(next)) {
			reachOut(front, half);
			return onwards ? edgeAt(next.cell) : LineEnd::Crease;
		}
		if (endsAtUmbilic(front, next))
			return LineEnd::Umbilic;
		// A line that comes back next to its start would be stopped by it. The offset is noise, and closing
		// is better than two ends side by side. It is less than the room other lines leave.
		const Vector3d toStart = start.position - next.position;
		const double   ahead   = toStart.dot(next.direction);
		const double   aside   = (toStart - ahead * next.direction).norm();
		const double   step    = (next.position - front.position).norm();
		const double   d       = std::max(distance(next.cell), 2.0 * step);
		const bool approaches  = m_side > 0.0 && next.arc > 2.0 * step && ahead > 0.0 &&
								ahead < OwnArc * d && aside < OwnDistance * m_options.stopFactor * d &&
								next.direction.dot(start.direction) > SharpTurnCosine;
		if (occupied(next, approaches))
			return LineEnd::Line;
		registerSegment(front, next);
		half.push_back(next);
		if (approaches && ahead < 2.0 * step)
			return LineEnd::None;
		front = next;
		if (half.size() % ReportEvery == 0)
			progress.report(0.0);
	}
	return LineEnd::Length;
}

// The sideways offset of a closed line's end from its start, spread over the last stretch.
void Tracer::closeUp(const FlowPoint& start, Points& half)
{
	const FlowPoint last  = half.back();
	const Vector3d  gap   = start.position - last.position;
	const Vector3d  aside = gap - gap.dot(last.direction) * last.direction;
	const double    from  = std::max(0.0, last.arc - ClosingSpread * aside.norm());
	for (FlowPoint& point : half) {
		if (point.arc <= from)
			continue;
		FlowPoint moved = point;
		if (sampleAt(point.position + (point.arc - from) / (last.arc - from) * aside, point, moved)) {
			moved.arc = point.arc;
			point     = moved;
		}
	}
}

void Tracer::traceThrough(Index seed, const Progress& progress)
{
	FlowPoint start;
	start.cell      = seed;
	start.normal    = m_cloud.normals.col(seed);
	m_side          = 1.0;
	start.direction = m_umbilics.region[seed] >= 0 ?
						  regionDirection(seed) :
						  Vector3d((m_family == 1 ? m_field.d1 : m_field.d2).col(seed));
	if (!sampleAt(m_cloud.positions.col(seed), start, start))
		return;
	ProximityQuery query;
	query.position = start.position;
	query.normal   = start.normal;
	query.cell     = start.cell;
	query.radius   = distance(start.cell);
	if (m_registry.occupied(m_family, query))
		return;

	const Index  known = m_registry.size(m_family);
	Points       line;
	std::array<LineEnd, 2> ends;
	ends[1]             = traceHalf(start, line, progress);
	const bool   closed = ends[1] == LineEnd::None;
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
	m_registry.truncate(m_family, known);
	if (line.back().arc - line.front().arc < distance(seed))
		return; // too short to cross two lines of the other family
	for (std::size_t k = 0; k + 1 < line.size(); ++k)
		registerSegment(line[k], line[k + 1]);
	if (closed) {
		FlowPoint end = start;
		end.arc       = line.back().arc + (start.position - line.back().position).norm();
		registerSegment(line.back(), end);
	}
	append(line, closed, ends);
}

void Tracer::append(const Points& line, bool closed, const std::array<LineEnd, 2>& ends)
{
	m_points.insert(m_points.end(), line.begin(), line.end());
	m_network.offsets.push_back(static_cast<Index>(m_points.size()));
	m_network.family.push_back(m_family);
	m_network.closed.push_back(closed);
	m_network.ends.push_back(ends);
}

LineNetwork Tracer::run(const Progress& progress)
{
	const std::vector<Index> seeds = seedsByConfidence();
	for (std::size_t k = 0; k < seeds.size(); ++k) {
		const Progress here = progress.sub(double(k) / seeds.size(), 1.0, "Tracing lines");
		if (k % ReportEvery == 0)
			here.report(0.0);
		for (m_family = 1; m_family <= 2; ++m_family)
			traceThrough(seeds[k], here);
	}
	const Index count = static_cast<Index>(m_points.size());
	m_network.vertices.resize(3, count);
	m_network.normals.resize(3, count);
	m_network.curvature.resize(count);
	for (Index i = 0; i < count; ++i) {
		m_network.vertices.col(i) = m_points[i].position;
		m_network.normals.col(i)  = m_points[i].normal;
		m_network.curvature[i]    = m_points[i].curvature;
	}
	m_network.epsilon   = m_spacing.epsilon;
	m_network.crossings = m_registry.countCrossings(m_cloud.normals);
	return std::move(m_network);
}

// A traced network within so much of the target is not traced again.
constexpr double TargetTolerance = 0.08;
constexpr int    TargetRounds    = 3;

} // namespace

Eigen::VectorXd arcLengths(const LineNetwork& lines)
{
	Eigen::VectorXd arc(lines.vertices.cols());
	for (Index l = 0; l < lines.lines(); ++l)
		for (Index v = lines.offsets[l]; v < lines.offsets[l + 1]; ++v)
			arc[v] = v == lines.offsets[l] ?
						 0.0 :
						 arc[v - 1] + (lines.vertices.col(v) - lines.vertices.col(v - 1)).norm();
	return arc;
}

LineNetwork traceLines(
	const PointCloud&           cloud,
	const CurvatureField&       field,
	const MinimumNeighborhoods& minimum,
	const UmbilicRegions&       umbilics,
	const VoronoiCells&         cells,
	const LineTracingOptions&   options,
	const Progress&             progress)
{
	LineNetwork best;
	double      bestMiss = HUGE_VAL, wanted = options.targetVertices;
	const int   rounds   = options.targetVertices > 0 ? TargetRounds : 1;
	for (int round = 0; round < rounds; ++round) {
		const LineSpacing spacing = chooseLineSpacing(cloud, field, minimum, options, wanted);
		Tracer      tracer(cloud, field, minimum, umbilics, cells, options, spacing);
		LineNetwork network = tracer.run(
			progress.sub(double(round) / rounds, double(round + 1) / rounds, "Tracing lines"));
		if (options.targetVertices <= 0)
			return network;
		const double found = std::max<Index>(1, network.crossings);
		const double miss  = std::abs(std::log(found / options.targetVertices));
		if (miss < bestMiss) {
			bestMiss = miss;
			best     = std::move(network);
		}
		if (bestMiss < TargetTolerance)
			break;
		wanted *= options.targetVertices / found;
	}
	return best;
}

} // namespace curvature_lines
