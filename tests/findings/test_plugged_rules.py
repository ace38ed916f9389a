"""Rules of installed packages judge as shipped ones do: settings, comments, options, pages; a mistake in one is a finding."""

from __future__ import annotations

from pathlib import Path

import pytest

from archgen import analyses, pipeline
from archgen.cache.program_stamp import stamp_program
from archgen.findings import rule_pages
from archgen.findings.plugged_rules import load_plugged_rules
from archgen.installed_plugins import PluginRefusedError, switch_off_others
from archgen.resources import SWITCH_VARIABLE
from tests.installed_packages import installed_in, write_package
from tests.judged_projects import check_text

CODE = '''
from archgen.plugin.findings import Diagnostic, RuleOption, Severity

def short_name(architecture, *, most):
    """A component has a short name.

    Why: nobody finds it.
    """
    for component in architecture.components.values():
        if len(component.id.partition(".")[2]) <= most * 10:
            yield Diagnostic("short-name", f"`{component.id}` is short", component.at, element=component.id)

def broken_rule(architecture):
    """It breaks."""
    yield from ()
    print(1 // len(architecture.hosts))

RULES = {"api": 1, "rules": ((short_name, Severity.WARNING, (RuleOption("most", 20, 0, 100, "How short."),)),)}
BROKEN = {"api": 1, "rules": ((broken_rule, Severity.WARNING),)}
'''
PROJECT = "archgen: 1\ngroups:\n  g:\n    components:\n      ab:{comment}\n        outputs: {{o: std_msgs/msg/Bool}}\n"


def judge(comment: str = "", settings: str = "") -> list[str]:
    text = PROJECT.format(comment=comment) + settings
    return [
        f"{finding.severity} {finding.rule}: {finding.message}"
        for finding in check_text(text)
        if finding.rule in {"short-name", "failed-rule", "unknown-rule", "unused-ignore", "unknown-key"}
    ]


def install(folder: Path, target: str, code: str = CODE) -> None:
    write_package(folder, "archgen_names", {"archgen.rules": {"names": f"archgen_names:{target}"}}, code)


def test_a_rule_of_a_package_is_known_in_settings_comments_and_options(tmp_path: Path) -> None:
    assert judge(settings="rules: {short-name: error}\n") == ["warning unknown-rule: there is no rule `short-name`"]
    install(tmp_path, "RULES")
    with installed_in(tmp_path):
        assert judge() == ["warning short-name: `g.ab` is short"]
        assert judge(settings="rules: {short-name: error}\n") == ["error short-name: `g.ab` is short"]
        assert judge(settings="rules: {short-name: off}\n") == []
        assert judge(settings="rules: {short-name: {severity: note, most: 10 %}}\n") == []
        assert judge(comment=" # archgen: ignore[short-name] because it is") == []
        rule = pipeline.index_all_rules()["short-name"]
        assert rule_pages.format_rule_page(rule).startswith(
            "short-name (warning, of archgen-names 1.0)\n\nA component has a short name."
        )


