"""Write out what a project makes from component types, and take composed components apart into leaves and shells.

What comes out is a project as if everything had been written by hand: the groups hold leaves, by their path inside the
group (`arm.motor`). Nodes of the tree keep their places, so that what is wrong with an instance points at the type's
line. A project without types and composed components comes out as it went in.

What a reference (`same_as`) may say: it is its type exactly, and has only a place and a name of its own.

Give each instance containers of its own: `containers` inside of a component become containers of the project.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import TYPE_CHECKING

from archgen.compose.expanded_project import ComponentShell, ExpandedProject, Expansion, InstanceOrigin, TypeExpression
from archgen.compose.instance_overlay import InstanceOverlay
from archgen.compose.library_types import library_of_type, list_type_entries
from archgen.diagnostics import Diagnostic, Label
from archgen.model.derived_names import derive_node_ids
from archgen.syntax.yaml_tree import MappingEntry, MappingNode, ScalarNode, change_at, find_value, list_entries

if TYPE_CHECKING:
    from archgen.compose.type_table import MissingTypeDescriber


def make_instance_containers(
    root: MappingNode, bodies: Mapping[str, MappingEntry], parents: Mapping[str, str]
) -> tuple[dict[str, MappingEntry], dict[str, str]]:
    """Return the containers to add to a project, and who brings them along, by id; name them in the bodies of components.

    `bodies` are the entries of all components by complete id; those whose node names a container inside of what is
    around it get a body of their own.
    """
    entries_by_path = dict(_list_containers(bodies))
    if not entries_by_path:
        return {}, {}
    written = root.get("containers")
    used_ids = written.entries if isinstance(written, MappingNode) else {}
    ids = derive_node_ids(entries_by_path, entries_by_path, used_ids)
    for component_id, entry in bodies.items():
        _name_container(component_id, entry, ids, parents)
    containers = {
        ids[path]: MappingEntry(ids[path], each.key_span, each.value) for path, each in entries_by_path.items()
    }
    return containers, {ids[path]: path.rpartition(".")[0] for path in entries_by_path}


def _list_containers(bodies: Mapping[str, MappingEntry]) -> Iterator[tuple[str, MappingEntry]]:
    for component_id, entry in bodies.items():
        for container in list_entries(entry.value, "containers"):
            yield f"{component_id}.{container.key}", container


def _name_container(component_id: str, entry: MappingEntry, ids: Mapping[str, str], parents: Mapping[str, str]) -> None:
    reference = find_value(entry.value, "node", "container")
    if not isinstance(reference, ScalarNode):
        return
    around: str | None = component_id
    while around is not None and f"{around}.{reference.text}" not in ids:
        around = parents.get(around)
    if around is None:
        return
    name = ScalarNode(ids[f"{around}.{reference.text}"], ids[f"{around}.{reference.text}"], reference.span)
    # A body of its own: other instances share the type's.
    entry.value = change_at(entry.value, ("node", "container"), lambda _: name)


MAX_ELEMENTS = 100_000
"""So many components a project may have when everything is written out: ten times the largest that people describe."""
MAX_DEPTH = 60
"""So deep components may stand inside of one another, written or made from types."""
_COMPOSING_KEYS = frozenset({"is", "same_as", "components", "node", "containers", "from", "autoconnect"})
"""Keys of a component that make it more than a leaf with ports."""


def expand_project(
    root: MappingNode,
    incomplete_libraries: frozenset[str] = frozenset(),
    describe_missing_type: MissingTypeDescriber | None = None,
) -> ExpandedProject:
    """Return a merged project with types written out and composed components taken apart. The tree is not changed.

    Types that `incomplete_libraries` lack are not reported: something in them could not be read. Others are, with what
    `describe_missing_type` says of them.
    """
    groups = root.get("groups")
    groups = groups if isinstance(groups, MappingNode) else MappingNode({}, root.span)
    if "component_types" not in root.entries and not _uses_composition(groups):
        return ExpandedProject(root, is_plain=True)
    return _ProjectExpander(root, incomplete_libraries, describe_missing_type).expand_groups(groups)


def _uses_composition(groups: MappingNode) -> bool:
    return any(
        isinstance(component.value, MappingNode) and not _COMPOSING_KEYS.isdisjoint(component.value.entries)
        for group in groups
        for component in list_entries(group.value, "components")
    ) or any("autoconnect" in group.value.entries for group in groups if isinstance(group.value, MappingNode))


class _ProjectExpander:
    """Expands the components of a project; equal parts of one type are expanded once and shared."""

    def __init__(
        self,
        root: MappingNode,
        incomplete_libraries: frozenset[str],
        describe_missing_type: MissingTypeDescriber | None,
    ) -> None:
        from archgen.compose.type_table import TypeTable

        self._root = root
        self._diagnostics: list[Diagnostic] = []
        self._types = TypeTable(list_type_entries(root), self._diagnostics, incomplete_libraries, describe_missing_type)
        self._overlay = InstanceOverlay(self._diagnostics, self._types.may_replace)
        # By the identity of the written node, which the merged tree or a type's body keeps alive.
        self._expansions: dict[int, Expansion] = {}
        self._open_types: list[str] = []
        self._damaged_elements: set[str] = set()
        self._circular_types: set[str] = set()
        self._result = ExpandedProject(root)

    def expand_groups(self, groups: MappingNode) -> ExpandedProject:
        sized_groups = [
            (
                group,
                [
                    (part, self._expand(part.value, f"{group.key}.{part.key}"))
                    for part in list_entries(group.value, "components")
                ],
            )
            for group in groups
        ]
        total = sum(expansion.size for _, parts in sized_groups for _, expansion in parts)
        if total > MAX_ELEMENTS:
            sized_groups = [(group, list(self._limit_parts(group, parts))) for group, parts in sized_groups]
        self._result.parts = {group.key: parts for group, parts in sized_groups}
        group_entries = {group.key: self._flatten_group(group, parts) for group, parts in sized_groups}
        if group_entries:
            section = self._root.entries["groups"].with_value(MappingNode(group_entries, groups.span))
            self._result.root = MappingNode({**self._root.entries, "groups": section}, self._root.span)
        self._add_containers()
        self._judge_types()
        self._result.damaged_elements = frozenset(self._damaged_elements)
        self._result.diagnostics = tuple(dict.fromkeys(self._diagnostics))
        return self._result

    def _add_containers(self) -> None:
        leaves = {
            f"{group.key}.{leaf.key}": leaf
            for group in list_entries(self._result.root, "groups")
            for leaf in list_entries(group.value, "components")
        }
        shells = {shell.id: shell.entry for shell in self._result.shells.values()}
        containers, holders = make_instance_containers(self._root, {**leaves, **shells}, self._result.parents)
        self._result.container_holders = holders
        if containers:
            written = self._root.entries.get("containers")
            entries = written.value.entries if written and isinstance(written.value, MappingNode) else {}
            span = next(iter(containers.values())).key_span
            section = MappingEntry("containers", span, MappingNode({**entries, **containers}, span))
            self._result.root = MappingNode(
                {**self._result.root.entries, "containers": section}, self._result.root.span
            )

    def _judge_types(self) -> None:
        """Find what is wrong in types of which there is no instance; of libraries only in those that are used."""
        for name in self._types.entries:
            if library_of_type(name) is None:
                self._judge_type(name)
        # To judge one may ask for others; sorted, since a packed file holds them in another order.
        while names := sorted(name for name in self._types.library_names if name not in self._result.type_bodies):
            for name in names:
                self._judge_type(name)

    def _judge_type(self, name: str) -> None:
        from archgen.compose.type_table import list_generic_names

        entry = self._types.entries[name]
        body = self._types.get_body(TypeExpression(name, list_generic_names(entry)))
        self._result.type_bodies[name] = body or MappingNode({}, entry.key_span)
        self._result.type_entries[name] = entry
        self._types.ask_replacement(name)
        self._open_types.append(name)
        for part in list_entries(body, "components"):
            self._expand(part.value, f"{name}.{part.key}")
        self._open_types.pop()

    def _expand(self, node: object, component_id: str) -> Expansion:
        body = node if isinstance(node, MappingNode) else MappingNode({}, self._root.span)
        expansion = self._expansions.get(id(body))
        if expansion is None:
            expansion = self._make_expansion(body, component_id)
            self._expansions[id(body)] = expansion
        return expansion

    def _make_expansion(self, body: MappingNode, component_id: str) -> Expansion:
        if component_id.count(".") > MAX_DEPTH:
            self._report_depth(body, component_id)
            return Expansion(body, body.without("components"), None, {}, 1)
        origin, full_body = self._lay_over_type(body, component_id)
        if origin:
            if origin.expression.name in self._open_types:
                self._report_circle(origin.expression.name)
                return Expansion(body, body.without("components"), origin, {}, 1)
            self._open_types.append(origin.expression.name)
        parts = {
            part.key: (part, self._expand(part.value, f"{component_id}.{part.key}"))
            for part in list_entries(full_body, "components")
        }
        if origin:
            self._open_types.pop()
        return Expansion(
            body,
            full_body.without("components") if parts else full_body,
            origin,
            parts,
            1 + sum(expansion.size for _, expansion in parts.values()),
        )

    def _lay_over_type(self, body: MappingNode, component_id: str) -> tuple[InstanceOrigin | None, MappingNode]:
        key = "same_as" if "same_as" in body.entries else "is"
        reference = body.get(key)
        if not isinstance(reference, ScalarNode) or reference.value is None:
            return None, body
        if "same_as" in body.entries and "is" in body.entries:
            self._diagnostics.append(_diagnose_two_types(body, component_id))
        expression = self._types.find_type(reference, component_id)
        type_body = self._types.get_body(expression) if expression else None
        if expression is None or type_body is None:
            self._damaged_elements.add(component_id)
            return None, body
        if key == "same_as":
            changes = find_same_as_changes(body, component_id, expression.name)
            self._diagnostics += changes
            body = MappingNode({e.key: e for e in body if e.key not in _list_changed_keys(changes, body)}, body.span)
        full_body = self._overlay.lay_over_instance(type_body, body, component_id)
        return InstanceOrigin(expression, key == "same_as", reference.span), full_body

    def _report_depth(self, body: MappingNode, component_id: str) -> None:
        message = f"components stand more than {MAX_DEPTH} deep inside of one another"
        help_line = "what is inside of this one is left out"
        self._diagnostics.append(
            Diagnostic("too-large", message, body.span, help=help_line, element=".".join(component_id.split(".")[:3]))
        )

    def _report_circle(self, name: str) -> None:
        from archgen.compose.type_table import diagnose_circle

        if name not in self._circular_types:
            self._circular_types.add(name)
            start = self._open_types.index(name)
            self._diagnostics.append(diagnose_circle(self._types.entries[name], self._open_types[start:], "holds"))

    def _limit_parts(
        self, group: MappingEntry, parts: list[tuple[MappingEntry, Expansion]]
    ) -> Iterator[tuple[MappingEntry, Expansion]]:
        """Report what is too large, and leave out what is inside of it."""
        for part, expansion in parts:
            if expansion.size <= MAX_ELEMENTS // max(len(parts), 1):
                yield part, expansion
                continue
            element_id = f"{group.key}.{part.key}"
            message = f"`{element_id}` stands for {_format_count(expansion.size)} components; at most {MAX_ELEMENTS:,} are written out"
            self._diagnostics.append(
                Diagnostic(
                    "too-many-elements",
                    message,
                    part.key_span,
                    help="use fewer instances inside of one another",
                    element=element_id,
                )
            )
            yield part, Expansion(expansion.written, expansion.body, expansion.origin, {}, 1)

    def _flatten_group(self, group: MappingEntry, parts: list[tuple[MappingEntry, Expansion]]) -> MappingEntry:
        leaves: dict[str, MappingEntry] = {}
        for part, expansion in parts:
            self._flatten_part(group.key, part, expansion, part.key, None, leaves)
        return group.change_keys({"components": lambda components: components.with_entries(leaves)})

    def _flatten_part(  # noqa: PLR0913, PLR0917 - what the recursion carries
        self,
        group_id: str,
        part: MappingEntry,
        expansion: Expansion,
        path: str,
        parent: str | None,
        leaves: dict[str, MappingEntry],
    ) -> None:
        component_id = f"{group_id}.{path}"
        if expansion.origin:
            self._result.instances[component_id] = expansion.origin
        if parent:
            self._result.parents[component_id] = parent
        entry = MappingEntry(path, part.key_span, expansion.body)
        if not expansion.parts:
            leaves[path] = entry
            return
        self._report_duplicates(component_id, expansion)
        children = tuple(f"{component_id}.{name}" for name in expansion.parts)
        written_parts = {name: inner_part for name, (inner_part, _) in expansion.parts.items()}
        self._result.shells[component_id] = ComponentShell(
            component_id, group_id, parent, entry, children, written_parts
        )
        for name, (inner_part, inner_expansion) in expansion.parts.items():
            self._flatten_part(group_id, inner_part, inner_expansion, f"{path}.{name}", component_id, leaves)

    def _report_duplicates(self, component_id: str, expansion: Expansion) -> None:
        for output in list_entries(expansion.body, "outputs"):
            if output.key in expansion.parts:
                self._diagnostics.append(
                    Diagnostic(
                        "duplicate-port",
                        f"`{output.key}` is an output of `{component_id}` and a component inside of it",
                        output.key_span,
                        labels=(Label(expansion.parts[output.key][0].key_span, "the component"),),
                        help="call one of the two otherwise",
                        element=component_id,
                    )
                )


def _list_changed_keys(changes: list[Diagnostic], body: MappingNode) -> set[str]:
    """Return the keys of a reference that are reported whole: they are left out."""
    spans = {change.span for change in changes}
    return {entry.key for entry in body if entry.key_span in spans}


def _diagnose_two_types(body: MappingNode, component_id: str) -> Diagnostic:
    return Diagnostic(
        "conflicting-values",
        f"`{component_id}` is an instance of one type and the same as another",
        body.entries["is"].key_span,
        labels=(Label(body.entries["same_as"].key_span, "exactly this"),),
        help="keep `is` where it changes something, else `same_as`",
        element=component_id,
    )


def _format_count(count: int) -> str:
    return f"{count:,}" if count < 10**12 else f"10^{len(str(count)) - 1}"


_OWN_KEYS = frozenset({"same_as", "is", "title", "owner", "layout", "from", "inputs", "node"})
_OWN_INPUT_KEYS = frozenset({"from", "external"})
_OWN_NODE_KEYS = frozenset({"host", "namespace", "start"})


def find_same_as_changes(body: MappingNode, component_id: str, type_name: str) -> list[Diagnostic]:
    """Return what a reference says that its type decides."""
    changed = [entry for entry in body if entry.key not in _OWN_KEYS]
    inputs, node = body.get("inputs"), body.get("node")
    for port in list_entries(inputs):
        changed += (
            [e for e in port.value if e.key not in _OWN_INPUT_KEYS] if isinstance(port.value, MappingNode) else []
        )
    changed += [e for e in node if e.key not in _OWN_NODE_KEYS] if isinstance(node, MappingNode) else []
    return [_diagnose_change(entry, component_id, type_name) for entry in changed]


def _diagnose_change(entry: MappingEntry, component_id: str, type_name: str) -> Diagnostic:
    return Diagnostic(
        "changed-reference",
        f"`{component_id}` is the same as `{type_name}`, which decides its `{entry.key}`",
        entry.key_span,
        help=f"write `is: {type_name}` instead of `same_as` if this one differs, or change the type",
        element=component_id,
    )
