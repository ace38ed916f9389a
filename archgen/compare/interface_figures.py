"""The figures of an interface between two partners: how often, how much, how old, on which hosts, and the QoS of both ends.

They are what an agreement promises and expects in numbers. Here they are values, so that two versions can be compared.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass, field, replace
from fractions import Fraction
from functools import cached_property

from archgen.compare.comparison import ComparedFigure, FigureChange, FigureKey, TravelPath
from archgen.compare.matched_ids import MatchedIds
from archgen.diagnostics import NO_SPAN
from archgen.model.architecture import Architecture
from archgen.model.node import Endpoint, Qos
from archgen.model.partner_interfaces import PartnerInterface, list_givers
from archgen.model.ros_distro import is_ros_1
from archgen.timing.analysis import Analysis, TopicLoad, find_pace
from archgen.timing.figures.figure_wording import name_unknown_reason
from archgen.timing.figures.timing_values import UNKNOWN_VALUE, TimingValue
from archgen.timing.rates.link_traffic import find_topic_loads
from archgen.timing.system import activity_builder
from archgen.timing.system.timing_system import Arc

_NEGLIGIBLE_SHARE, _NEGLIGIBLE_AGE = Fraction(5, 1000), Fraction(5, 100)
"""A figure that changed by a smaller share concerns nobody. Of the age on arrival smaller changes are not even told, since
one more message on a link makes everything on it a little older; agreements do not have it.
"""
UNCHANGED_SHARE, _UNCHANGED_DURATION = Fraction(1, 1000), 1000
"""A figure that differs by no more than that share, or a duration by less than so many ns, is the same to everybody: all
figures move a little with the common tick of the analysis.
"""
_AGE_NAME = "age on arrival"
DELAY_NAMES = frozenset({"largest gap", _AGE_NAME, "answers within"})
RECEIVER_NAMES = frozenset({_AGE_NAME, "QoS asked", "hosts"})
"""The figures that depend on who receives."""
_SIZE_NAMES = {
    "service": {"request": "size of a request", "answer": "size of an answer"},
    "action": {"request": "size of a goal", "answer": "size of a result"},
}


InterfaceFigures = Mapping[FigureKey, ComparedFigure]


@dataclass
class FigureReader:
    """Reads the figures of interfaces of one version. Without an analysis there are those alone that need none."""

    architecture: Architecture
    analysis: Analysis | None
    matched_ids: MatchedIds = field(default_factory=MatchedIds)

    @cached_property
    def _activity_names(self) -> activity_builder.ActivityNames:
        return activity_builder.name_activities(self.architecture)

    @cached_property
    def _topic_loads(self) -> Mapping[str, TopicLoad]:
        # The analysis that rules judge leaves them out.
        return find_topic_loads(self.analysis.system, self.analysis.outputs) if self.analysis else {}

    def read_figures(self, interface: PartnerInterface) -> InterfaceFigures:
        """Return the figures of an interface, each with its node where nodes have them; what flows physically has none."""
        if interface.flow == "physical":
            return {}
        return dict((*self._read_paces(interface), *self._read_qos(interface), *self._read_path(interface)))

    def is_written(self, endpoints: Iterable[Endpoint]) -> bool:
        """Whether somebody wrote a node of these endpoints; figures of others are those of a plan."""
        return any(self.architecture.nodes[endpoint.node].written for endpoint in endpoints)

    def _read_paces(self, interface: PartnerInterface) -> Iterator[tuple[FigureKey, ComparedFigure]]:
        if self.analysis is None:
            return
        for endpoint in list_givers(self.architecture, interface):
            node = self._common_node(endpoint)
            if interface.flow == "topic":
                yield from self._read_pace(self.analysis, endpoint, node)
            else:
                response = self.analysis.responses.get(self._activity_of(endpoint))
                yield FigureKey("answers within", node), response.worst if response else UNKNOWN_VALUE
        yield from self._read_sizes(interface)
        yield FigureKey(_AGE_NAME), self._find_age(self.analysis, interface)

    def _read_pace(
        self, analysis: Analysis, endpoint: Endpoint, node: str
    ) -> Iterator[tuple[FigureKey, ComparedFigure]]:
        pace = find_pace(analysis, self._activity_names, endpoint)
        yield FigureKey("rate", node), pace.rate
        yield FigureKey("largest gap", node), pace.gap

    def _read_sizes(self, interface: PartnerInterface) -> Iterator[tuple[FigureKey, ComparedFigure]]:
        if interface.flow != "topic":
            for arc in self._list_arcs(interface):
                if name := _SIZE_NAMES[interface.flow].get(arc.role):
                    yield FigureKey(name), (UNKNOWN_VALUE if arc.size is None else TimingValue(Fraction(arc.size)))
            return
        loads = [load for name in interface.topic_names if (load := self._topic_loads.get(name))]
        if len(loads) == 1:
            yield FigureKey("size"), loads[0].size
            yield FigureKey("traffic"), loads[0].published

    def _find_age(self, analysis: Analysis, interface: PartnerInterface) -> TimingValue:
        """Return how old data is at most when it arrives: from the start of the work that gives it, links included."""
        if interface.flow != "topic":
            return UNKNOWN_VALUE
        ages = []
        for arc in self._list_arcs(interface):
            response = analysis.responses[arc.source].worst
            if response.value is None or not response.complete or arc.worst is None:
                return UNKNOWN_VALUE
            ages.append(response.value + arc.worst * analysis.system.tick)
        return TimingValue(max(ages)) if ages else UNKNOWN_VALUE

    def _list_arcs(self, interface: PartnerInterface) -> list[Arc]:
        """Return what the interface's data passes along, from its givers to its takers and (answers) back."""
        if self.analysis is None:
            return []
        arcs_from = self.analysis.system.arcs_from
        givers = {self._activity_of(endpoint) for endpoint in interface.giver_endpoints}
        takers = {self._activity_of(endpoint) for endpoint in interface.taker_endpoints}
        names = set(interface.topic_names)
        arcs = (arc for name in sorted(givers | takers) for arc in arcs_from.get(name, ()) if arc.topic in names)
        return [arc for arc in arcs if {arc.source, arc.target} & givers and {arc.source, arc.target} & takers]

    def _read_qos(self, interface: PartnerInterface) -> Iterator[tuple[FigureKey, ComparedFigure]]:
        if interface.flow != "topic" or is_ros_1(self.architecture.distro):
            return
        sides = ("QoS offered", interface.giver_endpoints), ("QoS asked", interface.taker_endpoints)
        for name, endpoints in sides:
            for endpoint in endpoints:
                yield FigureKey(name, self._common_node(endpoint)), endpoint.qos

    def _read_path(self, interface: PartnerInterface) -> Iterator[tuple[FigureKey, ComparedFigure]]:
        senders, receivers = (
            self._list_hosts(endpoints) for endpoints in (interface.giver_endpoints, interface.taker_endpoints)
        )
        if senders and receivers:
            links = {self.matched_ids.common_id("link", arc.link) for arc in self._list_arcs(interface) if arc.link}
            yield FigureKey("hosts"), TravelPath(senders, receivers, tuple(sorted(links)))

    def _list_hosts(self, endpoints: Iterable[Endpoint]) -> tuple[str, ...]:
        hosts = {self.architecture.nodes[endpoint.node].host for endpoint in endpoints}
        return tuple(sorted(self.matched_ids.common_id("host", host) for host in hosts if host))

    def _common_node(self, endpoint: Endpoint) -> str:
        return self.matched_ids.common_id("node", endpoint.node)

    def _activity_of(self, endpoint: Endpoint) -> str:
        return activity_builder.activity_of_endpoint(self._activity_names, endpoint)


