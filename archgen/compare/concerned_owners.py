"""Find the partners who own what a comparison touches, or have something at its other end, beside it or behind it."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence

from archgen.compare.comparison import BoundaryChange, ChainChange, Change, LimitChange, LoadChange
from archgen.compare.element_sentences import find_outer_messages
from archgen.compare.kinds import Effect, find_effect
from archgen.compare.version_pair import ComparedElement, ConnectionMap, ElementKey, VersionPair
from archgen.diagnostics.natural_order import order_naturally

_MEANING_KEYS = frozenset({"", "type", "description"})
_OUTPUT_TIMING = "timing.outputs."
_PACE_KEYS = frozenset(
    f"timing.{key}" for key in ("behaviour", "rate", "jitter", "every", "throttle", "trigger", "trigger.inputs")
)
"""Keys of components and nodes that say how often their outputs come."""
_OWNER_KEYS = frozenset({"owner", "co_owners"})
_PLACE_KEYS = frozenset({"host", "container"})


def find_concerned_owners(
    changes: Sequence[Change],
    versions: VersionPair,
    figures: Iterable[BoundaryChange | LimitChange | LoadChange | ChainChange] = (),
) -> tuple[str, ...]:
    """Return the partners who should look at the changes, sorted: those who own what changed or have something at its
    other end, those who lose something, and those whose figures are others now.
    """
    owner_ids = {partner for figure in figures for partner in figure.concerned_partners}
    owner_ids.update(partner for change in changes for partner in change.broken_partners)
    # Removed elements are reported by their old id, `elements_before` has them by the common one.
    elements_by_own_id = {
        (old_element.kind, old_element.own_id): old_element for old_element in versions.elements_before.values()
    }
    for change in _walk_changes(changes):
        owner_ids.update(_find_affected(change, versions, elements_by_own_id))
    return tuple(sorted(owner_ids, key=order_naturally))


def _find_affected(
    change: Change, versions: VersionPair, elements_by_own_id: Mapping[ElementKey, ComparedElement]
) -> Iterator[str]:
    if change.element_kind == "link" and versions.link_users is not None:
        # Most of those on the hosts that a link connects send nothing over it.
        yield from () if _is_textual(change) else versions.link_users.get(change.element_id, ())
        for elements in versions.elements:
            element = _find_element(change, elements, elements_by_own_id)
            yield from _list_owners(element, elements) if element else ()
        return
    if change.element_kind == "policy":
        yield from () if _is_textual(change) else versions.policy_partners.get(change.element_id, ())
        return
    # Both versions: who read the output before is concerned as much as who reads it now.
    for elements, connections in (
        (versions.elements_before, versions.connections_before),
        (versions.elements_after, versions.connections_after),
    ):
        element = _find_element(change, elements, elements_by_own_id)
        yield from _owners_of_change(change, element, elements, connections)
    node = versions.elements_after.get(("node", change.element_id))
    if node and change.element_kind == "node" and change.key in _PLACE_KEYS:
        yield from _owners_beside(node, versions)


def _walk_changes(changes: Sequence[Change]) -> Iterator[Change]:
    for change in changes:
        yield change
        yield from _walk_changes(change.parts)


def _find_element(
    change: Change,
    elements: Mapping[ElementKey, ComparedElement],
    elements_by_own_id: Mapping[ElementKey, ComparedElement],
) -> ComparedElement | None:
    kind = "input" if change.element_kind == "connection" else change.element_kind
    element = elements.get((kind, change.element_id))
    if (
        element is None
        and change.kind == "removed"
        and (removed_element := elements_by_own_id.get((kind, change.element_id)))
    ):
        return elements.get((kind, removed_element.id))
    return element


def _owners_of_change(
    change: Change,
    element: ComparedElement | None,
    elements: Mapping[ElementKey, ComparedElement],
    connections: ConnectionMap,
) -> Iterator[str]:
    if element is None:
        return
    yield from _list_owners(element, elements)
    for key in (*_opposite_keys(change, element, elements, connections), *_surrounding_keys(change, element)):
        opposite = elements.get(key)
        if opposite:
            yield from _list_owners(opposite, elements)


def _list_owners(element: ComparedElement, elements: Mapping[ElementKey, ComparedElement]) -> Iterator[str]:
    """Yield all who answer for an element; for a port those of its component."""
    if element.owner:
        yield element.owner
    holder = elements.get(element.parent_key) if element.kind in {"input", "output"} and element.parent_key else element
    co_owners = holder.values.get("co_owners") if holder else None
    if isinstance(co_owners, frozenset):
        yield from co_owners


def _surrounding_keys(change: Change, element: ComparedElement) -> Iterator[ElementKey]:
    """Yield the group that a component came into or left: its owner answers for what is in it."""
    if change.element_kind == "component" and change.kind != "changed" and element.parent_key:
        yield element.parent_key


def _opposite_keys(
    change: Change, element: ComparedElement, elements: Mapping[ElementKey, ComparedElement], connections: ConnectionMap
) -> Iterator[ElementKey]:
    """Yield the keys of what is at the other end of a changed element."""
    if change.element_kind in {"chain", "host", "container", "link", "frame"} and _is_textual(change):
        return
    match change.element_kind:
        case "input" if change.key == "optional":
            # Whether somebody depends on it is for the source to know.
            yield from (("output", name) for name in connections.sources_by_input.get(element.id, ()))
        case "connection":
            yield from (("output", name) for name in connections.sources_by_input.get(element.id, ()))
        case "output" | "port" | "component" | "node" | "group":
            yield from (
                ("input", name)
                for output in _find_changed_outputs(change, element, connections)
                for name in connections.readers_by_output.get(output, ())
            )
        case "chain":
            yield from _chain_points(element)
        case "host" | "container" | "link":
            yield from _nodes_at_place(element, elements)
        case "type" | "requirement" | "frame":
            yield from _users_and_readers(element, elements, connections)
        case "project" if change.key == "distro":
            # Everybody builds against it.
            yield from elements
        case "message":
            yield from _carriers_of_message(element, elements, connections)


def _find_changed_outputs(change: Change, element: ComparedElement, connections: ConnectionMap) -> Iterable[str]:
    """Return the outputs that a change makes into something else for their readers: in meaning, in form or in pace."""
    key = change.key or ""
    if change.element_kind == "output":
        return (element.id,) if key in _MEANING_KEYS else ()
    if change.element_kind == "port":
        return element.component_refs
    # Readers meet a node's topics: one that follows the node's name is a change of its own.
    if key in _OWNER_KEYS or (change.kind in {"renamed", "moved"} and change.element_kind != "node"):
        # Another counterpart, or another name to write: whoever reads it has to know.
        holders = element.component_refs if element.kind == "node" else (element.id,)
        prefixes = tuple(f"{holder}." for holder in holders)
        return [name for name in connections.readers_by_output if f"{name}.".startswith(prefixes)]
    if key.startswith(_OUTPUT_TIMING):
        output_name = key.removeprefix(_OUTPUT_TIMING).partition(".")[0]
        return [f"{component}.{output_name}" for component in element.component_refs]
    if key in _PACE_KEYS or key.startswith("performance."):
        return [name for name in connections.readers_by_output if name.rpartition(".")[0] in element.component_refs]
    return ()


def _is_textual(change: Change) -> bool:
    return change.key is not None and find_effect(change.element_kind, change.key) is Effect.TEXT


def _owners_beside(node: ComparedElement, versions: VersionPair) -> Iterator[str]:
    """Yield the owners of the nodes on the host that a node came to: they share it now."""
    elements = versions.elements_after
    container = elements.get(("container", str(node.values.get("container"))))
    host_id = node.values.get("host") or (container.values.get("host") if container else None)
    host = elements.get(("host", str(host_id)))
    for key in _nodes_at_place(host, elements) if host else ():
        yield from _list_owners(elements[key], elements)


def _carriers_of_message(
    message: ComparedElement, elements: Mapping[ElementKey, ComparedElement], connections: ConnectionMap
) -> Iterator[ElementKey]:
    """Yield the ports whose types are carried by a message or by one that contains it, and who reads these."""
    messages = {message.id, *find_outer_messages(message.id, elements)}
    for candidate in elements.values():
        if candidate.kind == "type" and candidate.values.get("message") in messages:
            yield from _users_and_readers(candidate, elements, connections)


def _chain_points(chain: ComparedElement) -> Iterator[ElementKey]:
    """Yield the components, nodes and outputs that a chain may lead through."""
    through = chain.values.get("through")
    for point in through if isinstance(through, tuple) else ():
        # A point's id does not say its kind; the keys that do not exist are skipped by `_owners_of_change`.
        yield from (("component", point), ("node", point), ("output", point))


def _nodes_at_place(place: ComparedElement, elements: Mapping[ElementKey, ComparedElement]) -> Iterator[ElementKey]:
    """Yield the nodes on a host, in a container, or on the hosts that a link connects."""
    hosts = place.values.get("connects") if place.kind == "link" else frozenset({place.id})
    if not isinstance(hosts, frozenset):
        return
    key = "container" if place.kind == "container" else "host"
    container_ids = {
        name
        for (kind, name), candidate in elements.items()
        if kind == "container" and candidate.values.get("host") in hosts
    }
    for candidate_key, candidate_node in elements.items():
        in_container = key == "host" and candidate_node.values.get("container") in container_ids
        if candidate_key[0] == "node" and (candidate_node.values.get(key) in hosts or in_container):
            yield candidate_key


def _users_and_readers(
    element: ComparedElement, elements: Mapping[ElementKey, ComparedElement], connections: ConnectionMap
) -> Iterator[ElementKey]:
    """Yield the users of an element, and who reads these."""
    for key in _users_of_element(element, elements):
        yield from (key, *(("input", reader) for reader in connections.readers_by_output.get(key[1], ())))


def _users_of_element(element: ComparedElement, elements: Mapping[ElementKey, ComparedElement]) -> Iterator[ElementKey]:
    """Yield the ports of a type, the components that serve a requirement and what is on the chains that verify it, or
    what is given or placed in a frame.
    """
    verified_by = element.values.get("verified_by")
    for name in sorted(verified_by) if isinstance(verified_by, frozenset) else ():
        if chain := elements.get(("chain", name)):
            yield from _chain_points(chain)
    for key, candidate in elements.items():
        if element.kind == "frame" and element.id in {candidate.values.get("frame"), candidate.values.get("parent")}:
            yield from (key, *_users_of_element(candidate, elements)) if key[0] == "type" else (key,)
        if element.kind == "type" and key[0] in {"output", "input"} and candidate.values.get("type") == element.id:
            yield key
        requirement_ids = (
            candidate.values.get("requirements") if element.kind == "requirement" and key[0] == "component" else None
        )
        if isinstance(requirement_ids, frozenset) and element.id in requirement_ids:
            yield key
