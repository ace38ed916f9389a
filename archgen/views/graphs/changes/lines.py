"""Arrows of pictures of changes: one for all connections between two boxes with the same change."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass

from archgen.views.changes.telling import SIGNS
from archgen.views.graphs.flows import Style
from archgen.views.shapes import Arrow, Changed

_NAMED = 3
Key = tuple[str, str, Style, Changed | None]


@dataclass(frozen=True, slots=True)
class Line:
    """One connection of either version with its change; `sentence` describes it."""

    tail: str
    head: str
    style: Style
    label: str
    change: Changed | None
    sentence: str
    optional: bool = False

    @property
    def ends(self) -> frozenset[str]:
        """Return both ends."""
        return frozenset((self.tail, self.head))


def arrows(lines: Iterable[Line]) -> tuple[Arrow, ...]:
    """Return one arrow for each bundle of lines; only changed ones have a label."""
    bundles: dict[Key, list[Line]] = {}
    for line in lines:
        bundles.setdefault((line.tail, line.head, line.style, line.change), []).append(line)
    return tuple(_arrow(key, bundle) for key, bundle in bundles.items())


def _arrow(key: Key, bundle: Sequence[Line]) -> Arrow:
    tail, head, style, change = key
    return Arrow(
        f"{tail}>{head}:{style}:{change or 'same'}",
        tail,
        head,
        _label(bundle, SIGNS[change]) if change else "",
        style=style,
        count=len(bundle),
        optional=all(line.optional for line in bundle),
        faded=change is None,
        flows=tuple(line.sentence for line in bundle),
        change=change,
    )


def _label(bundle: Sequence[Line], sign: str) -> str:
    names = list(dict.fromkeys(line.label for line in bundle if line.label))
    shown = names if len(names) <= _NAMED else [*names[: _NAMED - 1], f"{len(names) - _NAMED + 1} more"]
    return "\n".join(f"{sign} {name}" for name in shown)
