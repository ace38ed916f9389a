"""What every stage reports: diagnostics with their rule, severity and place, and the words that quote user text safely."""

from archgen.diagnostics.common_wording import (
    fit_lines,
    floor_percent,
    format_transition,
    join_first,
    join_words,
    keep_first,
    shorten_hash,
)
from archgen.diagnostics.diagnostic import (
    AskedName,
    Diagnostic,
    Label,
    Rule,
    Severity,
    count_by_severity,
    diagnose_repetition,
    name_rule,
    phrase_severity_counts,
    read_rules,
    settle_diagnostics,
    sort_gravest_first,
)
from archgen.diagnostics.natural_order import order_naturally
from archgen.diagnostics.source_span import NO_SPAN, SourceTexts, Span, first_written_span
from archgen.diagnostics.suggestions import NAMES_HELP, count_slips, did_you_mean, did_you_shorten, find_closest
from archgen.diagnostics.text_columns import (
    defuse_command,
    format_json,
    make_visible,
    measure_width,
    replace_surrogates,
)

__all__ = ["NAMES_HELP", "NO_SPAN", "AskedName", "Diagnostic", "Label", "Rule", "Severity", "SourceTexts", "Span"]
__all__ += ["count_by_severity", "count_slips", "defuse_command", "diagnose_repetition", "did_you_mean"]
__all__ += ["did_you_shorten", "find_closest", "first_written_span", "fit_lines", "floor_percent", "format_json"]
__all__ += ["format_transition", "join_first", "join_words", "keep_first", "make_visible", "measure_width", "name_rule"]
__all__ += ["order_naturally", "phrase_severity_counts", "read_rules", "replace_surrogates", "settle_diagnostics"]
__all__ += ["shorten_hash", "sort_gravest_first"]
