"""The YAML files of a new project, as a person would write them."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Any

from archgen.emit import yaml
from archgen.project import MARKER
from archgen.start import templates
from archgen.start.answers import Answers

_WIDE = 110
"""The columns of a line; what is longer continues below."""
_R1 = "The robot touches neither people nor things that it should not touch"
_HINTS = {
    "functionality": "  # what it does, in a sentence or two",
    "inputs": "  # id: group.component.output",
    "outputs": "  # id: conceptual type",
    "output": "  # of which conceptual type?",
}


def example(answers: Answers, others: bool) -> dict[str, bytes]:  # noqa: FBT001 - what `other_yaml` found
    """Return the files of a project that begins with an example."""
    top = templates.project(answers, {"R-1": _R1}, {}, sources=others)
    return {MARKER: top, **templates.groups(answers)}


def imported(answers: Answers, data: Mapping[str, Any], others: bool) -> dict[str, bytes]:  # noqa: FBT001 - as above
    """Return the files of a project whose groups, nodes, types and requirements were imported."""
    top = templates.project(answers, data.get("requirements", {}), data.get("types", {}), sources=others)
    files = {MARKER: top}
    for name, group in data.get("groups", {}).items():
        # With the dot, so that the group `arm` does not take the nodes of `arm_left`.
        own = f"{name}."
        nodes = {key: node for key, node in data.get("nodes", {}).items() if _first(node).startswith(own)}
        files[f"groups/{name}.yaml"] = ("\n".join(_slice(name, group, nodes)) + "\n").encode()
    return files


def _first(node: Mapping[str, Any]) -> str:
    """Return the first component that a node implements: it decides into which group's file the node goes."""
    found = node["implements"]
    return str(found if isinstance(found, str) else found[0])


def _slice(name: str, group: Mapping[str, Any], nodes: Mapping[str, Any]) -> Iterator[str]:
    yield f"# yaml-language-server: $schema=../{templates.SCHEMA}"
    yield "groups:"
    yield f"  {name}:"
    for key, value in group.items():
        if key != "components":
            yield from _entry(key, value, "    ")
    yield "    components:"
    for component, body in group["components"].items():
        yield ""
        yield f"      {component}:"
        yield from _component(body)
    if nodes:
        yield ""
        yield "nodes:"
        for node, body in nodes.items():
            yield from _entry(node, body, "  ")


def _component(body: Mapping[str, Any]) -> Iterator[str]:
    """Yield the lines of a component; unknown keys are left empty, with a comment on what belongs there."""
    keys = dict.fromkeys((*(key for key in body if key not in {"inputs", "outputs"}), "functionality"))
    for key in keys:
        yield from _entry(key, body.get(key), "        ")
    for key in ("inputs", "outputs"):
        ports = body.get(key)
        if ports:
            yield f"        {key}:"
            for port, value in ports.items():
                yield from _entry(port, value, "          ", "output" if key == "outputs" else "")
        else:
            yield from _entry(key, ports, "        ")


def _entry(key: str, value: object, indent: str, hint: str = "") -> Iterator[str]:
    """Yield the lines of one key: on one line where it fits, long text folded, long lists and mappings below."""
    head = f"{indent}{yaml.scalar(key)}:"
    if value is None:
        yield f"{head}{_HINTS.get(hint or key, '')}"
        return
    line = f"{head} {yaml.flow(value)}"
    if isinstance(value, str) and (len(line) > _WIDE or "\n" in value):
        yield from yaml.paragraph(head, value, f"{indent}  ", _WIDE)
    elif len(line) > _WIDE and isinstance(value, Mapping):
        yield head
        for inner, below in value.items():
            yield from _entry(inner, below, f"{indent}  ", " ")
    elif len(line) > _WIDE and isinstance(value, (list, tuple)):
        yield head
        yield from (f"{indent}  - {yaml.flow(item)}" for item in value)
    else:
        yield line
