"""Ends that met and meet no more: less is offered than was asked for, or one of them sends another message, is in another
domain, goes by another clock, or no longer runs; or a name is used that no longer exists.

What counts is what is on the wire, after all that launches, parameters and hosts say, and whatever says it is the cause. If
the reader alone asks for more or turns away, its own partner cuts it off: nobody else loses anything.
"""

from __future__ import annotations

import re
from collections import defaultdict
from collections.abc import Container, Iterable, Iterator, Mapping, Sequence

from archgen.analyses.qos_compatibility import QosConflict, find_qos_conflicts
from archgen.compare.comparison import Change
from archgen.compare.kinds import Effect, find_effect
from archgen.compare.losses.change_context import WRITING_USES, ChangeContext, PartnerLoss, tick_name, tick_sorted_names
from archgen.compare.losses.lost_connections import find_component_renames
from archgen.compare.version_pair import ElementKey
from archgen.derivation.wire.running_state import domain_of
from archgen.diagnostics import join_words
from archgen.frozen import NamedTuple
from archgen.model.architecture import Architecture
from archgen.model.node import Clock, Endpoint, FlowKind
from archgen.model.ros_distro import is_ros_1

TopicKey = tuple[str, FlowKind]


def find_renamed_topics(context: ChangeContext) -> Iterator[PartnerLoss]:
    """Find names that disappeared while other partners' nodes use them: their programs do not follow the files."""
    old_endpoints, new_endpoints = context.offered_endpoints
    topics_by_port: dict[str, set[TopicKey]] = defaultdict(set)
    lasting_topics_by_port: dict[str, set[TopicKey]] = defaultdict(set)
    for (node, port), ends in new_endpoints.items():
        topics = list_known_names(ends)
        topics_by_port[port] |= topics
        new_node = context.after.nodes.get(node)
        if new_node is None or new_node.status != "planned" or ("node", node) in context.versions.elements_before:
            lasting_topics_by_port[port] |= topics
    readers = list_topic_readers(context)
    for node, port in sorted(old_endpoints):
        if port and ("output", port) not in context.versions.elements_after:
            continue  # the connection itself is gone
        old_topics = list_known_names(old_endpoints[node, port])
        # A new node that is only planned keeps no topic alive which the program that had it gives another name.
        new_topics = (lasting_topics_by_port if (node, port) in new_endpoints else topics_by_port)[port]
        indices = _find_causes(context, node, port) if old_topics - new_topics else []
        for name, flow in sorted(old_topics - new_topics):
            own_topics = list_known_names(new_endpoints.get((node, port), ()))
            replacements = sorted(
                new_name for new_name, new_flow in (new_topics if port else own_topics) - old_topics if new_flow == flow
            )
            users = [
                endpoint
                for endpoint in readers.get((name, flow), ())
                if (not port or not endpoint.sources or _reads_output(context, endpoint, port))
                and not _follows_by_launch(context, endpoint, new_topics)
            ]
            new_name_note = (
                f"it is {tick_sorted_names(replacements)} now"
                if replacements
                else "nobody offers it under that name any more"
            )
            yield from context.losses_of_readers(
                indices, group_users(context, users), f"takes the {flow} {tick_name(name)} from", f"; {new_name_note}"
            )


def list_known_names(endpoints: Iterable[Endpoint]) -> set[TopicKey]:
    """Return what endpoints use, as far as its name is known."""
    return {(endpoint.name, endpoint.flow) for endpoint in endpoints if endpoint.name is not None}


def list_topic_readers(context: ChangeContext) -> Mapping[TopicKey, list[Endpoint]]:
    """Return the readers of each name in the first version that can be broken: those of real nodes."""
    readers: dict[TopicKey, list[Endpoint]] = defaultdict(list)
    for endpoint in context.before.endpoints:
        node = context.before.nodes[endpoint.node]
        if endpoint.use in {"publishes", "serves"} or node.status == "planned":
            continue
        if node.written and (
            endpoint.port is None or context.needs_source(context.matched_ids.common_id("input", endpoint.port))
        ):
            for key in list_known_names([endpoint]):
                readers[key].append(endpoint)
    return readers


def _follows_by_launch(context: ChangeContext, endpoint: Endpoint, topics: Container[TopicKey]) -> bool:
    """Whether a reader's program is as it was, and what starts it gives it the new name, too."""
    return any(
        each.program_name is not None
        and each.program_name == endpoint.program_name
        and each.name != each.program_name
        and (each.name, each.flow) in topics
        for each in context.find_new_ends(endpoint)
    )


