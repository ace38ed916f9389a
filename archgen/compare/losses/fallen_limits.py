"""Promises and freshness that were kept, and are broken now or no longer shown to be kept."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterable, Iterator

from archgen.compare.asked_limits import AskedLimits, LimitKey, judge_limits, list_reliers, read_limits
from archgen.compare.change_hashes import hash_fallen_limit
from archgen.compare.figure_changes import LimitChange
from archgen.compare.limit_wording import describe_growth, describe_limit
from archgen.compare.losses.change_context import ChangeContext, PartnerLoss
from archgen.compare.losses.separated_causes import CauseSeparator, SeparatedCauses
from archgen.compare.losses.timing_causes import TimingCauses
from archgen.compare.matched_ids import MatchedIds
from archgen.frozen import replace
from archgen.model.architecture import Architecture
from archgen.timing.analysis import Analysis
from archgen.timing.figures.timing_values import ZERO_VALUE


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
        owned_readers = _own_readers(context, {limit.reader} & readers if limit.reader else readers)
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
        causes_found = [context.changes[index] for index in found.indices]
        found_hash = hash_fallen_limit(limit.port, limit.key, describe_limit(limit), causes_found, context.versions)
        reason = f"{lead} {describe_limit(limit)}{rest} ({growth}){found.note}; {{}}{ending}"
        for loss in context.shared_losses(found.indices, owned_readers, reason, verb):
            yield replace(loss, fallen=(limit.port, limit.key), hash=found_hash)


def _own_readers(context: ChangeContext, readers: Iterable[str]) -> dict[str, list[str]]:
    """Return those of some inputs that needed what they read, by partner."""
    owned: dict[str, list[str]] = defaultdict(list)
    for reader in sorted(filter(context.needs_source, readers)):
        partner = context.owner_before("input", reader)
        if partner:
            owned[partner].append(reader)
    return owned


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
