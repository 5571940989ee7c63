// The MeshLab plugin class, and the border no foreign exception crosses: MeshLab's window survives
// MLException and std::bad_alloc only.
// SPDX-License-Identifier: GPL-3.0-or-later
#include "filter_curvature_lines.h"

#include <exception>
#include <map>
#include <new>
#include <string>

#include "filter_results.h"
#include "filter_table.h"
#include "host_progress.h"
#include "progress.h"

using namespace curvature_lines;

namespace {

const FilterSpec& specOf(int id)
{
	if (id < 0 || id >= static_cast<int>(filterTable().size()))
		throw MLException("Curvature lines: unknown filter.");
	return filterTable()[id];
}

// A script that leaves parameters out (written by hand, or for an older version) gets the defaults:
// MeshLab's window passes scripts on as they are.
RichParameterList withDefaults(const RichParameterList& given, RichParameterList complete)
{
	for (const RichParameter& parameter : given) {
		if (!complete.hasParameter(parameter.name()))
			continue; // MeshLab's window adds its global settings
		if (complete.getParameterByName(parameter.name()).value().typeName() !=
		    parameter.value().typeName())
			throw MLException(
				"Parameter '" + parameter.name() + "' has the wrong type: " +
				complete.getParameterByName(parameter.name()).stringType() + " expected.");
		complete.setValue(parameter.name(), parameter.value());
	}
	return complete;
}

} // namespace

FilterCurvatureLines::FilterCurvatureLines()
{
	for (int id = 0; id < static_cast<int>(filterTable().size()); ++id) {
		typeList.push_back(id);
		actionList.push_back(new QAction(filterName(id), this));
	}
}

QString FilterCurvatureLines::pluginName() const
{
	return "FilterCurvatureLines";
}

QString FilterCurvatureLines::vendor() const
{
	return "Curvature Lines";
}

QString FilterCurvatureLines::filterName(ActionIDType id) const
{
	return specOf(id).name;
}

QString FilterCurvatureLines::pythonFilterName(ActionIDType id) const
{
	return specOf(id).pythonName;
}

QString FilterCurvatureLines::filterInfo(ActionIDType id) const
{
	return specOf(id).help;
}

FilterPlugin::FilterClass FilterCurvatureLines::getClass(const QAction* action) const
{
	return FilterClass(specOf(ID(action)).filterClass);
}

FilterPlugin::FilterArity FilterCurvatureLines::filterArity(const QAction* action) const
{
	return specOf(ID(action)).arity;
}

int FilterCurvatureLines::getPreConditions(const QAction* action) const
{
	return specOf(ID(action)).preConditions;
}

int FilterCurvatureLines::postCondition(const QAction* action) const
{
	return specOf(ID(action)).postCondition;
}

RichParameterList
FilterCurvatureLines::initParameterList(const QAction* action, const MeshDocument& document)
{
	return specOf(ID(action)).action.parameters(document);
}

std::map<std::string, QVariant> FilterCurvatureLines::applyFilter(
	const QAction*           action,
	const RichParameterList& given,
	MeshDocument&            document,
	unsigned int&,
	vcg::CallBackPos* callback)
{
	const FilterSpec& spec = specOf(ID(action));
	// Both hosts put the filter's name before it.
	const auto failure = [](const QString& why) {
		return MLException(why.left(1).toUpper() + why.mid(1));
	};
	try {
		const RichParameterList list = withDefaults(given, spec.action.parameters(document));
		FilterResults           results =
			spec.action.apply({document, m_cache, hostProgress(callback)}, list);
		// MeshLab's window drops the dictionary, so the log carries it.
		for (const auto& [key, value] : results.values())
			log("%s: %s", key.c_str(), value.toString().toStdString().c_str());
		for (const std::string& sentence : results.warnings())
			log("Warning: %s", sentence.c_str());
		return results.values();
	}
	catch (const MLException& error) {
		throw failure(error.what());
	}
	catch (const Cancelled&) {
		throw failure("Cancelled; nothing was changed.");
	}
	catch (const std::bad_alloc&) {
		throw failure("Not enough memory; try a smaller or simplified point cloud.");
	}
	catch (const std::exception& error) {
		throw failure(error.what());
	}
	catch (...) {
		throw failure("Failed for an unknown reason; nothing was changed.");
	}
}

MESHLAB_PLUGIN_NAME_EXPORTER(FilterCurvatureLines)
