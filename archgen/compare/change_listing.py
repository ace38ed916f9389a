"""Find what differs between two versions (elements, keys, connections), and which of it is one change.

A version is listed as flat elements in normal form; the first under the ids of the second, so that what follows a rename is
equal.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterator, Mapping

from archgen.compare import change_sentences, changed_keys, element_sentences
from archgen.compare.architecture_version import ArchitectureVersion
from archgen.compare.comparison import Change
from archgen.compare.key_phrases import title_partners
from archgen.compare.kinds import ELEMENT_KINDS, KIND_ORDER
from archgen.compare.kinds.key_spec import KeyValues, ReadContext, key_values
from archgen.compare.kinds.kind_spec import KindSpec
from archgen.compare.kinds.ros_kinds import NODE, PORT, NodePort
from archgen.compare.match_elements import match_elements
from archgen.compare.matched_ids import MatchedIds
from archgen.compare.normal_values import last_part
from archgen.compare.version_pair import (
    ComparedElement,
    ConnectionMap,
    ElementKey,
    RewiredInput,
    VersionPair,
    find_rewired_inputs,
    map_connections,
)
from archgen.diagnostics import NO_SPAN
from archgen.diagnostics.natural_order import NaturalOrder, order_naturally
from archgen.frozen import dataclass, field, replace
from archgen.model.architecture import Architecture
from archgen.model.node import Node, PortUse


def list_elements(
    before: ArchitectureVersion, after: ArchitectureVersion, matched_ids: MatchedIds
) -> tuple[dict[ElementKey, ComparedElement], dict[ElementKey, ComparedElement]]:
    """List all elements of both versions under the ids of the second one."""
    single_before, single_after = (
        ReadContext(version, MatchedIds()).single_node_components for version in (before, after)
    )
    # Only what both versions have: a component that was added or removed has nothing to be compared with.
    matched_components = matched_ids.new_ids.get("component", {})
    split_components = frozenset(
        new_id for old_id, new_id in matched_components.items() if (old_id in single_before) != (new_id in single_after)
    )
    before_context = ReadContext(before, matched_ids, split_components)
    after_context = ReadContext(after, MatchedIds(), split_components)
    elements_after = _list_version_elements(after_context)
    # With other ids an element that is the same refers to others.
    listed = None if matched_ids.has_renames else (after_context, elements_after)
    return _list_version_elements(before_context, listed), elements_after


_ListedVersion = tuple[ReadContext, Mapping[ElementKey, ComparedElement]]


def _list_version_elements(
    context: ReadContext, other_version: _ListedVersion | None = None
) -> dict[ElementKey, ComparedElement]:
    # Values hold no spans: elements that move between files have not changed.
    listed = (element for kind in ELEMENT_KINDS.values() for element in _list_kind(kind, context, other_version))
    return {(element.kind, element.id): element for element in (*listed, *_list_node_ports(context))}


def _list_kind(kind: KindSpec, context: ReadContext, other_version: _ListedVersion | None) -> Iterator[ComparedElement]:
    """Yield the elements of a kind; those of which the other version has the very same, as they are listed there."""
    keys, surroundings = kind.keys, kind.surroundings
    other_context, other_listed = other_version or (context, {})
    other_elements = kind.elements(other_context.version) if kind.elements and other_version else {}
    for own_id, element in kind.elements(context.version).items() if kind.elements else ():
        is_same = element is other_elements.get(own_id)
        if is_same and surroundings and surroundings(element, context) == surroundings(element, other_context):
            yield other_listed[kind.name, own_id]
            continue
        yield ComparedElement(
            kind.name,
            context.matched_ids.common_id(kind.name, own_id),
            own_id,
            KeyValues(keys, element, context),
            kind.parent(element, context),
            kind.owner(element, context),
            kind.is_declared(element),
            kind.components(element, context),
            # Chapters and settings have no place in a slice.
            getattr(element, "at", NO_SPAN).file,
        )


def _list_node_ports(context: ReadContext) -> Iterator[ComparedElement]:
    """Yield the ports of which a written node says more than what its component says already."""
    port_keys = PORT.keys
    untold_components = context.single_node_components - context.told_components
    for node in context.architecture.nodes.values():
        if not node.written:
            continue
        name = context.matched_ids.common_id("node", node.id)
        owner = NODE.owner(node, context)
        for use in (*node.uses, *_implied_uses(context.architecture, node, untold_components)):
            is_stated = use.internal or not (
                use.port is not None and use.port.rpartition(".")[0] in context.told_components
            )
            values = key_values(port_keys, NodePort(use, node, is_stated), context)
            if values:
                key, own_key = _port_ids(use, node, context.matched_ids)
                yield ComparedElement(
                    "port",
                    f"{name}.{key}",
                    f"{node.id}.{own_key}",
                    values,
                    ("node", name),
                    owner,
                    component_refs=_component_port(use, context.matched_ids),
                )


def _implied_uses(architecture: Architecture, node: Node, components: frozenset[str]) -> Iterator[PortUse]:
    """Yield the ports of some of its components that a node carries without writing them."""
    written_ports = {use.port for use in node.uses}
    for endpoint in architecture.endpoints if components.intersection(node.implements) else ():
        if (
            endpoint.node == node.id
            and endpoint.port not in written_ports
            and endpoint.port
            and endpoint.port.rpartition(".")[0] in components
        ):
            yield PortUse(endpoint.use, endpoint.port.rpartition(".")[2], endpoint.port)


def _port_ids(use: PortUse, node: Node, matched_ids: MatchedIds) -> tuple[str, str]:
    """Return a port's id below its node, with the common name and with the name in this version."""
    if use.port is None:
        key = f"{'internal.' if use.internal else ''}{use.use}.{use.key}"
        return key, key
    common_port = _component_port(use, matched_ids)[0]
    # Two components may have ports of one name: with several components the id names the component as well.
    part_count = 1 if len(node.implements) <= 1 else 2
    return f"{use.use}.{last_part(common_port, part_count)}", f"{use.use}.{last_part(use.port, part_count)}"


