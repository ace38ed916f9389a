"""Options of rules: what each does at its bound, what is wrong with a setting, and that schema and pages know them all."""

from __future__ import annotations

from fractions import Fraction

import jsonschema_rs
import pytest

from archgen.diagnostics.rule_options import RuleOption, format_percentage
from archgen.findings.rule_pages import format_rule_page, read_rule_page, rule_page_to_markdown
from archgen.findings.rule_table import index_rules
from archgen.pipeline import SHIPPED_RULES
from archgen.schema.language_schema import load_schema
from tests.judged_projects import check_text

RULES = index_rules(SHIPPED_RULES)
OPTIONS = [(rule.name, option) for rule in RULES.values() for option in rule.options]


def _messages(rule: str, example: str, setting: str = "") -> list[str]:
    """Return what a rule reports about an example of its page, with its setting."""
    page = read_rule_page(RULES[rule])
    text = page.good if example == "good" else page.bad
    findings = check_text(f"{text}\nrules: {{{rule}: {setting}}}\n" if setting else text)
    return [finding.message for finding in findings if finding.rule == rule]


@pytest.mark.parametrize(
    ("rule", "silent", "reported", "message"),
    [
        (
            "late-chain",
            "margin: 43 %",
            "margin: 43.1 %",
            "nothing proves that the chain `see_and_stop` meets its deadline of 100 ms with a margin of 43.1 %: it may take 57 ms",
        ),
        (
            "overloaded-host",
            "limit: 56 %",
            "limit: 55 %",
            "`pc` is loaded beyond its limit: what runs there takes 55 % of its 2 cores",
        ),
        (
            "saturated-link",
            "limit: 15 %",
            "limit: 14 %",
            "`cable` is to carry 14.4 % of its bandwidth, most of it `/sensing/camera/image`; its limit is 14 %",
        ),
        (
            "slow-component",
            "margin: 10 %",
            "margin: 11 %",
            "`sensing.detector` is asked to need at most 200 ms, but `detector` takes up to 180 ms; 11 % of it must stay free",
        ),
        (
            "slow-service",
            "margin: 40 %",
            "margin: 41 %",
            "`control` runs every 200 ms, but waits up to 120 ms for `planner`, with 2 callers; 41 % of it must stay free",
        ),
        (
            "long-execution",
            "limit: 24 %",
            "limit: 23 %",
            "the worst case execution time of `camera` (`wcet`, 8 ms) is above 23 % of its period",
        ),
        (
            "large-jitter",
            "limit: 15 %",
            "limit: 14 %",
            "the jitter of `camera` (`jitter`, 6 ms) is above 14 % of its period",
        ),
        (
            "short-queue",
            "margin: 0 %",
            "margin: 1 %",
            "`filter` keeps 11 messages of `/sensing/imu/motion`, and 11 can come before it has read them",
        ),
    ],
)
def test_a_threshold_is_tightened(rule: str, silent: str, reported: str, message: str) -> None:
    assert _messages(rule, "good") == []
    assert _messages(rule, "good", f"{{{silent}}}") == []
    assert _messages(rule, "good", f"{{{reported}}}") == [message]


@pytest.mark.parametrize(
    ("rule", "silent", "reported"),
    [
        ("lost-samples", "tolerance: 17 %", "tolerance: 16 %"),
        ("large-jitter", "limit: 150 %", "limit: 149 %"),
    ],
)
def test_a_threshold_is_loosened(rule: str, silent: str, reported: str) -> None:
    assert len(_messages(rule, "bad")) == 1
    assert _messages(rule, "bad", f"{{{silent}}}") == []
    assert len(_messages(rule, "bad", f"{{{reported}}}")) == 1


@pytest.mark.parametrize(("stated", "tolerance", "count"), [(29, 4, 0), (29, 3, 1), (31, 4, 0), (31, 3, 1), (30, 0, 0)])
def test_rates_may_differ_by_a_tolerance(stated: int, tolerance: int, count: int) -> None:
    bad = read_rule_page(RULES["period-conflict"]).bad.replace("rate: 10 Hz", f"rate: {stated} Hz")
    findings = check_text(f"{bad}\nrules: {{period-conflict: {{tolerance: {tolerance} %}}}}\n")
    assert len([finding for finding in findings if finding.rule == "period-conflict"]) == count


def test_a_queue_with_a_margin_says_what_it_must_hold() -> None:
    good = read_rule_page(RULES["short-queue"]).good
    (finding,) = (
        finding
        for finding in check_text(f"{good}\nrules: {{short-queue: {{margin: 20 %}}}}\n")
        if finding.rule == "short-queue"
    )
    assert finding.help == "`depth: 14` keeps all of them with the margin, `depth: 1` says that only the newest counts"


