"""Tables of what lies between activities: lost samples, beats, queues; servers and their callers; and what is late."""

from __future__ import annotations

from typing import TYPE_CHECKING

import pytest

from archgen import pipeline
from archgen.views import timing, timing_between, timing_of, timing_verdicts
from archgen.views.index import Index, Scope, index
from archgen.views.shapes import Bullets, Facts, Inlines, Paragraph, Table
from archgen.views.timed import timing as analysed

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
def view(tmp_path: Path) -> Index:
    (tmp_path / "archgen.yaml").write_text(PROJECT, "utf-8")
    architecture = pipeline.check(tmp_path).architecture
    return index(architecture, timed=analysed(architecture))


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


def test_edges_that_lose_samples_or_beat(view: Index) -> None:
    assert view.timed is not None
    lead, *rows = read(timing_between.edges(view, view.timed))
    assert str(lead).startswith(
        "Of 3 edges whose readers are not asked on demand, 2 lose samples or beat. Of 1 the rates are not known."
    )
    assert rows == [
        ["From", "Topic", "To", "Lost", "Times read", "Beat"],
        ["camera", "/sensing/camera/image", "viewer", "33.3 %", "", "100 ms"],
        ["camera", "/sensing/camera/image", "logger", "", "1.3", "100 ms"],
    ]


def test_of_a_part_only_the_edges_that_touch_it(view: Index) -> None:
    assert view.timed is not None
    part = index(view.architecture, scope=Scope(nodes=frozenset({"button"})), timed=view.timed)
    assert read(timing_between.edges(part, view.timed)) == [
        "Of 1 edge whose readers are not asked on demand, none lose samples or beat. Of 1 the rates are not known."
    ]


def test_servers_say_how_long_their_callers_wait(view: Index) -> None:
    assert view.timed is not None
    head, row = read(timing_between.services(view, view.timed))
    assert head == [
        "Server",
        "Callers",
        "Answers all of them within",
        "A caller that waits for its answers responds within",
    ]
    assert row == ["finder", "2", "8 ms", "viewer: 16 ms\nlogger: 16 ms"]


def test_one_core_is_held_against_both_bounds(view: Index) -> None:
    assert view.timed is not None
    table = timing.hosts(view, view.timed)
    assert table is not None
    head, row = read([table])
    shown = dict(zip(head, row, strict=True))  # type: ignore[call-overload]
    assert (shown["Rate-monotonic bound"], shown["Earliest-deadline bound"]) == ("75.7 %", "100 %")


def test_what_is_late_comes_first_with_why(view: Index) -> None:
    assert view.timed is not None
    (late,) = read(timing_verdicts.late(view, view.timed))
    assert str(late).startswith("Seen and shown. Missed: up to ")
    table = timing_verdicts.chains(view, view.timed)
    assert table is not None
    head, *rows = read([table])
    at = head.index("Largest step")  # type: ignore[attr-defined]
    assert [row[at].split()[0] for row in rows] == ["viewer", "camera"]  # type: ignore[index]


def test_an_assumption_is_said_once(view: Index) -> None:
    assert view.timed is not None
    facts = timing_of.chain_blocks(view, view.timed, view.timed.chains[0])[0]
    assert isinstance(facts, Facts)
    assert "assuming a dedicated core" not in said(dict(facts.rows).get("Assumptions", ()))