def _reads_output(context: ChangeContext, endpoint: Endpoint, output_id: str) -> bool:
    return output_id in {context.matched_ids.common_id("output", source) for source in endpoint.sources}


def group_users(context: ChangeContext, users: Iterable[Endpoint]) -> Mapping[str, set[str]]:
    """Return the nodes of endpoints by the partner who owns them."""
    nodes_by_partner: dict[str, set[str]] = defaultdict(set)
    for endpoint in users:
        node = context.before.nodes[endpoint.node]
        if node.owner:
            nodes_by_partner[context.matched_ids.common_id("partner", node.owner)].add(
                context.matched_ids.common_id("node", endpoint.node)
            )
    return dict(sorted(nodes_by_partner.items()))


def _find_causes(context: ChangeContext, node_id: str, port_id: str) -> list[int]:
    """Return the indices of the change that renamed a topic: at the port, the node, or the elements its name is made
    of.
    """
    component_id = port_id.rpartition(".")[0]
    group_id = component_id.partition(".")[0]
    # From the most specific cause to the most general; the first that changed at all is blamed.
    candidate_indices = (
        context.port_change_indices(node_id, port_id, "topic"),
        context.change_indices("node", node_id, "name", "namespace"),
        context.indices_by_change_kind("node", node_id, "renamed", "removed"),
        context.indices_by_change_kind("output", port_id, "renamed"),
        find_component_renames(context, component_id),
        context.indices_by_change_kind("group", group_id, "renamed"),
        context.change_indices("node", node_id),
        context.change_indices("output", port_id, "medium"),
        context.change_indices("output", port_id),
    )
    return next((indices for indices in candidate_indices if indices), [])


_CLOCK_TOPIC = "/clock"
_CLOCK_WORDS: Mapping[Clock | None, str] = {"simulated": "simulated time", "system": "the time of the system"}


class _Parting(NamedTuple):
    """Why two ends meet no more: the changes that part them, and the reason around the topics; `{}` are the readers."""

    indices: tuple[int, ...]
    lead: str
    rest: str
    verb: str


class _FollowedEnd(NamedTuple):
    """An end of the first version, the ends that took its place in the second, and whether these are other than by name."""

    old: Endpoint
    new: Sequence[Endpoint]
    is_touched: bool


def find_parted_ends(context: ChangeContext) -> Iterator[PartnerLoss]:
    """Find ends that met before the change and do not meet now, or of which nobody knows that any more.

    What a reader asks for now does not matter: otherwise a branch could lower both sides at once.
    """
    nodes: dict[tuple[_Parting, str], dict[str, set[str]]] = defaultdict(lambda: defaultdict(set))
    for topic, parting, reader in _Partings(context).list_partings():
        owner = context.before.nodes[reader.node].owner
        if owner:
            partner = context.matched_ids.common_id("partner", owner)
            nodes[parting, topic][partner].add(context.matched_ids.common_id("node", reader.node))
    topics: dict[tuple[_Parting, tuple[tuple[str, tuple[str, ...]], ...]], list[str]] = defaultdict(list)
    for (parting, topic), parts in nodes.items():
        topics[parting, tuple((partner, tuple(sorted(names))) for partner, names in parts.items())].append(topic)
    for (parting, parts_of_partners), names in topics.items():
        reason_text = f"{parting.lead}{tick_sorted_names(names)}{parting.rest}"
        yield from context.shared_losses(parting.indices, dict(parts_of_partners), reason_text, parting.verb, "wire")


