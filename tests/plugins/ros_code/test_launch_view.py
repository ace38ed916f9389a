"""The views `ros1_launch` and `ros2_launch`: parts that are generated one after the other into one package belong together."""

from __future__ import annotations

from pathlib import Path

import pytest

from archgen.pipeline import check_project
from archgen.plugins.ros_code.launch_view import make_view
from archgen.views.generation.generation_context import GenerationContext

PROJECT = """\
archgen: 1
project: {id: bot, title: Bot}
ros: {distro: DISTRO}
groups: {g: {components: {cam: {functionality: Looks., parameters: {rate: 10}}, arm: {functionality: Moves.}, stage: {functionality: Is.}}}}
nodes:
  cam: {implements: cam, status: existing, package: cams, executable: cam, host: left}
  arm: {implements: arm, status: existing, package: arms, executable: arm, host: right, kind: KIND, start: {state: active}}
  stage: {implements: stage, kind: program, command: [stage], host: right}
hosts: {left: {}, right: {}}
"""


@pytest.mark.parametrize("ros", [1, 2])
def test_the_package_is_that_of_all_parts(tmp_path: Path, ros: int) -> None:
    text = PROJECT.replace("DISTRO", {1: "noetic", 2: "jazzy"}[ros]).replace("KIND", {1: "node", 2: "lifecycle"}[ros])
    (tmp_path / "p.yaml").write_text(text, encoding="utf-8")
    architecture = check_project(tmp_path / "p.yaml").architecture
    whole = make_view(GenerationContext(architecture), ros).data
    (package,) = whole["packages"]
    assert (package["rosdep_keys"], package["has_parameters"]) == (["arms", "cams"], True)
    assert package["scripts"] == [{1: "run_program", 2: "set_states"}[ros]]
    for host in ("left", "right"):
        part = make_view(GenerationContext(architecture, host=host), ros).data
        assert part["packages"] == [package]
        assert part["hosts"] == [each for each in whole["hosts"] if each["name"] == host]
    assert (
        make_view(GenerationContext(architecture, nodes=frozenset(), components=frozenset()), ros).data["packages"]
        == []
    )
