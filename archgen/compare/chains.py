"""Chains of which the bound changed. The timing is only analysed where a change can touch it."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from archgen.compare.change import ChainChange, Change
from archgen.compare.names import Names
from archgen.model.architecture import Architecture
from archgen.timing import chains as timing_chains
from archgen.timing.analyse import analyse
from archgen.timing.analysis import ChainResult

_TEXT_SORTS = frozenset({"partner", "use_case", "requirement", "chapter", "view", "policy", "project"})
_TEXT_KEYS = frozenset(
    {
        *("title", "description", "functionality", "comment", "owner", "tags", "layout", "role", "requirements"),
        *("external", "optional", "executable", "package", "plugin", "status", "parameter_files"),
    }
)
_TEXT_STARTS = ("urls.", "performance.", "parameters.")


def chains(
    before: Architecture, after: Architecture, names: Names, changes: Sequence[Change]
) -> tuple[ChainChange, ...]:
    """Give the chains that came, went, or have another bound or deadline, in the order of the second version."""
    if not (before.chains or after.chains) or not any(map(_matters, changes)):
        return ()
    if before.lost or after.lost:  # of what could not be read nobody knows how long it takes
        return ()
    new, old = _results(after), _results(before)  # the analysis of the version judged last is still at hand
    pairs = [(names.back.get("chain", {}).get(name), name) for name in new]
    gone = [(name, None) for name in old if names.known("chain", name) is None]
    told = ((old.get(a) if a else None, new[b] if b else None) for a, b in (*pairs, *gone))
    return tuple(ChainChange((b or a).id, a, b) for a, b in told if (a or b) and _differ(a, b))  # type: ignore[union-attr]


def _matters(change: Change) -> bool:
    """Say whether a change can touch a bound."""
    if change.sort in _TEXT_SORTS:
        return False
    if change.kind == "changed" and change.key:
        return change.key not in _TEXT_KEYS and not change.key.startswith(_TEXT_STARTS)
    return change.kind in {"added", "removed", "changed"}


def _results(found: Architecture) -> Mapping[str, ChainResult]:
    return timing_chains.chains(analyse(found, judging=True), found) if found.chains else {}


def _differ(one: ChainResult | None, other: ChainResult | None) -> bool:
    if one is None or other is None:
        return True
    bounds = [(each.bound.value, each.bound.complete, each.bound.side) for each in (one, other)]
    return bounds[0] != bounds[1] or one.deadline != other.deadline