class _Partings:
    """Compares the ends of two versions, pair by pair."""

    def __init__(self, context: ChangeContext) -> None:
        self._context = context
        self._has_qos = not is_ros_1(context.before.distro)
        self._has_clock = any(
            end.name == _CLOCK_TOPIC and end.use in WRITING_USES and end.runs == "active"
            for end in context.after.endpoints
        )

    def list_partings(self) -> Iterator[tuple[str, _Parting, Endpoint]]:
        """Yield topics, each with why two of its ends meet no more, and the reader."""
        for topic in self._context.before.topics.values():
            writers, readers = (self._follow(ends) for ends in (topic.writers, topic.readers))
            # Nearly all are as they were.
            touched_writers = [writer for writer in writers if writer.is_touched]
            for reader in readers if touched_writers or any(each.is_touched for each in readers) else ():
                if reader.old.port and not self._context.needs_source(self._context.common_port(reader.old)):
                    continue
                for writer in writers if reader.is_touched else touched_writers:
                    partings = [list(self._part(writer.old, new, reader)) for new in writer.new]
                    if partings and all(partings):
                        yield from ((writer.new[0].label, parting, reader.old) for parting in partings[0])

    def _follow(self, ends: Iterable[Endpoint]) -> list[_FollowedEnd]:
        followed = []
        for end in ends:
            if self._context.before.nodes[end.node].written:
                new_ends = self._context.find_new_ends(end)
                is_touched = any(_read_wire(end) != _read_wire(each) for each in new_ends)
                followed.append(_FollowedEnd(end, new_ends, is_touched))
        return followed

    def _part(self, old_writer: Endpoint, writer: Endpoint, reader: _FollowedEnd) -> Iterator[_Parting]:
        """Yield what parts a writer from the reader that it met."""
        new_reader = reader.new[0] if reader.new else reader.old
        if old_writer.flow == "topic" and self._has_qos and not _find_clashes(old_writer, reader.old):
            clashes = _find_clashes(writer, reader.old)
            if clashes:
                yield self._part_by_qos(clashes, old_writer, writer)
            else:
                # Of its own accord it turns away; a parameter of the project may make it do so.
                clashes = _find_clashes(writer, new_reader)
                yield from [self._part_by_qos(clashes, reader.old, new_reader)] if clashes else ()
        yield from self._part_by_message(old_writer, writer, reader.old)
        if old_writer.runs != "active" or reader.old.runs != "active":
            return
        old_domains, domains = (
            tuple(map(domain_of, ends)) for ends in ((old_writer, reader.old), (writer, new_reader))
        )
        if None in old_domains or old_domains[0] != old_domains[1]:
            return
        is_same_unknown = writer.evidence.get("domain") == new_reader.evidence.get("domain")
        if domains[0] != domains[1] or (None in domains and not is_same_unknown):
            causes = self._find_causes(["domain"], (old_writer, writer), (reader.old, new_reader))
            own_domain, other_domain = map(_name_domain, domains)
            yield _Parting(
                causes,
                "runs what is on ",
                f" in {own_domain}, where {{}} in {other_domain}: nothing arrives any more",
                "runs",
            )
        if writer.runs in {"inactive", "off"} or (writer.runs is None and writer.runs != old_writer.runs):
            rule = writer.evidence["runs"].rule if "runs" in writer.evidence else "unknown"
            yield _Parting(
                self._find_causes(["runs"], (old_writer, writer)),
                f"no longer has {tick_name(writer.node)} run ({tick_name(rule)}), and with it ",
                "; {} it",
                "needs",
            )
        yield from self._part_by_clock(old_writer, writer, reader.old, new_reader)

    def _part_by_qos(self, clashes: Sequence[QosConflict], old: Endpoint, new: Endpoint) -> _Parting:
        offered, requested = (
            join_words(list(dict.fromkeys(words)))
            for words in ([each.offered for each in clashes], [each.requested for each in clashes])
        )
        policies = [key for key in {**old.evidence, **new.evidence} if key.startswith("qos.")]
        indices = tuple(self._context.port_change_indices(new.node, new.port or "", "qos"))
        causes = indices or self._find_causes(policies or ["qos"], (old, new))
        return _Parting(
            causes, f"offers {offered} on ", f", where {{}} for {requested}: nothing arrives any more", "asks"
        )

    def _part_by_clock(
        self, old_writer: Endpoint, writer: Endpoint, old_reader: Endpoint, reader: Endpoint
    ) -> Iterator[_Parting]:
        if old_writer.clock != old_reader.clock:
            return
        words = _CLOCK_WORDS.get(writer.clock, "a clock that nobody knows")
        if writer.clock != reader.clock:
            causes = self._find_causes(["clock"], (old_writer, writer), (old_reader, reader))
            other_words = _CLOCK_WORDS.get(reader.clock, "one that nobody knows")
            yield _Parting(causes, "runs what is on ", f" by {words}, where {{}} by {other_words}", "runs")
        elif writer.clock == "simulated" != old_writer.clock and not self._has_clock:
            lead = f"runs {tick_name(writer.node)} by {words}, which nobody gives, and with it "
            yield _Parting(self._find_causes(["clock"], (old_writer, writer)), lead, "; {} it", "needs")

    def _part_by_message(self, old_writer: Endpoint, writer: Endpoint, reader: Endpoint) -> Iterator[_Parting]:
        """Yield another message on a topic that belongs to no port, such as /tf; outputs are looked at as such."""
        before, after = old_writer.message, writer.message
        if not (before and after) or before == after or old_writer.port or reader.port:
            return
        # A message of another name is another message to programs: then its rename is the change.
        indices = self._context.port_change_indices(writer.node, "", "message") or [
            index
            for index, change in enumerate(self._context.changes)
            if change.element_kind == "message" and change.old_id == before
        ]
        lead = f"sends {tick_name(after)} instead of {tick_name(before)} on "
        yield _Parting(tuple(indices), lead, ", to which {}", "subscribes")

    def _find_causes(self, fields: Iterable[str], *ends: tuple[Endpoint, Endpoint]) -> tuple[int, ...]:
        """Return the changes that made fields of ends others: where the evidence names a key, those of that key; else
        those that name the node, or say something of it.
        """
        indices: list[int] = []
        for old, new in ends:
            for name in fields:
                evidence = new.evidence.get(name), old.evidence.get(name)
                if evidence[0] != evidence[1] or _read_wire(old) != _read_wire(new):
                    rule = next((each.rule for each in evidence if each), "")
                    indices += self._find_changes_of(new, rule, is_run=name == "runs")
        return tuple(dict.fromkeys(indices))

    def _find_changes_of(self, end: Endpoint, rule: str, *, is_run: bool) -> list[int]:
        holders = _list_holders(self._context.after, end)
        word = rule.removeprefix("-p ").partition("=")[0].partition(":")[0]

        def is_named(change: Change) -> bool:
            return bool(word) and word in f"{change.key} {change.before} {change.after}"

        named = [index for holder in holders for index in self._context.list_indices(*holder, is_named)]
        # A manager of life cycles that lists it no longer, or starts no more.
        told = self._find_mentions(self._context.after.nodes[end.node].name) if is_run and not named else []
        own = (self._context.list_indices(*holder, _is_more_than_text) for holder in holders)
        anything = (
            index for index, change in enumerate(self._context.changes) if change.key and _is_more_than_text(change)
        )
        # Where nothing leads to it, it is laid at all that may have done it, rather than at nothing.
        return named or told or next(filter(None, own), []) or list(anything)

    def _find_mentions(self, name: str) -> list[int]:
        """Return the changes of nodes that name another one in what is said of them."""
        versions = self._context.versions
        word = re.compile(rf"(?<!\w){re.escape(name)}(?!\w)")
        return [
            index
            for index, change in enumerate(self._context.changes)
            if change.element_kind == "node"
            for key in [("node", self._context.common_id(change))]
            if any(word.search(str(dict(side[key].values))) for side in versions.elements if key in side)
            and change.element_id != name
        ]