def test_plug_ins_of_others_are_switched_off(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    install(tmp_path, "RULES")
    # Set here, so that it is taken back.
    monkeypatch.setenv(SWITCH_VARIABLE, "")
    with installed_in(tmp_path):
        assert [plugged.rule.name for plugged in load_plugged_rules()] == ["short-name"]
        load_plugged_rules.cache_clear()
        switch_off_others()
        assert load_plugged_rules() == ()
        assert judge() == []


def test_a_rule_that_fails_is_a_finding_that_names_the_package(tmp_path: Path) -> None:
    install(tmp_path, "BROKEN")
    with installed_in(tmp_path):
        failure = (
            "the rule `broken-rule` of archgen-names 1.0 failed: ZeroDivisionError: integer division or modulo by zero"
        )
        assert judge() == [f"error failed-rule: {failure}"]
        assert judge(settings="rules: {failed-rule: off}\n") == []


@pytest.mark.parametrize(
    ("body", "problem"),
    [
        ("yield 'text'", "it yields 'text', which is no finding of its own"),
        (
            "yield Diagnostic('unread-output', 'x', architecture.project.at)",
            "it yields Diagnostic(rule='unread-output'",
        ),
        ("raise SystemExit(3)\n    yield", "SystemExit: 3"),
    ],
)
def test_what_is_no_finding_of_the_rule_is_refused(body: str, problem: str, tmp_path: Path) -> None:
    code = f'from archgen.plugin.findings import Diagnostic, Severity\ndef odd(architecture):\n    """Odd."""\n    {body}\nRULES = {{"api": 1, "rules": [(odd, Severity.NOTE)]}}\n'
    install(tmp_path, "RULES", code)
    with installed_in(tmp_path):
        (found,) = judge()
        assert found.startswith(f"error failed-rule: the rule `odd` of archgen-names 1.0 failed: {problem}")


def test_endless_findings_end(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    code = (
        CODE
        + '''
def endless(architecture):
    """It has no end."""
    while True:
        yield Diagnostic("endless", "more", architecture.project.at)
ENDLESS = {"api": 1, "rules": [(endless, Severity.NOTE)]}
'''
    )
    install(tmp_path, "ENDLESS", code)
    monkeypatch.setattr(analyses, "MAX_LOOKED_FOR", 5)
    with installed_in(tmp_path):
        messages = {finding.message for finding in check_text(PROJECT.format(comment="")) if finding.rule == "endless"}
        assert messages == {"more", analyses.NO_LONGER_LOOKED_FOR}


@pytest.mark.parametrize(
    ("facts", "problem"),
    [
        ('{"api": 2, "rules": ()}', "is written for api 2 of archgen.plugin, and this archgen has 1"),
        ('{"rules": ()}', "is written for api None of archgen.plugin, and this archgen has 1"),
        ('{"api": 1, "rules": (), "more": 1}', "has api, rules, more: it says `api` and `rules`, and nothing else"),
        ('{"api": 1, "rules": [print]}', "is not (function, severity) or (function, severity, options)"),
        ('{"api": 1, "rules": [(print, "note")]}', "is not (function, severity) or (function, severity, options)"),
        (
            '{"api": 1, "rules": [(lambda a: (), Severity.NOTE)]}',
            "`<lambda>` has no docstring, which is the page of a rule",
        ),
        ('{"api": 1, "rules": [(unread_output, Severity.NOTE)]}', "archgen has one of this name"),
        (
            '{"api": 1, "rules": [(short_name, Severity.NOTE, [1])]}',
            "the options of `short_name` are not all of the type RuleOption",
        ),
        ("[]", "is no mapping with `api`: `archgen_names:RULES` is of the type list"),
        ("1 / 0", "cannot be loaded: `archgen_names:RULES`: ZeroDivisionError: division by zero"),
    ],
)
def test_what_is_no_set_of_rules_is_said_in_a_sentence(facts: str, problem: str, tmp_path: Path) -> None:
    install(
        tmp_path,
        "RULES",
        f'{CODE}\ndef unread_output(architecture):\n    """It has a name that is taken."""\nRULES = {facts}\n',
    )
    with installed_in(tmp_path), pytest.raises(PluginRefusedError) as refused:
        judge()
    assert problem in str(refused.value)
    assert "archgen-names 1.0" in str(refused.value)


def test_packages_are_part_of_the_keys_of_caches(tmp_path: Path) -> None:
    before = stamp_program()
    install(tmp_path, "RULES")
    with installed_in(tmp_path):
        with_rules = stamp_program()
        assert "archgen-names 1.0" in with_rules
    install(tmp_path, "RULES", f"{CODE}\n# changed, under the same version\n")
    with installed_in(tmp_path):
        assert stamp_program() not in {before, with_rules}
    assert stamp_program() != with_rules
