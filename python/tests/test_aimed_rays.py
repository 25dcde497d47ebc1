# SPDX-FileCopyrightText: The promin developers
# SPDX-License-Identifier: Apache-2.0
"""Rays that are aimed at corners and edges of closed meshes, near and far. No ray slips through, and parities are
right."""

from __future__ import annotations

from itertools import islice

import numpy as np
import peers
import pytest
from conftest import make_box


def hold(count: int, levels: int) -> None:
    for vertices, faces in (make_box(), peers.make_ball(levels)):
        origins, directions = peers.aim(vertices, faces, count)
        for offset in (0.0, 1e4, 1e6):
            away = np.array([offset, offset, -offset])
            for peer in islice(peers.make_peers(vertices + away, faces), 2):
                assert peers.find_wrong(peer, origins + away, directions) == (0, 0, count), (offset, peer.name)


def test_aimed_rays() -> None:
    hold(20000, 3)


@pytest.mark.long
def test_a_million_aimed_rays() -> None:
    hold(10**6, 5)
