# SPDX-FileCopyrightText: The promin developers
# SPDX-License-Identifier: Apache-2.0
"""HTML and SVG as nested calls, which close what they open and escape what is text."""

from __future__ import annotations

import html
from collections.abc import Iterable

_WITHOUT_END = {"img", "meta"}


class Markup(str):
    """What is HTML already."""


def element(name: str, /, *content: str, **attributes: object) -> Markup:
    """An element with this content, of which plain text is escaped. An attribute that Python has a word for ends in "_"
    ("class_"), "_" in a name stands for "-"."""
    words = "".join(
        f' {key.rstrip("_").replace("_", "-")}="{html.escape(str(value))}"' for key, value in attributes.items()
    )
    opened = f"<{name}{words}>"
    return Markup(opened if name in _WITHOUT_END else f"{opened}{join(content)}</{name}>")


def join(content: Iterable[str]) -> Markup:
    """One after the other."""
    return Markup("".join(part if isinstance(part, Markup) else html.escape(part) for part in content))


def table(head: Iterable[str], rows: Iterable[Iterable[str]]) -> Markup:
    """A row of headings and rows of cells."""
    heading = element("tr", *(element("th", cell) for cell in head))
    return element("table", heading, *(element("tr", *(element("td", cell) for cell in row)) for row in rows))
