"""An element's card: what `archgen show` prints for one element of any kind."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from typing import Any

from archgen.frozen import replace
from archgen.model.made_elements import find_made_element
from archgen.views.elements.annotation_facts import ElementCard, format_fact, known_facts, list_annotation_lines
from archgen.views.elements.element_names import elements_by_kind
from archgen.views.elements.level_cards import (
    make_channel_card,
    make_component_card,
    make_component_type_card,
    make_composed_card,
    make_group_card,
    make_node_card,
    make_port_card,
    make_topic_card,
)
from archgen.views.elements.plain_cards import make_generic_card, make_use_case_card
from archgen.views.lookup import Lookup


def make_card(lookup: Lookup, kind: str, element_id: str) -> ElementCard:
    """Make the card of one element."""
    make_kind_card = _CARD_MAKERS.get(kind)
    if make_kind_card is None:
        card = make_generic_card(lookup, kind, element_id)
    else:
        card = make_kind_card(lookup, elements_by_kind(lookup.architecture)[kind][element_id])
    further_facts = (
        tuple(_list_further_facts(lookup, kind, element_id)) if kind not in {"topic", "channel", "variant"} else ()
    )
    if (made := find_made_element(lookup.architecture.made_elements, card.span)) is not None:
        further_facts = (*further_facts, ("origin", str(made)))
    return replace(card, facts=(*card.facts, *further_facts)) if further_facts else card


def _list_further_facts(lookup: Lookup, kind: str, element_id: str) -> Iterator[tuple[str, str]]:
    """Yield what elements of several kinds may say: status, contact, picture, documents, properties, hints."""
    element = elements_by_kind(lookup.architecture)[kind][element_id]
    if kind in {"component", "composed", "component type"}:
        yield from known_facts([(key, format_fact(getattr(element, key))) for key in ("status", "contact", "image")])
    if kind in {"input", "output"} and element.urls:
        yield "urls", ", ".join(f"{name}: {address}" for name, address in element.urls.items())
    yield from list_annotation_lines(element)


_CARD_MAKERS: Mapping[str, Callable[[Lookup, Any], ElementCard]] = {
    "group": make_group_card,
    "component": make_component_card,
    "composed": make_composed_card,
    "component type": make_component_type_card,
    "input": make_port_card,
    "output": make_port_card,
    "node": make_node_card,
    "topic": make_topic_card,
    "channel": make_channel_card,
    "use case": make_use_case_card,
}
"""What makes the card of an element; other kinds have a list of fields."""
