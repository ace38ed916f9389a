"""Figures laid over an architecture: what can be said, and what is refused."""

from __future__ import annotations

from pathlib import Path

import pytest

from archgen.link.timing_overrides import OverrideError, apply_overrides
from archgen.model.architecture import Architecture
from archgen.pipeline import check_project

PROJECT = """
groups:
  see:
    components:
      camera: {outputs: {image: sensor_msgs/msg/Image}, timing: {rate: 10 Hz, wcet: 5 ms}}
      finder: {inputs: {image: camera.image}, timing: {bcet: 2 ms}}
      twice: {outputs: {x: std_msgs/msg/String}}
nodes:
  cam: {implements: camera}
  find: {implements: finder}
  one: {implements: twice}
  two: {implements: twice}
  both: {implements: [see.camera, see.finder]}
"""


@pytest.fixture
def architecture(tmp_path: Path) -> Architecture:
    file = tmp_path / "project.yaml"
    file.write_text(PROJECT.replace("  both: {implements: [see.camera, see.finder]}\n", ""))
    return check_project(file).architecture


def test_a_figure_is_laid_over_a_node_or_its_component(architecture: Architecture) -> None:
    for element in ("find", "finder", "see.finder", "find.finder"):
        changed = apply_overrides(architecture, [f"{element}.timing.wcet=120ms", f"{element}.timing.priority=7"])
        timing = changed.nodes["find"].timing["see.finder"]
        assert (str(timing.wcet), str(timing.bcet), timing.priority) == ("120 ms", "2 ms", 7)
    assert architecture.nodes["find"].timing["see.finder"].wcet is None


def test_a_period_replaces_a_rate(architecture: Architecture) -> None:
    timing = apply_overrides(architecture, ["cam.timing.period=50 ms"]).nodes["cam"].timing["see.camera"]
    assert (timing.rate, str(timing.period)) == (None, "50 ms")


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("cam.timing.wcet", "`cam.timing.wcet` is not ELEMENT.timing.KEY=VALUE, for instance"),
        ("cam.wcet=3 ms", "`cam.wcet=3 ms` is not ELEMENT.timing.KEY=VALUE"),
        ("camm.timing.wcet=3 ms", "nothing is called `camm`; did you mean `cam`?"),
        ("cam.timing.wect=3 ms", "`timing` has no key `wect` that can be set; did you mean `wcet`?"),
        ("cam.timing.wcet=3", "`wcet` takes a duration such as 120 ms"),
        ("cam.timing.rate=3 ms", "`rate` takes a frequency such as 10 Hz"),
        ("cam.timing.every=x", "`every` takes a whole number, not `x`"),
        ("cam.timing.behaviour=often", "`behaviour` takes periodic, event, on_demand, once, not `often`"),
        ("cam.timing.period=0 ms", "cam: a period cannot be zero"),
        (
            "find.timing.wcet=1 ms",
            "find: the best case execution time (`bcet`, 2 ms) is above the worst (`wcet`, 1 ms)",
        ),
        ("twice.timing.wcet=1 ms", "2 nodes implement `see.twice`: name one of them (one, two)"),
    ],
)
def test_what_makes_no_sense_is_refused(architecture: Architecture, text: str, said: str) -> None:
    with pytest.raises(OverrideError) as caught:
        apply_overrides(architecture, [text])
    assert str(caught.value).startswith(said)
