"""Merge the slices: documents become one mapping, in their order; elements that no file declares are reported.

Find elements that lack what they mean nothing without, in all slices together.

Put what the files of libraries hold into a merged project, where a packed file has it.
"""

from __future__ import annotations

import posixpath
import re
from collections.abc import Iterator, Sequence

from archgen.diagnostics import NO_SPAN, Diagnostic, diagnose_repetition, did_you_mean
from archgen.grouping import group_pairs
from archgen.language.language_tables import SUPPORTING_KEYS
from archgen.link import mapping_values
from archgen.model.architecture import Architecture
from archgen.project.library_reading import LIBRARY_SECTIONS, LoadedLibrary
from archgen.syntax.yaml_tree import (
    MappingEntry,
    MappingNode,
    ScalarNode,
    SequenceNode,
    YamlDocument,
    YamlNode,
    find_value,
    list_entries,
)

KeyPath = tuple[str, ...]
_SUPPORTING_KEYS = frozenset((*SUPPORTING_KEYS["component"], "components"))
"""Keys that supporting files add to components which other files declare: they alone declare nothing."""
_INSTANCE_KEYS = frozenset({"is", "same_as"})


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
    entries_by_key = group_pairs((key, entry) for table in mappings for key, entry in table.entries.items())
    entries = {key: _merge_entries(several, (*path, key), diagnostics) for key, several in entries_by_key.items()}
    declares = not mappings or any(mapping.declares for mapping in mappings)
    return MappingNode(entries, mappings[0].span if mappings else NO_SPAN, declares)


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
        return first_entry.with_value(SequenceNode(items, first_entry.value.span))
    # A mapping and a leaf at one path conflict whatever comes first; the mappings among them are merged all the same.
    if isinstance(first_entry.value, MappingNode) and not _is_parameter(path):
        mappings = [entry.value for entry in same_entries if isinstance(entry.value, MappingNode)]
        if path[0] == "nodes" and len(path) == _NODE_DEPTH and (twin := _find_twin(same_entries)):
            diagnostics.append(_diagnose_twin(first_entry, twin))
            return first_entry
        diagnostics.extend(
            _diagnose_conflict(entry, first_entry, path)
            for entry in same_entries
            if not isinstance(entry.value, MappingNode)
        )
        return first_entry.with_value(_merge_mappings(mappings, path, diagnostics))
    diagnostics.extend(_diagnose_conflict(entry, first_entry, path) for entry in same_entries[1:])
    return first_entry


_NODE_DEPTH = 2


def _find_twin(entries: list[MappingEntry]) -> MappingEntry | None:
    """Return the second of two nodes that were meant to have ids of their own: both say what they implement, and more."""
    bodies = [entry.value.entries.keys() if isinstance(entry.value, MappingNode) else set() for entry in entries]
    twins = (
        entry
        for entry, keys in zip(entries[1:], bodies[1:], strict=True)
        if "implements" in keys and len(keys & bodies[0]) >= _FEW_KEYS and "implements" in bodies[0]
    )
    return next(twins, None)


_FEW_KEYS = 3
"""So many keys that two files write of one node, what it implements among them, make two nodes of it."""


def _diagnose_twin(first_entry: MappingEntry, twin: MappingEntry) -> Diagnostic:
    message = f"two places describe a node `{twin.key}`"
    help_line = "rename one of them; if it is one node, each value stands in one place"
    return diagnose_repetition(
        "conflicting-values", message, twin.key_span, first_entry.key_span, help_line=help_line, element=twin.key
    )


def _is_parameter(path: KeyPath) -> bool:
    # `nodes, id, parameters, name` or `ros, parameters, name`: a parameter is one value even if it is a mapping, and is
    # never merged. At components it is a declaration, which several files may complete.
    if path[0] == "variants" and path[2:3] == ("changes",):
        path = path[3:]
    return path[-2:-1] == ("parameters",) and (path[:1], len(path)) in {(("nodes",), 4), (("ros",), 3)}


def _diagnose_conflict(entry: MappingEntry, first_entry: MappingEntry, path: KeyPath) -> Diagnostic:
    from archgen.schema.schema_wording import element_of_path

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
        yield from _list_paths_below((group.key,), group.value)


def _list_paths_below(path: KeyPath, holder: YamlNode) -> Iterator[KeyPath]:
    for component in list_entries(holder, "components"):
        yield (*path, component.key)
        yield from _list_paths_below((*path, component.key), component.value)


