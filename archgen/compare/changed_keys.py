"""List the keys of an element that changed, without those that differ only as a consequence of another change."""

from __future__ import annotations

from collections.abc import Iterator

from archgen.compare.kinds import find_key
from archgen.compare.kinds.ros_kinds import default_qos
from archgen.compare.normal_values import ElementTitle, to_plain_data
from archgen.compare.version_pair import MAPPED_KEY, SOME_PORTS, ComparedElement, ElementKey, ElementsByKey
from archgen.frozen import dataclass
from archgen.model.path_resolver import title_from_id

_OWNER_KEYS = frozenset({"owner", "co_owners"})


@dataclass(frozen=True, slots=True)
class ElementPair:
    """An element in both versions, among all elements of these."""

    old: ComparedElement
    new: ComparedElement
    before: ElementsByKey
    after: ElementsByKey

    def list_values(self, key: str) -> tuple[object, object]:
        """Return what a key says in both versions."""
        return self.old.values.get(key), self.new.values.get(key)


def is_consequence(key: str, pair: ElementPair) -> bool:
    """Whether a key only follows another change: a generated title its id, an owner or timing the element it is
    inherited from.
    """
    old_value, new_value = pair.list_values(key)
    if isinstance(old_value, ElementTitle) and isinstance(new_value, ElementTitle):
        # After a rename a written title that merely repeats the id follows it; with the same id only generated or equal
        # titles are the same.
        both_follow_id = (
            pair.old.own_id != pair.new.own_id and _follows_id(pair.old, old_value) and _follows_id(pair.new, new_value)
        )
        return both_follow_id or old_value.text == new_value.text or (old_value.generated and new_value.generated)
    if key == "timing.behaviour" and {old_value, new_value} == {None, "periodic"}:
        # What has a rate is periodic, whether or not somebody writes it down.
        return None not in pair.list_values("timing.rate")
    if key in _OWNER_KEYS:
        return _component_came_or_went(pair) or _owner_is_inherited(key, pair)
    # That a removed element is no longer named is no news.
    referred_kind = find_key(pair.new.kind, key).refers_to
    if referred_kind and _lost_removed_only(old_value, new_value, referred_kind, pair.after):
        return True
    if pair.new.kind == "chain" and key == "through" and _leads_past_removed_only(old_value, new_value, pair.after):
        return True
    return _follows_by_kind(key, pair)


def _follows_by_kind(key: str, pair: ElementPair) -> bool:
    old_value, new_value = pair.list_values(key)
    match pair.new.kind:
        case "component":
            return SOME_PORTS in {old_value, new_value} if key in {"inputs", "outputs"} else _follows_mapping(key, pair)
        case "component_type":
            return _came_with_part(key, pair.old) != _came_with_part(key, pair.new)
        case "type":
            return key.startswith("fields.") and _follows_definition(key, pair)
        case "node" if key == "host":
            # A node may move into a container on the same host: "host" vanishes from its values, but it runs where it
            # ran.
            return _host_of_node(pair.old, pair.before) == _host_of_node(pair.new, pair.after)
        case "node":
            return key.startswith("timing.") and _component_came_or_went(pair)
    is_unnamed = pair.new.kind == "project" and key in {"id", "title"} and None in {old_value, new_value}
    return is_unnamed or key == "carried" or (key == "chapters" and _only_chapters_differ(old_value, new_value))


def _came_with_part(key: str, component_type: ComparedElement) -> bool:
    """Whether a component type has the port, or the component inside, that a key says something of."""
    section, _, path = key.partition(".")
    part, mark, inner_key = path.partition(":")
    if not mark or section not in {"inputs", "outputs", "components"}:
        return True
    if section != "components":
        return f"{section}.{part}" in component_type.values
    if f"{section}.{part}:title" not in component_type.values:
        return False
    port, inner_mark, _ = inner_key.partition(":")
    is_port = inner_mark and port.partition(".")[0] in {"inputs", "outputs"}
    return not is_port or f"{section}.{part}:{port}" in component_type.values


def _follows_definition(key: str, pair: ElementPair) -> bool:
    """Whether the definition of a type's message says itself that a field came, went or holds something else."""
    field_name = key.rpartition(".")[2]
    old_lines, new_lines = (
        _list_field_lines(field_name, elements.get(("message", str(element.values.get("message")))))
        for element, elements in ((pair.old, pair.before), (pair.new, pair.after))
    )
    return old_lines != new_lines


