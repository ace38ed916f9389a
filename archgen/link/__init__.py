"""Link: slices are merged, elements declared, references resolved; the architecture comes out."""

from __future__ import annotations

from archgen.link import merge as _merge
from archgen.link import rules as _rules
from archgen.link.chapters import MISSING_CHAPTER
from archgen.link.declare import link
from archgen.link.merge import merge

RULES = (*_merge.RULES, *_rules.RULES, MISSING_CHAPTER)

__all__ = ["RULES", "link", "merge"]
