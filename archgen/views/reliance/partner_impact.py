"""What rests on a partner or on some components: deadlines, use cases, requirements, readers, interfaces, and what may
stand in for them meanwhile. Nothing is judged here: all of it is read off the chains, steps and interfaces that views show.
"""

from __future__ import annotations

from collections.abc import Collection, Iterable, Iterator, Sequence
from typing import Literal

from archgen.frozen import dataclass, replace
from archgen.model.architecture import Partner
from archgen.model.component import Component
from archgen.model.partner_interfaces import components_at_ends, foreign_owners
from archgen.model.requirement import Requirement
from archgen.model.selector_evaluation import MilestoneNeeds, list_needs
from archgen.model.step_connections import ConnectedStep
from archgen.timing.analysis import ChainResult
from archgen.timing.figures.timing_values import TimingValue, sum_bounds
from archgen.views.agreement.exchange_tables import PartnerExchange
from archgen.views.agreement.interface_terms import InterfaceTerms
from archgen.views.lookup import Lookup
from archgen.views.timing.flow_tables import list_activities

StepState = Literal["runs", "theirs", "never"]
"""How a step of a use case fares: it comes before all of theirs, is theirs, or comes after one of them."""
StandIn = Literal["recording", "stub", "none"]
"""What readers may work with meanwhile: a recording or a stub of a topic, a stub of what is called for or is no ROS; none of
what is physical, or has no message yet."""


@dataclass(frozen=True, slots=True)
class LateParts:
    """Who or what is late: the ids of leaves, and the activities that are theirs. `partner` is None for chosen components."""

    partner: Partner | None
    components: frozenset[str]
    activities: frozenset[str]
    owners: tuple[str, ...]


@dataclass(frozen=True, slots=True)
class RestingChain:
    """A chain with a deadline that runs through them: how many of its steps are theirs, and how long these take (ns)."""

    result: ChainResult
    own_steps: int
    own_time: TimingValue


@dataclass(frozen=True, slots=True)
class StoppedUseCase:
    """A use case that needs them, with the state of each of its steps."""

    id: str
    steps: tuple[StepState, ...]

    @property
    def stop(self) -> int:
        """Return the number of the first step that is theirs, from 1."""
        return self.steps.index("theirs") + 1


@dataclass(frozen=True, slots=True)
class RestingRequirement:
    """A requirement that they serve, or a chain through them, with the other components that serve it."""

    requirement: Requirement
    others: tuple[Component, ...]


@dataclass(frozen=True, slots=True)
class AwaitedInterface:
    """What they give to other partners: its terms with each of them, and what rests on it."""

    terms: tuple[InterfaceTerms, ...]
    chains: tuple[str, ...]
    use_case_steps: int
    readers: tuple[str, ...]
    stand_in: StandIn

    @property
    def takers(self) -> tuple[str, ...]:
        """Return the partners who wait for it."""
        return tuple(dict.fromkeys(each.interface.pair[1] for each in self.terms))

    @property
    def open_words(self) -> tuple[str, ...]:
        """Return what is still to be settled of it, with any of them."""
        return tuple(dict.fromkeys(word for each in self.terms for word in each.open_terms))


@dataclass(frozen=True, slots=True)
class WaitingPartner:
    """A partner who waits for them: for how many flows, for which interfaces, and which of his components run without."""

    id: str
    flow_count: int
    interfaces: tuple[AwaitedInterface, ...]
    free_components: tuple[str, ...]


@dataclass(frozen=True, slots=True)
class PartnerImpact:
    """All that rests on what is late. `interfaces` are in the order in which to settle them."""

    late: LateParts
    chains: tuple[RestingChain, ...]
    free_chains: tuple[str, ...]
    """The chains with a deadline that do not run through them."""
    use_cases: tuple[StoppedUseCase, ...]
    use_case_count: int
    requirements: tuple[RestingRequirement, ...]
    interfaces: tuple[AwaitedInterface, ...]
    waiting: tuple[WaitingPartner, ...]
    awaited: tuple[tuple[str, int], ...]
    """For whom they wait themselves, and for how many flows."""
    readers: tuple[str, ...]
    """The other components that read from them."""
    reached: int
    """How many other components are fed by these in the end, the readers included."""
    milestones: tuple[MilestoneNeeds, ...]
    """The milestones that need some of theirs, by their days; `components` are those. With `until` those before it."""
    until: str | None

    @property
    def enough(self) -> int:
        """Return how many of the first interfaces give every reader something to read."""
        seen: set[str] = set()
        needed = {reader for each in self.interfaces for reader in each.readers}
        for count, each in enumerate(self.interfaces, start=1):
            seen.update(each.readers)
            if seen == needed:
                return count
        return 0


