// Validated parameters and shared declarations.
// SPDX-License-Identifier: GPL-3.0-or-later
#include "parameters.h"

#include <cmath>
#include <limits>

#include <common/mlexception.h>

namespace curvature_lines {

namespace {

// Floats arrive in single precision: a bound that is not a float must still be reachable.
constexpr double slack = 1e-6;

MLException outOfRange(const QString& name, const QString& value, const QString& allowed)
{
	return MLException(
		"parameter '" + name + "' is " + value + "; allowed are values " + allowed + ".");
}

} // namespace

bool Parameters::flag(const QString& name) const
{
	return m_list.getBool(name);
}

Index Parameters::integer(const QString& name, int min, int max) const
{
	const int value = m_list.getInt(name);
	if (value < min || value > max)
		throw outOfRange(name, QString::number(value), QString("from %1 to %2").arg(min).arg(max));
	return value;
}

double Parameters::real(const QString& name, double min, double max) const
{
	const double value = m_list.getFloat(name);
	if (!(value >= min - slack * std::abs(min) && value <= max + slack * std::abs(max)))
		throw outOfRange(name, QString::number(value), QString("from %1 to %2").arg(min).arg(max));
	return value;
}

double Parameters::automaticOr(const QString& name, double min, double max) const
{
	const double value = m_list.getFloat(name);
	if (value != 0.0 && !(value >= min && value <= max))
		throw outOfRange(
			name,
			QString::number(value),
			QString("of 0 (automatic) and from %1 to %2").arg(min).arg(max));
	return value;
}

double Parameters::length(const QString& name) const
{
	const double value = m_list.getFloat(name);
	if (!(value >= 0.0 && value <= std::numeric_limits<float>::max()))
		throw outOfRange(name, QString::number(value), "of 0 (automatic) or more");
	return value;
}

int Parameters::choice(const QString& name) const
{
	const int         value   = m_list.getEnum(name);
	const auto*       choices = dynamic_cast<const RichEnum*>(&m_list.getParameterByName(name));
	const QStringList labels  = choices ? choices->enumvalues : QStringList();
	if (value < 0 || value >= labels.size())
		throw outOfRange(
			name,
			QString::number(value),
			QString("from 0 to %1 (%2)").arg(labels.size() - 1).arg(labels.join(", ")));
	return value;
}

int Parameters::layerId(const QString& name) const
{
	return static_cast<int>(m_list.getMeshId(name));
}

QString Parameters::text(const QString& name) const
{
	const RichParameter& parameter = m_list.getParameterByName(name);
	return parameter.value().getString();
}

Eigen::Vector3d Parameters::color(const QString& name) const
{
	const QColor color = m_list.getColor(name);
	return {color.redF(), color.greenF(), color.blueF()};
}

Eigen::Vector3d Parameters::point(const QString& name) const
{
	const Point3m         p = m_list.getPoint3m(name);
	const Eigen::Vector3d point(p[0], p[1], p[2]);
	if (!point.allFinite())
		throw outOfRange(name, "not finite", "three numbers");
	return point;
}

void addScaleMode(RichParameterList& list, bool advanced)
{
	list.addParam(RichEnum(
		"scale_mode",
		static_cast<int>(CurvatureOptions().scaleMode),
		QStringList() << "Adaptive"
					  << "Paper",
		"Scale",
		"How large the region is that each estimate looks at.<ul>"
		"<li><b>Adaptive</b>: found from the cloud, around every point: as large as the noise asks "
		"for and as small as the shape does</li>"
		"<li><b>Paper</b>: a fixed number of local point spacings, as published</li></ul>",
		advanced));
}

ScaleMode scaleMode(const Parameters& parameters)
{
	return static_cast<ScaleMode>(parameters.choice("scale_mode"));
}

void addEstimateParameters(RichParameterList& list)
{
	const EstimateOptions defaults;
	addScaleMode(list, false);
	list.addParam(RichFloat(
		"region_scale",
		Scalarm(defaults.curvature.paper.regionScale),
		"Region scale (Paper; spacings)",
		"With Scale Paper only: radius of the operating region around each point, in local point "
		"spacings (1 to 20). Larger regions resist more noise and blur more detail."));
	list.addParam(RichInt(
		"max_iterations",
		defaults.curvature.paper.maxIterations,
		"Maximum iterations (Paper)",
		"With Scale Paper only: largest number of reweighting iterations per point (1 to 1000).",
		true));
	list.addParam(RichBool(
		"feature_gate",
		defaults.curvature.paper.featureGate,
		"Feature gate (Paper)",
		"With Scale Paper only: keep only neighbours that agree with the point itself before the "
		"fit, so that the other side of a sharp edge has no influence.",
		true));
	list.addParam(RichFloat(
		"boundary_threshold",
		Scalarm(defaults.neighborhood.boundaryThreshold),
		"Boundary threshold (spacings)",
		"A sixth of the tangent plane counts as empty when its closest point is farther than this "
		"many median point spacings (1 to 100); two neighbouring empty sixths make a boundary "
		"point.",
		true));
}

EstimateOptions estimateOptions(const Parameters& parameters)
{
	EstimateOptions options;
	options.curvature.scaleMode            = scaleMode(parameters);
	options.curvature.paper.regionScale    = parameters.real("region_scale", 1.0, 20.0);
	options.curvature.paper.maxIterations  = parameters.integer("max_iterations", 1, 1000);
	options.curvature.paper.featureGate    = parameters.flag("feature_gate");
	options.neighborhood.boundaryThreshold = parameters.real("boundary_threshold", 1.0, 100.0);
	return options;
}

void addUmbilicRatio(RichParameterList& list)
{
	list.addParam(RichFloat(
		"umbilic_ratio",
		Scalarm(UmbilicOptions().ratio),
		"Umbilic ratio (0 to 1)",
		"A point is umbilic, without principal directions of its own, when the smaller curvature "
		"is more than this share of the larger one (0 to 1).",
		true));
}

double umbilicRatio(const Parameters& parameters)
{
	return parameters.real("umbilic_ratio", 0.0, 1.0);
}

} // namespace curvature_lines
