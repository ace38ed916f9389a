"""Tables of what lies between activities: lost samples, beats, queues; servers and their callers; and what is late."""

from __future__ import annotations

from typing import TYPE_CHECKING

import pytest

from archgen import pipeline
from archgen.views.lookup import DocumentScope, Lookup, make_lookup
from archgen.views.shapes import Bullets, Facts, Inlines, Paragraph, Table
from archgen.views.timing import element_timing, timing_tables, timing_verdicts, use_tables
from archgen.views.timing.timing_lookup import analyse_with_chains as analysed

if TYPE_CHECKING:
    from collections.abc import Iterable
    from pathlib import Path

    from archgen.views.shapes import Block

PROJECT = """\
archgen: 1
groups:
  sensing:
    components:
      camera: {outputs: {image: sensor_msgs/msg/Image}}
      button: {outputs: {pressed: std_msgs/msg/Bool}}
      finder: {outputs: {find: {type: std_srvs/srv/Trigger}}, inputs: {image: camera.image}}
      viewer: {inputs: {image: camera.image, pressed: button.pressed, find: finder.find}}
      logger: {inputs: {image: camera.image, find: finder.find}}
nodes:
  camera: {implements: camera, host: pc, timing: {rate: 30 Hz, wcet: 1 ms}}
  button: {implements: button, timing: {behaviour: event}}
  finder: {implements: finder, host: pc, timing: {behaviour: on_demand, wcet: 2 ms}}
  viewer: {implements: viewer, host: pc, timing: {rate: 20 Hz, wcet: 2 ms}}
  logger: {implements: logger, host: pc, timing: {rate: 40 Hz, wcet: 1 ms}}
hosts: {pc: {cores: 1}}
chains:
  show: {title: Seen and shown, through: [camera, viewer], deadline: 50 ms}
  keep: {through: [camera, logger], deadline: 2 s}
"""


@pytest.fixture
def view(tmp_path: Path) -> Lookup:
    (tmp_path / "archgen.yaml").write_text(PROJECT, "utf-8")
    architecture = pipeline.check_project(tmp_path).architecture
    return make_lookup(architecture, timing_lookup=analysed(architecture))


def said(inlines: Inlines) -> str:
    return "".join(("\n" if part.line_break else "") + part.text.replace("\u00a0", " ") for part in inlines)


def read(blocks: Iterable[Block]) -> list[object]:
    """Give what blocks say, tables as rows below their columns."""
    found: list[object] = []
    for block in blocks:
        match block:
            case Paragraph():
                found.append(said(block.inlines))
            case Bullets():
                found += [said(item) for item in block.items]
            case Table():
                found += [
                    [column.title for column in block.columns],
                    *([said(cell) for cell in row] for row in block.rows),
                ]
    return found


def test_edges_whose_readers_keep_another_pace(view: Lookup) -> None:
    assert view.timing is not None
    lead, *rows = read(use_tables.make_edge_blocks(view, view.timing))
    assert str(lead).startswith(
        "Of 3 edges whose readers are not asked on demand, 2 are read less or more often than published, or in another rhythm. Of 1 the rates are not known."
    )
    assert rows == [
        ["From", "Topic", "To", "Not read", "Times read", "Beat"],
        ["camera", "/sensing/camera/image", "viewer", "33.3 %", "", "100 ms"],
        ["camera", "/sensing/camera/image", "logger", "", "1.3", "100 ms"],
    ]


def test_of_a_part_only_the_edges_that_touch_it(view: Lookup) -> None:
    assert view.timing is not None
    part = make_lookup(view.architecture, scope=DocumentScope(nodes=frozenset({"button"})), timing_lookup=view.timing)
    assert read(use_tables.make_edge_blocks(part, view.timing)) == [
        "Of 1 edge whose readers are not asked on demand, none are read less or more often than published, or in another rhythm. Of 1 the rates are not known."
    ]


def test_servers_say_how_long_their_callers_wait(view: Lookup) -> None:
    assert view.timing is not None
    head, row = read(use_tables.make_service_blocks(view, view.timing))
    assert head == [
        "Server",
        "Callers",
        "Answers all of them within",
        "A caller that waits for its answers responds within",
    ]
    assert row == ["finder", "2", "8 ms", "viewer: 16 ms\nlogger: 16 ms"]


def test_one_core_is_held_against_both_bounds(view: Lookup) -> None:
    assert view.timing is not None
    table = timing_tables.make_load_table(view, view.timing)
    assert table is not None
    head, row = read([table])
    shown = dict(zip(head, row, strict=True))  # type: ignore[call-overload]
    assert (shown["Rate-monotonic bound"], shown["Earliest-deadline bound"]) == ("75.7 %", "100 %")


def test_what_is_late_comes_first_with_why(view: Lookup) -> None:
    assert view.timing is not None
    (late,) = read(timing_verdicts.list_late_elements(view, view.timing))
    assert str(late).startswith("Seen and shown. Missed. In a simulated run it took ")
    table = timing_verdicts.make_bound_table(view, view.timing)
    assert table is not None
    head, *rows = read([table])
    at = head.index("Largest step")  # type: ignore[attr-defined]
    assert [row[at].split()[0] for row in rows] == ["viewer", "camera"]  # type: ignore[index]


def test_an_assumption_is_said_once(view: Lookup) -> None:
    assert view.timing is not None
    facts = element_timing.make_chain_blocks(view, view.timing, view.timing.chains[0])[0]
    assert isinstance(facts, Facts)
    assert "assuming a dedicated core" not in said(dict(facts.rows).get("Assumptions", ()))
