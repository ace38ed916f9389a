"""Resolve references: which element a dotted path means, and what to report if it means none, or several."""

from __future__ import annotations

from collections.abc import Collection, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field

from archgen.diagnostic import Diagnostic, Label
from archgen.link import reading
from archgen.model.names import NOTHING, Found, Named, Names
from archgen.source import NOWHERE, Span
from archgen.suggest import closest
from archgen.syntax.tree import Scalar, Table

# How many parts the complete path of each kind has: a reference with more parts cannot mean that kind.
_DEPTH = {"group": 1, "node": 1, "component": 2, "output": 3, "input": 3}
_GUESSES = 300_000
"""How many names may be compared with mistyped ones in one run: some dozen guesses among the names of 10,000
components, as many as anybody needs in a project of usual size. What comes later is reported without a guess. Without
the limit, thousands of unknown references would take time that grows with the square of the project.
"""


@dataclass(slots=True)
class References:
    """Resolves references to everything that can be referred to, and collects what is wrong with them.

    `implements` is filled in from outside once the nodes' components are resolved, which itself needs this object.
    """

    places: Mapping[str, Mapping[str, Span]]
    """Where elements that dotted paths can name were declared, by kind and complete id."""
    plain_places: Mapping[str, Mapping[str, Span]]
    """The same for elements named by their id alone, by kind (`partner`, `host`, `container`, `use case`) and id."""
    found: list[Diagnostic]
    lost: frozenset[str] = frozenset()
    """The keys in files that could not be read: what they may declare is not reported as unknown."""
    implements: Mapping[str, Collection[str]] = field(default_factory=dict)
    """The components of each node, once they are known."""
    suspects: set[str] = field(default_factory=set)
    """Complete ids of what unresolved references most likely meant: later rules do not call these unconnected."""
    names: Names = field(init=False)
    _left: int = _GUESSES
    _pools: dict[tuple[str, int], tuple[str, ...]] = field(default_factory=dict)

    def __post_init__(self) -> None:
        self.names = Names(self.places)

    def follow(self, written: Scalar, kinds: Sequence[str], element: str, component: str | None = None) -> Named | None:
        """Return the element that a reference means; None, and a diagnostic, if that is not clear.

        `kinds` are the kinds that are allowed here; the diagnostic is about `element_id`. `component_id` is the
        component that writes the reference: elements of its group win; a single word never means itself or its output.
        """
        words = written.text
        result = self.names.find(words, kinds, component=component)
        one = result.one
        # Whatever an unresolved reference may have meant is a suspect: that such an element seems unread is an
        # aftermath of this finding, not a second mistake.
        if result.count > 1:
            self.suspects.update(name.id for name in result.elements)
            self.found.append(self._ambiguous(written, result, element))
        elif one is None and not self.is_lost(words):
            self.found.append(self._unknown(written, kinds, element, component))
        elif one and result.hidden:
            self._warn_hidden(written, one, result.hidden, element)
        return one

    def plain(self, written: Scalar | None, kind: str, element: str) -> str | None:
        """Return the id of a partner, host, container or use case; None, and a diagnostic, if there is no such one."""
        known = self.plain_places[kind]
        if written is None or written.text in known:
            return written.text if written else None
        if self.is_lost(written.text):
            return None
        guess = self.guess(written.text, known)
        self.found.append(unknown(written, kind, guess, known.get(guess or "", NOWHERE), element))
        return None

    def owners(self, below: Table, element: str, inherited: Iterable[str]) -> tuple[str, ...]:
        """Return the owners of an element, each once: those written, or the inherited ones if none are written."""
        if below.get("owner") is None:
            return tuple(dict.fromkeys(inherited))
        found = (self.plain(one, "partner", element) for one in reading.scalars(below, "owner"))
        return tuple(dict.fromkeys(name for name in found if name))

    def is_lost(self, words: str) -> bool:
        """Whether a file that could not be read may declare what a path names."""
        # The last part or the one before it: a port may be lost, or the component that it belongs to.
        return not self.lost.isdisjoint(words.split(".")[-2:])

    def guess(self, word: str, pool: Collection[str]) -> str | None:
        """Return the candidate that a name most likely stands for, as long as the budget for guesses lasts."""
        # Set to zero, not left as it is: from here on no reference gets a guess, not even one with a smaller pool.
        if len(pool) > self._left:
            self._left = 0
            return None
        self._left -= len(pool)
        return closest(word, pool)

    def _ambiguous(self, written: Scalar, result: Found, element: str) -> Diagnostic:
        self.suspects.update(name.id for name in result.elements)
        listed = [f"`{name.id}`" for name in result.elements]
        more = result.count - len(listed)
        last = f"{more} more" if more else listed.pop()
        return Diagnostic(
            "ambiguous-reference",
            f"`{written.text}` can mean {', '.join(listed)} or {last}",
            written.at,
            labels=tuple(Label(self._place(name), f"`{name.id}`") for name in result.elements),
            help=f"write more of the path, such as `{result.elements[0].id}`",
            element=element,
        )

    def _unknown(self, written: Scalar, kinds: Sequence[str], element: str, component: str | None) -> Diagnostic:
        words = written.text
        what = _possible(kinds, words.count(".") + 1)
        # The commonest reasons are named before anything is guessed: the writer itself, an input, a group.
        own = f"{component}.{words}"
        if component and (own in self.places["output"] or component.endswith(f".{words}")):
            help_line = "one word never means the writer itself or its own output: a loop is written `component.output`"
            message = f"no other {what} named `{words}`"
            return Diagnostic("unknown-reference", message, written.at, help=help_line, element=element)
        inputs = self.names.ending("input", words)
        if "output" in kinds and inputs:
            label = (Label(self.places["input"][inputs[0]], "an input"),)
            message = f"no {what} named `{words}`: `{inputs[0]}` is an input"
            help_line = "name the output that the data comes from"
            return Diagnostic("unknown-reference", message, written.at, labels=label, help=help_line, element=element)
        if words in self.places["group"] and "group" not in kinds:
            return self._not_a_group(written, what, element)
        guess = self._guess_path(words, kinds)
        candidates = self.names.find(guess, kinds, component=component) if guess else NOTHING
        self.suspects.update(name.id for name in candidates.elements)
        meant = candidates.one
        return unknown(written, what, guess, self._place(meant) if meant else NOWHERE, element)

    def _not_a_group(self, written: Scalar, what: str, element: str) -> Diagnostic:
        group, place = written.text, self.places["group"][written.text]
        self.suspects.update(path for path in self.places["component"] if path.startswith(f"{group}."))
        return Diagnostic(
            "unknown-reference",
            f"no {what} named `{group}`: it is a group",
            written.at,
            labels=(Label(place, "the group"),),
            help="name its components",
            element=element,
        )

    def _warn_hidden(self, written: Scalar, one: Named, hidden: Iterable[Named], element: str) -> None:
        # A node and the component that it implements often have the same name: either is meant, nothing is hidden.
        others = [name for name in hidden if name.id not in self.implements.get(one.id, ())]
        if others:
            self.found.append(
                Diagnostic(
                    "hidden-reference",
                    f"`{written.text}` is the {one.kind} `{one.id}`, which hides the {others[0].kind} `{others[0].id}`",
                    written.at,
                    labels=tuple(Label(self._place(name), "hidden") for name in others),
                    help=f"write `{others[0].id}` if that is meant",
                    element=element,
                )
            )

    def _guess_path(self, words: str, kinds: Sequence[str]) -> str | None:
        """Return the path that was most likely meant, or None.

        First among paths with the same last part (few, and a slip is usually in one part only), then among all paths of
        the same length; at last without leading parts, in case an element was moved to another group.
        """
        if not self._left:
            return None
        length = words.count(".") + 1
        fitting = [kind for kind in kinds if _DEPTH[kind] >= length]
        last = words.rpartition(".")[2]
        # A set of ends: two complete paths with the same end are one candidate, since the guess has the length of the
        # reference that somebody wrote.
        near = {_end(path, length) for kind in fitting for path in self.names.ending(kind, last)}
        guess = self.guess(words, near) if length > 1 and near else None
        if guess is None:
            pool = set().union(*(self._pool(kind, length) for kind in fitting)) if fitting else ()
            guess = self.guess(words, pool)
        while guess is None and "." in words:
            words = words.partition(".")[2]
            moved = self.names.find(words, kinds).one
            guess = moved.id if moved else None
        return guess

    def _pool(self, kind: str, length: int) -> tuple[str, ...]:
        key = (kind, length)
        if key not in self._pools:
            self._pools[key] = tuple(path for path in self.names.ends(kind) if path.count(".") == length - 1)
        return self._pools[key]

    def _place(self, name: Named) -> Span:
        return self.places[name.kind][name.id]


