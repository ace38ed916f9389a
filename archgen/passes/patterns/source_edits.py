"""Write the sources of ports: each is named as it is seen from where it is written."""

from __future__ import annotations

from archgen.passes.patterns.architecture_view import ArchitectureView
from archgen.passes.patterns.edit_values import EditError
from archgen.passes.patterns.layer_choice import WrittenPlace
from archgen.passes.patterns.pass_shapes import EditKind
from archgen.passes.patterns.pattern_shapes import (
    PortReference,
    ViewValue,
)
from archgen.syntax.yaml_tree import ScalarNode, SequenceNode, YamlNode


def write_sources(view: ArchitectureView, kind: EditKind, place: WrittenPlace, value: ViewValue) -> None:
    """Write what a port, or a component, takes its data from; raise EditError for what there is not or is not seen there."""
    span = view.tree.find_place(place.source)
    is_output = place.path[0] == "outputs"
    type_name = place.layer.type_name
    writer = view.type_keys.get(type_name, place.key) if type_name else place.key
    nodes: list[ScalarNode] = []
    for item in value if isinstance(value, list) else [value]:
        reference = _find_target(view, item, writer, is_output=is_output)
        words = view.references.write(reference, writer, is_output=is_output)
        if words is None:
            message = f"`{reference}` cannot be named at `{writer}`: it lies outside of what is seen from there"
            raise EditError(message, "lead it through the ports of what stands around")
        node = ScalarNode(words, words, reference.span or span)
        view.remember_reference(node, reference)
        nodes.append(node)
    if kind == "set":
        view.tree.set(place.target, SequenceNode(list[YamlNode](nodes), span), place.source)
    for node in nodes if kind == "add" else ():
        view.tree.append(place.target, node, place.source)


def _find_target(view: ArchitectureView, item: ViewValue, writer: str, *, is_output: bool) -> PortReference:
    if isinstance(item, PortReference):
        return item
    text = str(item) if isinstance(item, str) else ""
    if text.startswith("self."):
        shell = writer if is_output else view.elements[writer].parent
        return PortReference(shell or "", text.removeprefix("self."), holder=shell or "")
    if text in view.elements:
        return PortReference(text, None)
    component, _, port = text.rpartition(".")
    if component not in view.elements:
        message = f"`{text}` is no port and no component"
        raise EditError(message, "a source is a path and a port: `$source.$port`, or `self.$port`")
    return PortReference(component, port)
