"""The rules about two versions of a project, which no version breaks by itself: reviews report them."""

from __future__ import annotations

from archgen.diagnostics.diagnostic import Rule, Severity

BREAKING_CHANGE = Rule(
    "breaking-change",
    Severity.WARNING,
    "A change takes something from a partner who does not own what was changed, and nobody accepted that.",
    setting="review: {breaking: {wire: error}}  # off, note, warning or error for each category, or one for all",
)
COMPARISON_RULES = (BREAKING_CHANGE,)
