"""Pages and cards show what is written of threads, callback groups, orders and resources."""

from __future__ import annotations

from pathlib import Path

import pytest

from archgen.cli.show_command import format_card
from archgen.views.elements.element_card import make_card
from archgen.views.elements.element_names import find_elements
from archgen.views.elements.implementation_level import make_node_blocks
from archgen.views.pages.host_pages import make_host_pages
from archgen.views.shapes import Facts
from tests.agreeing import checked, text, view

ROBOT = """\
archgen: 1
groups:
  g:
    components:
      a: {outputs: {x: std_msgs/msg/Bool, y: std_msgs/msg/Bool}}
      b: {inputs: {x: {from: a.x, freshness: 1 s}, y: a.y}}
nodes:
  na: {implements: a, host: pc, timing: {rate: 10 Hz, uses: {gpu: 2 ms}}}
  nb: {implements: b, threads: 2, scheduling: ros2_executor, reentrant: true}
  nc: {implements: [a, b], callback_groups: {fast: [a], slow: [g.b]}}
hosts: {pc: {cores: 4, scheduling: {0: edf, 3: fifo}}}
containers: {box: {scheduling: fifo}}
resources: {gpu: {host: pc, scheduling: fifo, title: Graphics card}}
"""


@pytest.mark.parametrize(
    ("name", "lines"),
    [
        ("nb", ["threads:        2", "scheduling:     ros2_executor", "reentrant:      yes"]),
        ("nc", ["callback_groups: fast: a; slow: b"]),
        ("pc", ["scheduling:     core 0 edf, core 3 fifo"]),
        ("box", ["scheduling:     fifo"]),
        ("gpu", ["host:           pc", "scheduling:     fifo", "na"]),
        ("g.b.x", ["freshness:      1 s"]),
    ],
)
def test_cards_show_it(tmp_path: Path, name: str, lines: list[str]) -> None:
    lookup = view(checked(tmp_path, ROBOT))
    ((kind, element_id),) = find_elements(lookup, name)
    card = [line.strip() for line in format_card(make_card(lookup, kind, element_id)).splitlines()]
    assert [line for line in lines if not any(shown.startswith(line) for shown in card)] == []


def test_pages_show_it(tmp_path: Path) -> None:
    lookup = view(checked(tmp_path, ROBOT))
    sections = [page.section for page in make_host_pages(lookup, tuple)]
    facts = {
        f"{section.anchor} {name}": text(value)
        for section in sections
        for block in section.blocks
        if isinstance(block, Facts)
        for name, value in block.rows
    }
    assert facts["host:pc Scheduling"] == "core 0 edf, core 3 fifo"
    assert facts["host:pc Resources"] == "Graphics card (used by na)"
    assert facts["container:box Scheduling"] == "fifo"


@pytest.mark.parametrize(
    ("node", "callbacks"),
    [
        ("na", None),
        ("nb", "2 threads, in the order ros2_executor, reentrant"),
        ("nc", "mutually exclusive in groups (fast: a; slow: b)"),
    ],
)
def test_the_page_of_a_node_says_how_its_callbacks_run(tmp_path: Path, node: str, callbacks: str | None) -> None:
    lookup = view(checked(tmp_path, ROBOT))
    blocks = make_node_blocks(lookup, lookup.architecture.nodes[node])
    (facts,) = (block for block in blocks if isinstance(block, Facts))
    assert {name: text(value) for name, value in facts.rows}.get("Callbacks") == callbacks
