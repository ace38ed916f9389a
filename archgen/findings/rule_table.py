"""The table of all rules by name, and findings about settings that name rules which do not exist."""

from __future__ import annotations

from typing import TYPE_CHECKING

from archgen.diagnostics import Diagnostic, Rule, Severity, did_you_mean

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator, Mapping
    from fractions import Fraction

    from archgen.diagnostics import Span
    from archgen.diagnostics.rule_options import OptionValues, WrittenOption


def index_rules(rules: Iterable[Rule]) -> Mapping[str, Rule]:
    """Return the rules by name, in alphabetical order. Raise ValueError for two of one name, which is a bug."""
    rule_by_name: dict[str, Rule] = {}
    for rule in sorted(rules, key=lambda rule: rule.name):
        if rule.name in rule_by_name:
            raise ValueError(f"two rules are called {rule.name}")
        rule_by_name[rule.name] = rule
    return rule_by_name


UNKNOWN_RULE = Rule(
    "unknown-rule",
    Severity.WARNING,
    "A setting or an ignore comment names a rule that does not exist, or one that cannot be set.",
)


FAILED_RULE = Rule(
    "failed-rule",
    Severity.ERROR,
    """\
A rule of an installed package failed, or found something that is no finding of its own.

Why: What the rule would have found is not known, and a check that was not made must not pass for one that found nothing. The
message names the package and what went wrong: who wrote it can mend it. `archgen --no-plugins check` leaves out the rules of all
packages that do not ship with archgen.
""",
)
"""No project breaks it by itself: only a package can, whose rules archgen.findings.plugged_rules runs."""


STALE_CODEOWNERS = Rule(
    "stale-codeowners",
    Severity.WARNING,
    "A CODEOWNERS file that archgen wrote is no longer what follows from the owners in the architecture.",
    setting="rules: {stale-codeowners: note}  # off, note, warning or error",
)
BREAKING_CHANGE = Rule(
    "breaking-change",
    Severity.WARNING,
    "A change takes something from a partner who does not own what was changed, and nobody accepted that.",
    setting="review: {breaking: {wire: error}}  # off, note, warning or error for each category, or one for all",
)
COMPARISON_RULES = (BREAKING_CHANGE,)
"""The rules about two versions, which no project breaks by itself: reviews report them."""
_REVIEW_RULES = index_rules(COMPARISON_RULES)


def check_rule_settings(settings: Iterable[tuple[str, Span]], rules: Mapping[str, Rule]) -> Iterator[Diagnostic]:
    """Check the names below `rules:`, each with the span of its key."""
    for name, span in settings:
        rule = rules.get(name)
        if name in _REVIEW_RULES:
            setting = _REVIEW_RULES[name].setting.partition("  #")[0]
            yield Diagnostic("unknown-rule", f"`{name}` is not set below `rules`", span, help=f"write `{setting}`")
        elif rule is None:
            help_text = did_you_mean(name, (candidate.name for candidate in rules.values() if not candidate.fixed))
            yield Diagnostic("unknown-rule", f"there is no rule `{name}`", span, help=help_text)
        elif rule.fixed:
            message = f"`{name}` is always {_SEVERITY_PHRASES[rule.severity]}: what comes after reading and linking rests on it"
            yield Diagnostic("unknown-rule", message, span, help="take this line out")


_SEVERITY_PHRASES = {
    Severity.ERROR: "an error",
    Severity.WARNING: "a warning",
    Severity.NOTE: "a note",
    Severity.OFF: "off",
}


_MAX_QUOTED_LENGTH = 40


def settle_rule_options(
    written_options: Mapping[str, Mapping[str, WrittenOption]], rules: Mapping[str, Rule]
) -> tuple[Mapping[str, OptionValues], tuple[Diagnostic, ...]]:
    """Return the values of the options that a project sets, by rule and option, and the findings about the others.

    Names that are no rule, or one that cannot be set, are left to `check_rule_settings`.
    """
    values: dict[str, dict[str, Fraction]] = {}
    diagnostics: list[Diagnostic] = []
    for rule_name, options in written_options.items():
        rule = rules.get(rule_name)
        if rule is None or rule.fixed:
            continue
        known_options = {option.name: option for option in rule.options}
        for name, written_option in options.items():
            option = known_options.get(name)
            share = option.parse_value(written_option.text) if option else None
            if option is None:
                help_line = did_you_mean(name, known_options) or _list_options(known_options)
                message = f"the rule `{rule_name}` has no option `{name}`"
                diagnostics.append(Diagnostic("unknown-key", message, written_option.key_span, help=help_line))
            elif share is None:
                message = f"`{name}` of the rule `{rule_name}` cannot be `{written_option.text[:_MAX_QUOTED_LENGTH]}`"
                diagnostics.append(
                    Diagnostic("wrong-value", message, written_option.value_span, help=f"it is {option.range_phrase}")
                )
            else:
                values.setdefault(rule_name, {})[name] = share
    return values, tuple(diagnostics)


def _list_options(names: Mapping[str, object]) -> str:
    """Say what can be set besides."""
    return f"it has {', '.join(f'`{name}`' for name in ('severity', *names))}" if names else "it has only `severity`"
