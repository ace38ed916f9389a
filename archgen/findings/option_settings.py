"""Judge the options of rules that a project sets: what is no option, or out of its range, is a finding at its place."""

from __future__ import annotations

from typing import TYPE_CHECKING

from archgen.diagnostics.diagnostic import Diagnostic, Rule
from archgen.diagnostics.suggestions import did_you_mean

if TYPE_CHECKING:
    from collections.abc import Mapping
    from fractions import Fraction

    from archgen.diagnostics.rule_options import OptionValues, WrittenOption

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