def is_same_figure(name: str, before: ComparedFigure | None, after: ComparedFigure | None) -> bool:
    """Whether two figures of a name say the same; what is unknown for another reason is not the same."""
    if isinstance(before, Qos) and isinstance(after, Qos):
        return before == after or _plain_qos(before) == _plain_qos(after)
    if not isinstance(before, TimingValue) or not isinstance(after, TimingValue):
        return _is_unknown(before) and _is_unknown(after) if before is None or after is None else before == after
    share = _NEGLIGIBLE_AGE if name == _AGE_NAME else Fraction(0)
    return is_same_duration(before, after, share) if name in DELAY_NAMES else is_close_value(before, after, share)


def concerns_nobody(change: FigureChange) -> bool:
    """Whether a figure changed so little that nobody has to look at it, or something only comes sooner."""
    before, after = change.before, change.after
    if not isinstance(before, TimingValue) or not isinstance(after, TimingValue):
        return False
    return is_close_value(before, after) or (change.key.name in DELAY_NAMES and is_smaller(before, after))


def is_smaller(before: TimingValue, after: TimingValue) -> bool:
    """Whether a bound is known in both versions, and smaller in the second one."""
    if before.value is None or after.value is None or not (before.complete and after.complete):
        return False
    return after.value < before.value


def is_close_value(before: TimingValue, after: TimingValue, negligible_share: Fraction = _NEGLIGIBLE_SHARE) -> bool:
    """Whether two values differ by no more than a share of the larger one, and by so little that nobody calls it a change."""
    if before.value is None or after.value is None:
        return name_unknown_reason(before) == name_unknown_reason(after)
    sides = [(value.complete, value.side) for value in (before, after)]
    # Nearly all are equal, and arithmetic of fractions is slow.
    return sides[0] == sides[1] and (
        before.value == after.value
        or abs(after.value - before.value)
        <= max(negligible_share, UNCHANGED_SHARE) * max(abs(before.value), abs(after.value))
    )


def is_same_duration(before: TimingValue, after: TimingValue, negligible_share: Fraction = Fraction(0)) -> bool:
    """Whether two durations (ns) are close, or differ by so little time that nobody calls it a change."""
    if before.value is not None and after.value is not None:
        is_short = abs(after.value - before.value) < _UNCHANGED_DURATION
        if is_short and (before.complete, before.side) == (after.complete, after.side):
            return True
    return is_close_value(before, after, negligible_share)


def _is_unknown(figure: ComparedFigure | None) -> bool:
    return figure is None or (isinstance(figure, TimingValue) and figure.value is None)


def _plain_qos(qos: Qos) -> Qos:
    """Return a QoS as it works: that somebody wrote it, and where, makes no difference."""
    return replace(qos, profile="", written=False, at=NO_SPAN)
