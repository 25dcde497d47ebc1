# SPDX-FileCopyrightText: The promin developers
# SPDX-License-Identifier: Apache-2.0
"""Writes the scenes in scenes/. Only python3 and its standard library are needed."""
