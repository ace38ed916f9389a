"""Tests of rule pages."""

from __future__ import annotations

from pathlib import Path

import pytest

from archgen import resources
from archgen.analyses import RULES
from archgen.diagnostics.diagnostic import Rule, Severity
from archgen.findings.rule_pages import (
    format_rule_index,
    format_rule_page,
    read_rule_page,
    rule_page_to_markdown,
    summarise_rule,
)
from archgen.findings.rule_table import index_rules

_RULE = Rule(
    "tardy-chain",
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


def test_a_page_in_a_docstring_has_four_parts() -> None:
    assert read_rule_page(_RULE) == (
        "A chain is late, and nobody said so.",
        "It matters\nto people.\n\nTwice.",
        "chains:\n  a: {}",
        "chains: {}",
    )


def test_a_page_in_a_file_has_the_same_parts(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    page = tmp_path / "docs" / "rules" / "tardy-chain.md"
    page.parent.mkdir(parents=True)
    page.write_text(rule_page_to_markdown(_RULE), encoding="utf-8")
    monkeypatch.setattr(resources, "resource_root", lambda: tmp_path)
    rule = Rule("tardy-chain", Severity.WARNING, "A chain is late, and nobody said so.")
    assert read_rule_page(rule) == read_rule_page(_RULE)._replace(why="It matters to people.\n\nTwice.")
    assert rule_page_to_markdown(rule) == rule_page_to_markdown(_RULE)


def test_what_a_rule_finds_is_said_without_its_page(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.delattr(resources, "resource_root")
    assert summarise_rule(_RULE) == "A chain is late, and nobody said so."
    assert [rule.name for rule in RULES if summarise_rule(rule) != " ".join(rule.doc.split())] == []


def test_a_page_in_the_terminal() -> None:
    assert format_rule_page(_RULE) == (
        "tardy-chain (warning)\n\nA chain is late, and nobody said so.\n\nIt matters to people.\n\nTwice.\n\n"
        "Reported:\n\n    chains:\n      a: {}\n\nNot reported:\n\n    chains: {}\n"
    )
    assert format_rule_page(_RULE, colour=True).startswith("\x1b[1mtardy-chain\x1b[0m (warning)\n")


def test_a_page_in_markdown_says_how_to_change_the_rule() -> None:
    assert rule_page_to_markdown(_RULE) == (
        "# tardy-chain\n\nA chain is late, and nobody said so.\n\n*Warning.*\n\n## Why\n\nIt matters to people.\n\nTwice.\n\n"
        "## Reported\n\n```yaml\nchains:\n  a: {}\n```\n\n## Not reported\n\n```yaml\nchains: {}\n```\n\n"
        "## To change it\n\nFor the whole project, in `archgen.yaml`:\n\n"
        "```yaml\nrules: {tardy-chain: note}  # off, note, warning or error\n```\n\n"
        "In one place, at the end of the line that it points at:\n\n"
        "```yaml\n# archgen: ignore[tardy-chain] because ...\n```\n"
    )


def test_a_rule_that_cannot_be_changed_says_so() -> None:
    rule = Rule("no-yaml", Severity.ERROR, "A file is no YAML.", fixed=True)
    assert rule_page_to_markdown(rule) == "# no-yaml\n\nA file is no YAML.\n\n*Error, cannot be changed.*\n"


def test_the_index_lists_rules_by_name() -> None:
    text = format_rule_index(index_rules([_RULE, Rule("early-chain", Severity.NOTE, "A chain | is early.")]))
    assert text.splitlines()[4:] == [
        "| rule | severity | what it finds |",
        "|---|---|---|",
        "| [early-chain](early-chain.md) | note | A chain \\| is early. |",
        "| [tardy-chain](tardy-chain.md) | warning | A chain is late, and nobody said so. |",
    ]


def test_every_rule_about_architectures_has_all_parts_of_its_page() -> None:
    assert [rule.name for rule in RULES if not all(read_rule_page(rule))] == []
