// Reading of parameters with validation (MeshLab gives ints and floats no range), and the
// declarations several filters share.
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <common/parameters/rich_parameter_list.h>

#include "curvature_cache.h"

namespace curvature_lines {

// Every reader throws an MLException that names the parameter and what is allowed.
class Parameters {
public:
	explicit Parameters(const RichParameterList& list) : m_list(list) {}

	bool flag(const QString& name) const;
	Index integer(const QString& name, int min, int max) const;
	double real(const QString& name, double min, double max) const;
	// 0 = automatic, or a value between the bounds.
	double automaticOr(const QString& name, double min, double max) const;
	// A length in model units, 0 = automatic.
	double length(const QString& name) const;
	// Position in the list of labels.
	int choice(const QString& name) const;
	int layerId(const QString& name) const;
	QString text(const QString& name) const;
	Eigen::Vector3d color(const QString& name) const; // red, green, blue, 0..1
	Eigen::Vector3d point(const QString& name) const; // finite

private:
	RichParameterList m_list;
};

// Adaptive or published.
void addScaleMode(RichParameterList& list, bool advanced);
ScaleMode scaleMode(const Parameters& parameters);

// The knobs of the curvature estimate, scale mode included.
void addEstimateParameters(RichParameterList& list);
EstimateOptions estimateOptions(const Parameters& parameters);

void addUmbilicRatio(RichParameterList& list);
double umbilicRatio(const Parameters& parameters);

} // namespace curvature_lines