def list_supported_elements(groups: MappingNode) -> Iterator[KeyPath]:
    """Yield the paths of elements that do not declare themselves: groups without title and components, components with supporting keys only."""
    for group in groups:
        if (
            isinstance(group.value, MappingNode)
            and "title" not in group.value.entries
            and not any(list_entries(group.value, "components"))
        ):
            yield (group.key,)
        yield from _list_supported_below((group.key,), group.value)


def _list_supported_below(path: KeyPath, holder: YamlNode) -> Iterator[KeyPath]:
    for component in list_entries(holder, "components"):
        if not declares_itself(component.value):
            yield (*path, component.key)
        # What an instance has inside is declared by its type: writing out types judges that.
        elif _INSTANCE_KEYS.isdisjoint(component.value.entries if isinstance(component.value, MappingNode) else ()):
            yield from _list_supported_below((*path, component.key), component.value)


def declares_itself(body: YamlNode) -> bool:
    """Whether a component's body declares it: it has more than supporting keys, or a component inside that declares itself."""
    if not isinstance(body, MappingNode):
        return True
    own_keys = body.entries.keys() - _SUPPORTING_KEYS
    return (bool(own_keys) and body.declares) or any(
        declares_itself(inner.value) for inner in list_entries(body, "components")
    )


def _is_empty_somewhere(path: KeyPath, documents: Sequence[YamlDocument]) -> bool:
    """Whether some document declares an element by its bare id."""
    full_path = ("groups", path[0], *(key for name in path[1:] for key in ("components", name)))
    found = (find_value(document.root, *full_path) for document in documents)
    return any(isinstance(node, MappingNode) and not node.entries and node.declares for node in found)


def _diagnose_undeclared(groups: MappingNode, path: KeyPath, declared_paths: Sequence[KeyPath]) -> Diagnostic:
    kind = "group" if len(path) == 1 else "component"
    entry = groups.entries[path[0]]
    for name in path[1:]:
        entry = next(component for component in list_entries(entry.value, "components") if component.key == name)
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
    def keep(group: MappingEntry) -> MappingEntry | None:
        if (group.key,) in removed_paths:
            return None
        kept = _remove_components((group.key,), group, removed_paths)
        # A group of which nothing is left goes too.
        is_left = kept is group or _has_path(kept.value, "title") or list_entries(kept.value, "components")
        return kept if is_left else None

    return groups.change_each(keep)


def _remove_components(path: KeyPath, holder: MappingEntry, removed_paths: frozenset[KeyPath]) -> MappingEntry:
    """Return what holds components without those at some paths: itself if there are none, since documents must not change."""

    def keep(component: MappingEntry) -> MappingEntry | None:
        inner_path = (*path, component.key)
        return None if inner_path in removed_paths else _remove_components(inner_path, component, removed_paths)

    return holder.change_keys({"components": lambda parts: parts.change_each(keep)})


_KeyPath = tuple[str, ...]
# By section, the paths without which an element means nothing. The schema cannot ask for them: in a single slice every
# key may be missing, because another file may write it.
_NEEDED_KEYS: dict[_KeyPath, tuple[_KeyPath, ...]] = {
    ("views",): (("show",),),
    ("review", "accepted"): (("reason",),),
    ("conform", "accepted"): (("rule",), ("reason",)),
}


_STEP_ENDS = ("from", "to")


def find_incomplete(root: MappingNode) -> Iterator[Diagnostic]:
    """Report elements that lack a key without which they mean nothing, in all slices together."""
    for section, needed_paths in _NEEDED_KEYS.items():
        for entry in list_entries(root, *section):
            nodes = entry.value.items if isinstance(entry.value, SequenceNode) else (entry.value,)
            for path in needed_paths:
                if not all(_has_path(node, *path) for node in nodes):
                    message = f"`{entry.key}` lacks `{'.'.join(path)}`"
                    yield Diagnostic(
                        "missing-key",
                        message,
                        entry.key_span,
                        help=_MISSING_KEY_HELP[".".join(section)],
                        element=entry.key,
                    )
    yield from _find_open_policies(root)
    yield from _find_open_steps(root)


def _find_open_policies(root: MappingNode) -> Iterator[Diagnostic]:
    """Report the policies that say neither what they forbid nor what they require, or only half of it."""
    for entry in list_entries(root, "policies"):
        requires = _has_path(entry.value, "require")
        parts = [("require", ("of", "inputs_from"))] if requires else []
        if not requires or _has_path(entry.value, "forbid"):
            parts.append(("forbid", ("from", "to")))
        for part, keys in parts:
            for key in keys:
                if not _has_path(entry.value, part, key):
                    message = f"`{entry.key}` lacks `{part}.{key}`"
                    yield Diagnostic(
                        "missing-key", message, entry.key_span, help=_MISSING_KEY_HELP[part], element=entry.key
                    )


