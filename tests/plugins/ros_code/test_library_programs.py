"""What the library that ships has is made by others: no program is generated for it; and what is judged again in a second run."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest

from archgen import pipeline
from archgen.emit.workspace import workspace_plan
from archgen.emit.workspace.disk_files import GeneratedFile
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


def test_own_code_that_was_just_written_is_not_judged_again(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    (tmp_path / "archgen.yaml").write_text(
        "archgen: 1\nproject: {id: r}\nros: {distro: jazzy}\n"
        "groups: {g: {components: {a: {outputs: {o: {type: std_msgs/msg/Bool, external: Somebody}}}}}}\n"
    )
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path / "cache"))
    words = ("generate", "ros2_python", "-o", tmp_path / "ws")
    archgen_here(*words, cwd=tmp_path, status=0)
    judged: list[str] = []
    judge = workspace_plan._judge  # noqa: SLF001 - what takes the time

    def note_judged(file: GeneratedFile, *more: Any) -> Any:  # noqa: ANN401 - what is handed on
        judged.append(file.path)
        return judge(file, *more)

    monkeypatch.setattr(workspace_plan, "_judge", note_judged)
    archgen_here(*words, cwd=tmp_path, status=0)
    assert judged == []
    (own_file,) = (tmp_path / "ws").glob("src/*/*/a.py")
    own_file.write_text(own_file.read_text() + "# mine\n")
    archgen_here(*words, cwd=tmp_path, status=0)
    assert judged == [str(own_file.relative_to(tmp_path / "ws"))]
