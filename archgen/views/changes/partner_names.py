"""What partners are called in sentences for people: by their titles, with the id where two have the same."""

from __future__ import annotations

from collections.abc import Iterable, Mapping

from archgen.compare import Comparison
from archgen.compare.key_phrases import shorten_text
from archgen.compare.partner_titles import title_partners


def name_each(partners: Iterable[str], partner_names: Mapping[str, str]) -> tuple[str, ...]:
    """Return what people call partners."""
    return tuple(partner_names.get(partner) or shorten_text(partner) for partner in partners)


def name_partners(comparison: Comparison) -> Mapping[str, str]:
    """Return the name of each partner of either version, by id."""
    return title_partners(comparison.before.architecture, comparison.after.architecture)
