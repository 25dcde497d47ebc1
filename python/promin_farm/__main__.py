# SPDX-FileCopyrightText: The promin developers
# SPDX-License-Identifier: Apache-2.0
"""`python -m promin_farm` is `promin-farm`."""

import sys

from promin_farm.command import main

if __name__ == "__main__":
    sys.exit(main())
