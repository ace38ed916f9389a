"""The keys of selectors: which components and nodes `tag:`, `owner:`, `type:` and the others select."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping

from archgen.frozen import dataclass
from archgen.model.architecture import Architecture
from archgen.model.component import Component
from archgen.model.names import Named
from archgen.model.node import Node


@dataclass(frozen=True, slots=True)
class Hit:
    """The elements that a path or key selects. `only_nodes`: it names nodes only, so that steps are between nodes."""

    components: frozenset[str]
    nodes: frozenset[str]
    named: tuple[Named, ...] = ()
    outputs: tuple[str, ...] = ()
    """The ids of outputs if nothing else is named: they feed less than their components do."""
    of_nodes: bool = False
    crosses: bool = True
    """Whether the components of the nodes are selected, too."""


def wild(pattern: str, text: str) -> bool:
    """Whether a text matches a pattern in which `*` stands for any characters, none included.

    Each piece is searched from the end of the one before it, so that the time is in proportion to the text. A regular
    expression made from the pattern would backtrack.
    """
    first, *rest = pattern.split("*")
    if not rest:
        return pattern == text
    *middle, last = rest
    if len(text) < len(first) + len(last) or not text.startswith(first) or not text.endswith(last):
        return False
    here, end = len(first), len(text) - len(last)
    for piece in middle:
        found = text.find(piece, here, end)
        if found < 0:
            return False
        here = found + len(piece)
    return True


def by_key(architecture: Architecture, key: str, value: str, findings: Mapping[str, frozenset[str]]) -> Hit:
    """Return the components and nodes that a key's value selects; `*` in it stands for any characters."""
    if key == "type":
        return Hit(frozenset(_with_type(architecture, " ".join(value.split()))), frozenset())
    if key == "tag":
        return _tagged(architecture, value)
    if key == "finding":
        return _found(architecture, [element for rule in findings if wild(value, rule) for element in findings[rule]])
    of_component, of_node = _COMPONENTS.get(key), _NODES.get(key)
    components = (
        (c.id for c in architecture.components.values() if _any(value, of_component(c))) if of_component else ()
    )
    nodes = (n.id for n in architecture.nodes.values() if _any(value, of_node(n))) if of_node else ()
    # A node of one partner may implement components of others: `owner:` selects the node without those components.
    return Hit(frozenset(components), frozenset(nodes), of_nodes=of_component is None, crosses=key != "owner")


def _any(value: str, texts: Iterable[str | None]) -> bool:
    return any(text is not None and wild(value, text) for text in texts)


def _media(component: Component) -> Iterable[str]:
    physical = (*(i.physical for i in component.inputs.values()), *(o.physical for o in component.outputs.values()))
    return ("physical" if yes else "digital" for yes in physical)


_COMPONENTS: Mapping[str, Callable[[Component], Iterable[str | None]]] = {
    "owner": lambda component: component.owners,
    "medium": _media,
    "role": lambda component: (component.role,),
    "requirement": lambda component: (use.text for use in component.requirements if use.is_id),
    "behaviour": lambda component: (component.timing.behaviour if component.timing else None,),
}
_NODES: Mapping[str, Callable[[Node], Iterable[str | None]]] = {
    "owner": lambda node: node.owners,
    "status": lambda node: (node.status,),
    "host": lambda node: (node.host,),
    "package": lambda node: (node.package,),
    "behaviour": lambda node: (timing.behaviour for timing in node.timing.values()),
    "node": lambda node: (node.id,),
}


def _tagged(architecture: Architecture, value: str) -> Hit:
    """Find what has a tag itself, through its group, through a requirement that it serves, or through its host."""
    groups = {g.id for g in architecture.groups.values() if _any(value, g.tags)}
    requirements = {r.id for r in architecture.requirements.values() if _any(value, r.tags)}
    hosts = {h.id for h in architecture.hosts.values() if _any(value, h.tags)}
    components = (
        c.id
        for c in architecture.components.values()
        if c.group in groups or _any(value, c.tags) or any(r.is_id and r.text in requirements for r in c.requirements)
    )
    nodes = (n.id for n in architecture.nodes.values() if n.host in hosts or _any(value, n.tags))
    return Hit(frozenset(components), frozenset(nodes))


def _with_type(architecture: Architecture, value: str) -> Iterable[str]:
    """Yield the components that send a type (or message), expect it, or read an output with it."""
    names = {t.name for t in architecture.types.values() if wild(value, t.name) or _any(value, (t.message,))}
    sending = {output.id for output in architecture.outputs.values() if output.type in names}
    yield from (architecture.outputs[output].component for output in sending)
    yield from (port.component for port in architecture.inputs.values() if port.type in names)
    yield from (architecture.inputs[edge.input].component for edge in architecture.edges if edge.output in sending)


def _found(architecture: Architecture, elements: Iterable[str]) -> Hit:
    """Return the components and nodes that findings are about; a finding on a group is about all of its components."""
    components, nodes = set[str](), set[str]()
    for element in elements:
        port = architecture.inputs.get(element) or architecture.outputs.get(element)
        if port:
            components.add(port.component)
        elif element in architecture.components:
            components.add(element)
        elif element in architecture.groups:
            components.update(c.id for c in architecture.groups[element].components.values())
        elif element in architecture.nodes:
            nodes.add(element)
    return Hit(frozenset(components), frozenset(nodes))
