// The MeshLab plugin: every virtual looks its answer up in the table of filters (filter_table.h).
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <map>
#include <string>

#include <common/plugins/interfaces/filter_plugin.h>

#include "curvature_cache.h"

class FilterCurvatureLines : public QObject, public FilterPlugin {
	Q_OBJECT
	MESHLAB_PLUGIN_IID_EXPORTER(FILTER_PLUGIN_IID)
	Q_INTERFACES(FilterPlugin)

public:
	FilterCurvatureLines();

	QString pluginName() const override;
	QString vendor() const override;

	// The versions that take a QAction look the id up and end here.
	using FilterPlugin::filterInfo;
	using FilterPlugin::filterName;
	using FilterPlugin::pythonFilterName;
	QString filterName(ActionIDType id) const override;
	QString pythonFilterName(ActionIDType id) const override;
	QString filterInfo(ActionIDType id) const override;

	FilterClass getClass(const QAction* action) const override;
	FilterArity filterArity(const QAction* action) const override;
	int getPreConditions(const QAction* action) const override;
	int postCondition(const QAction* action) const override;

	using FilterPlugin::initParameterList;
	RichParameterList
	initParameterList(const QAction* action, const MeshDocument& document) override;

	std::map<std::string, QVariant> applyFilter(
		const QAction*           action,
		const RichParameterList& given,
		MeshDocument&            document,
		unsigned int&            postConditionMask,
		vcg::CallBackPos*        callback) override;

private:
	curvature_lines::CurvatureCache m_cache;
};
