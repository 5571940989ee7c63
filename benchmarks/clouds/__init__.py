# The clouds that the tables are made of, each with the truth it is judged by: generated ones and scans.
# SPDX-License-Identifier: GPL-3.0-or-later