def _is_more_than_text(change: Change) -> bool:
    return not change.key or find_effect(change.element_kind, change.key) is not Effect.TEXT


def _list_holders(architecture: Architecture, end: Endpoint) -> list[ElementKey]:
    """Return what may say how an end runs: its node, what contains it, its host, its components, and the project."""
    node = architecture.nodes[end.node]
    container = architecture.containers.get(node.container or "")
    host = node.host or (container.host if container else None)
    return [
        ("node", node.id),
        ("container", node.container or ""),
        ("host", host or ""),
        *(("component", name) for name in node.implements),
        ("project", architecture.project.id),
    ]


def _read_wire(end: Endpoint) -> tuple[object, ...]:
    return end.qos, end.qos_if_ignored, end.message, end.domain, end.clock, end.runs, end.evidence.get("domain")


def _find_clashes(writer: Endpoint, reader: Endpoint) -> tuple[QosConflict, ...]:
    """Return the clashes between what is offered and asked for; where two are possible, with either."""
    offers, requests = ((end.qos, end.qos_if_ignored) if end.qos_if_ignored else (end.qos,) for end in (writer, reader))
    clashes = (clash for offer in offers for asked in requests for clash in find_qos_conflicts(offer, asked))
    return tuple(dict.fromkeys(clashes))


def _name_domain(domain: int | None) -> str:
    if domain is None:
        return "a domain that nobody knows"
    return f"the domain {domain}" if domain else "the usual domain"
