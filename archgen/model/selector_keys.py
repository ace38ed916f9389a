"""The keys of selectors: which components and nodes `tag:`, `owner:`, `type:` and the others select.

Conditions on properties, as selectors write them: `sil`, `sil>=2`, `mass<12 kg`, `vendor=ac*`.

The page of the site's explorer judges the same conditions itself (backends/site/assets/explorer/properties.js).
"""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable, Mapping

from archgen.frozen import NamedTuple, dataclass
from archgen.model.architecture import Architecture
from archgen.model.component import Component
from archgen.model.deprecation_lookup import list_deprecated_kinds
from archgen.model.element_annotations import order_values
from archgen.model.node import Node
from archgen.model.parameter_values import find_effective_parameters
from archgen.model.port_media import list_medium_words
from archgen.model.requirement import add_below


@dataclass(frozen=True, slots=True)
class SelectorHit:
    """The elements that a path or key selects. `only_nodes`: it names nodes only, so that steps are between nodes."""

    components: frozenset[str]
    nodes: frozenset[str]
    outputs: tuple[str, ...] = ()
    """The ids of outputs if nothing else is named: they feed less than their components do."""
    only_nodes: bool = False
    includes_components: bool = True
    """Whether the components of the nodes are selected, too."""


def matches_wildcard(pattern: str, text: str) -> bool:
    """Whether a text matches a pattern in which `*` stands for any characters, none included.

    Each piece is searched from the end of the one before it, so that the time is in proportion to the text. A regular
    expression made from the pattern would backtrack.
    """
    first, *remaining_pieces = pattern.split("*")
    if not remaining_pieces:
        return pattern == text
    *middle, last = remaining_pieces
    if len(text) < len(first) + len(last) or not text.startswith(first) or not text.endswith(last):
        return False
    position, end = len(first), len(text) - len(last)
    for piece in middle:
        match_position = text.find(piece, position, end)
        if match_position < 0:
            return False
        position = match_position + len(piece)
    return True


def find_by_key(
    architecture: Architecture, key: str, value: str, findings: Mapping[str, frozenset[str]]
) -> SelectorHit:
    """Return the components and nodes that a key's value selects; `*` in it stands for any characters."""
    if key == "type":
        return SelectorHit(frozenset(_find_by_type(architecture, " ".join(value.split()))), frozenset())
    if key in _ORIGIN_KEYS:
        list_origins = _ORIGIN_KEYS[key]
        instances = (
            c.id for c in architecture.components.values() if _matches_any(value, list_origins(architecture, c))
        )
        return SelectorHit(frozenset(instances), frozenset())
    if key in _ELEMENT_FINDERS:
        return _ELEMENT_FINDERS[key](architecture, value)
    if key == "finding":
        return find_elements_of(
            architecture, [element for rule in findings if matches_wildcard(value, rule) for element in findings[rule]]
        )
    component_values, node_values = _COMPONENT_KEYS.get(key), _NODE_KEYS.get(key)
    components = [
        c.id
        for c in architecture.components.values()
        if component_values and _matches_any(value, component_values(architecture, c))
    ]
    nodes = (n.id for n in architecture.nodes.values() if _matches_any(value, node_values(n))) if node_values else ()
    # Most statuses are those of nodes: where no component says this one, steps are between nodes.
    only_nodes = component_values is None or (key == "status" and not components)
    # A node of one partner may implement components of others: `owner:` selects the node without those components.
    return SelectorHit(
        frozenset(components), frozenset(nodes), only_nodes=only_nodes, includes_components=key != "owner"
    )


def find_component_status(architecture: Architecture, component: Component) -> str | None:
    """Return what a component says of its state, else what the composed one around it says."""
    return next((each.status for each in (component, *architecture.list_around(component)) if each.status), None)


def _matches_any(pattern: str, texts: Iterable[str | None]) -> bool:
    return any(text is not None and matches_wildcard(pattern, text) for text in texts)


_COMPONENT_KEYS: Mapping[str, Callable[[Architecture, Component], Iterable[str | None]]] = {
    "owner": lambda _, component: component.owners,
    "status": lambda architecture, component: (find_component_status(architecture, component),),
    "medium": lambda _, component: (word for port in component.ports for word in list_medium_words(port)),
    "role": lambda _, component: (component.role,),
    "behaviour": lambda _, component: (component.timing.behaviour if component.timing else None,),
}
_ORIGIN_KEYS: Mapping[str, Callable[[Architecture, Component], Iterable[str]]] = {
    "is": lambda architecture, component: architecture.list_types_of(component),
    "library": lambda architecture, component: architecture.list_libraries_of(component),
    "deprecated": list_deprecated_kinds,
}
_NODE_KEYS: Mapping[str, Callable[[Node], Iterable[str | None]]] = {
    "owner": lambda node: node.owners,
    "status": lambda node: (node.status,),
    "host": lambda node: (node.host,),
    "package": lambda node: (node.package,),
    "behaviour": lambda node: (timing.behaviour for timing in node.timing.values()),
    "node": lambda node: (node.id,),
}


