# SPDX-FileCopyrightText: The promin developers
# SPDX-License-Identifier: Apache-2.0
"""HTML and SVG as nested function calls. The functions close their elements and escape text."""

from __future__ import annotations

import html
from collections.abc import Iterable

_WITHOUT_END = {"img", "meta"}


class Markup(str):
    """A string that is already HTML."""


def element(name: str, /, *content: str, **attributes: object) -> Markup:
    """Returns an element with this content; plain text in it is escaped. An attribute whose name is a Python keyword
    ends in "_" ("class_"). "_" within a name stands for "-"."""
    words = "".join(
        f' {key.rstrip("_").replace("_", "-")}="{html.escape(str(value))}"' for key, value in attributes.items()
    )
    opened = f"<{name}{words}>"
    return Markup(opened if name in _WITHOUT_END else f"{opened}{join(content)}</{name}>")


def join(content: Iterable[str]) -> Markup:
    """Concatenates elements."""
    return Markup("".join(part if isinstance(part, Markup) else html.escape(part) for part in content))


def table(head: Iterable[str], rows: Iterable[Iterable[str]]) -> Markup:
    """Returns a table with a row of headings and rows of cells."""
    heading = element("tr", *(element("th", cell) for cell in head))
    return element("table", heading, *(element("tr", *(element("td", cell) for cell in row)) for row in rows))
