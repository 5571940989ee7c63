# Other tools that estimate curvature, each in a process of its own.
# SPDX-License-Identifier: GPL-3.0-or-later
