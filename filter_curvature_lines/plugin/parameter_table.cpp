// What each kind of parameter is to the host, and which values it allows.
// SPDX-License-Identifier: GPL-3.0-or-later
#include "parameter_table.h"

#include <cmath>
#include <limits>

#include <Eigen/Core>

#include <common/mlexception.h>

#include "host_types.h"
#include "point_cloud.h"

namespace curvature_lines {

namespace {

// Floats arrive in single precision (relative error 6e-8): a bound that is not a float must still be reachable.
constexpr double slack = 1e-6;

MLException outOfRange(const QString& name, const QString& value, const QString& allowed)
{
	return MLException(
		"parameter '" + name + "' is " + value + "; allowed are values " + allowed + ".");
}

template<class Number>
QString between(Number min, Number max)
{
	return QString("from %1 to %2").arg(min).arg(max);
}

template<class HostParameter, class HostValue>
void add(RichParameterList& list, const ParameterText& text, const HostValue& value)
{
	list.addParam(HostParameter(text.name, value, text.label, text.help, text.advanced));
}

Eigen::Vector3d finitePoint(const RichParameterList& given, const QString& name)
{
	const Eigen::Vector3d point = toEigen(given.getPoint3m(name));
	if (!point.allFinite())
		throw outOfRange(name, "not finite", "three numbers");
	return point;
}

} // namespace

void Flag::declare(RichParameterList& list, const ParameterText& text, bool value) const
{
	add<RichBool>(list, text, value);
}

bool Flag::read(const RichParameterList& given, const QString& name) const
{
	return given.getBool(name);
}

void Integer::declare(RichParameterList& list, const ParameterText& text, Index value) const
{
	add<RichInt>(list, text, value);
}

Index Integer::read(const RichParameterList& given, const QString& name) const
{
	const int value = given.getInt(name);
	if (value < min || value > max)
		throw outOfRange(name, QString::number(value), between(min, max));
	return value;
}

void Real::declare(RichParameterList& list, const ParameterText& text, double value) const
{
	add<RichFloat>(list, text, Scalarm(value));
}

double Real::read(const RichParameterList& given, const QString& name) const
{
	const double value = given.getFloat(name);
	if (!(value >= min - slack * std::abs(min) && value <= max + slack * std::abs(max)))
		throw outOfRange(name, QString::number(value), between(min, max));
	return value;
}

void AutomaticOr::declare(RichParameterList& list, const ParameterText& text, double value) const
{
	add<RichFloat>(list, text, Scalarm(value));
}

double AutomaticOr::read(const RichParameterList& given, const QString& name) const
{
	const double value = given.getFloat(name);
	if (value != 0.0 && !(value >= min && value <= max))
		throw outOfRange(name, QString::number(value), "of 0 (automatic) and " + between(min, max));
	return value;
}

void Length::declare(RichParameterList& list, const ParameterText& text, double value) const
{
	add<RichFloat>(list, text, Scalarm(value));
}

double Length::read(const RichParameterList& given, const QString& name) const
{
	const double value = given.getFloat(name);
	if (!(value >= 0.0 && value <= std::numeric_limits<float>::max()))
		throw outOfRange(name, QString::number(value), "of 0 (automatic) or more");
	return value;
}

void Choice::declare(RichParameterList& list, const ParameterText& text, int value) const
{
	list.addParam(RichEnum(text.name, value, labels, text.label, text.help, text.advanced));
}

int Choice::read(const RichParameterList& given, const QString& name) const
{
	const int value = given.getEnum(name);
	if (value < 0 || value >= labels.size())
		throw outOfRange(
			name,
			QString::number(value),
			QString("from 0 to %1 (%2)").arg(labels.size() - 1).arg(labels.join(", ")));
	return value;
}

void Layer::declare(RichParameterList& list, const ParameterText& text, int value) const
{
	list.addParam(RichMesh(text.name, value, &document, text.label, text.help, text.advanced));
}

int Layer::read(const RichParameterList& given, const QString& name) const
{
	return static_cast<int>(given.getMeshId(name));
}

void SaveFile::declare(
	RichParameterList& list, const ParameterText& text, const QString& value) const
{
	list.addParam(RichFileSave(text.name, value, pattern, text.label, text.help, text.advanced));
}

QString SaveFile::read(const RichParameterList& given, const QString& name) const
{
	return given.getParameterByName(name).value().getString();
}

void Color::declare(RichParameterList& list, const ParameterText& text, const Type& value) const
{
	add<RichColor>(list, text, QColor::fromRgbF(value.x(), value.y(), value.z()));
}

Eigen::Vector3d Color::read(const RichParameterList& given, const QString& name) const
{
	const QColor color = given.getColor(name);
	return {color.redF(), color.greenF(), color.blueF()};
}

void Position::declare(RichParameterList& list, const ParameterText& text, const Type& value) const
{
	add<RichPosition>(list, text, toPoint(value));
}

Eigen::Vector3d Position::read(const RichParameterList& given, const QString& name) const
{
	return finitePoint(given, name);
}

void Direction::declare(RichParameterList& list, const ParameterText& text, const Type& value) const
{
	add<RichDirection>(list, text, toPoint(value));
}

Eigen::Vector3d Direction::read(const RichParameterList& given, const QString& name) const
{
	return finitePoint(given, name);
}

} // namespace curvature_lines
