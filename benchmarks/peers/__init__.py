# Other tools on the same clouds, each in a process of its own, and the columns of our tables that they fill.
# SPDX-License-Identifier: GPL-3.0-or-later
