"""Where an element stands in the model takes the place of where it is written."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from archgen.installed_plugins import list_shipped_facts
from archgen.pipeline import check_project
from archgen.views.generation import CORE_VIEWS, find_view_maker, is_shipped_view
from archgen.views.generation.generation_context import GenerationContext, give_model_paths
from archgen.views.generation.model_paths import index_model_paths, write_model_paths

PROJECT = """\
archgen: 1
project: {id: p}
component_types:
  motor: {inputs: {goal: T}, parameters: {gain: 2}, operations: {stop: {}}}
groups:
  g:
    components:
      b: {is: motor}
      a: {is: motor}
      c:
        outputs: {out: T}
        parameters: {depth: 3}
types: {T: std_msgs/msg/Bool}
hosts: {pc: }
"""


def test_elements_have_paths(tmp_path: Path) -> None:
    (tmp_path / "p.yaml").write_text(PROJECT, encoding="utf-8")
    paths = index_model_paths(check_project(tmp_path / "p.yaml").architecture)
    by_line = {int(place.split(":")[1]): path for place, path in sorted(paths.items(), reverse=True)}
    assert [by_line[line] for line in (6, 8, 9, 10, 11, 12, 14)] == [
        "g",
        "g.b",
        "g.a",
        "g.c",
        "g.c.out",
        "g.c.depth",
        "pc",
    ]
    assert {path for place, path in paths.items() if place.startswith("p.yaml:4:")} >= {"motor", "motor.gain"}


def test_places_become_paths_at_any_depth() -> None:
    paths = {"p.yaml:4:3": "g.a"}
    data = {
        "place": "p.yaml:4:3",
        "name": "p.yaml:4:3",
        "parts": [{"place": "other.yaml:9:1"}, {"place": "own", "deep": ({"place": ""},)}],
    }
    assert write_model_paths(data, paths) == {
        "place": "g.a",
        "name": "p.yaml:4:3",
        "parts": [{"place": "other.yaml"}, {"place": "own", "deep": [{"place": ""}]}],
    }


EXAMPLES = Path(__file__).parents[3] / "examples"


@pytest.mark.parametrize("example", ["partners", "arm"])
@pytest.mark.parametrize("name", sorted({*CORE_VIEWS, *(name for _, name, _ in list_shipped_facts("views"))}))
def test_shipped_views_write_paths_themselves(name: str, example: str) -> None:
    """A workspace does not go through their data again."""
    context = GenerationContext(check_project(EXAMPLES / example).architecture)
    paths = index_model_paths(context.architecture)
    make_view = find_view_maker(name)
    assert make_view is not None
    assert is_shipped_view(name)
    data = make_view(context).data
    with give_model_paths(paths):
        written = make_view(context).data
    assert json.dumps(written, default=list) == json.dumps(write_model_paths(data, paths), default=list)
    assert make_view(context).data == data
