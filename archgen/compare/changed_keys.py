"""List the keys of an element that changed, without those that differ only as a consequence of another change."""

from __future__ import annotations

from collections.abc import Iterator, Mapping

from archgen.compare.kinds import find_key
from archgen.compare.kinds.ros_kinds import default_qos
from archgen.compare.normal_values import ElementTitle, to_plain_data
from archgen.compare.version_pair import MAPPED_KEY, SOME_PORTS, ComparedElement, ElementKey
from archgen.model.path_resolver import title_from_id

ElementsByKey = Mapping[ElementKey, ComparedElement]
_OWNER_KEYS = frozenset({"owner", "co_owners"})


def is_consequence(
    key: str, old_element: ComparedElement, new_element: ComparedElement, before: ElementsByKey, after: ElementsByKey
) -> bool:
    """Whether a key only follows another change: a generated title its id, an owner or timing the element it is
    inherited from.
    """
    old_value, new_value = old_element.values.get(key), new_element.values.get(key)
    if isinstance(old_value, ElementTitle) and isinstance(new_value, ElementTitle):
        # After a rename a written title that merely repeats the id follows it; with the same id only generated or equal
        # titles are the same.
        both_follow_id = (
            old_element.own_id != new_element.own_id
            and _follows_id(old_element, old_value)
            and _follows_id(new_element, new_value)
        )
        return both_follow_id or old_value.text == new_value.text or (old_value.generated and new_value.generated)
    if key == "timing.behaviour" and {old_value, new_value} == {None, "periodic"}:
        # What has a rate is periodic, whether or not somebody writes it down.
        return all(element.values.get("timing.rate") is not None for element in (old_element, new_element))
    if key in _OWNER_KEYS:
        return _component_came_or_went(old_element, new_element, before, after) or _owner_is_inherited(
            key, old_element, new_element, before, after
        )
    # That a removed element is no longer named is no news.
    referred_kind = find_key(new_element.kind, key).refers_to
    if referred_kind and _lost_removed_only(old_value, new_value, referred_kind, after):
        return True
    if new_element.kind == "chain" and key == "through" and _leads_past_removed_only(old_value, new_value, after):
        return True
    return _follows_by_kind(key, old_element, new_element, before, after)


def _follows_by_kind(
    key: str, old_element: ComparedElement, new_element: ComparedElement, before: ElementsByKey, after: ElementsByKey
) -> bool:
    old_value, new_value = old_element.values.get(key), new_element.values.get(key)
    match new_element.kind:
        case "component":
            return (
                SOME_PORTS in {old_value, new_value}
                if key in {"inputs", "outputs"}
                else _follows_mapping(key, old_element, new_element)
            )
        case "component_type":
            return _came_with_part(key, old_element) != _came_with_part(key, new_element)
        case "type":
            return key.startswith("fields.") and _follows_definition(key, old_element, new_element, before, after)
        case "node":
            # A node may move into a container on the same host: "host" vanishes from its values, but it runs where it
            # ran.
            host_differs = _host_of_node(old_element, before) != _host_of_node(new_element, after)
            return (
                not host_differs
                if key == "host"
                else key.startswith("timing.") and _component_came_or_went(old_element, new_element, before, after)
            )
    is_unnamed = new_element.kind == "project" and key in {"id", "title"} and None in {old_value, new_value}
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


def _follows_definition(
    key: str, old_element: ComparedElement, new_element: ComparedElement, before: ElementsByKey, after: ElementsByKey
) -> bool:
    """Whether the definition of a type's message says itself that a field came, went or holds something else."""
    field_name = key.rpartition(".")[2]
    old_lines, new_lines = (
        _list_field_lines(field_name, elements.get(("message", str(element.values.get("message")))))
        for element, elements in ((old_element, before), (new_element, after))
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


def _follows_mapping(key: str, old_element: ComparedElement, new_element: ComparedElement) -> bool:
    """Whether a component's timing was added or removed with its node."""
    mapping_differs = old_element.values.get(MAPPED_KEY) != new_element.values.get(MAPPED_KEY)
    is_missing = key not in old_element.values or key not in new_element.values
    return key == MAPPED_KEY or (key.startswith("timing.") and mapping_differs and is_missing)


def _host_of_node(node: ComparedElement, elements: ElementsByKey) -> object:
    """Return the host that a node runs on: its own, or its container's."""
    container = elements.get(("container", str(node.values.get("container"))))
    return node.values.get("host") or (container.values.get("host") if container else None)


def _component_came_or_went(
    old_element: ComparedElement, new_element: ComparedElement, before: ElementsByKey, after: ElementsByKey
) -> bool:
    """Whether a component of a node was added or removed: what the node inherits from it changed along."""
    component_gone = any(("component", ref) not in after for ref in old_element.component_refs)
    return new_element.kind == "node" and (
        component_gone or any(("component", ref) not in before for ref in new_element.component_refs)
    )


def _owner_is_inherited(
    key: str, old_element: ComparedElement, new_element: ComparedElement, before: ElementsByKey, after: ElementsByKey
) -> bool:
    """Whether an owner is inherited from an element whose own owner changed in the same way."""
    owner_sources = (
        [("component", ref) for ref in new_element.component_refs]
        if new_element.kind == "node"
        else [new_element.parent_key]
        if new_element.parent_key
        else []
    )
    return any(
        owner_source in before
        and owner_source in after
        and old_element.parent_key == new_element.parent_key
        and before[owner_source].values.get(key) == old_element.values.get(key)
        and after[owner_source].values.get(key) == new_element.values.get(key)
        for owner_source in owner_sources
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
    old_element: ComparedElement,
    new_element: ComparedElement,
    before: Mapping[ElementKey, ComparedElement],
    after: Mapping[ElementKey, ComparedElement],
) -> Iterator[KeyChange]:
    """Yield each changed key with its old and new value as plain data; all changes of `qos` are combined into one."""
    qos_changes: list[KeyChange] = []
    for key in sorted(old_element.values.keys() | new_element.values.keys()):
        old_value, new_value = old_element.values.get(key), new_element.values.get(key)
        if old_value == new_value or is_consequence(key, old_element, new_element, before, after):
            continue
        if key.startswith("qos."):
            name = key.removeprefix("qos.")
            plain_old, plain_new = (
                to_plain_data(default_qos(name) if qos_value is None else qos_value)
                for qos_value in (old_value, new_value)
            )
            qos_changes.append((name, plain_old, plain_new))
        else:
            yield key, to_plain_data(old_value), to_plain_data(new_value)
    if qos_changes:
        yield "qos", {key: value for key, value, _ in qos_changes}, {key: value for key, _, value in qos_changes}
