"""Both versions with the changes between them: who changed what, and who owns it."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from functools import cached_property

from archgen.compare.change import Change
from archgen.compare.elements import Key
from archgen.compare.names import Names
from archgen.compare.phrases import listed, short
from archgen.compare.told import Told
from archgen.model.architecture import Architecture
from archgen.model.node import Endpoint

_MOST = 4
"""Maximal number of elements named in one sentence; the rest is counted."""


@dataclass(frozen=True, slots=True)
class Loss:
    """What a partner loses by the change at an index of `ChangeContext.changes`. `reason` is that of `PartnerBreak`."""

    change: int
    partner: str
    why: str


@dataclass
class Both:
    """Both versions with their changes. Elements have their common ids; changes are known by their index at the top
    level.
    """

    before: Architecture
    after: Architecture
    names: Names
    told: Told
    changes: Sequence[Change]
    _about: dict[Key, list[tuple[int, Change]]] = field(default_factory=lambda: defaultdict(list))

    def __post_init__(self) -> None:
        for place, change in enumerate(self.changes):
            for one in self.all_of(change):
                name = self.common(one)
                self._about[one.sort, name].append((place, one))
                if one.sort == "port":
                    # A pseudo kind: what is said of the ports of a node is looked up by the node.
                    self._about["ports of", name.partition(".")[0]].append((place, one))

    def all_of(self, change: Change) -> Iterator[Change]:
        """Yield a change and all its parts, at any depth."""
        yield change
        for part in change.parts:
            yield from self.all_of(part)

    def common(self, change: Change) -> str:
        """Return the common id of the changed element, as `versions` has it."""
        if change.kind != "removed":
            return change.element
        return self.names.to("input" if change.sort == "connection" else change.sort, change.element)

    def found(self, sort: str, name: str) -> Sequence[tuple[int, Change]]:
        """Return the changes of an element, each with the index of the top-level change that contains it."""
        return self._about.get((sort, name), ())

    def about(self, sort: str, name: str, *keys: str) -> list[int]:
        """Return the indices of an element's changes: of the given keys, or all."""
        found = self._about.get((sort, name), ())
        return list(dict.fromkeys(place for place, one in found if not keys or one.key in keys))

    def of_kind(self, sort: str, name: str, *kinds: str) -> list[int]:
        """Return the indices of an element's changes of certain kinds ("removed", "renamed")."""
        return list(dict.fromkeys(p for p, one in self._about.get((sort, name), ()) if one.kind in kinds))

    def owners(self, place: int) -> frozenset[str]:
        """Return the partner who owns what changed, nobody if nobody owns it."""
        change = self.changes[place]
        return self.keepers("input" if change.sort == "connection" else change.sort, self.common(change))

    def keepers(self, sort: str, name: str) -> frozenset[str]:
        """Return the partner who owns an element in all versions that have it.

        An element that changes hands is nobody's: otherwise naming a new owner would be enough to change it quietly.
        """
        both = (listed.get((sort, name)) for listed in (self.told.before, self.told.after))
        found = {each.owner for each in both if each}
        return frozenset(owner for owner in found if owner and len(found) == 1)

    def shared(self, places: Iterable[int], parts: Mapping[str, Sequence[str]], why: str, verb: str) -> Iterator[Loss]:
        """Yield one loss for each partner who does not own a change; `{}` in `why` becomes their parts and `verb`."""
        for place in places:
            others = {partner: parts[partner] for partner in sorted(parts) if partner not in self.owners(place)}
            named = [f"{several(own)} of {partner}" for partner, own in others.items()]
            plural = sum(map(len, others.values())) != 1
            said = why.replace("{}", f"{listed(named)} {_verb(verb, plural=plural)}")
            yield from (Loss(place, partner, said) for partner in others)

    def losses(self, places: Iterable[int], partner: str, why: str) -> Iterator[Loss]:
        """Yield a loss of a partner for each change that is not its own."""
        yield from (Loss(place, partner, why) for place in places if partner not in self.owners(place))

    def owner(self, sort: str, name: str) -> str | None:
        """Return the partner who owned an element before the change; for a new element, who owns it."""
        # The first version decides: who loses something is who had it.
        element = self.told.before.get((sort, name)) or self.told.after.get((sort, name))
        return element.owner if element else None

    def needs(self, reader: str) -> bool:
        """Whether an input still exists and is not optional."""
        element = self.told.after.get(("input", reader))
        return element is not None and not element.values.get("optional")

    def own(self, sort: str, name: str) -> str:
        """Return the id that an element had before the change."""
        element = self.told.before.get((sort, name))
        return element.own if element else name

    @cached_property
    def ends(self) -> tuple[Mapping[tuple[str, str], list[Endpoint]], Mapping[tuple[str, str], list[Endpoint]]]:
        """Return what written nodes publish and serve, before and after, by common node and port ("" for internal
        ones).
        """
        return self._ends(self.before, self.names), self._ends(self.after, Names())

    def _ends(self, found: Architecture, names: Names) -> Mapping[tuple[str, str], list[Endpoint]]:
        ends: dict[tuple[str, str], list[Endpoint]] = defaultdict(list)
        for end in found.endpoints:
            if end.use in {"publishes", "serves"} and found.nodes[end.node].written:
                port = names.to("output", end.port) if end.port else ""
                ends[names.to("node", end.node), port].append(end)
        return ends

    def port(self, node: str, port: str, *keys: str) -> list[int]:
        """Return the indices of changes of what a node says of a component's port, or of its internal ones if `port` is
        empty.
        """
        found: list[int] = []
        for place, change in self.found("ports of", node):
            name = self.common(change)
            element = self.told.after.get(("port", name)) or self.told.before.get(("port", name))
            refs = element.refs if element else ()
            right = port in refs if port else name.startswith(f"{node}.internal.")
            if right and (not keys or change.key in keys or change.kind != "changed"):
                found.append(place)
        return list(dict.fromkeys(found))


def tick(name: object) -> str:
    """Return a name in backticks, whatever it contains."""
    return f"`{short(str(name))}`"


def several(names: Iterable[str]) -> str:
    """Return sorted names in backticks, joined for a sentence: `a`, `b` and `c`."""
    ticked = [tick(name) for name in sorted(names)]
    return listed(ticked if len(ticked) <= _MOST else [*ticked[: _MOST - 1], f"{len(ticked) - _MOST + 1} more"])


def _verb(verb: str, *, plural: bool) -> str:
    if not plural:
        return verb
    return "are" if verb == "is" else verb.removesuffix("s")
