"""Say once what changed at a component type, with its instances, of which the same is true."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass, field, replace

from archgen.compare.change_sentences import describe_change
from archgen.compare.comparison import Change, Comparison
from archgen.compare.key_phrases import name_partner, tick_names
from archgen.compare.type_origins import OriginFinder, TypeKey
from archgen.compare.version_pair import VersionPair
from archgen.diagnostics.common_wording import join_words

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
        owners = _list_owners(edit.instances, comparison)
        names = [name_partner(owner, comparison.versions.partner_names) for owner in owners]
        if len(comparison.versions.partner_names) > 1 and names:
            edit.texts.append(f"of {join_words(names)}")
    return edit


def _list_owners(component_ids: Iterable[str], comparison: Comparison) -> list[str]:
    """Return the partners whose components these are, sorted by id."""
    components = (comparison.after.architecture.find_component(each) for each in component_ids)
    return sorted({component.owner for component in components if component and component.owner})