def unknown(written: Scalar, what: str, guess: str | None, declared: Span, element: str) -> Diagnostic:
    """Report that there is no such element, with what may have been meant."""
    return Diagnostic(
        "unknown-reference",
        f"no {what} named `{written.text}`",
        written.at,
        labels=(Label(declared, "declared here"),) if guess and declared != NOWHERE else (),
        help=f"did you mean `{guess}`?" if guess else None,
        element=element,
    )


def _possible(kinds: Sequence[str], length: int) -> str:
    """Return the kinds that a path of some length can mean, as words: "component or output"."""
    possible = [kind for kind in kinds if _DEPTH[kind] >= length] or [kinds[-1]]
    return " or ".join(filter(None, (", ".join(possible[:-1]), possible[-1])))


def _end(path: str, length: int) -> str:
    return ".".join(path.split(".")[-length:])


@dataclass(slots=True)
class Ports:
    """Resolves keys that name ports: of one component, or of all components that a node implements."""

    references: References
    owner: str
    """The element whose keys they are, for diagnostics."""
    components: tuple[str, ...]
    ports: Mapping[str, Mapping[str, Collection[str]]]
    """The names of ports by kind (`input`, `output`) and component."""
    free: bool = False
    """Whether the node implements nothing, so that its keys are names of its own."""
    _names: Names | None = None

    @property
    def names(self) -> Names:
        """The look-up of ports by the ends of their ids, built on first use: most keys are found without it."""
        if self._names is None:
            self._names = Names({kind: list(_complete(self.components, names)) for kind, names in self.ports.items()})
        return self._names

    def follow(self, words: str, at: Span, kind: str) -> str | None:
        """Return the complete id of the port (`kind` is `input` or `output`) that a key means, or None."""
        if not self.components:  # what it implements is not known: that is reported already
            return words if self.free else None
        # The usual case, one component and the plain name of a port, needs no look-up of its own.
        if len(self.components) == 1 and words in self.ports[kind].get(self.components[0], ()):
            return f"{self.components[0]}.{words}"
        result = self.names.find(words, (kind,))
        if result.count == 1:
            return result.elements[0].id
        if result.count:
            self.references.suspects.update(name.id for name in result.elements)
            self.references.found.append(self._ambiguous(words, at, result))
        elif not self.references.is_lost(words):
            self.references.found.append(self._unknown(words, at, kind))
        return None

    def _ambiguous(self, words: str, at: Span, result: Found) -> Diagnostic:
        self.references.suspects.update(name.id for name in result.elements)
        listed = " or ".join(f"`{_end(name.id, 2)}`" for name in result.elements)
        return Diagnostic(
            "ambiguous-reference",
            f"`{words}` can mean {listed}",
            at,
            labels=tuple(Label(self._place(name), f"`{name.id}`") for name in result.elements),
            help="write `component.port` where several components of a node have a port of this name",
            element=self.owner,
        )

    def _unknown(self, words: str, at: Span, kind: str) -> Diagnostic:
        other = "input" if kind == "output" else "output"
        wrong_way = self.names.find(words, (other,)).elements
        message = f"no {kind} named `{words}` in {' or '.join(f'`{c}`' for c in self.components[:3])}"
        if wrong_way:
            label = Label(self._place(wrong_way[0]), f"an {other}")
            return Diagnostic(
                "unknown-reference", message, at, labels=(label,), help=f"`{words}` is an {other}", element=self.owner
            )
        # An ambiguous end would be no help as a guess.
        clear = [path for path in self.names.ends(kind) if len(self.names.ending(kind, path)) == 1]
        guess = self.references.guess(words, clear)
        meant = self.names.find(guess, (kind,)).one if guess else None
        self.references.suspects.update([meant.id] if meant else ())
        labels = (Label(self._place(meant), "declared here"),) if meant else self._declared()
        help_line = f"did you mean `{guess}`?" if guess else None
        return Diagnostic("unknown-reference", message, at, labels=labels, help=help_line, element=self.owner)

    def _declared(self) -> tuple[Label, ...]:
        places = self.references.places["component"]
        return tuple(Label(places[component], "declared here") for component in self.components[:3])

    def _place(self, name: Named) -> Span:
        return self.references.places[name.kind][name.id]


def _complete(components: Iterable[str], names: Mapping[str, Iterable[str]]) -> Iterator[str]:
    for component in components:
        yield from (f"{component}.{name}" for name in names.get(component, ()))
