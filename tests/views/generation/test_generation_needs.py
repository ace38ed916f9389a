"""What generators take for granted, and names that become one."""

from __future__ import annotations

from pathlib import Path

import pytest

from archgen.diagnostics.source_span import Span
from archgen.pipeline import check_project
from archgen.views.generation.architecture_needs import find_name_clashes, find_unmet_needs
from archgen.views.generation.generation_context import GenerationContext

NEEDS = """\
component_types:
  whole: {inputs: {x: Pose}, components: {inner: {inputs: {x: {from: self.x}}}}}
types: {Box: {generic: [T], fields: {x: T}}, Pose: geometry_msgs/Pose}
groups:
  g: {components: {a: {functionality: A., outputs: {o: Pose}}, b: {functionality: A., outputs: {o: Pose}}, c: {functionality: A., inputs: {i: [a.o, b.o]}}, w: {is: whole, inputs: {x: a.o}}}}
  h: {components: {a: {functionality: A., inputs: {i: g.a.o}}}}
"""


@pytest.mark.parametrize(
    ("need", "found"),
    [
        ("flat", ["g.w"]),
        ("no_generics", ["Box"]),
        ("one_source", ["g.c.i"]),
        ("unique_names", ["h.a"]),
    ],
)
def test_what_a_generator_needs(tmp_path: Path, need: str, found: list[str]) -> None:
    path = tmp_path / "p.yaml"
    path.write_text(f"archgen: 1\nproject: {{id: bot, title: Bot}}\n{NEEDS}")
    diagnostics = tuple(find_unmet_needs(GenerationContext(check_project(path).architecture), (need,)))
    assert [each.element for each in diagnostics] == found
    assert all(each.span.file == "p.yaml" and each.help for each in diagnostics)


def test_names_that_become_one() -> None:
    places = [Span("p.yaml", line, 1, line, 2) for line in (1, 2, 3)]
    names = zip(("Arm1", "Leg", "arm1"), ("arm_1", "leg", "arm1"), places, strict=True)
    (found,) = find_name_clashes(names, "class")
    assert found.message == "`arm_1` and `arm1` give the same class `arm1`"
    assert (found.span, found.labels[0].span) == (places[2], places[0])
