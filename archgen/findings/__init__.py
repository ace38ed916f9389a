"""What is done with findings after the analyses: silence, drop, compare with a baseline; the rules' pages."""

from __future__ import annotations

from archgen.findings.ignore_comments import UNUSED_IGNORE
from archgen.findings.rule_table import STALE_CODEOWNERS, UNKNOWN_RULE

RULES = (STALE_CODEOWNERS, UNUSED_IGNORE, UNKNOWN_RULE)
"""The rules about settings, comments, and what was written from the project."""
