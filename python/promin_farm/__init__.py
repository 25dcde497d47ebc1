# SPDX-FileCopyrightText: The promin developers
# SPDX-License-Identifier: Apache-2.0
"""promin-farm runs jobs of promin on many processes and machines, with Dask or any queue (docs/farm.md).

It decides where each piece is made, when it is made again, and measures the time. `promin.jobs`, the only module of
promin that it imports, knows the contents of pieces. The whole state is in the job's folder. `promin-farm resume`
therefore continues a job however it ended."""
