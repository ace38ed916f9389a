"""Hosts and links that are asked for more than they have; promises and freshness that were kept, and are broken now."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterable, Iterator
from fractions import Fraction

from archgen.compare.agreements import hash_fallen_limit
from archgen.compare.asked_limits import (
    AskedLimits,
    LimitKey,
    describe_growth,
    describe_limit,
    judge_limits,
    list_reliers,
    read_limits,
)
from archgen.compare.comparison import LimitChange
from archgen.compare.losses.change_context import ChangeContext, PartnerLoss
from archgen.compare.losses.separated_causes import CauseSeparator, SeparatedCauses
from archgen.compare.losses.timing_causes import TimingCauses
from archgen.compare.matched_ids import MatchedIds
from archgen.compare.timing_pair import is_overloaded
from archgen.frozen import replace
from archgen.model.architecture import Architecture
from archgen.timing.analysis import Analysis
from archgen.timing.figures.figure_wording import format_share
from archgen.timing.figures.timing_values import ZERO_VALUE, TimingValue
from archgen.timing.system.core_placement import ProcessingResource, find_resources


def find_overloaded_cores(context: ChangeContext, causes: TimingCauses) -> Iterator[PartnerLoss]:
    """Find cores that are overloaded now and were not before, and whose activities run there in both versions."""
    before, after = causes.timing_pair.before, causes.timing_pair.after
    if not any(map(is_overloaded, after.hosts.values())):
        return
    overloaded_before = {
        core_key: load >= resource.cores for core_key, resource, load in _shared_cores(before, context.matched_ids)
    }
    old_hosts = {
        core_name: core_key[0]
        for core_key, resource, _ in _shared_cores(before, context.matched_ids)
        for core_name in resource.members
    }
    for core_key, resource, load in _shared_cores(after, MatchedIds()):
        host = core_key[0]
        if load < resource.cores or overloaded_before.get(core_key):
            continue
        staying_activities = [
            core_name for core_name in resource.members if old_hosts.get(causes.old_activity(core_name) or "") == host
        ]
        heavier_ids = causes.heavier_activities(resource.members)
        indices = dict.fromkeys(
            [*context.change_indices("host", host, "cores"), *causes.find_causes(heavier_ids)]
            or causes.all_worsening_changes()
        )
        core_phrase = "its core" if resource.cores == 1 else f"its {resource.cores} cores"
        core_name = f"`{resource.id}`" if core_key[1] else f"the host `{host}`"
        reason_text = f"overloads {core_name} ({format_share(load / resource.cores)} of {core_phrase}), where {{}}"
        yield from context.shared_losses(indices, causes.activities_by_owner(staying_activities), reason_text, "runs")


def _shared_cores(
    analysis: Analysis, matched_ids: MatchedIds
) -> Iterator[tuple[tuple[str, str], ProcessingResource, Fraction]]:
    """Yield the cores that some activities share, by host and rest of their id, with their load in cores."""
    for resource in find_resources(analysis.system):
        # Threads of a container, each with a core that nobody named; cores that nobody wrote the number of.
        if resource.host is None or resource.missing:
            continue
        activity_loads = dict(analysis.hosts[resource.host].activity_shares)
        load = sum((activity_loads[name].value or Fraction(0) for name in resource.members), Fraction(0))
        yield (matched_ids.common_id("host", resource.host), resource.id.removeprefix(resource.host)), resource, load


def find_saturated_links(context: ChangeContext, causes: TimingCauses) -> Iterator[PartnerLoss]:
    """Find links that are saturated now and were not before, and who sent or received something over them."""
    for link_id, load in causes.timing_pair.after.links.items():
        old_load = causes.timing_pair.before.links.get(
            context.matched_ids.old_ids.get("link", {}).get(link_id, link_id)
        )
        if old_load is None or is_overloaded(old_load) or not is_overloaded(load):
            continue
        old_parts = dict(old_load.topic_traffic)
        grown_topics = [
            topic
            for topic, topic_load in load.topic_traffic
            if topic not in old_parts or _has_grown(old_parts[topic], topic_load)
        ]
        crossing_arcs = [
            arc for arc in causes.timing_pair.after.system.arcs if arc.link == link_id and arc.role == "data"
        ]
        # How much is sent is up to the sender; whether it takes this link, also to the reader.
        arc_ends = [
            arc_end
            for arc in crossing_arcs
            if arc.topic in grown_topics
            for arc_end in ((arc.source,) if arc.topic in old_parts else (arc.source, arc.target))
        ]
        indices = dict.fromkeys(
            [*find_link_causes(context, link_id, grown_topics, causes)]
            or causes.find_causes(arc_ends)
            or causes.all_worsening_changes()
        )
        users = {arc_end for arc in crossing_arcs if arc.topic in old_parts for arc_end in (arc.source, arc.target)}
        used_share = format_share(load.share.value) if load.share.value is not None else ""
        reason_text = f"asks the link `{link_id}` for {used_share} of its bandwidth; {{}} it"
        yield from context.shared_losses(indices, causes.activities_by_owner(users), reason_text, "uses")


def _has_grown(old_value: TimingValue, new_value: TimingValue) -> bool:
    return new_value.value is not None and (old_value.value is None or new_value.value > old_value.value)


def find_link_causes(
    context: ChangeContext, link_id: str, topics: Iterable[str], causes: TimingCauses
) -> Iterator[int]:
    """Yield the indices of changes of a link, and of the types and messages that are sent over it."""
    element_keys = [("link", link_id)]
    for sent_topic in filter(None, map(context.after.topics.get, topics)):
        element_keys += [("type", element_id) for element_id in sent_topic.types]
        element_keys += [("message", element_id) for element_id in sent_topic.messages]
    yield from causes.list_worsening(element_keys)


def find_fallen_limits(
    context: ChangeContext, limits: Iterable[LimitChange], causes: TimingCauses, separator: CauseSeparator
) -> Iterator[PartnerLoss]:
    """Find whom it breaks that a promise, or the freshness that he asks for, is not kept any more.

    Figures that are unknown since something new has none yet break nobody: that is how people begin.
    """
    fallen = [limit for limit in limits if limit.has_fallen]
    if not fallen:
        return
    asked_before = read_limits(context.before, context.matched_ids)
    readers_by_port: dict[str, set[str]] = defaultdict(set)
    for port, reader in list_reliers(context.before, context.matched_ids):
        readers_by_port[port].add(reader)
    losers: dict[tuple[LimitChange, str, SeparatedCauses], dict[str, list[str]]] = {}
    for limit in fallen:
        readers = {limit.port} if limit.key == "freshness" else readers_by_port[limit.port]
        owned_readers = context.group_readers({limit.reader} & readers if limit.reader else readers)
        found = _find_causes(context, limit, asked_before, causes, separator) if owned_readers else None
        if found and (limit.new_state == "broken" or not separator.lacks_new_figures_only(found, limit.after)):
            # Of one promise that is kept for none of its readers, one sentence.
            told = replace(limit, reader="", before=ZERO_VALUE, after=ZERO_VALUE)
            parts = losers.setdefault((told, describe_growth(limit), found), {})
            for partner, names in owned_readers.items():
                parts[partner] = [*parts.get(partner, ()), *names]
    for (limit, growth, found), owned_readers in losers.items():
        verb, ending = ("asks", " for it") if limit.key == "freshness" else ("reads", " it")
        lead, rest = ("breaks", "") if limit.new_state == "broken" else ("leaves", " no longer shown to be kept")
        reason = f"{lead} {describe_limit(limit)}{rest} ({growth}){found.note}; {{}}{ending}"
        changes = [context.changes[index] for index in found.indices]
        found_hash = hash_fallen_limit(limit.port, limit.key, str(limit.limit), changes, context.versions)
        for loss in context.shared_losses(found.indices, owned_readers, reason, verb):
            yield replace(loss, fallen=(limit.port, limit.key), hash=found_hash)


def _find_causes(
    context: ChangeContext,
    limit: LimitChange,
    asked_before: AskedLimits,
    causes: TimingCauses,
    separator: CauseSeparator,
) -> SeparatedCauses:
    key = LimitKey(limit.port, limit.key, limit.reader)
    own_indices = _find_asking_changes(context, limit) if limit.is_asked_anew else []

    def falls(architecture: Architecture, analysis: Analysis, without: frozenset[int]) -> bool:
        is_asked_as_before = own_indices and without.issuperset(own_indices)
        asked = asked_before[key[:2]] if is_asked_as_before else limit.limit
        judged = judge_limits(architecture, analysis, MatchedIds(), {key[:2]: asked}).get(key)
        return judged is None or judged.state != "kept"

    return separator.separate(list(_list_activities(causes, limit)), own_indices, falls)


def _find_asking_changes(context: ChangeContext, limit: LimitChange) -> list[int]:
    """Return the indices of the changes of what is promised, or asked for."""
    if limit.key == "freshness":
        return context.change_indices("input", limit.port, "freshness")
    shell, _, name = limit.port.rpartition(".")
    if limit.key == "qos.deadline":
        nodes = context.after.nodes_implementing(shell)
        return [index for node in nodes for index in context.port_change_indices(node.id, limit.port, "qos")]
    if limit.key == "timing.max_gap":
        return context.change_indices("component", shell, f"timing.outputs.{name}.max_gap")
    return [
        *context.change_indices("output", limit.port, f"promise.{limit.key}"),
        *context.change_indices("composed", shell, f"outputs.{name}:promise.{limit.key}"),
    ]


def _list_activities(causes: TimingCauses, limit: LimitChange) -> Iterator[str]:
    """Yield the activities of the second version at which a limit is kept: who sends, and of an age also who reads."""
    system, reader = causes.timing_pair.after.system, limit.port if limit.key == "freshness" else limit.reader
    leaves = () if limit.key == "freshness" else causes.context.after.leaf_ports_of("output", limit.port)
    for activity in system.activities.values():
        if reader in activity.inputs or not {*leaves}.isdisjoint(activity.outputs):
            yield activity.id
            yield from (arc.source for arc in system.arcs_into.get(activity.id, ()) if arc.input == reader)