def test_a_container_without_a_host_has_the_limit_too() -> None:
    project = """\
groups: {g: {components: {a: {outputs: {x: {type: T, external: E}}}, b: {outputs: {y: {type: T, external: E}}}}}}
nodes:
  a: {implements: a, container: c, timing: {period: 10 ms, wcet: 4 ms}}
  b: {implements: b, container: c, timing: {period: 10 ms, wcet: 2 ms}}
containers: {c: {threads: 1}}
rules: {overloaded-host: {limit: LIMIT}}
"""
    for limit, count in (("60 %", 1), ("61 %", 0)):
        findings = check_text(project.replace("LIMIT", limit))
        assert [f.message for f in findings if f.rule == "overloaded-host"] == count * [
            "`c` is loaded beyond its limit: what runs there takes 60 % of its thread"
        ]


def test_an_option_goes_with_a_severity() -> None:
    good = read_rule_page(RULES["late-chain"]).good
    findings = check_text(f"{good}\nrules: {{late-chain: {{severity: error, margin: 50 %}}}}\n")
    assert [finding.severity for finding in findings if finding.rule == "late-chain"] == ["error"]
    findings = check_text(f"{good}\nrules: {{late-chain: {{severity: off, margin: 50 %}}}}\n")
    assert [finding for finding in findings if finding.rule == "late-chain"] == []


@pytest.mark.parametrize(
    ("setting", "finding"),
    [
        ("unread-output: {severity: note}", None),
        ("short-queue: {margin: 12.5%}", None),
        (
            "late-chain: {margn: 1 %}",
            "1:22 unknown-key: a setting of late-chain has no key `margn` (did you mean `margin`?)",
        ),
        (
            "unread-output: {margin: 1 %}",
            "1:25 unknown-key: the rule `unread-output` has no option `margin` (it has only `severity`)",
        ),
        (
            "unread-output: {severty: note}",
            "1:25 unknown-key: the rule `unread-output` has no option `severty` (it has only `severity`)",
        ),
        (
            "late-chain: {margin: 100 %}",
            "1:30 wrong-value: `margin` of the rule `late-chain` cannot be `100 %` (it is from 0 % to 99 %)",
        ),
        (
            "overloaded-host: {limit: 0.5 %}",
            "1:34 wrong-value: `limit` of the rule `overloaded-host` cannot be `0.5 %` (it is from 1 % to 100 %)",
        ),
        (
            "late-chain: {margin: -1 %}",
            "1:30 wrong-value: `margin` cannot be `-1 %` (a share is a number and `%`, such as `20 %`)",
        ),
        (
            "late-chain: {margin: 20}",
            "1:30 wrong-type: `margin` is `20`, but must be text (a share is a number and `%`, such as `20 %`)",
        ),
        (
            "late-chain: {margin: 0.0001 %}",
            "1:30 wrong-value: `margin` cannot be `0.0001 %` (a share is a number and `%`, such as `20 %`)",
        ),
        ("late-chain: {severity: eror}", "1:32 wrong-value: `severity` cannot be `eror` (did you mean `error`?)"),
        ("unread-output: {severity: eror}", "1:35 wrong-value: `severity` cannot be `eror` (did you mean `error`?)"),
        ("late-chian: {margin: 1 %}", "1:9 unknown-rule: there is no rule `late-chian` (did you mean `late-chain`?)"),
    ],
)
def test_a_setting_is_judged_at_its_place(setting: str, finding: str | None) -> None:
    findings = [
        f"{f.span.line}:{f.span.column} {f.rule}: {f.message} ({f.help})" for f in check_text(f"rules: {{{setting}}}\n")
    ]
    assert findings == ([finding] if finding else [])


@pytest.mark.parametrize(("rule", "option"), OPTIONS, ids=lambda value: getattr(value, "name", value))
def test_schema_and_pages_know_every_option(rule: str, option: RuleOption) -> None:
    part = load_schema()["$defs"]["rules"]["properties"][rule]["properties"]
    assert set(part) == {"severity", *(each.name for each in RULES[rule].options)}
    assert part[option.name]["description"] == (
        f"{option.summary} From {option.least} % to {option.most} %; without it {option.default} %."
    )
    line = f"`{option.name}`: {part[option.name]['description']}"
    assert f"- {line}\n" in rule_page_to_markdown(RULES[rule])
    assert f"    {line}\n" in format_rule_page(RULES[rule])
    validator = jsonschema_rs.Draft202012Validator(load_schema())
    validator.validate({"rules": {rule: {"severity": "note", option.name: f"{option.example} %"}}})
    assert option.least <= option.default <= option.most
    assert option.parse_value(f"{option.example} %") == Fraction(option.example, 100) != Fraction(option.default, 100)


def test_the_schema_knows_no_other_options() -> None:
    assert set(load_schema()["$defs"]["rules"]["properties"]) == {rule for rule, _ in OPTIONS}


@pytest.mark.parametrize("text", ["20 %", "12.5 %", "0.125 %", "0 %", "1000 %"])
def test_percentages_are_read_and_written_exactly(text: str) -> None:
    share = RuleOption("x", 0, 0, 1000, "").parse_value(text)
    assert share is not None
    assert format_percentage(share) == text


@pytest.mark.parametrize("text", ["", "20", "20  %", "1e1 %", "-5 %", "\u0661 %", "20 % ", "1001 %", "nan %", "20 %\n"])
def test_what_is_no_percentage(text: str) -> None:
    assert RuleOption("x", 0, 0, 1000, "").parse_value(text) is None
