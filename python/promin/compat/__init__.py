# SPDX-FileCopyrightText: The promin developers
# SPDX-License-Identifier: Apache-2.0
"""promin behind the interfaces of other libraries: `promin.compat.trimesh` and `promin.compat.open3d`."""
