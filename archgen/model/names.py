"""Dotted names: which elements a path may mean whose leading parts are left out.

One look-up for references in files and for selectors. Every end of every path is a key, so that no search walks over the
elements.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from itertools import islice
from typing import NamedTuple

from archgen.frozen import dataclass

LISTED = 8
"""How many candidates are given by name; there may be ten thousand."""


def made_title(name: str) -> str:
    """Make the title of an element that has none from its id: `object_recognition` is "Object Recognition"."""
    return " ".join(word[:1].upper() + word[1:] for word in name.split("_") if word)


class Named(NamedTuple):
    """An element: its kind (`group`, `component`, `output`, ...) and its complete id."""

    kind: str
    id: str


@dataclass(frozen=True, slots=True)
class Found:
    """What a path may mean: one element, none, or several (`count` of them, the first few by name).

    `hidden` are the candidates that the complete path of another element hides.
    """

    elements: tuple[Named, ...]
    count: int
    hidden: tuple[Named, ...] = ()

    @property
    def one(self) -> Named | None:
        """Give the element, if it is one."""
        return self.elements[0] if self.count == 1 else None


NOTHING = Found((), 0)


class Names:
    """The complete ids of each kind of element, found by their ends."""

    __slots__ = ("_complete", "_ends", "_ends_in_group")

    def __init__(self, ids: Mapping[str, Iterable[str]]) -> None:
        """Take the complete ids by kind."""
        self._complete = {kind: frozenset(paths) for kind, paths in ids.items()}
        self._ends: dict[str, dict[str, list[str]]] = {}
        self._ends_in_group: dict[str, dict[tuple[str, str], list[str]]] = {}
        for kind, paths in ids.items():
            self._ends[kind], self._ends_in_group[kind] = _ends(paths)

    def find(self, words: str, kinds: Sequence[str], *, component: str | None = None) -> Found:
        """Look a path up among some kinds, as `component` (its complete id) writes it, or somebody outside all groups.

        A complete path is that element. Else the candidates end in the words; one word never means the writer or an
        output of its own; those in the writer's group win over all others.
        """
        ends = {kind: paths for kind in kinds if (paths := self._ends[kind].get(words))}
        if len(ends) == 1 and (component is None or "." in words):
            ((kind, paths),) = ends.items()
            if len(paths) == 1:  # nearly always
                return Found((Named(kind, paths[0]),), 1)
        return self._choose(words, kinds, ends, component) if ends else NOTHING

    def _choose(
        self, words: str, kinds: Sequence[str], ends: Mapping[str, Sequence[str]], component: str | None
    ) -> Found:
        own = self._own(words, component)
        for kind in kinds:
            if words in self._complete[kind]:
                hidden = tuple(name for name in _take(ends, own).elements if name != (kind, words))
                return Found((Named(kind, words),), 1, hidden)
        if component:
            group = component.partition(".")[0]
            found = _take({kind: self._ends_in_group[kind].get((group, words), ()) for kind in kinds}, own)
            if found.count:
                return found
        return _take(ends, own)

    def _own(self, words: str, component: str | None) -> tuple[Named, ...]:
        """Name what one word never means: the writer itself and its output of that name."""
        if component is None or "." in words:
            return ()
        own: list[Named] = []
        if component.rpartition(".")[2] == words:
            own.append(Named("component", component))
        if f"{component}.{words}" in self._complete.get("output", ()):
            own.append(Named("output", f"{component}.{words}"))
        return tuple(own)

    def is_complete(self, kind: str, path: str) -> bool:
        """Tell whether a path is the complete id of an element."""
        return path in self._complete[kind]

    def ends(self, kind: str) -> Iterable[str]:
        """Give every path that may stand for elements of a kind, each once."""
        return self._ends[kind]

    def ending(self, kind: str, words: str) -> Sequence[str]:
        """Give the complete ids of a kind that end in some words."""
        return self._ends[kind].get(words, ())


def _ends(paths: Iterable[str]) -> tuple[dict[str, list[str]], dict[tuple[str, str], list[str]]]:
    everywhere: dict[str, list[str]] = {}
    in_group: dict[tuple[str, str], list[str]] = {}
    for path in paths:
        group, dot, end = path.partition(".")
        everywhere.setdefault(path, []).append(path)
        while dot:
            everywhere.setdefault(end, []).append(path)
            in_group.setdefault((group, end), []).append(path)
            _, dot, end = end.partition(".")
    return everywhere, in_group


def _take(found: Mapping[str, Sequence[str]], own: tuple[Named, ...]) -> Found:
    """Name the first few and count the rest; `own` are left out. A long list is not walked through."""
    left_out = [name for name in own if name.kind in found]
    names = (Named(kind, path) for kind, paths in found.items() for path in paths)
    first = tuple(islice((name for name in names if name not in left_out), LISTED))
    return Found(first, sum(map(len, found.values())) - len(left_out))
