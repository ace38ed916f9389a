"""The pass that lets each message carry its sender: types of ports are wrapped in `Envelope<T>`."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import chain, count

from archgen.diagnostics import Span
from archgen.diagnostics.element_origins import TreePath
from archgen.link import mapping_values
from archgen.model.generic_names import read_generic_name
from archgen.model.port_media import flow_of_port, is_physical, uses_ros
from archgen.passes.linked_tree import LinkedTree
from archgen.passes.pass_shape import Pass, PassWork
from archgen.passes.project_tree import PlainData, list_paths
from archgen.passes.type_probes import link_types
from archgen.passes.written_places import list_existing_components
from archgen.syntax.yaml_tree import MappingNode, ScalarNode, SequenceNode, YamlNode

_NAMES = ("Envelope", "Sender envelope")
_PORT_SECTIONS = frozenset({"inputs", "outputs"})
_HOLDERS = ("groups", "component_types", "libraries")
_Port = tuple[int, str, str]
"""A port of a linked project: which project, `input` or `output`, and the complete id."""


def _wrap_messages(work: PassWork) -> None:
    wrapper = _find_wrapper(work)
    type_paths = dict(_list_type_places(work))
    wrapped_places = _PortNetwork(work, type_paths).list_wrapped_places()
    if not wrapped_places:
        return
    for place, paths in type_paths.items():
        if place in wrapped_places:
            for path in paths:
                text = work.tree.get_text(path)
                if text is not None and read_generic_name(text).base != wrapper and not _is_wrapped(work, text):
                    work.tree.set(path, f"{wrapper}<{text.strip()}>", path)
    uses_wrapper = any(
        read_generic_name(work.tree.get_text(path) or "").base == wrapper
        for paths in type_paths.values()
        for path in paths
    )
    if uses_wrapper and work.tree.get(("types", wrapper)) is None:
        first_path = next(paths[0] for place, paths in type_paths.items() if place in wrapped_places)
        body: dict[str, PlainData] = {
            "generic": ["T"],
            "fields": {"sender": {"type": "string"}, "payload": {"type": "T"}},
        }
        work.tree.set(("types", wrapper), body, first_path)
        comment = "A message with the name of who sent it."
        work.tree.set(("types", wrapper, "comment"), comment, first_path)


def _find_wrapper(work: PassWork) -> str:
    """Return the name of the wrapping type: the first that is free, or that wraps already."""
    further_names = (f"{_NAMES[-1]} {number}" for number in count(2))
    return next(name for name in chain(_NAMES, further_names) if _is_usable(work.tree.get(("types", name))))


def _is_wrapped(work: PassWork, text: str) -> bool:
    """Whether a type is what wrapping made of another, which has a name of its own by now."""
    body = work.tree.get(("types", text.strip()))
    return isinstance(body, MappingNode) and {"sender", "payload"} <= set(
        mapping_values.get_mapping(body, "fields").entries
    )


def _is_usable(body: YamlNode | None) -> bool:
    return body is None or (isinstance(body, MappingNode) and _is_envelope_type(body))


def _is_envelope_type(body: MappingNode) -> bool:
    """Whether a type is made for one other, and has a sender and a payload."""
    generic = body.get("generic")
    fields = mapping_values.get_mapping(body, "fields")
    return (
        isinstance(generic, SequenceNode) and len(generic.items) == 1 and {"sender", "payload"} <= set(fields.entries)
    )


def _list_type_places(work: PassWork) -> Iterator[tuple[Span, list[TreePath]]]:
    """Yield where types of ports are written, with the paths of all that carry this place."""
    paths: dict[Span, list[TreePath]] = {}
    for section in _HOLDERS:
        node = work.tree.get((section,))
        for path, value in list_paths(node, (section,)) if node is not None else ():
            is_port_type = len(path) > 3 and path[-1] == "type" and path[-3] in _PORT_SECTIONS  # noqa: PLR2004
            if is_port_type and isinstance(value, ScalarNode) and value.value is not None:
                paths.setdefault(value.span, []).append(path)
    yield from paths.items()


class _PortNetwork:
    """Which ports must have one type: those that are connected, and those of instances of one type."""

    def __init__(self, work: PassWork, type_paths: dict[Span, list[TreePath]]) -> None:
        self._work = work
        self._type_paths = type_paths
        self._leaders: dict[object, object] = {}
        self._blocked: set[object] = set()

    def list_wrapped_places(self) -> set[Span]:
        """Return the places of the types that are wrapped: neither they nor what they are connected to must stay plain."""
        for number, linked in enumerate((self._work.link(), link_types(self._work))):
            self._add_ports(number, linked, list_existing_components(linked))
        blocked = {self._find(each) for each in self._blocked}
        seen = {place for place in self._type_paths if place in self._leaders}
        return {place for place in seen if self._find(place) not in blocked}

    def _add_ports(self, number: int, linked: LinkedTree, existing: set[str]) -> None:
        sources = linked.joined_sources
        types = linked.declared_types.types
        for component_id, outputs in linked.outline.outputs.items():
            for output in outputs.values():
                port: _Port = (number, "output", output.id)
                self._join_type(port, output.type_at)
                conceptual_type = types.get(sources.type_of_output(output.id) or "")
                is_message = not is_physical(output) and flow_of_port(output, conceptual_type) == "topic"
                if not is_message or not uses_ros(output) or output.external is not None or component_id in existing:
                    self._blocked.add(port)
                self._join_sources(number, linked, port)
            for name, entry in linked.outline.inputs[component_id].items():
                body = mapping_values.get_body(entry)
                port = (number, "input", f"{component_id}.{name}")
                self._join_type(port, mapping_values.get_span(body, "type"))
                if (
                    body.get("external") is not None
                    or mapping_values.get_medium(body, "medium")
                    or component_id in existing
                ):
                    self._blocked.add(port)
                self._join_sources(number, linked, port)

    def _join_type(self, port: _Port, place: Span) -> None:
        if place in self._type_paths:
            self._join(port, place)

    def _join_sources(self, number: int, linked: LinkedTree, port: _Port) -> None:
        kind, port_id = port[1:]
        for source in linked.joined_sources.list_sources((kind, port_id)):
            target = source.target
            if target.kind in {"input", "output"}:
                self._join(port, (number, target.kind, target.id))
            else:
                for output_id in linked.joined_sources.outputs_behind(target, port_id.rpartition(".")[0]):
                    self._join(port, (number, "output", output_id))

    def _find(self, each: object) -> object:
        leader = self._leaders.get(each, each)
        while leader != each:
            each, leader = leader, self._leaders.get(leader, leader)
        return leader

    def _join(self, first: object, second: object) -> None:
        self._leaders.setdefault(first, first)
        self._leaders.setdefault(second, second)
        self._leaders[self._find(first)] = self._find(second)


ENVELOPE = Pass(
    "envelope",
    "Wraps the types of messages in `Envelope<T>`, so that each message carries its sender.",
    _wrap_messages,
    needs=("no_component_sources",),
    leaves=("enveloped",),
    ends=("no_generics",),
)