def _find_open_steps(root: MappingNode) -> Iterator[Diagnostic]:
    """Report the steps of use cases that do not say where they begin or end."""
    for entry in list_entries(root, "use_cases"):
        steps = find_value(entry.value, "steps")
        for number, step in enumerate(steps.items if isinstance(steps, SequenceNode) else (), 1):
            for key in _STEP_ENDS:
                if not _has_path(step, key):
                    message = f"step {number} of `{entry.key}` lacks `{key}`"
                    help_line = "say between whom it happens: `{from: speech, to: dialogue, say: passes on the words}`"
                    yield Diagnostic("missing-key", message, step.span, help=help_line, element=entry.key)


_MISSING_KEY_HELP = {
    "views": 'say what the view shows: `show: "tag:safety"`',
    "require": "say who may take its inputs only from whom: "
    '`require: {of: "property:sil>=2", inputs_from: "property:sil>=2"}`',
    "forbid": "say which flow is forbidden: `forbid: {from: planning, to: motors}`",
    "review.accepted": "say why the change is right: `camera.image: {key: type, reason: the tracker moved to depth images}`",
    "conform.accepted": "say what is accepted and why: `lidar: {rule: not-running, reason: it is in repair}`",
}


def _has_path(node: YamlNode, *path: str) -> bool:
    return find_value(node, *path) is not None


_WORD = re.compile(r"[a-z0-9]+")


def merge_libraries(
    root: MappingNode, libraries: tuple[LoadedLibrary, ...]
) -> tuple[MappingNode, tuple[Diagnostic, ...]]:
    """Return a merged project with its libraries filled in; the tree is not changed."""
    if not libraries:
        return root, ()
    diagnostics: list[Diagnostic] = []
    bodies = {library.key: library for library in list_entries(root, "libraries")}
    for library in libraries:
        entry = bodies.get(library.id)
        if entry is not None and isinstance(entry.value, MappingNode):
            content, findings = _merge_content(entry.value, library)
            diagnostics += findings
            package = _name_package(library)
            body = MappingNode({**package, **entry.value.entries, **content.entries}, entry.value.span)
            bodies[library.id] = entry.with_value(body)
    return root.change_keys({"libraries": lambda section: section.with_entries(bodies)}), tuple(diagnostics)


def _name_package(library: LoadedLibrary) -> dict[str, MappingEntry]:
    """Return the entry of the package of a library's messages, named after its folder: all of its users know that one."""
    name = "_".join(_WORD.findall(posixpath.basename(library.folder).lower()))
    if not name or not name[0].isalpha():
        return {}
    text = name if name.endswith("_msgs") else f"{name}_msgs"
    return {"package": MappingEntry("package", library.at, ScalarNode(text, text, library.at))}


def _merge_content(written: MappingNode, library: LoadedLibrary) -> tuple[MappingNode, tuple[Diagnostic, ...]]:
    """Return what is written at the library's path together with what its files hold."""
    sections = {name: entry for name, entry in written.entries.items() if name in LIBRARY_SECTIONS}
    own_documents = (YamlDocument("", MappingNode(sections, written.span)),) if sections else ()
    return merge_documents((*own_documents, *library.documents))


def keep_used_libraries(root: MappingNode, architectures: Sequence[Architecture]) -> MappingNode:
    """Return a merged project whose libraries hold only what it uses, also in its variants, and no paths."""

    def keep(library: MappingEntry) -> MappingEntry | None:
        body = _keep_used_types(library, architectures)
        return library.with_value(body) if body.entries else None

    def keep_section(section: MappingEntry) -> MappingEntry | None:
        kept = section.change_each(keep)
        return kept if list_entries(kept.value) else None

    return root.change_keys({"libraries": keep_section})


def _keep_used_types(library: MappingEntry, architectures: Sequence[Architecture]) -> MappingNode:
    body = mapping_values.get_body(library)
    component_types = [
        entry
        for entry in mapping_values.get_mapping(body, "component_types")
        if any(f"{library.key}.{entry.key}" in each.component_types for each in architectures)
    ]
    types = [
        entry
        for entry in mapping_values.get_mapping(body, "types")
        if any(
            (used_type := each.types.get(mapping_values.normalise_type_name(entry.key)))
            and used_type.library == library.key
            for each in architectures
        )
    ]
    used_entries = {
        name: body.entries[name].with_value(MappingNode({e.key: e for e in entries}, body.span))
        for name, entries in (("component_types", component_types), ("types", types))
        if entries
    }
    if types and "package" in body.entries:
        used_entries = {"package": body.entries["package"], **used_entries}
    return MappingNode(used_entries, body.span)
