"""For rules, and for what importers find wrong: a finding with its place, a rule with its options, guesses at misspelt names."""

from archgen.diagnostics.common_wording import join_words
from archgen.diagnostics.diagnostic import Diagnostic, Label, Rule, Severity
from archgen.diagnostics.rule_options import RuleOption
from archgen.diagnostics.safe_text import make_visible
from archgen.diagnostics.source_span import NO_SPAN, Span, first_written_span
from archgen.diagnostics.suggestions import did_you_mean

__all__ = ["NO_SPAN", "Diagnostic", "Label", "Rule", "RuleOption", "Severity", "Span", "did_you_mean"]
__all__ += ["first_written_span", "join_words", "make_visible"]
