"""Tests of rule pages."""

from __future__ import annotations

from archgen.analyses import RULES
from archgen.diagnostics.diagnostic import Rule, Severity
from archgen.findings.rule_pages import format_rule_index, format_rule_page, parse_rule_page, rule_page_to_markdown
from archgen.findings.rule_table import index_rules

_RULE = Rule(
    "late-chain",
    Severity.WARNING,
    """A chain is late,
and nobody said so.

Why: It matters
to people.

Twice.

Bad:
    chains:
      a: {}

Good:

    chains: {}
""",
)


def test_a_page_has_four_parts() -> None:
    assert parse_rule_page(_RULE) == (
        "A chain is late, and nobody said so.",
        "It matters\nto people.\n\nTwice.",
        "chains:\n  a: {}",
        "chains: {}",
    )


def test_a_page_in_the_terminal() -> None:
    assert format_rule_page(_RULE) == (
        "late-chain (warning)\n\nA chain is late, and nobody said so.\n\nIt matters to people.\n\nTwice.\n\n"
        "Reported:\n\n    chains:\n      a: {}\n\nNot reported:\n\n    chains: {}\n"
    )
    assert format_rule_page(_RULE, colour=True).startswith("\x1b[1mlate-chain\x1b[0m (warning)\n")


def test_a_page_in_markdown_says_how_to_change_the_rule() -> None:
    assert rule_page_to_markdown(_RULE) == (
        "# late-chain\n\nA chain is late, and nobody said so.\n\n*Warning.*\n\n## Why\n\nIt matters to people.\n\nTwice.\n\n"
        "## Reported\n\n```yaml\nchains:\n  a: {}\n```\n\n## Not reported\n\n```yaml\nchains: {}\n```\n\n"
        "## To change it\n\nFor the whole project, in `archgen.yaml`:\n\n"
        "```yaml\nrules: {late-chain: note}  # off, note, warning or error\n```\n\n"
        "In one place, at the end of the line that it points at:\n\n"
        "```yaml\n# archgen: ignore[late-chain] because ...\n```\n"
    )


def test_a_rule_that_cannot_be_changed_says_so() -> None:
    rule = Rule("syntax-error", Severity.ERROR, "A file is no YAML.", fixed=True)
    assert rule_page_to_markdown(rule) == "# syntax-error\n\nA file is no YAML.\n\n*Error, cannot be changed.*\n"


def test_the_index_lists_rules_by_name() -> None:
    text = format_rule_index(index_rules([_RULE, Rule("early-chain", Severity.NOTE, "A chain | is early.")]))
    assert text.splitlines()[4:] == [
        "| rule | severity | what it finds |",
        "|---|---|---|",
        "| [early-chain](early-chain.md) | note | A chain \\| is early. |",
        "| [late-chain](late-chain.md) | warning | A chain is late, and nobody said so. |",
    ]


def test_every_rule_about_architectures_has_all_parts_of_its_page() -> None:
    assert [rule.name for rule in RULES if not all(parse_rule_page(rule))] == []
