// The parameters of a filter, each declared once: a row names the member of the filter's options that the parameter
// sets. The dialog and the validated reader follow from the rows, and through the host the filter scripts and type stubs.
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <type_traits>

#include <Eigen/Core>

#include <common/ml_document/mesh_document.h>
#include <common/parameters/rich_parameter_list.h>

#include "point_cloud.h"

namespace curvature_lines {

// Last argument of a row: the dialog shows the parameter only on request.
constexpr bool advancedParameter = true;

struct ParameterText {
	QString name, label, help; // help: HTML
	bool    advanced = false;
};

// The kinds of parameters. Each can declare itself with a default, and read what the user gave. Reading throws an
// MLException that names the parameter and what is allowed: hosts give numbers no range.

struct Flag {
	using Type = bool;
	void declare(RichParameterList& list, const ParameterText& text, bool value) const;
	bool read(const RichParameterList& given, const QString& name) const;
};

struct Integer {
	using Type = Index;
	Index min, max;
	void declare(RichParameterList& list, const ParameterText& text, Index value) const;
	Index read(const RichParameterList& given, const QString& name) const;
};

struct Real {
	using Type = double;
	double min, max;
	void declare(RichParameterList& list, const ParameterText& text, double value) const;
	double read(const RichParameterList& given, const QString& name) const;
};

// 0 = automatic, or a value between the bounds.
struct AutomaticOr {
	using Type = double;
	double min, max;
	void declare(RichParameterList& list, const ParameterText& text, double value) const;
	double read(const RichParameterList& given, const QString& name) const;
};

// In model units, 0 = automatic.
struct Length {
	using Type = double;
	void declare(RichParameterList& list, const ParameterText& text, double value) const;
	double read(const RichParameterList& given, const QString& name) const;
};

// An enumeration; its values 0, 1, 2, ... have these labels.
struct Choice {
	using Type = int;
	QStringList labels;
	void declare(RichParameterList& list, const ParameterText& text, int value) const;
	int read(const RichParameterList& given, const QString& name) const;
};

// Id of a layer, which may not exist.
struct Layer {
	using Type = int;
	const MeshDocument& document;
	void declare(RichParameterList& list, const ParameterText& text, int value) const;
	int read(const RichParameterList& given, const QString& name) const;
};

// Path of a file to be written.
struct SaveFile {
	using Type = QString;
	QString pattern; // such as *.png
	void declare(RichParameterList& list, const ParameterText& text, const QString& value) const;
	QString read(const RichParameterList& given, const QString& name) const;
};

// Red, green, blue, 0..1.
struct Color {
	using Type = Eigen::Vector3d;
	void declare(RichParameterList& list, const ParameterText& text, const Type& value) const;
	Type read(const RichParameterList& given, const QString& name) const;
};

// In the layer's coordinates, finite.
struct Position {
	using Type = Eigen::Vector3d;
	void declare(RichParameterList& list, const ParameterText& text, const Type& value) const;
	Type read(const RichParameterList& given, const QString& name) const;
};

// Of any length, finite.
struct Direction {
	using Type = Eigen::Vector3d;
	void declare(RichParameterList& list, const ParameterText& text, const Type& value) const;
	Type read(const RichParameterList& given, const QString& name) const;
};

// Goes over the rows of a filter, a function `void parameters(ParameterTable&, Options&)`, to declare or to read them.
// Options are default-constructed before: when a row is declared, the value of its member is the default.
class ParameterTable {
public:
	explicit ParameterTable(const MeshDocument& document) : m_document(document) {}
	ParameterTable(const MeshDocument& document, const RichParameterList& given) :
			m_document(document), m_given(&given)
	{
	}

	template<class Member, class Kind>
	void
	row(const QString& name,
	    Member&        member,
	    const Kind&    kind,
	    const QString& label,
	    const QString& help,
	    bool           advanced = false)
	{
		using Type = typename Kind::Type;
		static_assert(std::is_same_v<Member, Type> || std::is_enum_v<Member>);
		if (m_given != nullptr)
			member = static_cast<Member>(kind.read(*m_given, name));
		else
			kind.declare(m_declared, {name, label, help, advanced}, static_cast<Type>(member));
	}

	const MeshDocument& document() const { return m_document; }
	const RichParameterList& declared() const { return m_declared; }

private:
	const MeshDocument&      m_document;
	const RichParameterList* m_given = nullptr; // null: declare
	RichParameterList        m_declared;
};

} // namespace curvature_lines
