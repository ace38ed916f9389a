"""Why a chain takes longer or shorter than before: the changes behind the parts of its bound that differ."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import replace

from archgen.compare.comparison import ChainChange, Change
from archgen.compare.losses.change_context import ChangeContext
from archgen.compare.losses.timing_causes import TimingCauses
from archgen.compare.timing_pair import TimingPair, can_affect_timing
from archgen.timing.analysis import ChainResult


class _BothWays(TimingCauses):
    """The causes of a figure that is better as well as of one that is worse: nobody is blamed here."""

    def can_worsen(self, change: Change) -> bool:
        return can_affect_timing(change)

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
    """Return chains with the sentences about the changes that made their bounds what they are."""
    if timing_pair is None or not chains:
        return tuple(chains)
    causes = _BothWays(context, timing_pair)
    return tuple(
        replace(chain, causes=tuple(dict.fromkeys(_describe_causes(context, chain, causes)))) for chain in chains
    )


def _describe_causes(context: ChangeContext, chain: ChainChange, causes: _BothWays) -> Iterator[str]:
    # A chain that came or went has no other reason than that.
    if chain.before is None or chain.after is None:
        return
    indices = context.change_indices("chain", chain.id, "through") or _find_causes(chain.before, chain.after, causes)
    for index in indices:
        yield context.changes[index].text.partition("; ")[0]


def _find_causes(old_result: ChainResult, new_result: ChainResult, causes: _BothWays) -> list[int]:
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
    return causes.find_causes(other_activities)
