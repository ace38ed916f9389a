"""Arrows of pictures of changes: one for all connections between two boxes with the same change."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass

from archgen.views.changes.change_wording import CHANGE_SIGNS
from archgen.views.graph_shapes import Arrow, ElementChange
from archgen.views.graphs.component_flows import FlowStyle

_MAX_LABELS = 3
ArrowKey = tuple[str, str, FlowStyle, ElementChange | None]


@dataclass(frozen=True, slots=True)
class ConnectionLine:
    """One connection of either version with its change; `sentence` describes it."""

    tail: str
    head: str
    style: FlowStyle
    label: str
    change: ElementChange | None
    sentence: str
    optional: bool = False

    @property
    def ends(self) -> frozenset[str]:
        """Return both ends."""
        return frozenset((self.tail, self.head))


def bundle_arrows(lines: Iterable[ConnectionLine]) -> tuple[Arrow, ...]:
    """Return one arrow for each bundle of lines; only changed ones have a label."""
    bundles: dict[ArrowKey, list[ConnectionLine]] = {}
    for line in lines:
        bundles.setdefault((line.tail, line.head, line.style, line.change), []).append(line)
    return tuple(_draw_bundle(key, bundle) for key, bundle in bundles.items())


def _draw_bundle(key: ArrowKey, bundle: Sequence[ConnectionLine]) -> Arrow:
    tail, head, style, change = key
    return Arrow(
        f"{tail}>{head}:{style}:{change or 'same'}",
        tail,
        head,
        _bundle_label(bundle, CHANGE_SIGNS[change]) if change else "",
        style=style,
        count=len(bundle),
        optional=all(line.optional for line in bundle),
        faded=change is None,
        flows=tuple(line.sentence for line in bundle),
        change=change,
    )


def _bundle_label(bundle: Sequence[ConnectionLine], sign: str) -> str:
    labels = list(dict.fromkeys(line.label for line in bundle if line.label))
    shown_labels = (
        labels if len(labels) <= _MAX_LABELS else [*labels[: _MAX_LABELS - 1], f"{len(labels) - _MAX_LABELS + 1} more"]
    )
    return "\n".join(f"{sign} {name}" for name in shown_labels)
