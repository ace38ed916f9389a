"""The view `components`, and what files of keys and values need of it."""

from __future__ import annotations

from pathlib import Path

import pytest

from archgen.pipeline import check_project
from archgen.views.generation.architecture_needs import UNMET_NEED, find_unfit_tags, find_unfit_values
from archgen.views.generation.component_records import make_view, name_tag, read_own_hints
from archgen.views.generation.generation_context import GenerationContext

PROJECT = """\
archgen: 1
project: {id: lab, middleware: mqtt}
partners: {certh: {title: CERTH}}
component_types:
  laser:
    functionality: Looks.
    inputs: {}
    outputs: {scan: {type: Scan, hints: {mine: {tag: Beam}}}}
    parameters: {max_range: 80.0, size: {x: 1, "%s": 2}, text: %s}
    hints: {mine: {tag: Laser2d}, other: {tag: X}}
groups:
  g:
    owner: certh
    components:
      front: {is: laser, node: {name: eye, package: p, executable: e, host: pc, parameters: {max_range: 40.0}}}
      rear: {same_as: laser}
      map_maker: {functionality: Draws., inputs: {scan: {type: Scan, from: [front.scan]}}, outputs: {}}
hosts: {pc: {}}
types: {Scan: }
"""


def make_context(folder: Path, second_name: str = "y", text: str = "a") -> GenerationContext:
    path = folder / "p.yaml"
    path.write_text(PROJECT % (second_name, text), "utf-8")
    return GenerationContext(check_project(path).architecture, frozenset({"g.front", "g.map_maker"}), backend="mine")


def test_what_a_component_is_made_of(tmp_path: Path) -> None:
    data = make_view(make_context(tmp_path)).data
    front, map_maker = data["components"]
    assert data["middleware"] == "mqtt"
    assert {key: front[key] for key in ("id", "tag", "type", "owners", "host", "executable", "hints")} == {
        "id": "g.front",
        "tag": "Laser2d",
        "type": "laser",
        "owners": ["certh"],
        "host": "pc",
        "executable": "e",
        "hints": {"tag": "Laser2d"},
    }
    assert [(each["name"], each["tags"], each["value"]) for each in front["parameters"]] == [
        ("max_range", ["MaxRange"], 40.0),
        ("size.x", ["Size", "X"], 1),
        ("size.y", ["Size", "Y"], 2),
        ("text", ["Text"], "a"),
    ]
    assert (map_maker["tag"], map_maker["inputs"][0]["tag"]) == ("MapMaker", "Scan")
    (source,) = map_maker["inputs"][0]["sources"]
    assert (source["id"], source["component"], source["tag"], source["host"]) == ("g.front.scan", "front", "Beam", "pc")


def test_hints_of_another_form_say_nothing() -> None:
    assert read_own_hints({"mine": ["tag"]}, "mine") == {}
    assert name_tag({"mine": {"tag": 3}}, "mine", "left_arm") == "LeftArm"


def test_sound_values_and_tags_are_fit(tmp_path: Path) -> None:
    context = make_context(tmp_path, text="[a b, c]")
    assert [*find_unfit_tags(context, UNMET_NEED), *find_unfit_values(context, UNMET_NEED)] == []


@pytest.mark.parametrize(
    ("text", "words"),
    [('"a\\tb"', "line break or a control"), ("$(env HOME)", "launch file"), ("['\"']", "double quote in a list")],
)
def test_values_without_a_line_are_told(tmp_path: Path, text: str, words: str) -> None:
    (found,) = find_unfit_values(make_context(tmp_path, text=text), UNMET_NEED)
    assert words in found.message
    assert (found.element, found.span.line) == ("g.front", 9)


def test_equal_tags_are_told(tmp_path: Path) -> None:
    (found,) = find_unfit_tags(make_context(tmp_path, second_name="X"), UNMET_NEED)
    assert found.message == "`g.front size.x` and `g.front size.X` have the same tag `Size.X`"
    assert [found.span.line, found.labels[0].span.line] == [9, 9]


def test_the_view_says_whose_components_they_are(tmp_path: Path) -> None:
    (tmp_path / "archgen.yaml").write_text(
        "project: {id: rover, title: The rover}\ngroups: {g: {components: {a: {}}}}\n"
    )
    data = make_view(GenerationContext(check_project(tmp_path).architecture)).data
    assert data["project"] == {"id": "rover", "title": "The rover"}
