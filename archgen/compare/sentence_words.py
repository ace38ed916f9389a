"""What sentences about changes are made of: names in backticks, ids as readers know them, lists that are cut."""

from __future__ import annotations

from collections.abc import Iterable, Sequence

from archgen.compare.key_phrases import shorten_text
from archgen.compare.version_pair import VersionPair
from archgen.diagnostics.common_wording import join_words

_MAX_EFFECTS = 3
"""Maximal number of effects in one sentence; all of them are in the parts."""
_MAX_NAMES = 6
"""Maximal number of names in one list; the rest is counted."""


def limit_effects(effects: Sequence[str]) -> Sequence[str]:
    """Return the first effects, and how many more there are."""
    surplus = len(effects) - _MAX_EFFECTS
    return (
        effects
        if surplus <= 0
        else (*effects[:_MAX_EFFECTS], f"and {surplus} more such effect{'s' if surplus > 1 else ''}")
    )


def shown_id(kind: str, name: str, versions: VersionPair) -> str:
    """Return the id that readers know: that of the second version, of a removed element that of the first."""
    element = None if (kind, name) in versions.elements_after else versions.elements_before.get((kind, name))
    return element.own_id if element else name


def tick_names(names: Iterable[str], max_names: int = _MAX_NAMES) -> str:
    """Return element names in backticks, the surplus counted."""
    ticked_names = [f"`{shorten_text(name)}`" for name in names]
    return (
        join_words(ticked_names)
        if len(ticked_names) <= max_names
        else join_words([*ticked_names[: max_names - 1], f"{len(ticked_names) - max_names + 1} more"])
    )
