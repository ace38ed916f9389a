"""Merge the slices: documents become one mapping, in their order; elements that no file declares are reported."""

from __future__ import annotations

from typing import TYPE_CHECKING

from archgen.diagnostics.diagnostic import Diagnostic, Rule, Severity, diagnose_repetition
from archgen.diagnostics.source_span import NO_SPAN
from archgen.diagnostics.suggestions import did_you_mean
from archgen.link.missing_keys import find_incomplete
from archgen.schema import element_of_path
from archgen.syntax.yaml_tree import MappingEntry, MappingNode, SequenceNode

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator, Sequence

    from archgen.syntax.yaml_tree import YamlDocument, YamlNode

KeyPath = tuple[str, ...]
_SUPPORTING_KEYS = frozenset({"timing", "requirements", "tags", "urls", "layout", "owner", "parameters"})
"""Keys that supporting files add to components which other files declare: they alone declare nothing."""


def merge_documents(
    documents: Sequence[YamlDocument],
    lost_keys: frozenset[str] = frozenset(),
    damaged_elements: frozenset[str] = frozenset(),
) -> tuple[MappingNode, tuple[Diagnostic, ...]]:
    """Merge documents in normal form into one mapping.

    The documents are not changed (they may be cached for other revisions); the result shares their nodes. `lost_keys`
    are the keys in files that could not be read: an element that one of them may declare is not reported as undeclared.
    Nor are `damaged_elements`, in which there is an error of reading: what declares them may have been taken out.
    """
    diagnostics: list[Diagnostic] = []
    root = _merge_mappings([document.root for document in documents], (), diagnostics)
    # Before incomplete elements are looked for, so that an undeclared element is a single finding.
    root, undeclared_diagnostics = _drop_undeclared(root, documents, lost_keys, damaged_elements)
    return root, (*diagnostics, *undeclared_diagnostics, *find_incomplete(root))


def _merge_mappings(mappings: Sequence[MappingNode], path: KeyPath, diagnostics: list[Diagnostic]) -> MappingNode:
    """Merge mappings key by key, in the order of first appearance."""
    # Most subtrees are in one file only: they are shared with its document instead of being rebuilt.
    if len(mappings) == 1:
        return mappings[0]
    entries_by_key: dict[str, list[MappingEntry]] = {}
    for table in mappings:
        for key, entry in table.entries.items():
            entries_by_key.setdefault(key, []).append(entry)
    entries = {key: _merge_entries(several, (*path, key), diagnostics) for key, several in entries_by_key.items()}
    return MappingNode(entries, mappings[0].span if mappings else NO_SPAN)


def _merge_entries(same_entries: list[MappingEntry], path: KeyPath, diagnostics: list[Diagnostic]) -> MappingEntry:
    """Merge the entries at one path: mappings key by key; of anything else the first stays, the others are reported."""
    if len(same_entries) > 1:
        # What validation has taken out and reported left an empty list that stands nowhere: what others write counts.
        same_entries = [entry for entry in same_entries if entry.value.span.file] or same_entries[:1]
    first_entry = same_entries[0]
    if len(same_entries) == 1:
        return first_entry
    if path[:2] == ("review", "accepted") and all(isinstance(entry.value, SequenceNode) for entry in same_entries):
        # Each partner who loses something by a change agrees in a file of its own.
        items = [item for entry in same_entries if isinstance(entry.value, SequenceNode) for item in entry.value.items]
        return MappingEntry(first_entry.key, first_entry.key_span, SequenceNode(items, first_entry.value.span))
    # A mapping and a leaf at one path conflict whatever comes first; the mappings among them are merged all the same.
    if isinstance(first_entry.value, MappingNode) and not _is_parameter(path):
        mappings = [entry.value for entry in same_entries if isinstance(entry.value, MappingNode)]
        diagnostics.extend(
            _diagnose_conflict(entry, first_entry, path)
            for entry in same_entries
            if not isinstance(entry.value, MappingNode)
        )
        return MappingEntry(first_entry.key, first_entry.key_span, _merge_mappings(mappings, path, diagnostics))
    diagnostics.extend(_diagnose_conflict(entry, first_entry, path) for entry in same_entries[1:])
    return first_entry


def _is_parameter(path: KeyPath) -> bool:
    # `nodes, id, parameters, name` or `ros, parameters, name`: a parameter is one value even if it is a mapping, and is
    # never merged. At components it is a declaration, which several files may complete.
    return path[-2:-1] == ("parameters",) and (path[:1], len(path)) in {(("nodes",), 4), (("ros",), 3)}


def _diagnose_conflict(entry: MappingEntry, first_entry: MappingEntry, path: KeyPath) -> Diagnostic:
    owner = element_of_path(path[:-1])
    owner_phrase = f" of `{owner}`" if owner else ""
    if path[0] == "groups" and path[-3:-2] == ("parameters",):
        owner_phrase = f" of the parameter `{path[-2]}`{owner_phrase}"
    message = f"`{path[-1]}`{owner_phrase} is written in two places"
    help_line = "a value is written once in the whole project, even where both are equal: keep one of them"
    return diagnose_repetition(
        "conflicting-values", message, entry.value.span, first_entry.value.span, help_line=help_line, element=owner
    )


