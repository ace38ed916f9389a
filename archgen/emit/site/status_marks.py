"""Draw states: chips with an icon and words, bars of a share, and marks in the tree. The words say all that they show."""

from __future__ import annotations

from collections.abc import Mapping

from archgen.emit.site.html_text import escape_html
from archgen.views.shapes import Meter, Status

_RING = "M8 2.5a5.5 5.5 0 1 1 0 11a5.5 5.5 0 1 1 0-11"
_TRIANGLE = "M8 2.5 14.5 13.5H1.5ZM8 6.5v3.2M8 11.6v.2"
_ICON_PATHS: Mapping[Status, str] = {
    "met": "M3 8.5 6.5 12 13 4.5",
    "not proven": "M5 6a3 3 0 1 1 4.2 2.8C8.3 9.3 8 9.7 8 10.5M8 12.8v.2",
    "missed": "M4 4 12 12M12 4 4 12",
    "open": _RING,
    "uncovered": f"{_RING}M4.2 11.8 11.8 4.2",
    "error": "M4 4 12 12M12 4 4 12",
    "warning": _TRIANGLE,
    "note": f"{_RING}M8 7.3v3.4M8 5.1v.2",
    "changed": "M3 5.5h9L9.5 3M13 10.5H4L6.5 13",
}
"""What is drawn in a square of 16 by 16, with a line of 1.6."""
_METER_LENGTH = 72
_METER_HEIGHT = 7


def write_chip(status: Status, text: str) -> str:
    """Write a chip: an icon, the word of the state, and what the words behind a ` · ` add."""
    word, _, addition = text.partition(" · ")
    addition_html = f' <span class="addition">{escape_html(addition)}</span>' if addition else ""
    return f'<span class="chip {_class_name(status)}">{write_icon(status)}{escape_html(word)}{addition_html}</span>'


def write_icon(status: Status) -> str:
    """Write the icon of a state."""
    return f'<svg class="icon" viewBox="0 0 16 16" width="12" height="12" aria-hidden="true"><path d="{_ICON_PATHS[status]}"/></svg>'


def list_icons() -> tuple[tuple[str, str], ...]:
    """Return the path of each state's icon, for scripts that draw chips."""
    return tuple(_ICON_PATHS.items())


def write_meter(meter: Meter) -> str:
    """Write a bar. Screen readers leave it out: the figures beside it say the same.

    Beyond the whole it is drawn in full, with a mark where the whole ends.
    """
    scale = _METER_LENGTH / max(1.0, meter.share)
    length = max(0.0, meter.share) * scale
    parts = [f'<rect class="ground" width="{_METER_LENGTH}" height="{_METER_HEIGHT}" rx="3"/>']
    if meter.is_partial:
        parts.append(f'<path class="hatch" d="{_hatch(length)}"/>')
    parts.append(f'<rect class="known" width="{min(length, scale):.4g}" height="{_METER_HEIGHT}" rx="3"/>')
    if meter.share > 1:
        parts.append(
            f'<rect class="over" x="{scale:.4g}" width="{length - scale:.4g}" height="{_METER_HEIGHT}"/>'
            f'<path class="limit" d="M{scale:.4g} -2V{_METER_HEIGHT + 2}"/>'
        )
    return (
        f'<svg class="meter {_class_name(meter.status)}" viewBox="0 -2 {_METER_LENGTH} {_METER_HEIGHT + 4}"'
        f' width="{_METER_LENGTH}" height="{_METER_HEIGHT + 4}" preserveAspectRatio="none" aria-hidden="true">'
        f"{''.join(parts)}</svg>"
    )


def _hatch(start: float) -> str:
    """Return slanted lines from the end of what is known to the end of the bar."""
    first = int(start) + 1
    return "".join(f"M{x} {_METER_HEIGHT}l5-{_METER_HEIGHT}" for x in range(first, _METER_LENGTH - 5, 4))


_MARK_WORDS = {
    "error": "there is an error",
    "missed": "a deadline is missed",
    "open": "something is open",
    "changed": "changed",
}


def write_mark(mark: str) -> str:
    """Write the mark of an entry of the tree: a ring for something open, a disc for an error or a missed deadline, a square
    for what has changed.
    """
    words = _MARK_WORDS[mark]
    return f'<span class="mark {mark}"><span class="spoken"> ({words})</span></span>'


def _class_name(status: Status) -> str:
    return status.replace(" ", "-")