def find_parts_of(lookup: Lookup, partner: Partner) -> LateParts:
    """Return what a partner owns: components, and those that nodes of his implement for others."""
    architecture = lookup.architecture
    foreign = (
        component
        for node in architecture.nodes.values()
        if partner.id in foreign_owners(architecture, node)
        for component in node.implements
    )
    own = (component.id for component in architecture.components.values() if partner.id in component.owners)
    return make_parts(lookup, (*own, *foreign), partner)


def make_parts(lookup: Lookup, component_ids: Iterable[str], partner: Partner | None = None) -> LateParts:
    """Return chosen components, composed ones with all that is inside, as what is late."""
    architecture = lookup.architecture
    leaves = dict.fromkeys(leaf for name in component_ids for leaf in architecture.leaves_of(name))
    activities = [each.id for leaf in leaves for each in list_activities(lookup, lookup.nodes_of.get(leaf, ()), leaf)]
    if partner:
        nodes = [node for node in architecture.nodes.values() if partner.id in node.owners and not node.implements]
        activities += [each.id for each in list_activities(lookup, nodes)]
    owners = {owner: None for leaf in leaves for owner in architecture.components[leaf].owners}
    return LateParts(partner, frozenset(leaves), frozenset(activities), (partner.id,) if partner else tuple(owners))


def find_impact(
    lookup: Lookup,
    exchanges: Sequence[PartnerExchange],
    late: LateParts,
    needs: Sequence[MilestoneNeeds] | None = None,
    until: str | None = None,
) -> PartnerImpact:
    """Return all that rests on what is late, of the milestones those before a day (YYYY-MM-DD)."""
    needs = list_needs(lookup.architecture) if needs is None else needs
    own_needs = [
        replace(each, components=own)
        for each in needs
        if (own := tuple(name for name in each.components if name in late.components))
        and (until is None or (each.milestone.date is not None and each.milestone.date < until))
    ]
    judged = [result for result in lookup.timing.chains if result.deadline or result.shares] if lookup.timing else []
    chains = tuple(_find_chains(judged, late))
    broken_ids = {each.result.id for each in chains}
    interfaces = _find_interfaces(lookup, exchanges, late)
    fed = lookup.reach.find_fed(sorted(late.components))
    cases = lookup.steps.by_use_case
    return PartnerImpact(
        late,
        chains,
        tuple(result.id for result in judged if result.id not in broken_ids),
        tuple(_find_use_cases(lookup, late)),
        len(cases),
        tuple(_find_requirements(lookup, late, broken_ids)),
        interfaces,
        tuple(_find_waiting(lookup, interfaces)),
        tuple(_count_awaited(exchanges, late)),
        tuple(name for name, steps in fed.items() if steps == 1),
        len(fed),
        tuple(own_needs),
        until,
    )


def _find_chains(judged: Iterable[ChainResult], late: LateParts) -> Iterator[RestingChain]:
    for result in judged:
        own = [term for term in result.terms if term.activity in late.activities]
        if own:
            time = sum_bounds([part for term in own for part in (term.sampling, term.response, term.link)])
            yield RestingChain(result, len(own), time)


def _is_late(lookup: Lookup, component_id: str, late: LateParts) -> bool:
    return not late.components.isdisjoint(lookup.architecture.leaves_of(component_id))


def _find_use_cases(lookup: Lookup, late: LateParts) -> Iterator[StoppedUseCase]:
    for name, steps in lookup.steps.by_use_case.items():
        states: list[StepState] = []
        for each in steps:
            ends = (end.participant for end in (each.step.source, each.step.target) if end.kind != "actor")
            is_theirs = any(_is_late(lookup, end, late) for end in ends)
            states.append("theirs" if is_theirs else "never" if "theirs" in states else "runs")
        if "theirs" in states:
            yield StoppedUseCase(name, tuple(states))