def list_key_values(architecture: Architecture, key: str) -> set[str]:
    """Return what a key could be followed by, as the elements have it; nothing for keys of conditions and types."""
    if key == "tag":
        kinds = (
            *(architecture.components, architecture.groups, architecture.nodes, architecture.requirements),
            architecture.hosts,
        )
        return {tag for elements in kinds for element in elements.values() for tag in element.tags}
    if key in {"requirement", "use_case", "variant"}:
        return {*getattr(architecture, f"{key}s")}
    list_values, node_values = _COMPONENT_KEYS.get(key), _NODE_KEYS.get(key)
    known = [
        value for each in architecture.components.values() if list_values for value in list_values(architecture, each)
    ]
    known += [value for each in architecture.nodes.values() if node_values for value in node_values(each)]
    return {*filter(None, known), *({*architecture.partners} if key == "owner" else ())}


def _find_tagged(architecture: Architecture, pattern: str) -> SelectorHit:
    """Find what has a tag itself, through its group, through a requirement that it serves, or through its host."""
    groups = {g.id for g in architecture.groups.values() if _matches_any(pattern, g.tags)}
    requirements = {r.id for r in architecture.requirements.values() if _matches_any(pattern, r.tags)}
    hosts = {h.id for h in architecture.hosts.values() if _matches_any(pattern, h.tags)}
    components = (
        c.id
        for c in architecture.components.values()
        if c.group in groups
        or _matches_any(pattern, c.tags)
        or any(r.is_id and r.text in requirements for r in c.requirements)
    )
    nodes = (n.id for n in architecture.nodes.values() if n.host in hosts or _matches_any(pattern, n.tags))
    return SelectorHit(frozenset(components), frozenset(nodes))


def _find_by_type(architecture: Architecture, pattern: str) -> Iterable[str]:
    """Yield the components that send a type (or message), expect it, or read an output with it."""
    names = {
        t.name
        for t in architecture.types.values()
        if matches_wildcard(pattern, t.name) or _matches_any(pattern, (t.message,))
    }
    sent_outputs = {output.id for output in architecture.outputs.values() if output.type in names}
    yield from (output.component for output in architecture.outputs.values() if output.id in sent_outputs)
    yield from (port.component for port in architecture.inputs.values() if port.type in names)
    yield from (architecture.inputs[edge.input].component for edge in architecture.edges if edge.output in sent_outputs)


def _find_by_requirement(architecture: Architecture, pattern: str) -> SelectorHit:
    """Find the components that serve a requirement, or what is part of it."""
    matching_ids = (each for each in architecture.requirements if matches_wildcard(pattern, each))
    declared_ids = add_below(architecture.requirements, matching_ids)
    components = (
        c.id
        for c in architecture.components.values()
        # What nobody declares can be asked for, too.
        if any(r.is_id and (r.text in declared_ids or matches_wildcard(pattern, r.text)) for r in c.requirements)
    )
    return SelectorHit(frozenset(components), frozenset())


def _find_by_parameter(architecture: Architecture, pattern: str) -> SelectorHit:
    """Find the components that declare a parameter, and the nodes that have it, whoever gives it to them."""
    components = (c.id for c in architecture.components.values() if _matches_any(pattern, c.parameters))
    nodes = (
        node.id
        for node in architecture.nodes.values()
        if _matches_any(pattern, find_effective_parameters(architecture, node))
    )
    return SelectorHit(frozenset(components), frozenset(nodes))


def _find_by_use_case(architecture: Architecture, pattern: str) -> SelectorHit:
    """Find the components that take part in a use case, of composed ones all that is inside."""
    components = (
        leaf
        for use_case_id, participants in list_participants(architecture).items()
        if matches_wildcard(pattern, use_case_id)
        for leaf in participants
    )
    return SelectorHit(frozenset(components), frozenset())


def list_participants(architecture: Architecture) -> Mapping[str, tuple[str, ...]]:
    """Return the components that take part in each use case with steps, each once: of composed ones all that is inside."""
    return {
        use_case.id: tuple(
            dict.fromkeys(
                leaf
                for step in use_case.steps
                for end in (step.source, step.target)
                if end.kind in {"component", "output"}
                for leaf in architecture.leaves_of(end.participant)
                if leaf in architecture.components
            )
        )
        for use_case in architecture.use_cases.values()
        if use_case.steps
    }


