# What is measured of a result, against the truth that its cloud brings along, never by the filter's own report.
# SPDX-License-Identifier: GPL-3.0-or-later
