"""Names that nothing can be built with are told, and what has them is left out; names of the language are no modules."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest

from archgen.diagnostics.source_span import NO_SPAN
from archgen.model.node import Node
from archgen.pipeline import check_project
from archgen.views.generation.generation_context import GenerationContext
from archgen.views.generation.node_programs import make_view
from archgen.views.generation.program_names import find_bad_names


@pytest.mark.parametrize(
    ("language", "package", "program", "plugin", "left_out"),
    [
        ("python", "rt", "go-1.2", "", ""),
        ("python", "Rt_2", "class", "", ""),
        ("python", "rt", "go", "no class", ""),
        ("python", "foo-bar", "go", "", "no package of Python can be called `foo-bar`"),
        ("python", "x; import os", "go", "", "no package of Python can be called `x; import os`"),
        ("python", "class", "go", "", "no package of Python can be called `class`"),
        ("python", "rt", "a = b:c", "", "no program can be called `a = b:c`"),
        ("cpp", "foo-bar", "go", "", ""),
        ("cpp", "Rt", "go", "", "no package of C++ can be called `Rt`"),
        ("cpp", "rt", "go", "no class", "no class of C++ can be called `no class`"),
    ],
)
def test_names_that_nothing_can_be_built_with(
    language: str, package: str, program: str, plugin: str, left_out: str
) -> None:
    node = Node("n", "n", plugin=plugin or None)
    messages = [each.message for each in find_bad_names(package, program, [node], NO_SPAN, language)]
    assert messages == ([f"the program of `n` is left out: {left_out}"] if left_out else [])


def test_the_others_are_made(tmp_path: Path) -> None:
    made = make_programs(
        tmp_path,
        "{a: {implements: a, package: 'x; import os'}, b: {implements: b, package: rt, executable: class},"
        " c: {implements: c, status: existing}, d: {implements: d, status: existing}}",
    )
    assert [(each["executable"], each["module"], each["class_name"]) for each in made.data["programs"]] == [
        ("class", "class_", "Class")
    ]
    assert [each.element for each in made.findings] == ["a"]


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