def _drop_undeclared(
    root: MappingNode,
    documents: Sequence[YamlDocument],
    lost_keys: frozenset[str],
    damaged_elements: frozenset[str],
) -> tuple[MappingNode, list[Diagnostic]]:
    """Remove the components and groups that no file declares, and report them."""
    groups = root.get("groups")
    if not isinstance(groups, MappingNode):
        return root, []
    # Normal form turns a bare id into `{}`, which merging makes invisible: it must be looked for in the documents.
    undeclared_paths = [
        path
        for path in list_supported_elements(groups)
        if ".".join(path) not in damaged_elements and not _is_empty_somewhere(path, documents)
    ]
    if not undeclared_paths:
        return root, []
    # Only what is declared is offered as a guess: two slips of the same kind must not suggest each other.
    declared_paths = [path for path in _list_element_paths(groups) if path not in undeclared_paths]
    diagnostics = [
        _diagnose_undeclared(groups, path, declared_paths) for path in undeclared_paths if path[-1] not in lost_keys
    ]
    entry = root.entries["groups"]
    kept_groups = _remove_paths(groups, frozenset(undeclared_paths))
    return MappingNode(
        {**root.entries, "groups": MappingEntry("groups", entry.key_span, kept_groups)}, root.span
    ), diagnostics


def _list_element_paths(groups: MappingNode) -> Iterator[KeyPath]:
    for group in groups:
        yield (group.key,)
        yield from ((group.key, component.key) for component in _components_of(group.value))


def list_supported_elements(groups: MappingNode) -> Iterator[KeyPath]:
    """Yield the paths of elements that do not declare themselves: of groups with neither title nor components, and of components with supporting keys only."""
    for group in groups:
        if (
            isinstance(group.value, MappingNode)
            and "title" not in group.value.entries
            and not any(_components_of(group.value))
        ):
            yield (group.key,)
        for component in _components_of(group.value):
            if isinstance(component.value, MappingNode) and _SUPPORTING_KEYS.issuperset(component.value.entries):
                yield (group.key, component.key)


def _components_of(group: YamlNode) -> Iterable[MappingEntry]:
    components = group.get("components") if isinstance(group, MappingNode) else None
    return components if isinstance(components, MappingNode) else ()


def _is_empty_somewhere(path: KeyPath, documents: Sequence[YamlDocument]) -> bool:
    """Whether some document declares an element by its bare id."""
    full_path = ("groups", path[0]) if len(path) == 1 else ("groups", path[0], "components", path[1])
    return any(_is_empty_at(document.root, full_path) for document in documents)


def _is_empty_at(node: YamlNode | None, path: KeyPath) -> bool:
    for key in path:
        node = node.get(key) if isinstance(node, MappingNode) else None
    return isinstance(node, MappingNode) and not node.entries


def _diagnose_undeclared(groups: MappingNode, path: KeyPath, declared_paths: Sequence[KeyPath]) -> Diagnostic:
    kind = "group" if len(path) == 1 else "component"
    entry = groups.entries[path[0]]
    if len(path) > 1:
        entry = next(component for component in _components_of(entry.value) if component.key == path[1])
    name = ".".join(path)
    guess = did_you_mean(
        name, (".".join(declared_path) for declared_path in declared_paths if len(declared_path) == len(path))
    )
    needed_keys = "a title or a component" if kind == "group" else "a title, a functionality, inputs or outputs"
    # An id of an existing element that is nearly the same is the likelier cause: without one the element is new.
    help_line = guess or f"give it {needed_keys} where it belongs"
    return Diagnostic(
        "undeclared-element", f"no file declares the {kind} `{name}`", entry.key_span, help=help_line, element=name
    )


def _remove_paths(groups: MappingNode, removed_paths: frozenset[KeyPath]) -> MappingNode:
    kept_groups: dict[str, MappingEntry] = {}
    for group in groups:
        if (group.key,) in removed_paths:
            continue
        components = [c for c in _components_of(group.value) if (group.key, c.key) not in removed_paths]
        if isinstance(group.value, MappingNode) and len(components) < sum(1 for _ in _components_of(group.value)):
            # A group of which nothing is left goes too; nodes are copied, since the documents must not change.
            if not components and "title" not in group.value.entries:
                continue
            components_entry = group.value.entries["components"]
            kept_components = MappingNode({c.key: c for c in components}, components_entry.value.span)
            entries = {
                **group.value.entries,
                "components": MappingEntry(components_entry.key, components_entry.key_span, kept_components),
            }
            kept_groups[group.key] = MappingEntry(group.key, group.key_span, MappingNode(entries, group.value.span))
        else:
            kept_groups[group.key] = group
    return MappingNode(kept_groups, groups.span)


RULES: tuple[Rule, ...] = (
    Rule(
        "conflicting-values",
        Severity.ERROR,
        """One value is written in two places of the project.

Why: two files that say the same today say different things tomorrow. Each value has one home.

Bad:

    groups:
      sensing:
        title: Sensing
        components:
          camera:
            performance:
              accuracy: 90 %
              overall: {accuracy: 95 %}
    nodes: {camera: {implements: sensing.camera}}

Good:

    groups:
      sensing:
        title: Sensing
        components:
          camera:
            performance: {accuracy: 90 %}
    nodes: {camera: {implements: sensing.camera}}
""",
        fixed=True,
    ),
    Rule(
        "undeclared-element",
        Severity.ERROR,
        """A file adds to a component or a group that no file declares.

Why: files with timing, requirements or tags refer to components by their ids. A slip in such an id would make a second
component, and the first would stay without its timing.

Bad:

    groups:
      sensing:
        title: Sensing
        components:
          camera: Camera
          camra: {timing: {rate: 10 Hz}}
    nodes: {camera: {implements: sensing.camera}}

Good:

    groups:
      sensing:
        title: Sensing
        components:
          camera: {title: Camera, timing: {rate: 10 Hz}}
    nodes: {camera: {implements: sensing.camera}}
""",
        fixed=True,
    ),
)
