"""List the keys of an element that changed, without those that only follow from another change."""

from __future__ import annotations

from collections.abc import Iterator, Mapping

from archgen.compare.compared_elements import ComparedElement, ElementKey
from archgen.compare.consequent_keys import is_consequence
from archgen.compare.kinds.ros_kinds import default_qos
from archgen.compare.normal_values import to_plain_data

KeyChange = tuple[str, object, object]


def list_changed_keys(
    old_element: ComparedElement,
    new_element: ComparedElement,
    before: Mapping[ElementKey, ComparedElement],
    after: Mapping[ElementKey, ComparedElement],
) -> Iterator[KeyChange]:
    """Yield each changed key with its old and new value as plain data; all changes of `qos` are combined into one."""
    qos_changes: list[KeyChange] = []
    for key in _sorted_keys(old_element.values, new_element.values):
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


def _sorted_keys(old_values: Mapping[str, object], new_values: Mapping[str, object]) -> list[str]:
    return sorted(old_values.keys() | new_values.keys())
