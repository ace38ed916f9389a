"""The packages of nodes that are generated: whole ones, of programs whose modules are no words of Python."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest

from archgen.pipeline import check_project
from archgen.plugins.ros_code.node_programs import make_view
from archgen.views.generation.generation_context import GenerationContext


def test_a_module_is_no_word_of_the_language(tmp_path: Path) -> None:
    existing = ", ".join(f"{name}: {{implements: {name}, status: existing}}" for name in "bcd")
    made = make_programs(tmp_path, f"{{a: {{implements: a, package: rt, executable: class}}, {existing}}}")
    assert [(each["executable"], each["module"], each["class_name"]) for each in made.data["programs"]] == [
        ("class", "class_", "Class")
    ]


def test_a_program_of_a_node_that_exists_is_not_made_for_another_one(tmp_path: Path) -> None:
    made = make_programs(
        tmp_path,
        "{a: {implements: a, package: cams, executable: cam, status: existing}, b: {implements: b, package: cams,"
        " executable: cam}, c: {implements: c, package: cams, executable: other}, d: {implements: d, status: existing}}",
    )
    assert [each["executable"] for each in made.data["programs"]] == ["other"]


@pytest.mark.parametrize("part", [{"host": "left"}, {"nodes": frozenset({"a"})}])
def test_a_package_is_made_whole_or_not_at_all(tmp_path: Path, part: dict[str, Any]) -> None:
    nodes = (
        "{a: {implements: a, package: p, executable: go, host: left}, b: {implements: b, package: p, executable: go,"
        " host: right}, c: {implements: c, package: p, host: right}, d: {implements: d, package: q, host: right}}"
    )
    whole, made = make_programs(tmp_path, nodes).data, make_programs(tmp_path, nodes, **part).data
    assert made["packages"] == whole["packages"][:1]
    # The program of two nodes is that of both: its name and topics are those of neither.
    assert [each["executable"] for each in made["programs"]] == ["c", "go"]
    assert [each["id"] for each in made["programs"][1]["nodes"]] == ["a", "b"]


def make_programs(tmp_path: Path, written_nodes: str, **part: Any) -> Any:  # noqa: ANN401 - of the context
    components = ", ".join(f"{name}: {{outputs: {{out: std_msgs/msg/String}}}}" for name in "abcd")
    (tmp_path / "p.yaml").write_text(
        f"archgen: 1\nproject: {{id: rt, title: Robot}}\nros: {{distro: jazzy}}\nhosts: {{left: , right: }}\n"
        f"groups: {{g: {{components: {{{components}}}}}}}\nnodes: {written_nodes.replace('implements: ', 'implements: g.')}\n",
        encoding="utf-8",
    )
    options = {"language": "python"}
    context = GenerationContext(check_project(tmp_path / "p.yaml").architecture, options=options, **part)
    return make_view(context)
