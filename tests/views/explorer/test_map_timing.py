"""The explorer's tables of how long steps take: what works for which component, and what nobody knows."""

from __future__ import annotations

from pathlib import Path

from archgen import pipeline
from archgen.products.output_options import OutputOptions
from archgen.products.product_inputs import ProductInputs
from archgen.views.explorer.explorer_map import make_timing_tables
from archgen.views.lookup import make_lookup

ROBOT = """\
archgen: 1
project: {id: r, title: R}
hosts: {pc: {cores: 2}}
groups:
  g:
    components:
      camera: {outputs: {image: {type: std_msgs/msg/Bool}}, timing: {rate: 10 Hz, response: 2 ms}}
      finder: {inputs: {image: camera.image}, outputs: {found: {type: std_msgs/msg/Bool}}, timing: {triggers: [image]}}
nodes:
  eye: {implements: [g.camera], host: pc}
  mind: {implements: [g.finder], host: pc}
"""


def test_steps_have_their_times_and_what_is_not_written_has_none(tmp_path: Path) -> None:
    (tmp_path / "robot.yaml").write_text(ROBOT, "utf-8")
    checked_project = pipeline.check_project(tmp_path / "robot.yaml")
    lookup = ProductInputs(checked_project, OutputOptions()).timed_lookup
    tables = make_timing_tables(lookup, {"g.camera": 0, "g.finder": 1}, {"eye": 0, "mind": 1})
    assert [(name, node, of, respond) for name, node, of, _, respond, _ in tables["activities"]] == [
        ("eye", 0, (0,), 2_000_000),
        ("mind", 1, (1,), None),
    ]
    ((tail, head, is_call, link, _, respond, why),) = tables["steps"]
    assert (tail, head, is_call, link, respond) == (0, 1, 0, 0, None)
    assert "image" in str(why)
    # What is not shown, and what was not analysed, has no rows.
    assert make_timing_tables(lookup, {"g.camera": 0}, {"eye": 0})["steps"] == ()
    empty = make_lookup(checked_project.architecture, ())
    assert make_timing_tables(empty, {}, {"eye": 0}) == {"activities": (), "steps": ()}
