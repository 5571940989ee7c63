// A struct as the tuple of its members.
// SPDX-License-Identifier: GPL-3.0-or-later
#include "members.h"

#include <gtest/gtest.h>

namespace curvature_lines {
namespace {

struct Two {
	int  a = 1;
	bool b = true;
};

struct Three {
	double a = 1.0;
	Two    b;
	int    c = 3;
};

bool operator==(const Two& x, const Two& y)
{
	return members<2>(x) == members<2>(y);
}

TEST(Members, AreReferencesInOrder)
{
	const Three s;
	EXPECT_EQ(&std::get<0>(members<3>(s)), &s.a);
	EXPECT_EQ(&std::get<1>(members<3>(s)), &s.b);
	EXPECT_EQ(&std::get<2>(members<3>(s)), &s.c);
}

TEST(Members, DifferWhereAnyMemberDoes)
{
	const Three same;
	for (int member = 0; member < 4; ++member) {
		Three other;
		EXPECT_TRUE(members<3>(other) == members<3>(same));
		if (member == 0)
			other.a = 2.0;
		else if (member == 1)
			other.b.a = 2;
		else if (member == 2)
			other.b.b = false;
		else
			other.c = 4;
		EXPECT_FALSE(members<3>(other) == members<3>(same)) << member;
	}
}

} // namespace
} // namespace curvature_lines
