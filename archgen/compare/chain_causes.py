"""Why a chain takes longer or shorter than before: the changes behind the parts of its bound that differ."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import replace

from archgen.compare.comparison import ChainChange, Change
from archgen.compare.kinds import Worsening, find_key
from archgen.compare.losses.change_context import ChangeContext
from archgen.compare.losses.timing_causes import TimingCauses
from archgen.compare.timing_pair import TimingPair, can_affect_timing
from archgen.timing.analysis import ChainResult
from archgen.timing.figures.timing_values import UNKNOWN_VALUE


class _ImprovementCauses(TimingCauses):
    """The causes of a figure that is better: those that cannot have made it worse."""

    def can_worsen(self, change: Change) -> bool:
        has_direction = change.key is not None and find_key(change.element_kind, change.key).worsening in {
            Worsening.LESS,
            Worsening.MORE,
        }
        return can_affect_timing(change) and not (has_direction and super().can_worsen(change))

    def heavier_activities(self, activity_ids: Iterable[str]) -> list[str]:
        own_ids = list(activity_ids)
        heavier_ids = super().heavier_activities(own_ids)
        shares = (self.timing_pair.before, self.timing_pair.after)
        lighter_ids = [
            name
            for name in own_ids
            if (old_name := self.old_activity(name)) is not None
            and shares[0].paces[old_name].rate.value != shares[1].paces[name].rate.value
        ]
        return list(dict.fromkeys([*heavier_ids, *lighter_ids]))


def add_chain_causes(
    context: ChangeContext, chains: Sequence[ChainChange], timing_pair: TimingPair | None
) -> tuple[ChainChange, ...]:
    """Return chains with the changes that made their bounds what they are."""
    if timing_pair is None or not chains:
        return tuple(chains)
    worsening_causes, improvement_causes = TimingCauses(context, timing_pair), _ImprovementCauses(context, timing_pair)
    return tuple(
        replace(
            chain,
            causes=tuple(_list_causes(context, chain, improvement_causes if _is_better(chain) else worsening_causes)),
        )
        for chain in chains
    )


def _is_better(chain: ChainChange) -> bool:
    """Whether a chain takes shorter than before, as far as that is known."""
    old_bound, new_bound = (result.bound if result else UNKNOWN_VALUE for result in (chain.before, chain.after))
    # The sum of what is known, where figures are missing, is less than the bound that it was.
    if old_bound.complete != new_bound.complete:
        return new_bound.complete
    return new_bound.value is not None and (old_bound.value is None or new_bound.value < old_bound.value)


def _list_causes(context: ChangeContext, chain: ChainChange, causes: TimingCauses) -> Iterator[Change]:
    # A chain that came or went has no other reason than that.
    if chain.before is None or chain.after is None:
        return
    indices = context.change_indices("chain", chain.id, "through") or _find_causes(chain.before, chain.after, causes)
    yield from (context.changes[index] for index in dict.fromkeys(indices))


def _find_causes(old_result: ChainResult, new_result: ChainResult, causes: TimingCauses) -> list[int]:
    if not new_result.terms:
        return causes.find_cuts([term.activity for term in old_result.terms])[0]
    old_terms = {term.activity: term for term in old_result.terms}
    other_activities = []
    for term in new_result.terms:
        old_term = old_terms.get(causes.old_activity(term.activity) or "")
        figures = (
            (getattr(each, key).value for key in ("sampling", "response", "link")) for each in (old_term, term) if each
        )
        if old_term is None or len({tuple(each) for each in figures}) > 1:
            other_activities.append(term.activity)
    indices = causes.find_causes(other_activities)
    if indices:
        return indices
    # No figure leads to it, as after the loss of a host's cores; of one change nobody doubts that it is the cause.
    other_indices = causes.all_worsening_changes()
    return other_indices if len(other_indices) == 1 else []