def _component_port(use: PortUse, matched_ids: MatchedIds) -> tuple[str, ...]:
    """Return the common id of the component's port behind a use, nothing for an internal one."""
    if use.port is None:
        return ()
    return (matched_ids.common_id("output" if use.use in {"publishes", "serves"} else "input", use.port),)


@dataclass(slots=True)
class DifferenceFinder:
    """Collects the changes between two versions. `attached_changes` belong to an element that was added or removed."""

    elements_before: Mapping[ElementKey, ComparedElement]
    elements_after: Mapping[ElementKey, ComparedElement]
    matched_ids: MatchedIds
    versions: VersionPair
    _sharing_nodes: frozenset[ElementKey] = frozenset()
    """Nodes that share their components with other nodes in both versions, and therefore say which ports they carry."""
    top_changes: list[Change] = field(default_factory=list)
    attached_changes: dict[ElementKey, list[Change]] = field(default_factory=lambda: defaultdict(list))

    def find_all_changes(self, old_connections: ConnectionMap, new_connections: ConnectionMap) -> tuple[Change, ...]:
        """Return all changes in the order of the report. Call it once: it fills `top_changes`."""
        # "carried" is only among the values of a port where the node must say that it carries it: internal ports, and
        # components with several nodes.
        carriers = (
            {
                candidate.parent_key
                for candidate in side.values()
                if candidate.kind == "port" and candidate.parent_key and "carried" in candidate.values
            }
            for side in (self.elements_before, self.elements_after)
        )
        self._sharing_nodes = frozenset.intersection(*map(frozenset, carriers))
        # Connections and ports come before `_add_whole_elements`: it attaches what they left in `attached_changes`, and
        # what is attached afterwards would be lost.
        self._add_connections(old_connections, new_connections)
        self._add_renames()
        for key, element in self.elements_after.items():
            if key in self.elements_before:
                self._add_changed_keys(self.elements_before[key], element)
            elif element.kind == "port":
                self._add_port_change(None, element)
        for key, element in self.elements_before.items():
            if key not in self.elements_after and element.kind == "port":
                self._add_port_change(element, None)
        self._add_whole_elements()
        return tuple(sorted(self.top_changes, key=change_order))

    def _add_whole_elements(self) -> None:
        """Add the elements that were added or removed, each with its parts inside the same change."""
        for change_kind, own_elements, other_elements in (
            ("removed", self.elements_before, self.elements_after),
            ("added", self.elements_after, self.elements_before),
        ):
            parts_by_parent: dict[ElementKey, list[ComparedElement]] = defaultdict(list)
            roots = []
            for key, element in own_elements.items():
                if (
                    key in other_elements
                    or not element.is_declared
                    or element.kind == "port"
                    or self.versions.may_be_unread(key)
                ):
                    continue
                if (
                    element.parent_key is not None
                    and element.parent_key in own_elements
                    and element.parent_key not in other_elements
                ):
                    parts_by_parent[element.parent_key].append(element)
                else:
                    roots.append(element)
            self.top_changes += (self._whole_change(change_kind, element, parts_by_parent) for element in roots)

    def _whole_change(
        self, change_kind: str, element: ComparedElement, parts_by_parent: Mapping[ElementKey, list[ComparedElement]]
    ) -> Change:
        key = (element.kind, element.id)
        part_changes = [
            self._whole_change(change_kind, part, parts_by_parent) for part in parts_by_parent.get(key, ())
        ] + self.attached_changes.pop(key, [])
        change = Change("added" if change_kind == "added" else "removed", element.kind, element.own_id)
        change = replace(change, parts=tuple(sorted(part_changes, key=change_order)))
        return replace(change, text=element_sentences.describe_element_change(change, element, self.versions))

    def _add_renames(self) -> None:
        for (kind, name), confidence in self.matched_ids.confidence.items():
            old_id = self.matched_ids.old_ids[kind][name]
            old_parent, new_parent = self._common_parent(old_id), name.rpartition(".")[0]
            is_nested = kind in {"component", "composed"}
            if is_nested and (old_parent, old_id.rpartition(".")[2]) == (new_parent, name.rpartition(".")[2]):
                continue  # its id follows that of what is around it
            is_moved = is_nested and old_parent != new_parent
            change = Change("moved" if is_moved else "renamed", kind, name, old_id=old_id, confidence=confidence)
            self.top_changes.append(replace(change, text=change_sentences.describe_rename(change, self.versions)))

    def _common_parent(self, component_id: str) -> str:
        """Return the common id of the group or composed component around a component."""
        parent = component_id.rpartition(".")[0]
        new_shell = self.matched_ids.find_new_id("composed", parent)
        if new_shell is not None:
            return new_shell
        group, dot, path = parent.partition(".")
        return f"{self.matched_ids.common_id('group', group)}{dot}{path}"

    def _add_changed_keys(self, old_element: ComparedElement, new_element: ComparedElement) -> None:
        if old_element is new_element or old_element.values == new_element.values:
            return
        for key, before, after in changed_keys.list_changed_keys(
            old_element, new_element, self.elements_before, self.elements_after
        ):
            element_key = (new_element.kind, new_element.id)
            if isinstance(before, Mapping) and isinstance(after, Mapping):
                read_names = [name for name in before if not self._may_be_unread_in_one(element_key, name)]
                before, after = ({name: each[name] for name in read_names} for each in (before, after))  # noqa: PLW2901
                if not read_names:
                    continue
            if not self.versions.value_may_be_unread(element_key, before, after, key):
                self.top_changes.append(self._key_change(new_element, key, before, after))

    def _may_be_unread_in_one(self, key: ElementKey, value_key: str) -> bool:
        """Whether a value that has a default was taken out of either version, since it could not be read."""
        return any(self.versions.key_may_be_unread(key, value_key, side) for side in (0, 1))

    def _key_change(self, element: ComparedElement, key: str, before: object, after: object) -> Change:
        change = Change("changed", element.kind, element.id, key=key, before=before, after=after)
        return replace(change, text=change_sentences.describe_change(change, self.versions))

    def _add_port_change(self, old_port: ComparedElement | None, new_port: ComparedElement | None) -> None:
        """Add what a node says of a port in one version only: to the port's change, to the node's, or as a change of
        its own.
        """
        port_element = new_port or old_port
        if port_element is None or port_element.parent_key is None:
            return
        # Compared with an element without values, every value of the port is a change of its own.
        absent_port = replace(port_element, values={})
        outermost_key = self._outermost_of_port(port_element.component_refs[0]) if port_element.component_refs else None
        node_key = (
            port_element.parent_key
            if (port_element.parent_key in self.elements_before) != (port_element.parent_key in self.elements_after)
            else None
        )
        parent_key = node_key or outermost_key
        # What is inside a node belongs to no component that could say it: it came or went as a whole.
        is_own = not port_element.component_refs
        if (
            parent_key
            or is_own
            or ("carried" in port_element.values and port_element.parent_key in self._sharing_nodes)
        ):
            change_kind = "added" if new_port else "removed"
            change = Change("added" if new_port else "removed", "port", port_element.own_id)
            change = replace(
                change, text=change_sentences.describe_port_change(change_kind, port_element, self.versions)
            )
            (self.attached_changes[parent_key] if parent_key else self.top_changes).append(change)
        else:
            self._add_changed_keys(old_port or absent_port, new_port or absent_port)

    def _outermost_of_port(self, port_id: str) -> ElementKey | None:
        """Return the outermost element with which a port was added or removed, None if the port is in both versions."""
        # A port's complete id does not say its direction.
        port_keys = (("output", port_id), ("input", port_id))
        key = next((key for key in port_keys if (key in self.elements_before) != (key in self.elements_after)), None)
        return self._outermost_element(key) if key else None

    def _outermost_element(self, key: ElementKey) -> ElementKey:
        """Return the component of a port if it was added or removed too, else the port."""
        parent_key = (self.elements_before.get(key) or self.elements_after[key]).parent_key
        parent_differs = parent_key is not None and (parent_key in self.elements_before) != (
            parent_key in self.elements_after
        )
        return parent_key if parent_differs and parent_key is not None else key

    def _add_connections(self, old_connections: ConnectionMap, new_connections: ConnectionMap) -> None:
        for rewired_input in find_rewired_inputs(old_connections, new_connections):
            if self._may_be_unread(rewired_input):
                continue
            cause_key = self._find_cause(rewired_input)
            before, after = sorted(rewired_input.sources_before), sorted(rewired_input.sources_after)
            change_kind = "changed" if before and after else "added" if after else "removed"
            input_id = (
                self._old_input_id(rewired_input.input_id) if change_kind == "removed" else rewired_input.input_id
            )
            change = Change(change_kind, "connection", input_id, before=self._old_output_ids(before), after=after)  # type: ignore[arg-type]
            change = replace(change, text=change_sentences.describe_connection(rewired_input, self.versions))
            (self.attached_changes[cause_key] if cause_key else self.top_changes).append(change)

    def _may_be_unread(self, rewired_input: RewiredInput) -> bool:
        """Whether a connection only seems to have changed because one of its ends could not be read."""
        lost_before, lost_after = self.versions.lost_keys
        for side, sources in ((0, rewired_input.gained_sources), (1, rewired_input.lost_sources)):
            if any(self.versions.is_of_untyped(name, side) for name in (*sources, rewired_input.input_id) if sources):
                return True
        if not (lost_before or lost_after):
            return False
        lost_words, gained_words = (
            {part for name in (*sources, rewired_input.input_id) for part in name.split(".") if sources}
            for sources in (rewired_input.lost_sources, rewired_input.gained_sources)
        )
        return not (lost_after.isdisjoint(lost_words) and lost_before.isdisjoint(gained_words))

    def _find_cause(self, rewired_input: RewiredInput) -> ElementKey | None:
        """Return the element whose addition or removal took the connection along, if there is one."""
        key = ("input", rewired_input.input_id)
        if (key in self.elements_before) != (key in self.elements_after):
            return self._outermost_element(key)
        # The reader was rewired to something that exists: that is its own decision, whatever became of the old source.
        if rewired_input.lost_sources and any(
            ("output", name) in self.elements_after for name in rewired_input.gained_sources
        ):
            return None
        own_elements, other_elements = (
            (self.elements_before, self.elements_after)
            if rewired_input.lost_sources
            else (self.elements_after, self.elements_before)
        )
        output_keys = [("output", name) for name in sorted(rewired_input.lost_sources or rewired_input.gained_sources)]
        if all(output in own_elements and output not in other_elements for output in output_keys):
            return self._outermost_element(output_keys[0])
        return None

    def _old_input_id(self, input_id: str) -> str:
        element = self.elements_before.get(("input", input_id))
        return element.own_id if element else input_id

    def _old_output_ids(self, outputs: list[str]) -> list[str]:
        """Return the outputs of the first version by the ids that they had there."""
        return sorted(
            self.elements_before[key].own_id if (key := ("output", name)) in self.elements_before else name
            for name in outputs
        )


