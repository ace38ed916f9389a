"""Say once what changed at a component type, with its instances, of which the same is true."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterable, Iterator, Mapping, Sequence

from archgen.compare.change_sentences import describe_change
from archgen.compare.comparison import Change, Comparison
from archgen.compare.key_phrases import name_partner, tick_names
from archgen.compare.kinds.functional_kinds import OWN_KEYS, PART_MARK
from archgen.compare.normal_values import to_plain_data
from archgen.compare.version_pair import VersionPair
from archgen.diagnostics import join_words
from archgen.frozen import NamedTuple, dataclass, field, replace
from archgen.model.architecture import Architecture
from archgen.model.component import Component

_PORT_SECTIONS = {"input": "inputs", "output": "outputs"}


class TypeKey(NamedTuple):
    """A key of a component type."""

    component_type: str
    key: str


class OriginFinder:
    """Finds the type that a change comes from."""

    def __init__(self, comparison: Comparison) -> None:
        """Look up what both versions say."""
        self._comparison = comparison
        self._base_chains: dict[str, tuple[str, ...]] = {}
        self._differences: dict[TypeKey, tuple[object, object] | None] = {}
        self._has_types = any(version.architecture.component_types for version in (comparison.before, comparison.after))

    def find_origin(self, change: Change) -> TypeKey | None:
        """Return the key of a component type that a change of an instance, or of a type made from it, follows."""
        if not self._has_types:
            return None
        architecture = (self._comparison.before if change.kind == "removed" else self._comparison.after).architecture
        return next((each for each in self._list_candidates(change, architecture) if self._is_same(change, each)), None)

    def find_difference(self, type_key: TypeKey) -> tuple[object, object] | None:
        """Return the values of a key in both versions as plain data, None where a type does not differ in it."""
        if type_key not in self._differences:
            self._differences[type_key] = self._compare_values(type_key)
        return self._differences[type_key]

    def _compare_values(self, type_key: TypeKey) -> tuple[object, object] | None:
        old, new = self._comparison.versions.find_both("component_type", type_key.component_type)
        before, after = (element.values.get(type_key.key) if element else None for element in (old, new))
        is_other = old is not None and new is not None and before != after
        return (to_plain_data(before), to_plain_data(after)) if is_other else None

    def _is_same(self, change: Change, type_key: TypeKey) -> bool:
        difference = self.find_difference(type_key)
        if difference is None:
            return False
        before, after = difference
        if change.kind == "changed":
            return (before, after) == (change.before, change.after)
        if change.element_kind in _PORT_SECTIONS:
            # What came or went with a port is told with the port.
            return not change.parts and (before if change.kind == "added" else after) is None
        names = [value if isinstance(value, list) else [] for value in (before, after)]
        own_names, other_names = names if change.kind == "removed" else reversed(names)
        name = change.element_id.rpartition(".")[2]
        return name in own_names and name not in other_names

    def _list_candidates(self, change: Change, architecture: Architecture) -> Iterator[TypeKey]:
        """Yield the keys that may be where a change comes from, those of the types that others are made from first."""
        if change.kind not in {"changed", "added", "removed"}:
            return
        match change.element_kind:
            case "component" | "composed":
                yield from self._list_component_keys(change, architecture)
            case "input" | "output":
                component_id, _, name = change.element_id.rpartition(".")
                port_key = f"{_PORT_SECTIONS[change.element_kind]}.{name}"
                suffix = "" if change.key in {None, "type"} else f"{PART_MARK}{change.key}"
                yield from self._list_keys(architecture, component_id, f"{port_key}{suffix}")
            case "node" if change.kind == "changed":
                node = architecture.nodes.get(change.element_id)
                for component_id in (node.wholes or node.implements)[:1] if node else ():
                    yield from self._list_keys(architecture, component_id, f"node.{change.key}")
            case "component_type" if change.kind == "changed":
                yield from self._list_type_keys(change)

    def _list_component_keys(self, change: Change, architecture: Architecture) -> Iterator[TypeKey]:
        if change.key:
            yield from self._list_keys(architecture, change.element_id, change.key)
            return
        component = architecture.find_component(change.element_id)
        if component and component.parent:
            yield from self._list_keys(architecture, component.parent, "components")

    def _list_keys(self, architecture: Architecture, component_id: str, key: str) -> Iterator[TypeKey]:
        """Yield a key of a component at its types, then at the types of the components around it."""
        component = architecture.find_component(component_id)
        holder = component
        while holder:
            path = component_id.removeprefix(holder.id).removeprefix(".")
            if path or key not in OWN_KEYS:
                whole_key = f"components.{path}{PART_MARK}{key}" if path else key
                yield from (TypeKey(name, whole_key) for name in self._list_types(holder, architecture))
            holder = architecture.find_component(holder.parent or "")

    def _list_type_keys(self, change: Change) -> Iterator[TypeKey]:
        """Yield where a key of a type may come from: the type of the part that it is about, or what it is made from."""
        path, _, key = (change.key or "").removeprefix("components.").partition(PART_MARK)
        if key and (change.key or "").startswith("components."):
            yield from self._list_part_keys(change.element_id, path, key)
        own_chain = self._list_bases(change.element_id)
        if change.key not in OWN_KEYS:
            yield from (TypeKey(name, change.key or "") for name in own_chain if name != change.element_id)

    def _list_part_keys(self, type_id: str, path: str, key: str) -> Iterator[TypeKey]:
        """Yield a key of a part inside of a type at the part's own types, then at those of the parts around it."""
        patterns, outer_path, inner_path = self._comparison.after.type_patterns.components, path, ""
        while outer_path:
            part = patterns.get(f"{type_id}.{outer_path}")
            if part and (inner_path or key not in OWN_KEYS):
                whole_key = f"components.{inner_path}{PART_MARK}{key}" if inner_path else key
                yield from (
                    TypeKey(name, whole_key) for name in self._list_types(part, self._comparison.after.architecture)
                )
            outer_path = outer_path.rpartition(".")[0]
            inner_path = path.removeprefix(outer_path).removeprefix(".")

    def _list_types(self, component: Component, architecture: Architecture) -> Sequence[str]:
        name = component.type_name
        if architecture is self._comparison.before.architecture:
            name = self._comparison.matched_ids.common_id("component_type", name)
        return self._list_bases(name)

    def _list_bases(self, name: str) -> tuple[str, ...]:
        """Return a type with all that it is made from, the outermost base first."""
        if name not in self._base_chains:
            bases = self._comparison.after.architecture.list_bases(name)
            self._base_chains[name] = tuple(each.id for each in reversed(list(bases)))
        return self._base_chains[name]


