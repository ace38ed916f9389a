"""Components that are indented too far, so that they are lines of the description above: one finding."""

from __future__ import annotations

import pytest

from archgen.schema.schema_validation import find_swallowed_components
from archgen.syntax import yaml_parser
from tests.judged_projects import check_text

_GROUP = """\
groups:
  sensing:
    description: >-
      All that sees.
    %scomponents:
    %s  lidar:
    %s    outputs: {scan: sensor_msgs/msg/LaserScan}
  driving:
    components: {stop: {inputs: {scan: lidar.scan}}}
nodes: {lidar: {implements: sensing.lidar}, stop: {implements: stop}}
"""


@pytest.mark.parametrize(("style", "columns"), [(">-", "  "), ("|", "  "), (">-", "    "), ("|", "      ")])
def test_swallowed_components_are_one_finding(style: str, columns: str) -> None:
    (found,) = (d for d in check_text(_GROUP.replace(">-", style).replace("%s", columns)) if d.severity != "note")
    assert f"{found.span.line}: {found.message}; {found.help}" == (
        "3: `components:` and what stands below it are lines of the text `description`; "
        "begin `components:` in the column of `description:`"
    )


@pytest.mark.parametrize(
    "text",
    [
        "The sensors write:\n\noutputs: scan and image\n",
        "Its parts:\ncomponents:\n- lidar\n- camera\n",
        "It has these components:\n  lidar: sees the room\n  stop: stops\n",
        "inputs:\noutputs:\n",
        "partners:\n  sees: all\n",
    ],
)
def test_texts_with_colons_are_texts(text: str) -> None:
    lines = "".join(f"      {line}\n" for line in text.split("\n"))
    document, _ = yaml_parser.parse_yaml("a.yaml", f"groups:\n  g:\n    title: G\n    description: |\n{lines}")
    assert document is not None
    assert not list(find_swallowed_components(document))


def test_a_text_may_show_the_language_where_components_are_written() -> None:
    text = _GROUP.replace("%s", "  ").replace("  driving:\n", "")
    document, _ = yaml_parser.parse_yaml("a.yaml", text)
    assert document is not None
    assert not list(find_swallowed_components(document))
