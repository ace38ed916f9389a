"""Find the chains whose bound or deadline changed."""

from __future__ import annotations

from collections.abc import Mapping

from archgen.compare.change import ChainChange
from archgen.compare.names import Names
from archgen.compare.timed import Timed
from archgen.model.architecture import Architecture
from archgen.timing import chains as timing_chains
from archgen.timing.analysis import Analysis, ChainResult


def chains(before: Architecture, after: Architecture, names: Names, timed: Timed | None) -> tuple[ChainChange, ...]:
    """Return the chains that were added or removed, or have another bound or deadline, in the order of the second
    version.
    """
    if timed is None:
        return ()
    new, old = _results(after, timed.after), _results(before, timed.before)
    pairs = [(names.back.get("chain", {}).get(name), name) for name in new]
    gone = [(name, None) for name in old if names.known("chain", name) is None]
    told = ((old.get(a) if a else None, new[b] if b else None) for a, b in (*pairs, *gone))
    return tuple(ChainChange((b or a).id, a, b) for a, b in told if (a or b) and _differ(a, b))  # type: ignore[union-attr]


def _results(found: Architecture, analysis: Analysis) -> Mapping[str, ChainResult]:
    return timing_chains.chains(analysis, found) if found.chains else {}


def _differ(one: ChainResult | None, other: ChainResult | None) -> bool:
    if one is None or other is None:
        return True
    # The words of a bound (what it lacks, where it is from) may change without the figure: they are left out.
    bounds = [(each.bound.value, each.bound.complete, each.bound.side) for each in (one, other)]
    return bounds[0] != bounds[1] or one.deadline != other.deadline