def change_order(change: Change) -> tuple[int, NaturalOrder, int, str]:
    """Return the sort key of a change: kind of element, id, what happened, key."""
    change_kinds = ("renamed", "moved", "removed", "added", "changed")
    return (
        KIND_ORDER[change.element_kind],
        order_naturally(change.element_id),
        change_kinds.index(change.kind),
        change.key or "",
    )


def list_changes(before: ArchitectureVersion, after: ArchitectureVersion) -> tuple[Change, ...]:
    """Return what is different in another version, element by element, without whom it breaks or what follows for timing."""
    return find_changes(before, after, match_elements(before.architecture, after.architecture))[1]


def find_changes(
    before: ArchitectureVersion, after: ArchitectureVersion, matched_ids: MatchedIds
) -> tuple[VersionPair, tuple[Change, ...]]:
    """Return two versions in normal form, and every difference between them."""
    elements = list_elements(before, after, matched_ids)
    old_connections = map_connections(before.architecture, matched_ids)
    new_connections = map_connections(after.architecture, MatchedIds())
    lost_keys = before.architecture.unread_keys, after.architecture.unread_keys
    version_pair = VersionPair(
        old_connections,
        new_connections,
        *elements,
        lost_keys,
        _find_unnamed_outputs(after.architecture),
        (before.sound_files, after.sound_files),
        (before.broken_files, after.broken_files),
        (before.library_files, after.library_files),
        (before.architecture.untyped_components, after.architecture.untyped_components),
        partner_names=title_partners(before.architecture, after.architecture),
    )
    finder = DifferenceFinder(*elements, matched_ids, version_pair)
    return version_pair, finder.find_all_changes(old_connections, new_connections)


def _find_unnamed_outputs(architecture: Architecture) -> frozenset[str]:
    """Return the outputs of written nodes whose topic, service or action has no written name."""
    # What runs as a whole has the names of the composed component, which stay where leaves inside move.
    written_nodes = {node.id for node in architecture.nodes.values() if node.written and not node.wholes}
    offered_endpoints = (
        endpoint
        for endpoint in architecture.endpoints
        if endpoint.node in written_nodes and endpoint.use in {"publishes", "serves"}
    )
    return frozenset(endpoint.port for endpoint in offered_endpoints if endpoint.port and not endpoint.name_written)
