"""All that the site's search finds, in the order in which it is loaded: names before ports, ports before texts."""

from __future__ import annotations

from collections.abc import Sequence

from archgen.views.lookup import Lookup
from archgen.views.search import functional_entries, implementation_entries, search_entry
from archgen.views.search.search_entry import SearchEntry
from archgen.views.shapes import Page


def make_search_entries(lookup: Lookup, pages: Sequence[Page]) -> tuple[SearchEntry, ...]:
    """Make the search entries of a site with these pages. Entries of one kind follow one another."""
    entries = [
        *functional_entries.make_component_entries(lookup),
        *functional_entries.make_composed_entries(lookup),
        *functional_entries.make_component_type_entries(lookup),
        *functional_entries.make_group_entries(lookup),
        *implementation_entries.make_node_entries(lookup),
        *implementation_entries.make_topic_entries(lookup),
        *implementation_entries.make_channel_entries(lookup),
        *implementation_entries.make_type_entries(lookup),
        *functional_entries.make_requirement_entries(lookup),
        *functional_entries.make_chain_entries(lookup),
        *functional_entries.make_partner_entries(lookup),
        *functional_entries.make_vocabulary_entries(lookup),
        *implementation_entries.make_host_entries(lookup),
        *implementation_entries.make_frame_entries(lookup),
        *implementation_entries.make_message_entries(lookup),
        *search_entry.make_finding_entries(lookup),
        *functional_entries.make_port_entries(lookup),
        *functional_entries.make_connection_entries(lookup),
    ]
    listed_anchors = frozenset(ref for entry in entries for ref in entry.refs[:1])
    return (*entries, *search_entry.make_page_entries(pages, listed_anchors))
