"""The YAML files of a new project, as a person would write them."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from archgen.model.review_settings import agreement_file
from archgen.products.editor_schema_marks import SCHEMA_FILE
from archgen.project import PROJECT_FILE
from archgen.start import start_templates
from archgen.start.start_answers import StartAnswers
from archgen.syntax import block_documents

_EXAMPLE_REQUIREMENT = "The robot touches neither people nor things that it should not touch"
_KEY_HINTS = {
    "functionality": "# what it does, in a sentence or two",
    "inputs": "# id: group.component.output",
    "outputs": "# id: conceptual type",
}
_OUTPUT_HINT = "# of which conceptual type?"
_SECTION_HINTS = {
    "requirements": "# components name what they serve; archgen says what nobody serves",
    "types": "# conceptual types and the ROS messages that carry them",
}


def example_files(answers: StartAnswers, has_other_yaml: bool) -> dict[str, bytes]:  # noqa: FBT001 - what `other_yaml` found
    """Return the files of a project that begins with an example."""
    sections = {"requirements": {"R-1": _EXAMPLE_REQUIREMENT}}
    return {
        PROJECT_FILE: _fill_project_file(answers, sections, has_other_yaml=has_other_yaml),
        **start_templates.fill_group_files(answers),
        **_agreement_files(answers),
    }


def _agreement_files(answers: StartAnswers) -> dict[str, bytes]:
    return {agreement_file(partner.id): start_templates.fill_agreements(partner.title) for partner in answers.partners}


def imported_files(answers: StartAnswers, data: Mapping[str, Any], has_other_yaml: bool) -> dict[str, bytes]:  # noqa: FBT001 - as above
    """Return the files of a project whose groups, nodes, types and requirements were imported."""
    files = {PROJECT_FILE: _fill_project_file(answers, data, has_other_yaml=has_other_yaml)}
    for name, group in data.get("groups", {}).items():
        # With the dot, so that the group `arm` does not take the nodes of `arm_left`.
        id_prefix = f"{name}."
        nodes = {
            key: node for key, node in data.get("nodes", {}).items() if _first_implemented(node).startswith(id_prefix)
        }
        files[f"groups/{name}.yaml"] = _write_slice(name, group, nodes).encode()
    return files | _agreement_files(answers)


def _fill_project_file(answers: StartAnswers, data: Mapping[str, Any], *, has_other_yaml: bool) -> bytes:
    """Return archgen.yaml: the template, and below it the sections that the data have."""
    sections = block_documents.BlockMapping()
    for key, hint in _SECTION_HINTS.items():
        if key in data:
            # In the column of the template's own comments.
            section = sections.add_mapping(key, f"{hint:>{len(hint) + 28 - len(key)}}", is_spaced=True)
            for name, value in data[key].items():
                section.add_entry(name, value)
    project_file = start_templates.fill_project_file(answers, sources=has_other_yaml)
    return project_file + (block_documents.write_document(sections).encode() if sections.content else b"")


def _first_implemented(node: Mapping[str, Any]) -> str:
    """Return the first component that a node implements: it decides into which group's file the node goes."""
    implements = node["implements"]
    return str(implements if isinstance(implements, str) else implements[0])


def _write_slice(name: str, group: Mapping[str, Any], nodes: Mapping[str, Any]) -> str:
    root = block_documents.BlockMapping()
    group_mapping = root.add_mapping("groups").add_mapping(name)
    for key, value in group.items():
        if key != "components":
            group_mapping.add_entry(key, value)
    components = group_mapping.add_mapping("components")
    for component, body in group["components"].items():
        _add_component(components.add_mapping(component, is_spaced=True), body)
    if nodes:
        node_section = root.add_mapping("nodes", is_spaced=True)
        for node, body in nodes.items():
            node_mapping = node_section.add_mapping(node)
            for key, value in body.items():
                node_mapping.add_entry(key, value)
    return block_documents.write_document(root, f"# yaml-language-server: $schema=../{SCHEMA_FILE}\n")


def _add_component(component: block_documents.BlockMapping, body: Mapping[str, Any]) -> None:
    """Add the keys of a component; unknown keys are left empty, with a comment on what belongs there."""
    keys = dict.fromkeys((*(key for key in body if key not in {"inputs", "outputs"}), "functionality"))
    for key in keys:
        component.add_entry(key, body.get(key), _KEY_HINTS.get(key, ""))
    for key in ("inputs", "outputs"):
        if ports := body.get(key):
            port_section = component.add_mapping(key)
            for port, value in ports.items():
                port_section.add_entry(port, value, _OUTPUT_HINT if key == "outputs" else "")
        else:
            component.add_entry(key, ports, _KEY_HINTS[key])
