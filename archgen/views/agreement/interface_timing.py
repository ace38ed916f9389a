"""How often and how much an interface carries, and which chains pass through it."""

from __future__ import annotations

from collections.abc import Iterator
from fractions import Fraction

from archgen.model.node import Endpoint
from archgen.timing.analysis import ChainResult, EventPace
from archgen.timing.figures.timing_values import TimingValue
from archgen.timing.system import activity_builder
from archgen.timing.system.message_sizes import MessageSize
from archgen.timing.system.timing_system import Arc, TimingSystem
from archgen.views import inline_text
from archgen.views.agreement.partner_interfaces import PartnerInterface
from archgen.views.lookup import Lookup
from archgen.views.shapes import Inlines, Text
from archgen.views.timing import rate_phrases, value_format
from archgen.views.timing.timing_lookup import TimingLookup

TermFact = tuple[str, Inlines]
_TIER_NAMES = {"declared": "declared", "dedicated": "derived, a core of its own assumed"}
_SIZE_PARTS = {
    "topic": (("Size", ""),),
    "service": (("Size of a request", "_Request"), ("Size of an answer", "_Response")),
    "action": (("Size of a goal", "_Goal"), ("Size of a result", "_Result"), ("Size of feedback", "_Feedback")),
}


def timing_facts(
    lookup: Lookup, activity_names: activity_builder.ActivityNames, interface: PartnerInterface
) -> Iterator[TermFact]:
    """Yield rate, largest gap, size and traffic; for a service or action, how soon it answers."""
    if interface.flow == "physical":
        return
    timed = lookup.timing
    written_givers = [
        endpoint for endpoint in interface.giver_endpoints if lookup.architecture.nodes[endpoint.node].written
    ]
    if timed is not None:
        for endpoint in written_givers or interface.giver_endpoints:
            suffix = f" of {endpoint.node}" if len(written_givers) > 1 else ""
            yield from _rate_facts(
                timed,
                activity_builder.activity_of_endpoint(activity_names, endpoint),
                endpoint,
                suffix,
            )
    for name, part in _SIZE_PARTS[interface.flow]:
        size = _message_size(lookup, interface, part)
        if size.bytes is not None:
            yield name, inline_text.to_inlines(_size_text(size))
        elif interface.flow == "topic":
            yield name, inline_text.message_to_inlines(f"not known: {size.why}", muted=True)
    if timed is not None and interface.flow == "topic":
        yield "Traffic", _traffic_text(timed, interface)


def _rate_facts(timed: TimingLookup, activity: str, endpoint: Endpoint, suffix: str) -> Iterator[TermFact]:
    if endpoint.flow == "topic":
        pace = timed.analysis.outputs.get((activity, activity_builder.endpoint_key(endpoint)), EventPace(None))
        yield f"Rate{suffix}", _rate_text(timed, activity, pace)
        if pace.behaviour not in {"once", "on_demand"}:
            yield f"Largest gap{suffix}", _gap_text(pace)
        return
    response = timed.analysis.responses.get(activity)
    if response is None or response.worst.value is None:
        yield f"Answers within{suffix}", inline_text.UNKNOWN_INLINES
    else:
        kind = _TIER_NAMES.get(response.tier, "derived")
        yield (
            f"Answers within{suffix}",
            inline_text.to_inlines(value_format.display_duration(response.worst), Text(f" ({kind})", muted=True)),
        )


def _rate_text(timed: TimingLookup, activity: str, pace: EventPace) -> Inlines:
    rate_words = rate_phrases.format_rate_words(pace)
    if rate_words == "?":
        return inline_text.UNKNOWN_INLINES
    if pace.rate.value is None:
        return inline_text.to_inlines(rate_words)
    if not pace.inferred:
        return inline_text.to_inlines(rate_words, Text(" (written)", muted=True))
    origins = value_format.describe_origins(timed.rate_origins.get(activity, ()))
    return inline_text.to_inlines(rate_words, Text(f" (derived{f' {origins}' if origins else ''})", muted=True))


def _gap_text(pace: EventPace) -> Inlines:
    gap_words = value_format.display_duration(pace.gap)
    return (
        inline_text.UNKNOWN_INLINES
        if pace.gap.value is None and gap_words == value_format.UNKNOWN_FIGURE
        else inline_text.to_inlines(gap_words, Text(" (derived)", muted=True))
    )


def _message_size(lookup: Lookup, interface: PartnerInterface, part: str) -> MessageSize:
    message = f"{interface.message}{part}" if interface.message else None
    return lookup.message_size(message, None if part else interface.type)


def _size_text(size: MessageSize) -> str:
    amount = value_format.display_bytes(TimingValue(Fraction(size.bytes or 0)))
    return f"{'' if size.exact else 'at most '}{amount} ({'written' if size.written else 'computed'})"


def _traffic_text(timed: TimingLookup, interface: PartnerInterface) -> Inlines:
    loads = ((name, timed.analysis.topics.get(name)) for name in interface.topic_names)
    traffic_phrases = [
        f"{value_format.display_traffic(load.published)}{f' on {name}' if len(interface.topic_names) > 1 else ''}"
        for name, load in loads
        if load and load.published.value is not None
    ]
    return inline_text.to_inlines(", ".join(traffic_phrases)) if traffic_phrases else inline_text.UNKNOWN_INLINES


def find_chains_through(
    lookup: Lookup, activity_names: activity_builder.ActivityNames, interface: PartnerInterface
) -> Iterator[ChainResult]:
    """Yield the chains that lead over the interface from giver to taker."""
    if lookup.timing is None:
        return
    giver_keys = {activity_builder.endpoint_key(endpoint) for endpoint in interface.giver_endpoints}
    taking_activities = {
        activity_builder.activity_of_endpoint(activity_names, endpoint) for endpoint in interface.taker_endpoints
    }
    system = lookup.timing.analysis.system
    for result in lookup.timing.chains:
        steps = zip(result.through, result.through[1:], strict=False)
        arcs = (arc for step, next_step in steps for arc in _arcs_between(system, step, next_step))
        if any({arc.source, arc.target} & taking_activities and {arc.output, arc.input} & giver_keys for arc in arcs):
            yield result


def _arcs_between(system: TimingSystem, step: str, next_step: str) -> list[Arc]:
    """Return what joins two steps of a chain: topics; services and actions only if there is no topic."""
    arcs = [arc for arc in system.arcs_from.get(step, ()) if arc.target == next_step]
    return [arc for arc in arcs if arc.role == "data"] or arcs
