"""What is done with findings after the analyses: silence, drop, compare with a baseline; the rules' pages."""

from __future__ import annotations

from archgen.findings.rules import UNKNOWN_RULE
from archgen.findings.suppress import UNUSED_IGNORE

RULES = (UNUSED_IGNORE, UNKNOWN_RULE)
"""The rules about settings and comments."""
