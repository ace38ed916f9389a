"""Chains that no longer meet their deadlines, and hosts and links that are asked for more than they have."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence

from archgen.compare.change import ChainChange
from archgen.compare.losses.both import Both, Loss
from archgen.compare.losses.causes import Causes
from archgen.compare.timed import full
from archgen.timing.analysis import ChainResult, HostLoad, LinkLoad, Term
from archgen.timing.value import Value
from archgen.timing.wording import duration, share


def late(both: Both, chains: Sequence[ChainChange], causes: Causes) -> Iterator[Loss]:
    """Find chains that met their deadline and may not any more, or that are later than they were already."""
    for each in chains:
        old, new = each.before, each.after
        if old is None or new is None or new.deadline is None or not (said := _said(old, new)):
            continue
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
    """Say how much worse a chain is; nothing where it is no worse than it was."""
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
    """Name the activities of the terms that grew."""
    before = {term.activity: term for term in old}
    found = []
    for term in new:
        was = before.get(causes.was(term.activity) or "")
        pairs = ((getattr(was, key), getattr(term, key)) for key in ("sampling", "response", "link"))
        if was is None or any(_grew(one, other) for one, other in pairs):
            found.append(term.activity)
    return found


def _grew(one: Value, other: Value) -> bool:
    if one.value is None or other.value is None:
        return one.value is not other.value
    return other.value > one.value or (one.complete and not other.complete)


def _on_links(both: Both, worse: Iterable[str], causes: Causes) -> list[int]:
    """Find the changes of links, and of what is sent, before the activities whose terms grew."""
    found = dict[int, None]()
    for name in worse:
        for arc in causes.timed.after.system.into.get(name, ()):
            if arc.link is not None:
                found.update(dict.fromkeys(_of_link(both, arc.link, [arc.topic], causes)))
    return list(found)


def _of_link(both: Both, link: str, topics: Iterable[str], causes: Causes) -> Iterator[int]:
    names = [("link", link)]
    for found in filter(None, map(both.after.topics.get, topics)):
        names += [("type", name) for name in found.types]
        names += [("message", name) for name in found.messages]
    for sort, name in names:
        yield from (place for place, change in both.found(sort, name) if causes.worse(change))


def overloaded(both: Both, causes: Causes) -> Iterator[Loss]:
    """Find hosts that can no longer do what they could, and who has something running there, then and now."""
    for name, load in causes.timed.after.hosts.items():
        was = _before(both, "host", name, causes)
        if not isinstance(was, HostLoad) or full(was) or not full(load):
            continue
        own = both.about("host", name, "cores")
        heavier = causes.heavier(part for part, _ in load.parts)
        places = dict.fromkeys([*own, *causes.of(heavier)] or causes.any())
        stayed = [part for part, _ in load.parts if _ran(causes, part, was)]
        used, cores = load.utilisation.value, load.cores
        whole = "its core" if cores == 1 else f"its {cores} cores"
        grown = f" ({share(used / cores)} of {whole})" if used is not None else ""
        yield from both.shared(places, causes.owned(stayed), f"overloads the host `{name}`{grown}, where {{}}", "runs")


def saturated(both: Both, causes: Causes) -> Iterator[Loss]:
    """Find links that can no longer carry what they could, and who has sent or received something over them."""
    for name, load in causes.timed.after.links.items():
        was = _before(both, "link", name, causes)
        if not isinstance(was, LinkLoad) or full(was) or not full(load):
            continue
        before = dict(was.parts)
        grown = [topic for topic, value in load.parts if topic not in before or _grew(before[topic], value)]
        crossing = [arc for arc in causes.timed.after.system.arcs if arc.link == name and arc.role == "data"]
        ends = [end for arc in crossing if arc.topic in grown for end in (arc.source, arc.target)]
        places = dict.fromkeys([*_of_link(both, name, grown, causes)] or causes.of(ends) or causes.any())
        users = {end for arc in crossing if arc.topic in before for end in (arc.source, arc.target)}
        used = share(load.share.value) if load.share.value is not None else ""
        why = f"asks the link `{name}` for {used} of its bandwidth; {{}} it"
        yield from both.shared(places, causes.owned(users), why, "uses")


def _before(both: Both, sort: str, name: str, causes: Causes) -> HostLoad | LinkLoad | None:
    own = both.names.back.get(sort, {}).get(name, name)
    return (causes.timed.before.hosts if sort == "host" else causes.timed.before.links).get(own)


def _ran(causes: Causes, name: str, load: HostLoad) -> bool:
    return causes.was(name) in {part for part, _ in load.parts}
