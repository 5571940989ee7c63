// Members that are computed when they are first asked for.
// SPDX-License-Identifier: GPL-3.0-or-later
#include "cloud_index.h"

#include <memory>
#include <mutex>
#include <utility>
#include <vector>

#include <Eigen/Core>

#include "gate_normals.h"
#include "local_spacing.h"
#include "neighborhoods.h"
#include "point_cloud.h"
#include "progress.h"
#include "spatial_order.h"

namespace curvature_lines {

namespace {

// A value that the first to ask for it computes; others wait. When `make` throws, the next one tries again.
template<class Value>
class OnDemand {
public:
	template<class Make>
	const Value& get(const Make& make) const
	{
		std::call_once(m_once, [&] { m_value = std::make_unique<const Value>(make()); });
		return *m_value;
	}

private:
	mutable std::once_flag               m_once;
	mutable std::unique_ptr<const Value> m_value;
};

} // namespace

struct CloudIndex::State {
	std::shared_ptr<const PointCloud> cloud;
	MinimumNeighborhoodOptions        options;

	OnDemand<SpatialOrder>         order;
	OnDemand<std::vector<Index>>   shuffled;
	OnDemand<Eigen::Matrix3Xd>     arranged;
	OnDemand<NeighborSearch>       search, arrangedSearch, shuffledSearch;
	OnDemand<std::vector<double>>  spacing;
	OnDemand<Eigen::Matrix3Xd>     gateNormals;
	OnDemand<MinimumNeighborhoods> minimum;
};

CloudIndex::CloudIndex(PointCloud cloud, const MinimumNeighborhoodOptions& options)
{
	m_cloud        = std::make_shared<const PointCloud>(std::move(cloud));
	auto state     = std::make_shared<State>();
	state->cloud   = m_cloud;
	state->options = options;
	m_state        = std::move(state);
}

CloudIndex CloudIndex::moved(Eigen::Matrix3Xd positions, Eigen::Matrix3Xd normals) const
{
	return CloudIndex({std::move(positions), std::move(normals)}, m_state->options);
}

CloudIndex CloudIndex::withNormals(Eigen::Matrix3Xd normals) const
{
	CloudIndex other = *this;
	other.m_cloud =
		std::make_shared<const PointCloud>(PointCloud{cloud().positions, std::move(normals)});
	return other;
}

CloudIndex CloudIndex::part(const std::vector<Index>& which) const
{
	return CloudIndex(columnsOf(cloud(), which), m_state->options);
}

const SpatialOrder& CloudIndex::order() const
{
	return m_state->order.get([&] { return SpatialOrder(cloud().positions); });
}

const std::vector<Index>& CloudIndex::shuffled() const
{
	return m_state->shuffled.get([&] {
		std::vector<Index> points(size());
		for (Index place = 0; place < size(); ++place)
			points[order().rank[place]] = order().source[place];
		return points;
	});
}

const Eigen::Matrix3Xd& CloudIndex::arrangedPositions() const
{
	return m_state->arranged.get([&] { return order().arrange(cloud().positions); });
}

const NeighborSearch& CloudIndex::arrangedSearch() const
{
	return m_state->arrangedSearch.get([&] { return NeighborSearch(arrangedPositions()); });
}

const NeighborSearch& CloudIndex::search() const
{
	return m_state->search.get([&] { return NeighborSearch(arrangedSearch(), order().source); });
}

const NeighborSearch& CloudIndex::shuffledSearch() const
{
	return m_state->shuffledSearch.get(
		[&] { return NeighborSearch(arrangedSearch(), order().rank); });
}

const std::vector<double>& CloudIndex::spacing(const Progress& progress) const
{
	return m_state->spacing.get(
		[&] { return localSpacing(arrangedPositions(), arrangedSearch(), order(), progress); });
}

const Eigen::Matrix3Xd& CloudIndex::gateNormals(const Progress& progress) const
{
	return m_state->gateNormals.get(
		[&] { return curvature_lines::gateNormals(*m_state->cloud, search(), progress); });
}

const MinimumNeighborhoods& CloudIndex::minimum(const Progress& progress) const
{
	return m_state->minimum.get([&] {
		return minimumNeighborhoods(*m_state->cloud, search(), m_state->options, progress);
	});
}

} // namespace curvature_lines
