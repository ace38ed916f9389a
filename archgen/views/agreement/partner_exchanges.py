"""What each two partners give each other, with all terms: for pages on partners, which show the pairs beside one another."""

from __future__ import annotations

from collections.abc import Mapping

from archgen.frozen import dataclass
from archgen.model.partner_interfaces import PartnerInterface, PartnerPair, components_at_ends, find_all_interfaces
from archgen.timing.system import activity_builder
from archgen.views.agreement.interface_terms import InterfaceTerms, gather_terms
from archgen.views.lookup import Lookup


@dataclass(frozen=True, slots=True)
class PartnerExchange:
    """What two partners give each other. `pair` has them in the order in which the project declares them."""

    pair: PartnerPair
    interfaces: tuple[InterfaceTerms, ...]
    open_count: int
    """How many points the two have still to settle."""

    def list_given(self, giver: str) -> tuple[InterfaceTerms, ...]:
        """Return what one of the two gives the other."""
        return tuple(terms for terms in self.interfaces if terms.interface.pair[0] == giver)


def gather_exchanges(lookup: Lookup) -> tuple[PartnerExchange, ...]:
    """Return the exchanges between all partners that have interfaces with shown components or nodes, as declared."""
    activity_names = activity_builder.name_activities(lookup.architecture)
    positions: Mapping[str, int] = {partner: at for at, partner in enumerate(lookup.architecture.partners)}
    interfaces_by_pair: dict[PartnerPair, list[InterfaceTerms]] = {}
    for interface in find_all_interfaces(lookup.architecture):
        if _is_shown(lookup, interface):
            first, second = sorted(interface.pair, key=lambda partner: positions.get(partner, len(positions)))
            terms = gather_terms(lookup, activity_names, interface)
            interfaces_by_pair.setdefault((first, second), []).append(terms)
    pairs = sorted(
        interfaces_by_pair, key=lambda pair: tuple(positions.get(partner, len(positions)) for partner in pair)
    )
    return tuple(
        # Counted once: each page on a partner and each page on a pair shows it.
        PartnerExchange(pair, tuple(all_terms), sum(len(terms.open_points) for terms in all_terms))
        for pair in pairs
        for all_terms in (interfaces_by_pair[pair],)
    )


def _is_shown(lookup: Lookup, interface: PartnerInterface) -> bool:
    """Whether a document that shows a part shows an interface: one of its ends is in that part."""
    ends = components_at_ends(lookup.architecture, interface)
    endpoints = (*interface.giver_endpoints, *interface.taker_endpoints)
    return any(lookup.scope.shows_component(component.id) for end in ends for component in end) or any(
        lookup.scope.shows_node(endpoint.node) for endpoint in endpoints if not any(ends)
    )
