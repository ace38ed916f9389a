"""Chains that no longer meet their deadlines."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence

from archgen.compare.change import ChainChange
from archgen.compare.losses.both import Both, Loss
from archgen.compare.losses.causes import Causes
from archgen.compare.losses.full import of_link
from archgen.timing.analysis import ChainResult, Term
from archgen.timing.value import Value
from archgen.timing.wording import duration


def late(both: Both, chains: Sequence[ChainChange], causes: Causes) -> Iterator[Loss]:
    """Find chains that met their deadline and may no longer do so, or that were late and are later now."""
    for each in chains:
        old, new = each.before, each.after
        if old is None or new is None or new.deadline is None or not (said := _said(old, new)):
            continue
        # A bound without terms means that the chain is cut: there is no sum to compare, only what took its steps away.
        if new.terms:
            worse = _worse(causes, old.terms, new.terms)
            places = causes.of(worse) + _on_links(both, worse, causes)
            own = causes.owned(term.activity for term in new.terms)
        else:
            places, behind = causes.cut([term.activity for term in old.terms])
            own = causes.owned_before(behind)
        places += both.about("chain", each.id, "deadline")
        places = places or both.about("chain", each.id, "through") or causes.any()
        said += "; {} on it"
        yield from both.shared(dict.fromkeys(places), own, said, "is")


def _said(old: ChainResult, new: ChainResult) -> str:
    """Describe how much worse a chain is; empty if it is no worse than before."""
    limit, name = f"its deadline of {_time(new.deadline)}", f"the chain `{new.id}`"
    if old.verdict == "met" and new.verdict == "missed":
        grown = f"{_time(old.bound)} → {_time(new.bound)}" if old.bound != new.bound else f"it takes {_time(new.bound)}"
        return f"makes {name} miss {limit} ({grown})"
    if old.verdict == "met" and new.verdict == "open":
        met = f"{name}, which met {limit} with {_time(old.bound)}"
        return f"leaves {met}, without a bound" if new.terms else f"cuts {met}"
    was, now = old.bound.value, new.bound.value
    if old.verdict == new.verdict == "missed" and was is not None and (now is None or now > was):
        return f"makes {name} miss {limit} by still more ({_time(old.bound)} → {_time(new.bound)})"
    return ""


def _time(value: Value | None) -> str:
    if value is None or value.value is None:
        return "no bound"
    return ("" if value.complete else "at least ") + duration(value.value)


def _worse(causes: Causes, old: Iterable[Term], new: Iterable[Term]) -> list[str]:
    """Return the activities whose terms grew."""
    before = {term.activity: term for term in old}
    found = []
    for term in new:
        was = before.get(causes.was(term.activity) or "")
        # The three summands of a `ChainResult` term.
        pairs = ((getattr(was, key), getattr(term, key)) for key in ("sampling", "response", "link"))
        if was is None or any(_grew(one, other) for one, other in pairs):
            found.append(term.activity)
    return found


def _grew(one: Value, other: Value) -> bool:
    if one.value is None or other.value is None:
        return one.value is not other.value
    return other.value > one.value or (one.complete and not other.complete)


def _on_links(both: Both, worse: Iterable[str], causes: Causes) -> list[int]:
    """Return the indices of changes of links, and of what is sent, in front of the activities whose terms grew."""
    found = dict[int, None]()
    for name in worse:
        for arc in causes.timed.after.system.into.get(name, ()):
            if arc.link is not None:
                found.update(dict.fromkeys(of_link(both, arc.link, [arc.topic], causes)))
    return list(found)
