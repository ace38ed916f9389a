"""What partners are called in sentences for people: by their titles, with the id where two have the same."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Mapping

from archgen.compare import Comparison
from archgen.compare.key_phrases import shorten_text


def name_each(partners: Iterable[str], partner_names: Mapping[str, str]) -> tuple[str, ...]:
    """Return what people call partners."""
    return tuple(partner_names.get(partner) or shorten_text(partner) for partner in partners)


def name_partners(comparison: Comparison) -> Mapping[str, str]:
    """Return the name of each partner of either version, by id."""
    partners = {**comparison.before.architecture.partners, **comparison.after.architecture.partners}
    titles = {partner_id: shorten_text(partner.title) for partner_id, partner in partners.items()}
    counts = Counter(titles.values())
    return {
        partner_id: f"{title} (`{shorten_text(partner_id)}`)" if counts[title] > 1 else title
        for partner_id, title in titles.items()
    }
