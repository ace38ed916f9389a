"""Large projects take few steps; what would take too many ends in a finding; damaged pass files end in findings, never in a crash."""

from __future__ import annotations

import random
from pathlib import Path

import pytest

from archgen.passes.pass_shape import STATES, PassWork
from archgen.passes.patterns.architecture_view import ArchitectureView
from archgen.passes.patterns.pattern_registry import list_shipped_passes
from archgen.passes.patterns.rule_running import run_rules
from archgen.passes.project_tree import ProjectTree
from archgen.pipeline import check_project
from archgen.syntax.yaml_tree import MappingNode, ScalarNode
from tests.passes.patterns.random_robots import make_robot
from tests.passes.patterns.transforming import pass_of, read, work_of
from tests.property_sizes import try_some

FIGURE_4 = """
- find: {components: {$whole: {autoconnect: ports}, $s: {in: $whole, outputs: {$port: {type: $type}}}, $t: {in: $whole, inputs: {$port: {type: $type}}}}}
  unless:
    - {components: {$t: {inputs: {$port: {from: [$_]}}}}}
    - {components: {$other: {in: $whole, outputs: {$port: {type: $type}}}}}
  add: {components: {$t: {inputs: {$port: {from: [$s.$port]}}}}}
"""


def _make_chain(count: int, *, same_names: bool) -> str:
    lines = ["archgen: 1", "groups:", "  g:", "    autoconnect: ports", "    components:"]
    for number in range(count):
        read_port, written_port = ("x", "x") if same_names else (f"p{number}", f"p{number + 1}")
        lines += [
            f"      c{number}:",
            f"        inputs: {{{read_port}: {{type: T}}}}",
            f"        outputs: {{{written_port}: T}}",
        ]
    return "\n".join([*lines, "types: {T: std_msgs/msg/String}", ""])


def test_a_thousand_components_take_few_steps(tmp_path: Path) -> None:
    work = work_of(_make_chain(1000, same_names=False), tmp_path)
    # With every pair tried it would be millions.
    assert run_rules(pass_of(FIGURE_4), work, match_steps=150_000) == ()
    components = work.tree.get_mapping(("groups", "g", "components"))
    assert len(components) == 1000
    last = work.tree.get(("groups", "g", "components", "c999", "inputs", "p999", "from", 0))
    assert isinstance(last, ScalarNode)
    assert last.text == "c998.p999"


@pytest.mark.slow
def test_a_million_pairs_end_in_a_finding(tmp_path: Path) -> None:
    work = work_of(_make_chain(1000, same_names=True), tmp_path)
    (finding,) = run_rules(pass_of(FIGURE_4), work, match_steps=100_000)
    assert finding.message == "the pass `tried` takes more than 100,000 steps to find what it looks for"
    assert finding.span.line == 3


def _damage(text: str, draw: random.Random) -> str:
    """Return a text with a few words exchanged, doubled or gone."""
    words = text.split(" ")
    for _ in range(draw.randint(1, 4)):
        first, second = draw.randrange(len(words)), draw.randrange(len(words))
        choice = draw.randrange(4)
        if choice == 0:
            words[first], words[second] = words[second], words[first]
        elif choice == 1:
            words[first] = words[second]
        elif choice == 2:
            del words[first]
        else:
            words[first] = draw.choice(
                [
                    "$c:",
                    "$_",
                    "[$x]",
                    "{}",
                    "[]",
                    "components:",
                    "from:",
                    "is:",
                    "$whole",
                    "''",
                    "null",
                    "{a: b}",
                    "same_as:",
                    "kind:",
                    "true",
                ]
            )
    return " ".join(words)


@pytest.mark.parametrize("seed", try_some(range(6), 3))
def test_damaged_rules_end_in_findings(seed: int, tmp_path: Path) -> None:
    draw = random.Random(seed)  # noqa: S311 - the same rules for the same seed
    checked = check_project(make_robot(seed, tmp_path))
    texts = [shipped.text for shipped in list_shipped_passes(tuple(STATES))]
    for _ in range(40):
        damaged = read(_damage(draw.choice(texts), draw))
        assert damaged.read_pass is not None or damaged.diagnostics
        if damaged.read_pass is not None:
            tree = ProjectTree(checked.merged_table)
            work = PassWork(checked.loaded_project, tree, checked.architecture.interfaces)
            findings = run_rules(damaged.read_pass, work, max_applications=200, match_steps=20_000)
            assert all(each.rule == "wrong-pass" and each.message for each in findings)
            # What it made can be looked at again.
            assert isinstance(tree.root, MappingNode)
            view = ArchitectureView(tree)
            assert all(view.get_component(path) is not None for path in view.list_elements("components"))
