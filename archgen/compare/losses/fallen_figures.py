"""Hosts and links that are asked for more than they have; promises, freshness and deadlines that were kept, and are broken
now.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterable, Iterator, Mapping, Sequence
from fractions import Fraction
from itertools import pairwise

from archgen.compare.agreements import hash_fallen_limit
from archgen.compare.asked_limits import (
    AskedLimits,
    LimitKey,
    describe_growth,
    describe_limit,
    is_overloaded,
    judge_limits,
    list_reliers,
    read_limits,
)
from archgen.compare.comparison import ChainChange, LimitChange
from archgen.compare.losses.change_context import ChangeContext, PartnerLoss, tick_sorted_names
from archgen.compare.losses.separated_causes import CauseSeparator, SeparatedCauses
from archgen.compare.losses.timing_causes import TimingCauses
from archgen.compare.matched_ids import MatchedIds
from archgen.frozen import replace
from archgen.model.architecture import Architecture
from archgen.timing.analysis import Analysis, ChainResult, ChainTerm
from archgen.timing.chains.chain_bounds import bound_chain
from archgen.timing.chains.chain_verdicts import judge_chain
from archgen.timing.figures.figure_wording import format_compared, format_compared_bounds, format_duration, format_share
from archgen.timing.figures.timing_values import ZERO_VALUE, TimingValue
from archgen.timing.system.core_placement import ProcessingResource, find_resources
from archgen.timing.system.timing_system import TimingSystem


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
            [*_find_link_causes(context, link_id, grown_topics, causes)]
            or causes.find_causes(arc_ends)
            or causes.all_worsening_changes()
        )
        users = {arc_end for arc in crossing_arcs if arc.topic in old_parts for arc_end in (arc.source, arc.target)}
        used_share = format_share(load.share.value) if load.share.value is not None else ""
        reason_text = f"asks the link `{link_id}` for {used_share} of its bandwidth; {{}} it"
        yield from context.shared_losses(indices, causes.activities_by_owner(users), reason_text, "uses")


def _has_grown(old_value: TimingValue, new_value: TimingValue) -> bool:
    return new_value.value is not None and (old_value.value is None or new_value.value > old_value.value)


def _find_link_causes(
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


def find_chains_made_late(
    context: ChangeContext, chains: Sequence[ChainChange], causes: TimingCauses, separator: CauseSeparator
) -> Iterator[PartnerLoss]:
    """Find chains that met their deadline and need not do so any more.

    The deadline of the first version counts, and that of the second one where it is stricter. A chain that is open since
    something new has no figures yet breaks nobody.
    """
    for chain_change in chains:
        old_result, new_result = chain_change.before, chain_change.after
        if old_result is None or new_result is None or not (reason_text := _lateness_reason(old_result, new_result)):
            continue
        lost_step = _find_lost_step(causes, old_result, new_result)
        # A bound without terms means that the chain is cut: there is no sum to compare, only what took its steps away.
        if lost_step:
            # Whoever is only on the way round had no part in the chain.
            indices = causes.find_cuts(lost_step[1:])[0]
            activities_of_owners = causes.old_activities_by_owner(old_result.through)
            reason_text = (
                f"cuts the chain `{new_result.id}`: `{lost_step[0]}` no longer reaches `{lost_step[1]}` directly"
            )
        elif new_result.terms:
            found = _separate_causes(context, old_result, new_result, causes, separator)
            if new_result.verdict == "open" and separator.lacks_new_figures_only(found, new_result.bound):
                continue
            indices, reason_text = list(found.indices), reason_text + found.note
            activities_of_owners = causes.activities_by_owner(term.activity for term in new_result.terms)
        else:
            indices, cut_off_activities = causes.find_cuts([term.activity for term in old_result.terms])
            activities_of_owners = causes.old_activities_by_owner(cut_off_activities)
            if _binding_deadline(old_result, new_result) is not old_result.deadline:
                indices += context.change_indices("chain", chain_change.id, "deadline")
        indices = (
            indices or context.change_indices("chain", chain_change.id, "through") or causes.all_worsening_changes()
        )
        reason_text += "; {} on it"
        yield from context.shared_losses(dict.fromkeys(indices), activities_of_owners, reason_text, "is")


def _separate_causes(
    context: ChangeContext,
    old_result: ChainResult,
    new_result: ChainResult,
    causes: TimingCauses,
    separator: CauseSeparator,
) -> SeparatedCauses:
    """Return the changes that made a chain late: of figures, of its path and of what it is held against."""
    binding = _binding_deadline(old_result, new_result)
    asking = () if binding is old_result.deadline else context.change_indices("chain", new_result.id, "deadline")
    leading = context.change_indices("chain", new_result.id, "through")

    def falls(architecture: Architecture, analysis: Analysis, without: frozenset[int]) -> bool:
        asked_chain = architecture.chains[new_result.id]
        result = bound_chain(analysis, architecture, asked_chain)
        limit = old_result.deadline if asking and without.issuperset(asking) else binding
        verdict = judge_chain(result, limit) if result.terms else "open"
        return verdict != "met" and (verdict == "missed" or old_result.verdict == "met")

    grown = _grown_activities(causes, old_result.terms, new_result.terms)
    return separator.separate(grown, (*asking, *leading, *_link_causes(context, grown, causes)), falls)


def _find_lost_step(causes: TimingCauses, old_result: ChainResult, new_result: ChainResult) -> tuple[str, str] | None:
    """Return two activities of the first version that followed each other on a chain, and are joined by a way round alone
    now that was there before: nobody meant the chain to take it. Something new between the two is meant.
    """
    systems = causes.timing_pair.before.system, causes.timing_pair.after.system
    path = [causes.old_activity(activity_id) or "" for activity_id in new_result.through] if new_result.terms else []
    for step in pairwise(old_result.through if old_result.terms else ()):
        if not set(step) <= set(path):
            continue
        first, last = (path.index(activity_id) for activity_id in step)
        way_round = list(pairwise(path[first : last + 1]))
        if len(way_round) > 1 and all(_are_joined(systems[0], *pair) for pair in way_round):
            ends = new_result.through[first], new_result.through[last]
            if not _are_joined(systems[1], *ends):
                return step
    return None


def _are_joined(system: TimingSystem, source: str, target: str) -> bool:
    return any(arc.target == target for arc in system.arcs_from.get(source, ()))


def _binding_deadline(old_result: ChainResult, new_result: ChainResult) -> TimingValue | None:
    """Return the deadline that a change is held against: the old one, or the new one where it is stricter."""
    old_deadline, new_deadline = old_result.deadline, new_result.deadline
    if old_deadline is None or old_deadline.value is None:
        return new_deadline
    is_stricter = (
        new_deadline is not None and new_deadline.value is not None and new_deadline.value < old_deadline.value
    )
    return new_deadline if is_stricter else old_deadline


def _lateness_reason(old_result: ChainResult, new_result: ChainResult) -> str:
    """Describe how much worse a chain is; empty if it is no worse than before."""
    deadline = _binding_deadline(old_result, new_result)
    new_verdict, chain_name = new_result.verdict, f"the chain `{new_result.id}`"
    limit = f"its deadline of {_format_bound(deadline)}"
    if new_result.deadline != deadline:
        # A chain without steps is cut, which is told in words of its own.
        new_verdict = judge_chain(new_result, deadline) if new_result.terms else "open"
        limit = f"the deadline of {_format_bound(deadline)} that it had before"
    limit_value, bound_value = deadline.value if deadline else None, new_result.bound.value
    is_above = limit_value is not None and bound_value is not None and bound_value > limit_value
    # What is no longer proven is as much of a loss as what is missed: nobody can rely on it any more.
    # A run may show by chance only now what nobody could rely on before.
    is_lost = old_result.verdict == "met" or (old_result.verdict == "not proven" and not new_result.late_run)
    if new_verdict == "missed" and is_lost:
        return f"makes {chain_name} miss {limit} ({_format_growth(old_result, new_result)})"
    if old_result.verdict == "met" and new_verdict == "not proven" and is_above:
        growth = _format_growth(old_result, new_result)
        return f"takes away the proof that {chain_name} meets {limit} ({growth})"
    if old_result.verdict == "met" and new_verdict in {"open", "not proven"}:
        (met_text,) = format_compared([old_result.bound.value or Fraction(0)], format_duration, limit=limit_value)
        met_phrase = f"{chain_name}, which met {limit} with {met_text}"
        return f"leaves {met_phrase}, without a bound" if new_result.terms else f"cuts {met_phrase}"
    return ""


def _format_growth(old_result: ChainResult, new_result: ChainResult) -> str:
    bounds = old_result.bound, new_result.bound
    limit = _binding_deadline(old_result, new_result)
    texts = format_compared_bounds(bounds, limit.value if limit else None)
    old_text, new_text = (
        "no bound" if bound.value is None else text for bound, text in zip(bounds, texts, strict=True)
    )
    return f"it takes {new_text}" if bounds[0] == bounds[1] else f"{old_text} → {new_text}"


def _format_bound(value: TimingValue | None) -> str:
    if value is None or value.value is None:
        return "no bound"
    return ("" if value.complete else "at least ") + format_duration(value.value)


def _grown_activities(
    causes: TimingCauses, old_terms: Iterable[ChainTerm], new_terms: Iterable[ChainTerm]
) -> list[str]:
    terms_by_activity = {term.activity: term for term in old_terms}
    activity_ids = []
    for term in new_terms:
        old_term = terms_by_activity.get(causes.old_activity(term.activity) or "")
        # The three summands of a `ChainResult` term.
        pairs = ((getattr(old_term, key), getattr(term, key)) for key in ("sampling", "response", "link"))
        if old_term is None or any(_bound_has_grown(old_value, new_value) for old_value, new_value in pairs):
            activity_ids.append(term.activity)
    return activity_ids


def _bound_has_grown(old_value: TimingValue, new_value: TimingValue) -> bool:
    if old_value.value is None or new_value.value is None:
        return old_value.value is not new_value.value
    return new_value.value > old_value.value or (old_value.complete and not new_value.complete)


def _link_causes(context: ChangeContext, activity_ids: Iterable[str], causes: TimingCauses) -> list[int]:
    """Return the indices of changes of links, and of what is sent, in front of the activities whose terms grew."""
    indices = dict[int, None]()
    for activity_id in activity_ids:
        for arc in causes.timing_pair.after.system.arcs_into.get(activity_id, ()):
            if arc.link is not None:
                indices.update(dict.fromkeys(_find_link_causes(context, arc.link, [arc.topic], causes)))
    return list(indices)


def find_weakened_deadlines(
    context: ChangeContext, chains: Sequence[ChainChange], causes: TimingCauses
) -> Iterator[PartnerLoss]:
    """Find chains that promise less than before to several partners with a part on them.

    Otherwise relaxing the deadline, in the change that would miss it, would be enough to miss it.
    """
    for chain_change in chains:
        old_result = chain_change.before
        if old_result is None or old_result.find_limit(Fraction(0)) is None:
            continue
        parts = _parts_by_owner(context, causes, old_result)
        for indices, reason_text in _find_weakenings(context, causes, chain_change, old_result):
            if len(parts) > 1 or "" in parts:
                owned_parts = {owner: names for owner, names in parts.items() if owner}
                yield from context.shared_losses(indices, owned_parts, reason_text + "; {} on it", "is")


def _find_weakenings(
    context: ChangeContext, causes: TimingCauses, chain_change: ChainChange, old_result: ChainResult
) -> Iterator[tuple[list[int], str]]:
    """Yield what a change of a chain takes from its promise, with the indices of the changes that do so."""
    chain_id, new_result = chain_change.id, chain_change.after
    asked = [(each.share, f" for {each.name} of its reactions") for each in old_result.shares]
    if old_result.deadline is not None and old_result.deadline.value is not None:
        asked = [(Fraction(1), ""), *asked]
    if new_result is None:
        common_id = context.matched_ids.common_id("chain", chain_id)
        removal_indices = context.indices_by_change_kind("chain", common_id, "removed")
        limit_text = format_duration(old_result.find_limit(asked[0][0]) or 0)
        yield removal_indices, f"takes away the chain `{chain_id}` with its deadline of {limit_text}{asked[0][1]}"
        return
    keys = ("deadline", *(f"deadline.{each.name}" for each in (*old_result.shares, *new_result.shares)))
    deadline_indices = context.change_indices("chain", chain_id, *dict.fromkeys(keys))
    for share, share_text in asked:
        old_limit, new_limit = old_result.find_limit(share) or Fraction(0), new_result.find_limit(share)
        if new_limit is None:
            yield (
                deadline_indices,
                f"takes the deadline of {format_duration(old_limit)}{share_text} from the chain `{chain_id}`",
            )
        elif new_limit > old_limit:
            limits_text = f"from {format_duration(old_limit)} to {format_duration(new_limit)}"
            yield deadline_indices, f"relaxes the deadline of the chain `{chain_id}`{share_text} {limits_text}"
    passed_names = _find_passed_parts(causes, chain_change) if new_result.terms else []
    if passed_names:
        through_indices = context.change_indices("chain", chain_id, "through")
        yield (
            through_indices,
            f"leads the chain `{chain_id}` with its deadline past {tick_sorted_names(passed_names)}",
        )


def _find_passed_parts(causes: TimingCauses, chain_change: ChainChange) -> list[str]:
    """Return the parts that a chain was asked to lead through and no longer does, of those that are still there."""
    if chain_change.before is None or chain_change.after is None:
        return []
    old_system, new_system = causes.timing_pair.before.system, causes.timing_pair.after.system
    new_parts = {
        _part_name(causes.activity_key(new_system.activities[term.activity])) for term in chain_change.after.terms
    }
    present_parts = {_part_name(causes.activity_key(activity)) for activity in new_system.activities.values()}
    passed_names = []
    for term in chain_change.before.terms:
        activity = old_system.activities[term.activity]
        part = _part_name(causes.old_activity_key(activity))
        is_waypoint = any(
            point in {activity.component, activity.node} or point.rpartition(".")[0] == activity.component
            for point in chain_change.before.through
        )
        if is_waypoint and part in present_parts - new_parts:
            passed_names.append(term.activity)
    return passed_names


def _part_name(activity_key: tuple[str, str]) -> str:
    """Return an activity's component, whatever node runs it, or its node if it has no component."""
    component, node = activity_key
    return component or node


def _parts_by_owner(
    context: ChangeContext, causes: TimingCauses, old_result: ChainResult
) -> Mapping[str, Sequence[str]]:
    """Return what is on a chain of the first version by owner, "" for what nobody owns."""
    activity_ids = {term.activity for term in old_result.terms}
    parts: dict[str, list[str]] = causes.old_activities_by_owner(activity_ids)
    if not activity_ids:
        # A chain without a path has no activities: what it names is on it.
        for point in old_result.through:
            parts.setdefault(_owner_of_point(context, point), []).append(point)
    elif sum(map(len, parts.values())) < len(activity_ids):
        parts[""] = []
    return parts


def _owner_of_point(context: ChangeContext, point: str) -> str:
    owners = (
        context.owner_before(kind, context.matched_ids.common_id(kind, point))
        for kind in ("component", "output", "node")
    )
    return next(filter(None, owners), "")
