"""Arrows of pictures of changes: one for all connections between two boxes with the same change."""

from __future__ import annotations

from collections.abc import Iterable, Sequence

from archgen.diagnostics import fit_lines
from archgen.frozen import dataclass
from archgen.views.changes.change_wording import BREAK_SIGN, CHANGE_SIGNS
from archgen.views.graphs.drawn_level import FlowStyle
from archgen.views.picture_shapes import Arrow, ElementChange

_MAX_LABELS = 3
ArrowKey = tuple[str, str, FlowStyle, ElementChange | None, tuple[str, ...]]


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
    ports: tuple[str, str] = ("", "")
    """The output and the input that it connects."""
    broken_partners: tuple[str, ...] = ()
    """What people call the partners for whom it breaks."""

    @property
    def ends(self) -> frozenset[str]:
        """Return both ends."""
        return frozenset((self.tail, self.head))


def bundle_arrows(lines: Iterable[ConnectionLine]) -> tuple[Arrow, ...]:
    """Return one arrow for each bundle of lines; only changed ones have a label."""
    bundles: dict[ArrowKey, list[ConnectionLine]] = {}
    for line in lines:
        bundles.setdefault((line.tail, line.head, line.style, line.change, line.broken_partners), []).append(line)
    return tuple(_draw_bundle(key, bundle) for key, bundle in bundles.items())


def _draw_bundle(key: ArrowKey, bundle: Sequence[ConnectionLine]) -> Arrow:
    tail, head, style, change, broken_partners = key
    label = _bundle_label(bundle, BREAK_SIGN if broken_partners else CHANGE_SIGNS[change or "changed"])
    return Arrow(
        f"{tail}>{head}:{style}:{change or 'same'}{':broken' if broken_partners else ''}",
        tail,
        head,
        label if change or broken_partners else "",
        style=style,
        count=len(bundle),
        optional=all(line.optional for line in bundle),
        faded=change is None and not broken_partners,
        flows=tuple(line.sentence for line in bundle),
        change=change,
        broken=bool(broken_partners),
    )


def _bundle_label(bundle: Sequence[ConnectionLine], sign: str) -> str:
    labels = list(dict.fromkeys(line.label for line in bundle if line.label))
    return "\n".join(f"{sign} {name}" for name in fit_lines(labels, _MAX_LABELS, "{} more"))
