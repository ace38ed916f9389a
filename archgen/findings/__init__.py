"""What is done with findings after the analyses: silence, drop, compare with a baseline; the rules' pages."""

from __future__ import annotations

from archgen.findings.ignore_comments import UNUSED_IGNORE
from archgen.findings.rule_table import UNKNOWN_RULE

RULES = (UNUSED_IGNORE, UNKNOWN_RULE)
"""The rules about settings and comments."""
