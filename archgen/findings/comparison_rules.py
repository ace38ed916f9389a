"""The rules that no project breaks by itself: about two versions, which reviews report, and about generating."""

from __future__ import annotations

from archgen.diagnostics.diagnostic import Rule, Severity
from archgen.views.generation.architecture_needs import UNMET_NEED
from archgen.views.generation.generation_context import NOT_GENERATED

BREAKING_CHANGE = Rule(
    "breaking-change",
    Severity.WARNING,
    "A change takes something from a partner who does not own what was changed, and nobody accepted that.",
    setting="review: {breaking: {wire: error}}  # off, note, warning or error for each category, or one for all",
)
COMPARISON_RULES = (BREAKING_CHANGE,)


GENERATION_RULES = (NOT_GENERATED, UNMET_NEED)
