"""How the fields of a message, service or action changed, from the lines that ROS writes: retyped, renamed, added, removed."""

from __future__ import annotations

from collections.abc import Iterable, Mapping

from archgen.frozen import NamedTuple

_SEPARATOR = "---"
FieldPlace = tuple[int, str]
"""The part of a service or action, and the field's name."""


class FieldChanges(NamedTuple):
    """What became of fields; `added` and `removed` as lines, the others by name."""

    retyped: Mapping[str, tuple[str, str]]
    """The old and the new type."""
    renamed: Mapping[str, str]
    """The new name: the same type in the same place, and nothing else came or went."""
    added: list[str]
    removed: list[str]


def compare_field_lines(before: object, after: object) -> FieldChanges:
    """Compare the lines of two definitions."""
    old_types, new_types = read_field_types(before), read_field_types(after)
    retyped = {
        place[1]: (old_type, new_types[place])
        for place, old_type in old_types.items()
        if new_types.get(place, old_type) != old_type
    }
    gone = [place for place in old_types if place not in new_types]
    new = [place for place in new_types if place not in old_types]
    renamed: dict[str, str] = {}
    if len(gone) == len(new) and all(
        (old_types[old], [*old_types].index(old), old[0]) == (new_types[place], [*new_types].index(place), place[0])
        for old, place in zip(gone, new, strict=True)
    ):
        renamed = {old[1]: place[1] for old, place in zip(gone, new, strict=True)}
        gone, new = [], []
    return FieldChanges(retyped, renamed, _write_lines(new, new_types), _write_lines(gone, old_types))


def read_field_types(lines: object) -> dict[FieldPlace, str]:
    """Return the types of fields by their places, in the order of the lines."""
    types: dict[FieldPlace, str] = {}
    part = 0
    for line in map(str, lines) if isinstance(lines, (list, tuple)) else ():
        if line == _SEPARATOR:
            part += 1
        else:
            field_type, _, name = line.rpartition(" ")
            types[part, name] = field_type
    return types


def _write_lines(places: Iterable[FieldPlace], types: Mapping[FieldPlace, str]) -> list[str]:
    return [f"{types[place]} {place[1]}" for place in places]
