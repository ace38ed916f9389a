"""Beside what is wrong about time, the rest is analysed as if the wrong figures had not been written."""

from __future__ import annotations

from pathlib import Path

import pytest

from archgen.pipeline import check_project
from archgen.timing.chains.chain_bounds import bound_all_chains
from archgen.timing.run_analysis import analyse_architecture

PROJECT = """
groups:
  arm:
    components:
      camera: {outputs: {image: sensor_msgs/msg/Image}}
      seer: {inputs: {image: camera.image}, outputs: {objects: vision_msgs/msg/Detection3DArray}}
      mover: {inputs: {objects: seer.objects}, outputs: {motion: {medium: physical, external: The arm moves}}}
nodes:
  camera: {implements: camera, timing: {rate: 10 Hz, period: 3 ms, wcet: 2 ms, bcet: 1 ms}}
  seer: {implements: seer, timing: {SEER}}
  mover: {implements: mover, timing: {period: 20 ms, wcet: 3 ms, bcet: 3 ms}}
chains:
  good: {through: [camera, mover], deadline: 0 ms}
  backwards: {through: [mover, camera], deadline: 1 s}
"""
MS = 10**6


@pytest.mark.parametrize(
    "seer",
    [
        "trigger: [image], wcet: 1 ms, bcet: 2 ms",
        "trigger: [imag], wcet: 1 ms",
        "trigger: [], wcet: 1 ms",
        "period: 0 ms, wcet: 1 ms",
        "period: -1 ms, wcet: 1 ms",
        "rate: 12345678901234567890 Hz, wcet: 1 ms",
        "jitter: 3 Hz, wcet: 1 ms",
    ],
)
def test_the_rest_is_analysed(tmp_path: Path, seer: str) -> None:
    file = tmp_path / "robot.yaml"
    file.write_text(PROJECT.replace("{SEER}", f"{{{seer}}}"), encoding="utf-8")
    checked = check_project(file)
    assert len([f for f in checked.findings if f.severity == "error"]) == 3
    analysis = analyse_architecture(checked.architecture)
    assert {name: pace.gap.value for name, pace in analysis.paces.items()} == {
        "camera": 3 * MS,
        "seer": 3 * MS + 1 * MS,
        "mover": 20 * MS,
    }
    found = bound_all_chains(analysis, checked.architecture)
    assert found["good"].bound.value == (3 + 2 + 1 + 20 + 3) * MS
    assert found["good"].deadline is None
    assert found["backwards"].bound.value is None


@pytest.mark.parametrize("through", ["[camera, nobody, mover]", "[nobody, mover]", "[camera, mover, nobody]"])
def test_of_a_chain_through_what_is_not_there_nothing_is_said(tmp_path: Path, through: str) -> None:
    file = tmp_path / "robot.yaml"
    text = PROJECT.replace("{SEER}", "{wcet: 1 ms}").replace("[camera, mover]", through).replace("0 ms}", "1 s}")
    file.write_text(text, encoding="utf-8")
    checked = check_project(file)
    result = bound_all_chains(analyse_architecture(checked.architecture), checked.architecture)["good"]
    assert result.verdict == "open"
    for value in (result.bound, result.best, result.reduced_reaction, result.reduced_age):
        assert (value.value, value.complete, value.missing) == (None, False, ("nobody",))
    assert result.bound.assumptions == ("`nobody` is not resolved",)
