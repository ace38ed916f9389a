"""The YAML files of a new project, as a person would write them."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Any

from archgen.project import PROJECT_FILE
from archgen.start import start_templates
from archgen.start.start_answers import StartAnswers
from archgen.syntax import yaml_writer

_MAX_WIDTH = 110
"""The columns of a line; what is longer continues below."""
_EXAMPLE_REQUIREMENT = "The robot touches neither people nor things that it should not touch"
_KEY_HINTS = {
    "functionality": "  # what it does, in a sentence or two",
    "inputs": "  # id: group.component.output",
    "outputs": "  # id: conceptual type",
    "output": "  # of which conceptual type?",
}


def example_files(answers: StartAnswers, has_other_yaml: bool) -> dict[str, bytes]:  # noqa: FBT001 - what `other_yaml` found
    """Return the files of a project that begins with an example."""
    project_file = start_templates.fill_project_file(answers, {"R-1": _EXAMPLE_REQUIREMENT}, {}, sources=has_other_yaml)
    return {PROJECT_FILE: project_file, **start_templates.fill_group_files(answers)}


def imported_files(answers: StartAnswers, data: Mapping[str, Any], has_other_yaml: bool) -> dict[str, bytes]:  # noqa: FBT001 - as above
    """Return the files of a project whose groups, nodes, types and requirements were imported."""
    project_file = start_templates.fill_project_file(
        answers, data.get("requirements", {}), data.get("types", {}), sources=has_other_yaml
    )
    files = {PROJECT_FILE: project_file}
    for name, group in data.get("groups", {}).items():
        # With the dot, so that the group `arm` does not take the nodes of `arm_left`.
        id_prefix = f"{name}."
        nodes = {
            key: node for key, node in data.get("nodes", {}).items() if _first_implemented(node).startswith(id_prefix)
        }
        files[f"groups/{name}.yaml"] = ("\n".join(_slice_lines(name, group, nodes)) + "\n").encode()
    return files


def _first_implemented(node: Mapping[str, Any]) -> str:
    """Return the first component that a node implements: it decides into which group's file the node goes."""
    implements = node["implements"]
    return str(implements if isinstance(implements, str) else implements[0])


def _slice_lines(name: str, group: Mapping[str, Any], nodes: Mapping[str, Any]) -> Iterator[str]:
    yield f"# yaml-language-server: $schema=../{start_templates.SCHEMA_PATH}"
    yield "groups:"
    yield f"  {name}:"
    for key, value in group.items():
        if key != "components":
            yield from _entry_lines(key, value, "    ")
    yield "    components:"
    for component, body in group["components"].items():
        yield ""
        yield f"      {component}:"
        yield from _component_lines(body)
    if nodes:
        yield ""
        yield "nodes:"
        for node, body in nodes.items():
            yield from _entry_lines(node, body, "  ")


def _component_lines(body: Mapping[str, Any]) -> Iterator[str]:
    """Yield the lines of a component; unknown keys are left empty, with a comment on what belongs there."""
    keys = dict.fromkeys((*(key for key in body if key not in {"inputs", "outputs"}), "functionality"))
    for key in keys:
        yield from _entry_lines(key, body.get(key), "        ")
    for key in ("inputs", "outputs"):
        ports = body.get(key)
        if ports:
            yield f"        {key}:"
            for port, value in ports.items():
                yield from _entry_lines(port, value, "          ", "output" if key == "outputs" else "")
        else:
            yield from _entry_lines(key, ports, "        ")


def _entry_lines(key: str, value: object, indent: str, hint: str = "") -> Iterator[str]:
    """Yield the lines of one key: on one line where it fits, long text folded, long lists and mappings below."""
    head = f"{indent}{yaml_writer.format_scalar(key)}:"
    if value is None:
        yield f"{head}{_KEY_HINTS.get(hint or key, '')}"
        return
    line = f"{head} {yaml_writer.format_flow(value)}"
    if isinstance(value, str) and (len(line) > _MAX_WIDTH or "\n" in value):
        yield from yaml_writer.write_paragraph(head, value, f"{indent}  ", _MAX_WIDTH)
    elif len(line) > _MAX_WIDTH and isinstance(value, Mapping):
        yield head
        for inner_key, inner_value in value.items():
            yield from _entry_lines(inner_key, inner_value, f"{indent}  ", " ")
    elif len(line) > _MAX_WIDTH and isinstance(value, (list, tuple)):
        yield head
        yield from (f"{indent}  - {yaml_writer.format_flow(item)}" for item in value)
    else:
        yield line
