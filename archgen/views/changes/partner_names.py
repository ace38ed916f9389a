"""What partners are called in sentences for people: by their titles, with the id where two have the same."""

from __future__ import annotations

from collections.abc import Iterable, Mapping

from archgen.compare import Comparison
from archgen.compare.partner_titles import name_partner


def name_each(partners: Iterable[str], partner_names: Mapping[str, str]) -> tuple[str, ...]:
    """Return what people call partners."""
    return tuple(name_partner(partner, partner_names) for partner in partners)


def name_partners(comparison: Comparison) -> Mapping[str, str]:
    """Return the name of each partner of either version, by id."""
    return comparison.versions.partner_names
