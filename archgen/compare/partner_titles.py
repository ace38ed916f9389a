"""What partners are called in sentences for people: by their titles, with the id where two have the same."""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping

from archgen.compare.key_phrases import shorten_text
from archgen.model.architecture import Architecture


def name_partner(partner: str, partner_names: Mapping[str, str]) -> str:
    """Return what people call a partner; its id where nobody declares it."""
    return partner_names.get(partner) or shorten_text(partner)


def title_partners(before: Architecture, after: Architecture) -> Mapping[str, str]:
    """Return the name of each partner of either version, by id."""
    partners = {**before.partners, **after.partners}
    titles = {partner_id: shorten_text(partner.title) for partner_id, partner in partners.items()}
    counts = Counter(titles.values())
    return {
        partner_id: f"{title} (`{shorten_text(partner_id)}`)" if counts[title] > 1 else title
        for partner_id, title in titles.items()
    }