def _find_requirements(lookup: Lookup, late: LateParts, chain_ids: Collection[str]) -> Iterator[RestingRequirement]:
    """Yield the requirements, those that no other component serves first."""
    found = []
    for requirement in lookup.architecture.requirements.values():
        servers = lookup.components_for_requirement.get(requirement.id, ())
        others = tuple(each for each in servers if not _is_late(lookup, each.id, late))
        chains = lookup.chains_for_requirement.get(requirement.id, ())
        if len(others) < len(servers) or any(chain.id in chain_ids for chain in chains):
            found.append(RestingRequirement(requirement, others))
    yield from sorted(found, key=lambda each: bool(each.others))


def _find_interfaces(
    lookup: Lookup, exchanges: Iterable[PartnerExchange], late: LateParts
) -> tuple[AwaitedInterface, ...]:
    """Return what they give, first what deadlines rest on, then steps of use cases, then readers."""
    given: dict[str, list[InterfaceTerms]] = {}
    for exchange in exchanges:
        for owner in exchange.pair:
            for terms in exchange.list_given(owner) if owner in late.owners else ():
                givers, _ = components_at_ends(lookup.architecture, terms.interface)
                if late.partner or any(each.id in late.components for each in givers):
                    given.setdefault(terms.interface.key, []).append(terms)
    steps = [each for steps in lookup.steps.by_use_case.values() for each in steps]
    interfaces = [_make_interface(lookup, tuple(terms), steps) for terms in given.values()]
    rank = lambda each: (-len(each.chains), -each.use_case_steps, -len(each.readers))  # noqa: E731 - one sort
    return tuple(sorted(interfaces, key=rank))


def _make_interface(
    lookup: Lookup, terms: tuple[InterfaceTerms, ...], steps: Iterable[ConnectedStep]
) -> AwaitedInterface:
    interfaces = [each.interface for each in terms]
    inputs = {port.id for each in interfaces for port in each.inputs}
    chains = (chain.id for each in terms for chain in each.chains if chain.deadline or chain.shares)
    key = interfaces[0].key
    use_case_steps = len(
        [step for step in steps if any(way.output == key and way.input in inputs for way in step.connections)]
    )
    readers = [taker.id for each in interfaces for taker in components_at_ends(lookup.architecture, each)[1]]
    readers += [end.node for each in interfaces for end in each.taker_endpoints if not end.component]
    first = interfaces[0]
    stand_in: StandIn = "recording" if first.flow == "topic" and not first.medium else "stub"
    if first.flow == "physical" or (first.message is None and not first.medium):
        stand_in = "none"
    return AwaitedInterface(
        terms, tuple(dict.fromkeys(chains)), use_case_steps, tuple(dict.fromkeys(readers)), stand_in
    )


def _find_waiting(lookup: Lookup, interfaces: Sequence[AwaitedInterface]) -> Iterator[WaitingPartner]:
    """Yield who waits, for most flows first."""
    found = []
    for partner in lookup.architecture.partners:
        awaited = tuple(each for each in interfaces if partner in each.takers)
        terms = [each for every in awaited for each in every.terms if each.interface.pair[1] == partner]
        if not terms:
            continue
        inputs = {port.id: port for each in terms for port in each.interface.inputs}
        needing = {port.component for port in inputs.values() if not port.optional}
        free = dict.fromkeys(port.component for port in inputs.values() if port.component not in needing)
        flows = sum(_count_flows(each) for each in terms)
        found.append(WaitingPartner(partner, flows, awaited, tuple(free)))
    yield from sorted(found, key=lambda each: -each.flow_count)


def _count_flows(terms: InterfaceTerms) -> int:
    return len(terms.interface.inputs) or len({end.node for end in terms.interface.taker_endpoints})


def _count_awaited(exchanges: Iterable[PartnerExchange], late: LateParts) -> Iterator[tuple[str, int]]:
    counts: dict[str, int] = {}
    for exchange in exchanges:
        for terms in exchange.interfaces:
            giver, taker = terms.interface.pair
            ports = terms.interface.inputs
            is_theirs = taker in late.owners and giver not in late.owners
            if is_theirs and (late.partner or any(port.component in late.components for port in ports)):
                counts[giver] = counts.get(giver, 0) + _count_flows(terms)
    yield from sorted(counts.items(), key=lambda entry: -entry[1])
