"""The selector language: one way to name a part of the architecture, in the terminal, in views, in policies.

    selector = word {blank word}                word = ["-"] term
    term     = [N]"+"atom | atom"+"[N] | [N]"+"atom"+"[N] | atom | atom".."atom
    atom     = path | key":"value

A path is as in references, with `*` for any run within one id.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable, Iterator, Mapping
from dataclasses import dataclass
from fnmatch import translate
from functools import cache
from typing import Literal

from archgen.model import graph
from archgen.model.architecture import Architecture
from archgen.model.component import Component, Input, Output
from archgen.model.graph import Graph, reach
from archgen.model.mapping import full_message
from archgen.suggest import closest

KEYS = (
    "tag",
    "owner",
    "status",
    "type",
    "medium",
    "role",
    "host",
    "package",
    "requirement",
    "behaviour",
    "finding",
    "node",
)
_WORD = re.compile(r'(?:[^\s"]|"[^"]*")+|"[^"]*$')
_TERM = re.compile(
    r"(?P<neg>-?)(?:(?P<before>\d{0,3})(?P<up>\+))?(?P<atom>.*?)(?:(?P<down>\+)(?P<after>\d{0,3}))?\Z", re.DOTALL
)
_PATH = re.compile(r"[A-Za-z0-9_*.\-]+\Z")


@dataclass(frozen=True, slots=True)
class Problem:
    """What is wrong with a selector, and where in its text (characters from 0, end exclusive)."""

    message: str
    start: int
    end: int
    severity: Literal["error", "warning"] = "error"
    help: str | None = None


@dataclass(frozen=True, slots=True)
class Selection:
    """What a selector names, by complete ids: components, and the nodes that implement them or were named themselves."""

    components: frozenset[str] = frozenset()
    nodes: frozenset[str] = frozenset()


@dataclass(frozen=True, slots=True)
class _Atom:
    text: str
    start: int
    end: int


@dataclass(frozen=True, slots=True)
class _Term:
    """One word, taken apart. `up` and `down` are steps: None for no `+`, -1 for any number."""

    negative: bool
    atom: _Atom
    to: _Atom | None = None
    up: int | None = None
    down: int | None = None


def select(
    text: str, architecture: Architecture, findings: Mapping[str, frozenset[str]] | None = None
) -> tuple[Selection, tuple[Problem, ...]]:
    """Evaluate a selector. `findings` gives, for each rule, the ids of the elements that it was found at.

    With an error the selection is empty. Without positive words everything is selected, less the negative ones.
    """
    terms, problems = parse(text)
    if problems:
        return Selection(), problems
    run = _Run(architecture, findings or {})
    wanted: set[str] = set()
    unwanted: set[str] = set()
    own: set[str] = set()
    for term in terms:
        components, nodes = run.term(term)
        (unwanted if term.negative else wanted).update(components)
        own = own - nodes if term.negative else own | nodes
    if all(term.negative for term in terms):
        wanted = set(architecture.components)
        own = {name for name, node in architecture.nodes.items() if not node.implements} - run.refused
    components = frozenset(wanted - unwanted)
    if any(problem.severity == "error" for problem in run.problems):
        return Selection(), tuple(run.problems)
    implementing = {n.id for n in architecture.nodes.values() if components.intersection(n.implements)}
    return Selection(components, frozenset((implementing | own) - run.refused)), tuple(run.problems)


def parse(text: str) -> tuple[tuple[_Term, ...], tuple[Problem, ...]]:
    """Take a selector apart, without looking anything up."""
    words = [_word(match[0], match.start()) for match in _WORD.finditer(text)]
    problems = [word for word in words if isinstance(word, Problem)]
    terms = [word for word in words if isinstance(word, _Term)]
    if not terms and not problems:
        problems.append(Problem("the selector is empty", 0, len(text)))
    return tuple(terms), tuple(problems)


def _word(word: str, start: int) -> _Term | Problem:
    end = start + len(word)
    if word.count('"') % 2:
        return Problem("a quotation mark is not closed", start, end)
    if "," in re.sub(r'"[^"]*"', "", word):
        return Problem("`,` is reserved; words are separated by blanks", start, end)
    match = _TERM.match(word)
    if match is None or not match["atom"]:
        return Problem(f"`{word}` names nothing", start, end)
    at = start + match.start("atom")
    left, dots, right = _split(match["atom"])
    if dots and (match["up"] or match["down"]):
        return Problem("`..` and `+` cannot stand in one word", start, end, help="write two words")
    atoms = [_Atom(left, at, at + len(left))]
    if dots:
        atoms.append(_Atom(right, at + len(left) + 2, at + len(left) + 2 + len(right)))
    for atom in atoms:
        problem = _check(atom)
        if problem:
            return problem
    to = atoms[1] if dots else None
    return _Term(
        bool(match["neg"]), atoms[0], to, _steps(match["up"], match["before"]), _steps(match["down"], match["after"])
    )


def _split(atom: str) -> tuple[str, str, str]:
    """Split `x..y` outside of quotes."""
    quoted = False
    for place, character in enumerate(atom):
        quoted ^= character == '"'
        if not quoted and atom.startswith("..", place):
            return atom[:place], "..", atom[place + 2 :]
    return atom, "", ""


def _steps(plus: str | None, number: str | None) -> int | None:
    return None if not plus else int(number) if number else -1


def _check(atom: _Atom) -> Problem | None:
    key, colon, value = atom.text.partition(":")
    if colon:
        if key not in KEYS:
            guess = closest(key, KEYS)
            said = f"did you mean `{guess}:`?" if guess else f"keys are {', '.join(KEYS)}"
            return Problem(f"there is no key `{key}:`", atom.start, atom.end, help=said)
        if not _unquoted(value):
            return Problem(f"`{key}:` needs a value", atom.start, atom.end)
        return None
    if not _PATH.match(atom.text) or not all(atom.text.split(".")):
        return Problem(
            f"`{atom.text}` is no path", atom.start, atom.end, help='a value with blanks is quoted: type:"Point cloud"'
        )
    return None


def _unquoted(value: str) -> str:
    return value[1:-1] if len(value) > 1 and value[0] == value[-1] == '"' else value.replace('"', "")


class _Run:
    """Evaluates terms against one architecture, and collects what is wrong."""

    def __init__(self, architecture: Architecture, findings: Mapping[str, frozenset[str]]) -> None:
        self.architecture = architecture
        self.findings = findings
        self.problems: list[Problem] = []
        self.refused: set[str] = set()
        self._flow: Graph | None = None

    @property
    def flow(self) -> Graph:
        """Read the flow off the architecture once, when a word first asks for it."""
        self._flow = self._flow or graph.components(self.architecture)
        return self._flow

    def term(self, term: _Term) -> tuple[frozenset[str], frozenset[str]]:
        """Give the components and the nodes that a word names."""
        components, nodes = self.atom(term.atom)
        if term.to is not None:
            ends, _ = self.atom(term.to)
            components = frozenset(reach(self.flow.after, components)) & frozenset(reach(self.flow.before, ends))
            nodes = frozenset()
        else:
            found = set(components)
            if term.up is not None:
                found |= reach(self.flow.before, components, None if term.up < 0 else term.up).keys()
            if term.down is not None:
                found |= reach(self.flow.after, components, None if term.down < 0 else term.down).keys()
            components = frozenset(found)
        if term.negative:
            self.refused |= nodes
        return components, nodes

    def atom(self, atom: _Atom) -> tuple[frozenset[str], frozenset[str]]:
        """Give the components and nodes of a path or of a key with its value."""
        key, colon, value = atom.text.partition(":")
        return self._keyed(atom, key, _unquoted(value)) if colon else self._path(atom)

    def _path(self, atom: _Atom) -> tuple[frozenset[str], frozenset[str]]:
        found = list(self._named(atom.text))
        components = frozenset(c for kind, name in found for c in self._components(kind, name))
        nodes = frozenset(name for kind, name in found if kind == "node")
        if not found:
            self._nothing(atom)
        return components, nodes

    def _named(self, path: str) -> Iterator[tuple[str, str]]:
        """Find what a path names: a complete path first; else all that end in its words; with `*` all that fit."""
        a = self.architecture
        sorts = (
            ("group", a.groups),
            ("component", a.components),
            ("output", a.outputs),
            ("input", a.inputs),
            ("node", a.nodes),
        )
        if "*" not in path:
            exact = [(kind, path) for kind, elements in sorts if path in elements]
            if exact:
                yield from exact
                return
        fits = _pattern(path)
        yield from ((kind, name) for kind, elements in sorts for name in elements if fits(name))

    def _components(self, kind: str, name: str) -> Iterable[str]:
        a = self.architecture
        if kind == "group":
            return [component.id for component in a.groups[name].components.values()]
        if kind == "node":
            return a.nodes[name].implements
        if kind == "component":
            return [name]
        return [(a.outputs.get(name) or a.inputs[name]).component]

    def _nothing(self, atom: _Atom) -> None:
        if "*" in atom.text:
            self.problems.append(Problem(f"nothing fits `{atom.text}`", atom.start, atom.end, "warning"))
            return
        a = self.architecture
        known = [part for name in (*a.groups, *a.components, *a.nodes) for part in (name, name.rpartition(".")[2])]
        guess = closest(atom.text, known)
        said = f"did you mean `{guess}`?" if guess else None
        self.problems.append(Problem(f"nothing is called `{atom.text}`", atom.start, atom.end, help=said))

    def _keyed(self, atom: _Atom, key: str, value: str) -> tuple[frozenset[str], frozenset[str]]:
        components, nodes = _MATCHERS[key](self, value)
        found = frozenset(components), frozenset(nodes)
        if not found[0] and not found[1]:
            self.problems.append(Problem(f"nothing has `{atom.text}`", atom.start, atom.end, "warning"))
        return found


@cache
def _pattern(path: str) -> Callable[[str], bool]:
    """Make the test of a path whose leading parts may be left out and whose `*` stand for any run within one id."""
    wanted = [re.compile(translate(part)) for part in path.split(".")]

    def fits(name: str) -> bool:
        parts = name.split(".")[-len(wanted) :]
        return len(parts) == len(wanted) and all(test.match(part) for test, part in zip(wanted, parts, strict=True))

    return fits


Found = tuple[Iterable[str], Iterable[str]]


def _by_component(test: Callable[[Component, str], bool]) -> Callable[[_Run, str], Found]:
    def match(run: _Run, value: str) -> Found:
        return [c.id for c in run.architecture.components.values() if test(c, value)], ()

    return match


def _tag(run: _Run, value: str) -> Found:
    a = run.architecture
    groups = {g.id for g in a.groups.values() if value in g.tags}
    hosts = {h.id for h in a.hosts.values() if value in h.tags}
    nodes = [n for n in a.nodes.values() if value in n.tags or n.host in hosts]
    required = {r.id for r in a.requirements.values() if value in r.tags}
    components = {
        c.id
        for c in a.components.values()
        if value in c.tags or c.group in groups or any(use.text in required for use in c.requirements if use.is_id)
    }
    return components.union(*(n.implements for n in nodes)), [n.id for n in nodes]


def _owner(run: _Run, value: str) -> Found:
    a = run.architecture
    nodes = [n for n in a.nodes.values() if n.owner == value]
    own = {c.id for c in a.components.values() if c.owner == value}
    return own, [n.id for n in nodes]


def _type(run: _Run, value: str) -> Found:
    a = run.architecture
    message = full_message(value)
    names = {t.name for t in a.types.values() if t.name == value or (message and t.message == message)}
    ports: list[Input | Output] = [*a.outputs.values(), *(port for port in a.inputs.values() if port.type)]
    readers = [edge.input for edge in a.edges if a.outputs[edge.output].type in names]
    return {p.component for p in ports if p.type in names} | {a.inputs[name].component for name in readers}, ()


def _medium(component: Component, value: str) -> bool:
    ports: tuple[Input | Output, ...] = (*component.inputs.values(), *component.outputs.values())
    return any(("physical" if port.physical else "digital") == value for port in ports)


def _nodes(test: Callable[[_Run, str], Callable[[object], bool]]) -> Callable[[_Run, str], Found]:
    def match(run: _Run, value: str) -> Found:
        fits = test(run, value)
        nodes = [n for n in run.architecture.nodes.values() if fits(n)]
        return {c for n in nodes for c in n.implements}, [n.id for n in nodes]

    return match


def _finding(run: _Run, value: str) -> Found:
    a = run.architecture
    elements = run.findings.get(value, frozenset())
    ports = {p.component for name in elements if (p := a.outputs.get(name) or a.inputs.get(name))}
    groups = {c.id for name in elements if name in a.groups for c in a.groups[name].components.values()}
    nodes = [name for name in elements if name in a.nodes]
    implemented = {c for name in nodes for c in a.nodes[name].implements}
    return {name for name in elements if name in a.components} | ports | groups | implemented, nodes


def _behaviour(run: _Run, value: str) -> Found:
    a = run.architecture
    nodes = [n for n in a.nodes.values() if any(t.behaviour == value for t in n.timing.values())]
    own = {c.id for c in a.components.values() if c.timing and c.timing.behaviour == value}
    return own | {c for n in nodes for c, t in n.timing.items() if c and t.behaviour == value}, [n.id for n in nodes]


_MATCHERS: dict[str, Callable[[_Run, str], Found]] = {
    "tag": _tag,
    "owner": _owner,
    "status": _nodes(lambda _run, value: lambda node: getattr(node, "status", None) == value),
    "type": _type,
    "medium": _by_component(_medium),
    "role": _by_component(lambda component, value: component.role == value),
    "host": _nodes(lambda _run, value: lambda node: getattr(node, "host", None) == value),
    "package": _nodes(lambda _run, value: lambda node: getattr(node, "package", None) == value),
    "requirement": _by_component(
        lambda component, value: any(use.is_id and use.text == value for use in component.requirements)
    ),
    "behaviour": _behaviour,
    "finding": _finding,
    "node": _nodes(lambda _run, value: lambda node: bool(_pattern(value)(getattr(node, "id", "")))),
}
