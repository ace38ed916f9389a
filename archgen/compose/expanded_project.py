"""A project with everything written out: its leaves, what stands around them, and what they are made from.

Types are named with what generic ones stand for: `filter<Pose>`, `pair<Pose, Envelope<Twist>>`.
"""

from __future__ import annotations

import re
from collections.abc import Mapping

from archgen.diagnostics import Diagnostic, Span
from archgen.frozen import NamedTuple, dataclass, field
from archgen.model.generic_names import MAX_NAME_LENGTH, read_generic_name
from archgen.syntax.yaml_tree import MappingEntry, MappingNode

MAX_TYPE_LENGTH = 2 * MAX_NAME_LENGTH
"""So many letters the name of a bound type may have: a generic type that holds itself twice doubles it each time."""
_WORD = re.compile(r"[^<>,]+")
_ARRAY = re.compile(r"\[(?:<=)?[0-9]*\]\Z")


class TypeExpression(NamedTuple):
    """A type's name, and the types that its generic names stand for; none where it is not generic."""

    name: str
    arguments: tuple[str, ...]

    def __str__(self) -> str:
        """Return the expression as it is written."""
        return f"{self.name}<{', '.join(self.arguments)}>" if self.arguments else self.name


def parse_type_expression(text: str) -> TypeExpression | None:
    """Return the parts of `name<A, B<C>>`; None if its brackets do not match or something is missing."""
    generic_name = read_generic_name(text.strip())
    if not generic_name.base or not {"<", ">"}.isdisjoint(generic_name.base):
        return None
    return TypeExpression(generic_name.base, generic_name.arguments)


def bind_type_name(text: str, bindings: Mapping[str, str]) -> str:
    """Return a type's name, or an array of it, with generic names replaced, also those inside of brackets."""
    if text in bindings:
        return bindings[text]
    if (array := _ARRAY.search(text)) is not None:
        return bind_type_name(text[: array.start()], bindings) + array[0]
    if "<" not in text:
        return text
    return _WORD.sub(lambda match: _bind_word(match[0], bindings), text)


def _bind_word(word: str, bindings: Mapping[str, str]) -> str:
    bare = word.strip()
    return word.replace(bare, bindings[bare], 1) if bare in bindings else word


@dataclass(slots=True)
class InstanceOrigin:
    """Which component type a component is made from."""

    expression: TypeExpression
    is_reference: bool
    """Whether it is exactly the type (`same_as`)."""
    at: Span


@dataclass(slots=True)
class ComponentShell:
    """A component that holds components: its entry without them, and the ids of those directly inside."""

    id: str
    group: str
    parent: str | None
    """The id of the component around it, None where it stands directly in its group."""
    entry: MappingEntry
    children: tuple[str, ...] = ()
    parts: dict[str, MappingEntry] = field(default_factory=dict)
    """What stands directly inside, by id, as it is written there or in the type: instances are not written out."""


@dataclass(slots=True)
class Expansion:
    """A component's body with everything written out, what it is made from, and how many components it stands for."""

    written: MappingNode
    """What it was made of: kept alive, since expansions are found by its identity."""
    body: MappingNode
    origin: InstanceOrigin | None
    parts: dict[str, tuple[MappingEntry, Expansion]]
    size: int


@dataclass(slots=True)
class ExpandedProject:
    """A project with everything written out: `root` has leaves only below its groups."""

    root: MappingNode
    is_plain: bool = False
    """Whether nothing is composed and nothing an instance: it is as it was written."""
    type_bodies: dict[str, MappingNode] = field(default_factory=dict)
    """Component types by name, with what they are made from: the project's own, then those it uses of libraries."""
    type_entries: dict[str, MappingEntry] = field(default_factory=dict)
    """The same component types as they are written."""
    shells: dict[str, ComponentShell] = field(default_factory=dict)
    """Composed components by complete id, outer ones first."""
    instances: dict[str, InstanceOrigin] = field(default_factory=dict)
    """What leaves and shells are made from, by complete id."""
    parents: dict[str, str] = field(default_factory=dict)
    """The shell around each leaf and shell that has one, by complete ids."""
    container_holders: dict[str, str] = field(default_factory=dict)
    """The component that brings along each container that is not the project's own, by id."""
    parts: dict[str, list[tuple[MappingEntry, Expansion]]] = field(default_factory=dict)
    """What stands directly in each group, as it is written and with everything written out."""
    damaged_elements: frozenset[str] = frozenset()
    """Components of which the type is not known: what they have is not known either."""
    diagnostics: tuple[Diagnostic, ...] = ()