def trace_origins(comparison: Comparison, changes: Sequence[Change]) -> Mapping[int, TypeKey]:
    """Return where changes come from, by the identity of each change that comes from a type."""
    finder = OriginFinder(comparison)
    return {id(change): origin for change in changes if (origin := finder.find_origin(change))}


_MAX_INSTANCES = 3
"""How many instances a sentence names, or one less and how many more."""


@dataclass(slots=True)
class TypeEdit:
    """What changed at one component type, and the changes that follow."""

    component_type: str
    texts: list[str]
    changes: list[Change] = field(default_factory=list)
    instances: tuple[str, ...] = ()

    @property
    def text(self) -> str:
        """Return the sentence without its instances."""
        return "; ".join(self.texts)


def find_type_edits(comparison: Comparison, changes: Sequence[Change]) -> Iterator[TypeEdit]:
    """Yield the changes of component types with those of instances that only follow; what concerns the same instances
    is one edit.
    """
    finder = OriginFinder(comparison)
    followers: dict[TypeKey, list[Change]] = defaultdict(list)
    for change in changes:
        origin = finder.find_origin(change)
        if origin:
            followers[origin].append(change)
    if not followers:
        return
    own_changes = {
        TypeKey(change.element_id, change.key): change
        for change in changes
        if change.element_kind == "component_type" and change.kind == "changed" and change.key
    }
    followed = {id(change) for members in followers.values() for change in members}
    edits: dict[tuple[str, tuple[str, ...]], TypeEdit] = {}
    for type_key, members in sorted(followers.items()):
        own_change = own_changes.get(type_key)
        if own_change and id(own_change) in followed:
            continue  # it is told at the type that it follows
        instances = _list_instances(members, comparison)
        new_edit = TypeEdit(type_key.component_type, [], instances=instances)
        edit = edits.setdefault((type_key.component_type, instances), new_edit)
        edit.texts.append((own_change or _make_change(type_key, finder, comparison.versions)).text)
        edit.changes += [*([own_change] if own_change else []), *members]
    yield from (_tell_instances(edit, comparison) for edit in edits.values())


def _make_change(type_key: TypeKey, finder: OriginFinder, versions: VersionPair) -> Change:
    """Return the change of a type where only what follows it was selected."""
    before, after = finder.find_difference(type_key) or (None, None)
    change = Change("changed", "component_type", type_key.component_type, key=type_key.key, before=before, after=after)
    return replace(change, text=describe_change(change, versions))


def _list_instances(changes: Iterable[Change], comparison: Comparison) -> tuple[str, ...]:
    names = {
        _name_as_now(name, comparison) if change.kind == "removed" else name
        for change in changes
        for name in _name_instance(change, comparison)
    }
    return tuple(sorted(names))


def _name_as_now(component_id: str, comparison: Comparison) -> str:
    """Return what a component of the version before is called after it."""
    new_ids = (comparison.matched_ids.find_new_id(kind, component_id) for kind in ("component", "composed"))
    return next(filter(None, new_ids), component_id)


def _name_instance(change: Change, comparison: Comparison) -> Iterator[str]:
    """Yield the component that a change is about; nothing for a change of a type."""
    match change.element_kind:
        case "component" | "composed":
            yield change.element_id if change.key else change.element_id.rpartition(".")[0]
        case "input" | "output":
            yield change.element_id.rpartition(".")[0]
        case "node":
            node = comparison.after.architecture.nodes[change.element_id]
            yield from (node.wholes or node.implements)[:1]


def _tell_instances(edit: TypeEdit, comparison: Comparison) -> TypeEdit:
    lead = f"component type `{edit.component_type}`: "
    first, *others = edit.texts
    if first.startswith(lead) and all(text.startswith(lead) for text in others):
        edit.texts = [lead + join_words([text.removeprefix(lead) for text in edit.texts])]
    if edit.instances:
        count = len(edit.instances)
        lead = f"in {count} instances: " if count > 1 else "in its instance "
        edit.texts.append(lead + tick_names(edit.instances, _MAX_INSTANCES))
        components = (comparison.after.architecture.find_component(each) for each in edit.instances)
        owners = sorted({component.owner for component in components if component and component.owner})
        names = [name_partner(owner, comparison.versions.partner_names) for owner in owners]
        if len(comparison.versions.partner_names) > 1 and names:
            edit.texts.append(f"of {join_words(names)}")
    return edit
