// One table of filters: what each is called, where MeshLab lists it, what it takes and does.
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <functional>
#include <vector>

#include <common/plugins/interfaces/filter_plugin.h>

#include "curvature_cache.h"
#include "filter_results.h"
#include "parameter_table.h"
#include "progress.h"

namespace curvature_lines {

struct FilterContext {
	MeshDocument&   document;
	CurvatureCache& cache;
	Progress        progress;
};

// What a filter takes and does: the rows of its parameters, and the function that gets the options they set.
class FilterAction {
public:
	// `rows` must be cheap and never throw but in reading: hosts ask for the parameters of documents without a usable
	// layer, too. `apply` reads the layer, calls core and writes the layer; when it throws, the document is untouched.
	template<class Options>
	FilterAction(
		void (*rows)(ParameterTable&, Options&),
		FilterResults (*apply)(const FilterContext&, const Options&)) :
			m_declare([rows](ParameterTable& table) {
				Options defaults;
				rows(table, defaults);
			}),
			m_apply([rows, apply](const FilterContext& context, const RichParameterList& given) {
				ParameterTable table(context.document, given);
				Options        options;
				rows(table, options);
				return apply(context, options);
			})
	{
	}

	// With their defaults for this document.
	RichParameterList parameters(const MeshDocument& document) const
	{
		ParameterTable table(document);
		m_declare(table);
		return table.declared();
	}
	// `given`: every parameter. Throws an MLException if one is out of range.
	FilterResults apply(const FilterContext& context, const RichParameterList& given) const
	{
		return m_apply(context, given);
	}

private:
	std::function<void(ParameterTable&)>                                         m_declare;
	std::function<FilterResults(const FilterContext&, const RichParameterList&)> m_apply;
};

struct FilterSpec {
	QString                   name; // menu text and key in .mlx files: never change it
	QString                   pythonName;
	QString                   summary;     // one line of plain text, for lists
	QString                   help;        // HTML
	int                       filterClass; // FilterPlugin::FilterClass, or-ed
	FilterPlugin::FilterArity arity;
	int                       preConditions, postCondition; // MeshModel::MeshElement, or-ed
	FilterAction              action;
};

// A filter's id is its position.
const std::vector<FilterSpec>& filterTable();

} // namespace curvature_lines
