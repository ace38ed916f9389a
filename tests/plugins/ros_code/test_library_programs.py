"""What the library that ships has is made by others: no program is generated for it."""

from __future__ import annotations

from pathlib import Path

import pytest

from archgen import pipeline
from tests.running import archgen_here


@pytest.mark.parametrize(
    ("facts", "made"),
    [
        ("", set()),
        (", node: {status: planned}", {"src/v4l2_camera"}),
        (", status: adapted, node: {status: adapted}", set()),
    ],
)
def test_no_program_is_generated_for_what_the_library_has_unless_it_is_planned(
    facts: str, made: set[str], tmp_path: Path
) -> None:
    (tmp_path / "archgen.yaml").write_text(
        "archgen: 1\nproject: {id: r}\nros: {distro: jazzy}\nlibraries: {ros: builtin}\n"
        f"groups: {{g: {{components: {{camera: {{is: ros.v4l2_camera{facts}}}}}}}}}\n"
    )
    archgen_here("generate", "ros2_cpp", "-o", tmp_path / "ws", cwd=tmp_path, status=0)
    assert {str(each.relative_to(tmp_path / "ws")) for each in tmp_path.glob("ws/src/*")} == made
    camera = pipeline.check_project(tmp_path).architecture.components["g.camera"]
    assert camera.status == ("adapted" if "adapted" in facts else "existing")
