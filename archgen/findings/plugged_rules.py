"""The rules of installed packages: loaded when a project is judged, known as shipped ones are, never trusted to work."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping
from fractions import Fraction
from functools import cache
from typing import Any

from archgen.analyses import bound_findings
from archgen.diagnostics import Diagnostic, Rule, Severity
from archgen.diagnostics.rule_options import OptionValues, RuleOption, read_option_values
from archgen.findings.rule_table import FAILED_RULE
from archgen.frozen import dataclass, replace
from archgen.installed_plugins import RULES, PluginEntry, PluginRefusedError, list_entries, load_facts
from archgen.model.architecture import Architecture


@dataclass(frozen=True, slots=True)
class PluggedRule:
    """A rule of a package, and the function behind it."""

    rule: Rule
    find: Callable[..., Iterable[Any]]


@cache
def load_plugged_rules() -> tuple[PluggedRule, ...]:
    """Return the rules of installed packages. Raise PluginRefusedError for an entry point that leads to none."""
    return tuple(rule for entry in list_entries(RULES) for rule in _load_rules(entry))


def _load_rules(entry: PluginEntry) -> Iterator[PluggedRule]:
    facts = load_facts(entry)
    if set(facts) != {"api", "rules"}:
        _refuse(
            entry, f"`{entry.target}` has {', '.join(map(str, facts))}: it says `api` and `rules`, and nothing else"
        )
    for rule_entry in facts["rules"]:
        match rule_entry:
            case (function, Severity() as severity, *more) if callable(function) and len(more) <= 1:
                options = tuple(more[0]) if more else ()
            case _:
                _refuse(entry, f"{rule_entry!r} is not (function, severity) or (function, severity, options)")
        if not function.__doc__:
            _refuse(entry, f"`{function.__name__}` has no docstring, which is the page of a rule")
        if not all(isinstance(option, RuleOption) for option in options):
            _refuse(entry, f"the options of `{function.__name__}` are not all of the type RuleOption")
        yield PluggedRule(replace(Rule.from_function(function, severity, options), origin=entry.origin), function)


def _refuse(entry: PluginEntry, problem: str) -> None:
    raise PluginRefusedError(f"the rules `{entry.name}` of {entry.origin} cannot be used: {problem}")


def refuse_taken_names(plugged_rules: Iterable[PluggedRule], taken: Iterable[str]) -> None:
    """Raise PluginRefusedError where two rules have one name: settings and comments would mean both."""
    origins = dict.fromkeys(taken, "archgen")
    for plugged in plugged_rules:
        if plugged.rule.name in origins:
            msg = f"the rule `{plugged.rule.name}` of {plugged.rule.origin} cannot be used: {origins[plugged.rule.name]} has one of this name"
            raise PluginRefusedError(msg)
        origins[plugged.rule.name] = plugged.rule.origin


def judge_plugged(architecture: Architecture, rule_options: Mapping[str, OptionValues]) -> Iterator[Diagnostic]:
    """Run the rules of installed packages, and yield their raw diagnostics; one for each rule that failed."""
    for plugged in load_plugged_rules():
        options = read_option_values(plugged.rule.options, rule_options.get(plugged.rule.name, {}))
        yield from bound_findings(_judge_by(plugged, architecture, options))


def _judge_by(
    plugged: PluggedRule, architecture: Architecture, options: Mapping[str, Fraction]
) -> Iterator[Diagnostic]:
    try:
        for finding in plugged.find(architecture, **options):
            if not isinstance(finding, Diagnostic) or finding.rule != plugged.rule.name:
                problem = f"it yields {finding!r:.200}, which is no finding of its own"
                yield _report_failure(architecture, plugged, problem)
                return
            yield finding
    except (Exception, SystemExit) as error:  # noqa: BLE001 - a stranger's mistake is a finding, never an end
        yield _report_failure(architecture, plugged, f"{type(error).__name__}: {error}")


def _report_failure(architecture: Architecture, plugged: PluggedRule, problem: str) -> Diagnostic:
    message = f"the rule `{plugged.rule.name}` of {plugged.rule.origin} failed: {problem}"
    help_line = (
        f"tell who wrote {plugged.rule.origin.partition(' ')[0]}; `archgen --no-plugins check` does without its rules"
    )
    return Diagnostic(FAILED_RULE.name, message, architecture.project.at, help=help_line)
