"""The anchors of headings, as GitHub makes them: the links of the documents work there and on the site."""

from __future__ import annotations

import re


def anchor_of(heading: str, separator: str = "-") -> str:
    return re.sub(r"[^\w\- ]", "", heading.strip().lower()).replace(" ", separator)
