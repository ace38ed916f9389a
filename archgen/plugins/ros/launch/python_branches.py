"""Put together what both ways of a condition leave behind that is not known: what differs is not known either."""

from __future__ import annotations

from collections.abc import Sequence

from archgen.plugin import replace
from archgen.plugins.ros.launch.launch_actions import LaunchAction
from archgen.plugins.ros.launch.launch_values import LaunchValue, Substitution, UnknownValue, is_plain
from archgen.plugins.ros.launch.python_values import NameScope

_MAX_DEPTH = 4
_MAX_PARTS = 10
_MAX_CONTAINERS = 1_000
_ABSENT = object()

Container = list[LaunchValue] | dict[LaunchValue, LaunchValue]


class BranchRecord:
    """The lists and dicts that names stand for in front of a condition, and what each of its ways makes of them."""

    def __init__(self, scope: NameScope) -> None:
        self._containers = _list_containers(scope)
        self._before: list[Container] = []
        self.size = len(self._containers) + sum(map(len, self._containers))
        """How much is to be remembered: containers, and what is in them."""

    def begin(self) -> None:
        """Remember what is in the containers."""
        self._before = [each.copy() for each in self._containers]

    def take_outcome(self) -> list[Container]:
        """Return what is in the containers, which are as they were in front of the condition from now on."""
        outcome = [each.copy() for each in self._containers]
        self.put_back(self._before)
        return outcome

    def put_back(self, contents: Sequence[Container]) -> None:
        """Fill the containers with what was in them."""
        for container, content in zip(self._containers, contents, strict=True):
            if isinstance(container, list):
                container[:] = content
            elif isinstance(content, dict):
                container.clear()
                container.update(content)

    def merge_outcomes(self, first: Sequence[Container], second: Sequence[Container], test: UnknownValue) -> None:
        """Fill the containers with what both ways left in them."""
        merged: list[Container] = []
        for one, other in zip(first, second, strict=True):
            if isinstance(one, list) and isinstance(other, list):
                merged.append(_merge_lists(one, other, test))
            elif isinstance(one, dict) and isinstance(other, dict):
                merged.append(merge_names(one, other, test))
        self.put_back(merged)


def merge_names(
    first: dict[LaunchValue, LaunchValue], second: dict[LaunchValue, LaunchValue], test: UnknownValue
) -> dict[LaunchValue, LaunchValue]:
    """Return values by their names as both ways of a condition leave them."""
    return {
        name: _merge_values(first.get(name, _ABSENT), second.get(name, _ABSENT), test) for name in {**first, **second}
    }


def _merge_values(first: LaunchValue, second: LaunchValue, test: UnknownValue) -> LaunchValue:
    if _is_same(first, second):
        return first
    if isinstance(first, list) and isinstance(second, list):
        return _merge_lists(first, second, test)
    if isinstance(first, LaunchAction) and isinstance(second, LaunchAction):
        # Each of them knows when it counts.
        return [first, second]
    for one, other in ((first, second), (second, first)):
        if (other is None or other is _ABSENT) and (isinstance(one, UnknownValue) or _holds_actions(one)):
            return one
    return _make_unknown(test)


def _merge_lists(first: list[LaunchValue], second: list[LaunchValue], test: UnknownValue) -> list[LaunchValue]:
    """Return what both ways have in common, actions, which know when they count, and one unknown value for the rest."""
    start = 0
    while start < min(len(first), len(second)) and _is_same(first[start], second[start]):
        start += 1
    kept = first[:start]
    rest = [*first[start:], *second[start:]]
    seen = {id(item) for item in kept}
    for item in rest:
        if _holds_actions(item) and id(item) not in seen:
            kept.append(item)
            seen.add(id(item))
    if not all(map(_holds_actions, rest)):
        kept.append(replace(_make_unknown(test), is_several=True))
    return kept


def _make_unknown(test: UnknownValue) -> UnknownValue:
    return UnknownValue(f"either way of `if {test.reason}`", test.line, test.file)


def _holds_actions(value: LaunchValue) -> bool:
    return isinstance(value, LaunchAction) or (
        isinstance(value, list | tuple) and bool(value) and all(isinstance(each, LaunchAction) for each in value)
    )


def _is_same(first: LaunchValue, second: LaunchValue, depth: int = 0) -> bool:
    """Whether two values are one, or plain and equal: nothing that may be nested without bounds is walked through."""
    if first is second:
        return True
    if isinstance(first, Substitution) and isinstance(second, Substitution):
        fits = first.kind == second.kind and len(first.parts) == len(second.parts) <= _MAX_PARTS
        return fits and depth < _MAX_DEPTH and all(map(_is_same, first.parts, second.parts, [depth + 1] * _MAX_PARTS))
    return type(first) is type(second) and is_plain(first) and bool(first == second)


def _list_containers(scope: NameScope) -> list[Container]:
    found: dict[int, Container] = {}
    pending: list[tuple[LaunchValue, int]] = []
    outer: NameScope | None = scope
    while outer is not None:
        pending += [(value, 0) for value in outer.values.values()]
        outer = outer.outer
    while pending and len(found) < _MAX_CONTAINERS:
        value, depth = pending.pop()
        if isinstance(value, list | dict) and depth < _MAX_DEPTH and id(value) not in found:
            found[id(value)] = value
            pending += [(inner, depth + 1) for inner in (value.values() if isinstance(value, dict) else value)]
    return list(found.values())
