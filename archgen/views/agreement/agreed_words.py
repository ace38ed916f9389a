"""What is agreed of an interface in words: late data, time stamps, clock, start-up, duties of readers.

What the model knows is derived; what partners wrote below `agreements` stands before it; where there is neither, that is said.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping

from archgen.bringup.plan_shapes import StartStep
from archgen.diagnostics.common_wording import join_words
from archgen.frozen import dataclass
from archgen.model.agreed_terms import INTERFACE_TERMS
from archgen.model.node import Endpoint
from archgen.model.partner_interfaces import PartnerInterface, list_givers
from archgen.views import inline_text, start_phrases
from archgen.views.agreement.interface_terms import InterfaceTerms
from archgen.views.lookup import Lookup
from archgen.views.shapes import Inlines, Text

_STAMP_TYPES = {"builtin_interfaces/msg/Time": "", "time": "", "std_msgs/msg/Header": ".stamp"}
"""Types of fields that are time stamps, or hold one."""
_NOTHING = "nothing is said of it"


@dataclass(frozen=True, slots=True)
class WordRow:
    """A term in words: what partners wrote, what follows from the model, and what is not said, each empty where it is not so."""

    key: str
    title: str
    written: str = ""
    derived: tuple[str, ...] = ()
    unsaid: str = ""

    @property
    def inlines(self) -> Inlines:
        """Return it as lines, what is not said muted."""
        lines = [inline_text.message_to_inlines(each) for each in (self.written, *self.derived) if each]
        return inline_text.join_lines([*lines, *([(Text(self.unsaid, muted=True),)] if self.unsaid else [])])


def list_word_rows(lookup: Lookup, terms: InterfaceTerms, steps: Mapping[str, StartStep] | None) -> Iterator[WordRow]:
    """Yield the terms of an interface in words. Without the steps of the start-up only late data, and what is written."""
    interface, duties = terms.interface, terms.missing_data_duties
    is_message = interface.flow != "physical" and not interface.medium
    found: dict[str, tuple[tuple[str, ...], str]] = {}
    if interface.flow != "physical":
        found["late"] = (duties, "" if duties else "nothing is promised for this case")
    if steps is not None and is_message:
        found |= {
            "stamps": _describe_stamps(lookup, interface),
            "clock": _describe_clock(lookup, interface, is_agreed="clock" in terms.agreed),
            "start": (tuple(_describe_starts(interface, lookup, steps)), _NOTHING),
            "duties": (tuple(_describe_freshness(lookup, interface)), _NOTHING),
        }
    for key, title in INTERFACE_TERMS.items():
        written, (derived, unsaid) = terms.agreed.get(key, ""), found.get(key, ((), ""))
        if written or derived or unsaid:
            is_silent = unsaid and not written and (key == "clock" or not derived)
            yield WordRow(key, title, written, derived, unsaid if is_silent else "")


def _describe_stamps(lookup: Lookup, interface: PartnerInterface) -> tuple[tuple[str, ...], str]:
    definition = lookup.architecture.interfaces.definitions.get(interface.message or "")
    if definition is None:
        return (), _NOTHING
    names = [
        f"{field.name}{_STAMP_TYPES[field.type]}"
        for part in definition.parts
        for field in part
        if field.type in _STAMP_TYPES
    ]
    if not names:
        return ("The message holds no time stamp.",), ""
    return (), f"nothing is said of whether {join_words(names)} is of measuring or of sending"


def _describe_clock(lookup: Lookup, interface: PartnerInterface, *, is_agreed: bool) -> tuple[tuple[str, ...], str]:
    endpoints = _list_ends(lookup, interface)
    nodes_by_clock: dict[str | None, dict[str, None]] = {}
    for endpoint in endpoints:
        nodes_by_clock.setdefault(endpoint.clock, {})[endpoint.node] = None
    if set(nodes_by_clock) - {"system"}:
        words = {
            "system": "the clock of its computer",
            "simulated": "simulated time (`/clock`)",
            None: "a clock that is not known",
        }
        return tuple(
            f"{join_words([f'`{node}`' for node in nodes])}: {words[clock]}." for clock, nodes in nodes_by_clock.items()
        ), ""
    architecture = lookup.architecture
    hosts = dict.fromkeys(architecture.nodes[endpoint.node].host for endpoint in endpoints)
    titles = [architecture.hosts[host].title for host in hosts if host]
    if not endpoints or None in hosts:
        return (), "which computers the ends run on is not decided, and nothing is said of their clocks"
    if len(titles) == 1:
        return (f"The clock of {titles[0]}, on which both sides run.",), ""
    unsaid = "" if is_agreed else "nothing is said of how far they may differ"
    return (f"The clocks of {join_words(titles)}.",), unsaid


def _describe_starts(interface: PartnerInterface, lookup: Lookup, steps: Mapping[str, StartStep]) -> Iterator[str]:
    """Yield for each giving node what it is started after, and what shows that it is up."""
    for node in dict.fromkeys(endpoint.node for endpoint in list_givers(lookup.architecture, interface)):
        step = steps.get(node)
        if step is None:
            continue
        awaited = join_words([f"`{each.awaited}`" for each in start_phrases.name_waits(step)])
        ready = start_phrases.describe_ready(step)
        parts = [f"is started after {awaited}"] if awaited else []
        parts += [f"is up when {ready}"] if ready else []
        if parts:
            yield f"`{node}` {' and '.join(parts)}."


def _describe_freshness(lookup: Lookup, interface: PartnerInterface) -> Iterator[str]:
    for port in interface.inputs:
        if port.freshness:
            title = lookup.architecture.components[port.component].title
            yield f"{title} uses nothing older than {port.freshness} as `{port.name}`."


def _list_ends(lookup: Lookup, interface: PartnerInterface) -> list[Endpoint]:
    ends: Iterable[Endpoint] = (*list_givers(lookup.architecture, interface), *interface.taker_endpoints)
    return [endpoint for endpoint in ends if lookup.architecture.nodes[endpoint.node].written]
