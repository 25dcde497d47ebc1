# SPDX-FileCopyrightText: The promin developers
# SPDX-License-Identifier: Apache-2.0
"""Replaces promin in the farm's own tests. It has only `promin.jobs`, so a farm that imports more of promin
fails."""
