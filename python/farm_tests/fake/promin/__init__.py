# SPDX-FileCopyrightText: The promin developers
# SPDX-License-Identifier: Apache-2.0
"""Stands in for promin in the farm's own tests: it has `promin.jobs` and nothing else, so that a farm that imports more
of promin does not run."""