def _list_field_lines(field_name: str, message: ComparedElement | None) -> list[str]:
    lines = message.values.get("fields") if message else None
    return [line for line in lines if line.endswith(f" {field_name}")] if isinstance(lines, tuple) else []


def _follows_id(element: ComparedElement, title: ElementTitle) -> bool:
    return title.text.casefold() == title_from_id(element.own_id.rpartition(".")[2]).casefold()


def _lost_removed_only(old_value: object, new_value: object, kind: str, after: ElementsByKey) -> bool:
    """Whether a list lost only elements that were removed, and gained nothing."""
    old_names, new_names = (
        value if isinstance(value, frozenset) else frozenset[str]() for value in (old_value, new_value)
    )
    return old_names > new_names and not any((kind, name) in after for name in old_names - new_names)


def _leads_past_removed_only(old_points: object, new_points: object, after: ElementsByKey) -> bool:
    """Whether a chain leads through the same as before, but for what was removed."""
    if not isinstance(old_points, tuple) or not isinstance(new_points, tuple):
        return False
    lost_points = set(old_points) - set(new_points)
    is_gone = not any((kind, point) in after for point in lost_points for kind in ("component", "node", "output"))
    return bool(lost_points) and is_gone and [point for point in old_points if point in new_points] == [*new_points]


def _follows_mapping(key: str, pair: ElementPair) -> bool:
    """Whether a component's timing was added or removed with its node."""
    mapped_before, mapped_after = pair.list_values(MAPPED_KEY)
    mapping_differs = mapped_before != mapped_after
    is_missing = key not in pair.old.values or key not in pair.new.values
    return key == MAPPED_KEY or (key.startswith("timing.") and mapping_differs and is_missing)


def _host_of_node(node: ComparedElement, elements: ElementsByKey) -> object:
    """Return the host that a node runs on: its own, or its container's."""
    container = elements.get(("container", str(node.values.get("container"))))
    return node.values.get("host") or (container.values.get("host") if container else None)


def _component_came_or_went(pair: ElementPair) -> bool:
    """Whether a component of a node was added or removed: what the node inherits from it changed along."""
    sides = ((pair.old.component_refs, pair.after), (pair.new.component_refs, pair.before))
    return pair.new.kind == "node" and any(
        ("component", name) not in elements for names, elements in sides for name in names
    )


def _owner_is_inherited(key: str, pair: ElementPair) -> bool:
    """Whether an owner is inherited from an element whose own owner changed in the same way."""
    sources: list[ElementKey] = [pair.new.parent_key] if pair.new.parent_key else []
    if pair.new.kind == "node":
        sources = [("component", name) for name in pair.new.component_refs]
    return any(
        (pair.before[source].values.get(key), pair.after[source].values.get(key)) == pair.list_values(key)
        for source in sources
        if source in pair.before and source in pair.after and pair.old.parent_key == pair.new.parent_key
    )


def _only_chapters_differ(old_order: object, new_order: object) -> bool:
    """Whether chapters were added or removed while all others kept their order."""
    if not isinstance(old_order, tuple) or not isinstance(new_order, tuple):
        return False
    return [name for name in old_order if name in new_order] == [
        name for name in new_order if name in old_order
    ] and any(name.endswith(".md") for name in {*old_order} ^ {*new_order})


KeyChange = tuple[str, object, object]


def list_changed_keys(
    old_element: ComparedElement, new_element: ComparedElement, before: ElementsByKey, after: ElementsByKey
) -> Iterator[KeyChange]:
    """Yield each changed key with its old and new value as plain data; all changes of `qos` are combined into one."""
    pair = ElementPair(old_element, new_element, before, after)
    qos_changes: list[KeyChange] = []
    for key in sorted(old_element.values.keys() | new_element.values.keys()):
        values = pair.list_values(key)
        if values[0] == values[1] or is_consequence(key, pair):
            continue
        if key.startswith("qos."):
            name = key.removeprefix("qos.")
            old_qos, new_qos = (to_plain_data(default_qos(name) if each is None else each) for each in values)
            qos_changes.append((name, old_qos, new_qos))
        else:
            yield key, to_plain_data(values[0]), to_plain_data(values[1])
    if qos_changes:
        yield "qos", {key: value for key, value, _ in qos_changes}, {key: value for key, _, value in qos_changes}
