"""Every rule's page: its examples run, and what follows from the rule on it is fresh."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

from archgen import resources
from archgen.conformance.robot_comparison import ComparedPart
from archgen.diagnostics.diagnostic import Diagnostic, Rule, Severity
from archgen.findings import rule_pages
from archgen.findings.rule_table import COMPARISON_RULES, FAILED_RULE, index_rules
from archgen.importers.robot_observation import ObservationOptions, observe_robot
from archgen.pipeline import SHIPPED_RULES, check_project
from archgen.products.robot_conformance import hold_against_robots
from archgen.views.generation.architecture_needs import GENERATION_RULES
from tests.judged_projects import check_text
from tests.plugins.recordings.test_bag_observation import Recorded, make_scan, write_topics
from tests.repositories import repository

_LOUD = {Severity.ERROR, Severity.WARNING}


def _judge(example: str, folder: Path) -> tuple[Diagnostic, ...]:
    """Judge an example: one file, or several that begin with a line `# file: NAME`, or one of a commit of some day.

    With a graph or the messages of a recording among them, the project is held against that robot, too.
    """
    if example.startswith("# committed on "):
        day = example.partition("\n")[0].removeprefix("# committed on ")
        repository(folder, {"archgen.yaml": example}, day=day)
        return check_project(folder / "archgen.yaml").findings
    parts = re.split(r"^# file: (\S+)\n", f"{example}\n", flags=re.MULTILINE)
    if len(parts) == 1:
        return check_text(parts[0])
    for name, text in zip(parts[1::2], parts[2::2], strict=True):
        (folder / name).parent.mkdir(parents=True, exist_ok=True)
        (folder / name).write_text(text, encoding="utf-8")
    checked = check_project(folder)
    graph, messages = folder / "graph.txt", folder / "messages.txt"
    sources = [graph] if graph.exists() else [write_bag(messages)] if messages.exists() else []
    robots = [observe_robot(source, folder, ObservationOptions(distro="jazzy")) for source in sources]
    return (*checked.findings, *hold_against_robots(checked, robots, ComparedPart()).reported.findings)


def write_bag(messages: Path) -> Path:
    """Write a recording whose messages are told a line a topic: `/scan TYPE frame laser, 500 B, at 0 100 200 ms`."""
    recorded = [
        Recorded(topic, message, [int(time) for time in times.split()], make_scan(frame, int(size)))
        for topic, message, frame, size, times in re.findall(
            r"(/\S+) (\S+) frame (\w+), (\d+) B, at ([\d ]+) ms", messages.read_text(encoding="utf-8")
        )
    ]
    return write_topics(messages.parent / "bag", recorded)


def _shown(diagnostics: tuple[Diagnostic, ...]) -> list[str]:
    return [f"{d.severity}[{d.rule}] {d.span}: {d.message}" for d in diagnostics]


@pytest.mark.parametrize("rule", SHIPPED_RULES, ids=lambda rule: rule.name)
def test_the_bad_example_breaks_this_rule_only_and_the_good_one_none(rule: Rule, tmp_path: Path) -> None:
    parts = rule_pages.read_rule_page(rule)
    assert parts.summary
    assert parts.why
    assert parts.bad
    assert parts.good
    bad, good = _judge(parts.bad, tmp_path / "bad"), _judge(parts.good, tmp_path / "good")
    assert rule.name in {d.rule for d in bad}, _shown(bad)
    assert {d.rule for d in bad if d.severity in _LOUD} <= {rule.name}, _shown(bad)
    assert rule.name not in {d.rule for d in good}, _shown(good)
    assert not [d for d in good if d.severity in _LOUD], _shown(good)


def test_the_pages_are_fresh() -> None:
    rules = index_rules((*SHIPPED_RULES, FAILED_RULE, *COMPARISON_RULES, *GENERATION_RULES))
    folder = resources.resource_path("docs", "rules")
    wanted = {
        "README.md": rule_pages.format_rule_index(rules),
        **{f"{name}.md": rule_pages.rule_page_to_markdown(rule) for name, rule in rules.items()},
    }
    written = {page.name: page.read_text(encoding="utf-8") for page in folder.glob("*.md")}
    assert sorted(written) == sorted(wanted)
    stale = [name for name, text in wanted.items() if written[name] != text]
    assert stale == [], "run tools/make_rule_pages.py"
