# The machinery that every table shares: command line, comparison over seeds, verdicts, Markdown, cost of a filter.
# Nothing here knows a surface, a peer or a table.
# SPDX-License-Identifier: GPL-3.0-or-later
