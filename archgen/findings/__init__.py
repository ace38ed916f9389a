"""Findings: diagnostics as text, JSON and more; the rules' pages."""

from __future__ import annotations

from archgen.findings.rules import UNKNOWN_RULE
from archgen.findings.suppress import UNUSED_IGNORE

RULES = (UNUSED_IGNORE, UNKNOWN_RULE)
"""The rules about settings and comments."""
