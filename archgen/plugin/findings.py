"""For rules, and for what importers find wrong: a finding with its place, a rule with its options, guesses at misspelt names."""

from archgen.diagnostics import (
    NO_SPAN,
    Diagnostic,
    Label,
    Rule,
    Severity,
    Span,
    did_you_mean,
    first_written_span,
    join_words,
    make_visible,
)
from archgen.diagnostics.rule_options import RuleOption

__all__ = ["NO_SPAN", "Diagnostic", "Label", "Rule", "RuleOption", "Severity", "Span", "did_you_mean"]
__all__ += ["first_written_span", "join_words", "make_visible"]
