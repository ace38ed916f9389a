"""Link: merge the slices, declare the elements, resolve the references, and return the architecture."""

from __future__ import annotations

from archgen.link import merge, rules
from archgen.link.chapters import MISSING_CHAPTER
from archgen.link.declare import link

RULES = (*merge.RULES, *rules.RULES, MISSING_CHAPTER)

__all__ = ["RULES", "link"]