def _find_by_property(architecture: Architecture, text: str) -> SelectorHit:
    """Find what has a property itself; components also by what is around them, nodes by their host."""
    condition = parse_property_condition(text)
    if condition is None:
        return SelectorHit(frozenset(), frozenset())
    components = {each: find_component_properties(architecture, own) for each, own in architecture.components.items()}
    nodes = {each: find_node_properties(architecture, own) for each, own in architecture.nodes.items()}
    met_components, met_nodes = (
        frozenset(each for each, own in found.items() if condition.is_met(own, matches_wildcard))
        for found in (components, nodes)
    )
    return SelectorHit(met_components, met_nodes)


def find_elements_of(architecture: Architecture, element_ids: Iterable[str]) -> SelectorHit:
    """Return the components and nodes that findings are about; a finding on a group is about all of its components."""
    components, nodes = set[str](), set[str]()
    for element_id in (find_port_holder(architecture, each) for each in element_ids):
        if element_id in architecture.components:
            components.add(element_id)
        elif element_id in architecture.shells:
            components.update(architecture.leaves_of(element_id))
        elif element_id in architecture.groups:
            components.update(c.id for c in architecture.groups[element_id].components.values())
        elif element_id in architecture.nodes:
            nodes.add(element_id)
    return SelectorHit(frozenset(components), frozenset(nodes))


def find_port_holder(architecture: Architecture, element_id: str) -> str:
    """Return the component of a port, composed or not; any other id is returned unchanged."""
    port = architecture.inputs.get(element_id) or architecture.outputs.get(element_id)
    if port:
        return port.component
    holder, _, name = element_id.rpartition(".")
    shell = architecture.shells.get(holder)
    is_child = shell is not None and element_id in shell.children
    return holder if shell and not is_child and (name in shell.inputs or name in shell.outputs) else element_id


_ELEMENT_FINDERS: Mapping[str, Callable[[Architecture, str], SelectorHit]] = {
    "tag": _find_tagged,
    "requirement": _find_by_requirement,
    "parameter": _find_by_parameter,
    "property": _find_by_property,
    "use_case": _find_by_use_case,
}
"""The keys whose values stand at other elements than the components and nodes that they select."""


_CONDITION = re.compile(r"([a-z0-9_*]++)\s*+(?:(>=|<=|=|>|<)\s*+((?![<=>]).*\S))?")
_ORDERS: Mapping[str, Callable[[int], bool]] = {
    ">=": lambda order: order >= 0,
    "<=": lambda order: order <= 0,
    ">": lambda order: order > 0,
    "<": lambda order: order < 0,
    "=": lambda order: order == 0,
}


class PropertyCondition(NamedTuple):
    """A property's id or a pattern of ids, and how its value compares with another; without `sign` any value fits."""

    name: str
    sign: str | None = None
    value: str = ""

    def is_met(self, properties: Mapping[str, str], matches: Callable[[str, str], bool]) -> bool:
        """Whether one of some properties meets the condition; `matches` tells whether a text fits a pattern with `*`."""
        return any(self._fits(text, matches) for name, text in properties.items() if matches(self.name, name))

    def _fits(self, text: str, matches: Callable[[str, str], bool]) -> bool:
        if self.sign is None:
            return True
        order = order_values(text, self.value)
        if order is not None:
            return _ORDERS[self.sign](order)
        return self.sign == "=" and matches(self.value, text)


def parse_property_condition(text: str) -> PropertyCondition | None:
    """Return the condition that a text is; None for none."""
    match = _CONDITION.fullmatch(text)
    return PropertyCondition(match[1], match[2], match[3] or "") if match else None


def find_component_properties(architecture: Architecture, component: Component) -> Mapping[str, str]:
    """Return the properties of a component: its own before those of what is around it, its group last."""
    group = architecture.groups.get(component.group)
    holders = (component, *architecture.list_around(component), *((group,) if group else ()))
    properties: dict[str, str] = {}
    for holder in holders:
        if holder.annotations.properties:
            properties = {**holder.annotations.properties, **properties}
    return properties


def find_node_properties(architecture: Architecture, node: Node) -> Mapping[str, str]:
    """Return the properties of a node: its own before those of its host."""
    host = architecture.hosts.get(node.host or "")
    own = node.annotations.properties
    return {**host.annotations.properties, **own} if host else own
