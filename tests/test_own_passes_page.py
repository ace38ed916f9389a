"""The page about passes: its example of a project's own is run as it stands there."""

from __future__ import annotations

import re
from pathlib import Path

import yaml

from archgen.checking.checked_packing import pack_checked_project
from archgen.passes.patterns.expressions import OPERATORS, TEST_FUNCTIONS, VALUE_FUNCTIONS
from archgen.passes.patterns.pattern_registry import SHIPPED_PREFIX, find_known_passes
from archgen.passes.patterns.view_values import VIEW_KEYS
from archgen.pipeline import check_project
from archgen.products.project_passes import choose_passes, transform_by_name
from archgen.syntax.yaml_writer import write_yaml
from tests.running import ROOT

PAGE = (ROOT / "docs" / "transformations.md").read_text(encoding="utf-8")


def test_the_example_makes_what_the_page_says(tmp_path: Path) -> None:
    blocks = dict(re.findall(r"```yaml\n# (\S+)\n(.*?)```", PAGE, flags=re.DOTALL))
    wanted = yaml.safe_load(blocks.pop("result"))
    assert sorted(blocks) == [
        "archgen.yaml",
        *(f"passes/{name}.yaml" for name in ("calls_as_topics", "log_network", "log_pictures", "move_navigation")),
    ]
    for name, text in blocks.items():
        (tmp_path / name).parent.mkdir(exist_ok=True)
        (tmp_path / name).write_text(text, encoding="utf-8")
    checked = check_project(tmp_path)
    assert [each for each in checked.findings if str(each.severity) == "error"] == []
    packed = pack_checked_project(transform_by_name(checked, choose_passes(checked, ["log_pictures"])))
    data = yaml.safe_load(write_yaml(packed.data, packed.comments))
    assert data["groups"]["logging"]["components"]["recorder"] == wanted


CALLS = """\
archgen: 1
project: {id: calls}
types: {Set brush: {request: {speed: float64}, response: {done: bool}}}
groups:
  g:
    components:
      brush: {outputs: {set: Set brush}}
      one: {inputs: {brush: brush.set}}
      two: {inputs: {brush: brush.set}}
"""


def test_a_service_with_two_clients_becomes_a_pair_of_topics(tmp_path: Path) -> None:
    (tmp_path / "passes").mkdir()
    (text,) = re.findall(r"```yaml\n# passes/calls_as_topics.yaml\n(.*?)```", PAGE, flags=re.DOTALL)
    (tmp_path / "passes" / "calls_as_topics.yaml").write_text(text, encoding="utf-8")
    assert len(text.splitlines()) <= 10
    (tmp_path / "archgen.yaml").write_text(CALLS, encoding="utf-8")
    checked = check_project(tmp_path)
    packed = pack_checked_project(transform_by_name(checked, choose_passes(checked, ["calls_as_topics"])))
    parts = yaml.safe_load(write_yaml(packed.data, packed.comments))["groups"]["g"]["components"]
    assert parts["brush"] == {
        "outputs": {"set_response": {"type": "Set brush response"}},
        "inputs": {"set_request": {"from": ["one.brush_request", "two.brush_request"]}},
    }
    client = {
        "inputs": {"brush_response": {"from": ["brush.set_response"]}},
        "outputs": {"brush_request": {"type": "Set brush request"}},
    }
    assert (parts["one"], parts["two"]) == (client, client)


def test_the_page_names_all_there_is() -> None:
    for name in find_known_passes(None).passes:
        assert f"`{name}`" in PAGE, name
    assert f"`{SHIPPED_PREFIX}`" in PAGE
    assert all(f"`{section}`" in PAGE for section in VIEW_KEYS)
    for word in (*VALUE_FUNCTIONS, *TEST_FUNCTIONS):
        assert f"`{word}(" in PAGE, word
    for word in OPERATORS:
        assert f"`{word}`" in PAGE, word
