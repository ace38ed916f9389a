"""Requirements that no component serves any more."""

from __future__ import annotations

from collections.abc import Iterator, Mapping

from archgen.compare.losses.both import Both, Loss
from archgen.compare.phrases import listed


def unserved(both: Both) -> Iterator[Loss]:
    """Find requirements that lost their last component.

    Broken are the other partners who serve the same use cases, since these can no longer be achieved; if there are
    none, all other partners: the requirement is what all of them promised.
    """
    before, after = both.told.serving
    for requirement in sorted(before.keys() - after.keys()):
        asked = both.told.after.get(("requirement", requirement))
        if asked is None:
            continue
        cases = asked.values.get("use_cases")
        partners = _serving(both, cases if isinstance(cases, frozenset) else frozenset(), after)
        for place in _because(both, requirement, before[requirement]):
            others = partners - both.owners(place)
            every = sorted(others or frozenset(both.after.partners) - both.owners(place))
            words = f", who serve{'s' if len(others) == 1 else ''} the same use case" if others else ""
            why = f"leaves `{requirement}` without a component, also for {listed(every)}{words}"
            yield from (loss for partner in every for loss in both.losses([place], partner, why))


def _because(both: Both, requirement: str, components: frozenset[str]) -> list[int]:
    """Return the indices of the changes that took the last components away."""
    found: list[int] = []
    for name in sorted(components):
        if both.told.unknown(("component", name)):
            continue
        gone = both.of_kind("component", name, "removed")
        found += gone or [p for p in both.about("component", name, "requirements") if _drops(both, p, requirement)]
    return list(dict.fromkeys(found))


def _drops(both: Both, place: int, requirement: str) -> bool:
    before, after = both.changes[place].before, both.changes[place].after
    was = before if isinstance(before, list) else []
    return requirement in was and requirement not in (after if isinstance(after, list) else [])


def _serving(both: Both, cases: frozenset[str], after: Mapping[str, frozenset[str]]) -> frozenset[str]:
    """Return the partners whose components serve requirements of some of the use cases."""
    found = set[str]()
    for requirement, components in after.items():
        other = both.told.after.get(("requirement", requirement))
        theirs = other.values.get("use_cases") if other else None
        if isinstance(theirs, frozenset) and not theirs.isdisjoint(cases):
            found.update(owner for name in components if (owner := both.owner("component", name)))
    return frozenset(found)
