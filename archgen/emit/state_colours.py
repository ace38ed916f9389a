"""Colours of states in office documents, as hexadecimal digits. Words say the same on grey paper."""

from __future__ import annotations

from collections.abc import Mapping

MUTED_COLOUR = "55606A"
CHANGE_COLOURS: Mapping[str, str] = {"added": "1C6B3C", "removed": "B3261E", "changed": "8A5300"}
STATUS_COLOURS: Mapping[str, str] = {
    "met": "1C6B3C",
    "not proven": "8A5300",
    "open": "8A5300",
    "uncovered": "8A5300",
    "warning": "8A5300",
    "missed": "B3261E",
    "error": "B3261E",
}
