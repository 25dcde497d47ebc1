# SPDX-FileCopyrightText: The promin developers
# SPDX-License-Identifier: Apache-2.0
"""promin-farm: jobs of promin on many processes and machines, by Dask or by any queue. docs/farm.md tells how.

It knows which piece is made where, again, and how long that takes; what a piece is knows `promin.jobs`, the one module
of promin that it imports. All truth is in the job's folder: whoever is ended, by whatever, `promin-farm resume` goes
on."""
