"""Link: slices are merged, elements declared, references resolved; the architecture comes out."""

from __future__ import annotations

from archgen.link.declare import link
from archgen.link.rules import RULES

__all__ = ["RULES", "link"]
