# Turns the plain comments of our headers into ones that Doxygen reads; it sees no others. The text is meant literally.
# SPDX-License-Identifier: GPL-3.0-or-later

# What Doxygen takes for a command, a tag or a link, but not between backquotes, where it takes nothing.
function literal(text,    parts, i, result)
{
	n = split(text, parts, "`")
	for (i = 1; i <= n; ++i) {
		if (i % 2 == 1)
			gsub(/[\\@<>#%&*_]/, "\\\\&", parts[i])
		result = result (i > 1 ? "`" : "") parts[i]
	}
	return result
}

BEGIN { head = 1 }

# The first lines say what the file is for.
head && /^\/\/ SPDX/ { print "//"; next }
head && /^\/\/ / {
	print (NR == 1 ? "/// \\file\n/// " : "/// ") literal(substr($0, 4))
	next
}
{ head = 0 }

# A line of its own is about what follows, unless it goes on with the remark at the end of the line before.
/^[\t ]*\/\// {
	at = index($0, "//")
	mark = remark && substr($0, 1, at - 1) ~ / $/ ? "///< " : "/// "
	print substr($0, 1, at - 1) mark literal(substr($0, at + 3))
	next
}
/[^\t ].*\/\/ / && !/^#/ && !/^}/ {
	at = index($0, "// ")
	print substr($0, 1, at - 1) "///< " literal(substr($0, at + 3))
	remark = 1
	next
}
{ print; remark = 0 }
