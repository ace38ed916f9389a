"""What an AADL file holds, as it is written: names are not yet looked up."""

from __future__ import annotations

from dataclasses import dataclass, field
from fractions import Fraction

from archgen.plugin.importing import NO_SPAN, Span

Path = tuple[str, ...]
"""A path of names, as `publisher.msg_out`; in lower case only where it is compared."""
Modes = tuple[str, ...]
"""The modes in which something counts, as they are written; empty where it counts in all."""


@dataclass(slots=True)
class AadlNumber:
    """A number with its unit, which is empty where none is written."""

    value: Fraction
    unit: str = ""


@dataclass(slots=True)
class AadlRange:
    """A range; its ends are numbers or names of constants."""

    low: AadlValue
    high: AadlValue


@dataclass(slots=True)
class AadlString:
    """A text in quotes."""

    text: str


@dataclass(slots=True)
class AadlName:
    """A bare name: a word of an enumeration, `true`, `false`, or a constant."""

    name: str


@dataclass(slots=True)
class AadlRecord:
    """A record `[a => 1; b => 2;]`."""

    fields: dict[str, AadlValue]


@dataclass(slots=True)
class AadlList:
    """A list `(a, b)`."""

    items: tuple[AadlValue, ...]


@dataclass(slots=True)
class AadlLink:
    """`reference (a.b)`, `classifier (p::c)`, `compute (f)`: the word, and what stands in the brackets."""

    kind: str
    path: Path


AadlValue = AadlNumber | AadlRange | AadlString | AadlName | AadlRecord | AadlList | AadlLink


@dataclass(slots=True)
class AadlProperty:
    """A property association; `paths` is what it applies to, empty where that is what it stands in."""

    name: str
    value: AadlValue
    span: Span
    paths: tuple[Path, ...] = ()
    appended: bool = False
    modes: Modes = ()
    other_values: tuple[tuple[AadlValue, Modes], ...] = ()
    """Further values, with the modes in which they count."""
    made_from: tuple[AadlProperty, ...] = ()
    """The associations that it was put together from: what its list goes on behind, or the one with all values."""


@dataclass(slots=True)
class AadlFeature:
    """A feature; `kind` is `data port`, `event data port`, `event port`, `data access`, `feature group`, ..."""

    name: str
    kind: str
    span: Span
    direction: str = ""
    """`in`, `out`, `in out`, `requires` or `provides`."""
    classifier: str = ""
    inverse: bool = False
    refined: bool = False
    dimensions: tuple[str, ...] = ()
    properties: list[AadlProperty] = field(default_factory=list)


@dataclass(slots=True)
class PrototypeBinding:
    """What a prototype stands for: a category and a classifier with bindings of its own."""

    category: str
    classifier: str
    bindings: dict[str, PrototypeBinding] = field(default_factory=dict)


@dataclass(slots=True)
class Prototype:
    """A prototype, what it may stand for."""

    name: str
    category: str
    classifier: str = ""
    span: Span = NO_SPAN


@dataclass(slots=True)
class Subcomponent:
    """A subcomponent, or a call of a subprogram."""

    name: str
    category: str
    span: Span
    classifier: str = ""
    bindings: dict[str, PrototypeBinding] = field(default_factory=dict)
    refined: bool = False
    dimensions: tuple[str, ...] = ()
    modes: Modes = ()
    properties: list[AadlProperty] = field(default_factory=list)


@dataclass(slots=True)
class AadlConnection:
    """A connection; one that refines another may have no ends."""

    name: str
    kind: str
    source: Path
    target: Path
    span: Span
    both_ways: bool = False
    refined: bool = False
    properties: list[AadlProperty] = field(default_factory=list)
    modes: Modes = ()


@dataclass(slots=True)
class AadlFlow:
    """A flow: `kind` is source, sink, path or `end to end`; `steps` are the features, or subcomponents and connections."""

    name: str
    kind: str
    steps: tuple[Path, ...]
    span: Span
    refined: bool = False
    properties: list[AadlProperty] = field(default_factory=list)
    modes: Modes = ()


@dataclass(slots=True)
class Classifier:
    """A type or an implementation of any category, or a feature group type."""

    category: str
    name: str
    """`talker`, or `talker.impl`."""
    span: Span
    extends: str = ""
    bindings: dict[str, PrototypeBinding] = field(default_factory=dict)
    inverse_of: str = ""
    prototypes: list[Prototype] = field(default_factory=list)
    features: list[AadlFeature] = field(default_factory=list)
    subcomponents: list[Subcomponent] = field(default_factory=list)
    connections: list[AadlConnection] = field(default_factory=list)
    calls: list[Subcomponent] = field(default_factory=list)
    flows: list[AadlFlow] = field(default_factory=list)
    modes: list[str] = field(default_factory=list)
    initial_mode: str = ""
    properties: list[AadlProperty] = field(default_factory=list)
    annexes: list[tuple[str, Span]] = field(default_factory=list)

    @property
    def is_implementation(self) -> bool:
        """Whether it is an implementation."""
        return "." in self.name


@dataclass(slots=True)
class AadlPackage:
    """A package, its public and its private part as one."""

    name: str
    span: Span
    uses: list[tuple[str, Span]] = field(default_factory=list)
    """Packages and property sets that it names with `with`."""
    renames: dict[str, str] = field(default_factory=dict)
    """What short names stand for, in lower case; a key `*` plus a package's name is `renames package::all`."""
    classifiers: list[Classifier] = field(default_factory=list)
    properties: list[AadlProperty] = field(default_factory=list)
    annexes: list[tuple[str, Span]] = field(default_factory=list)


@dataclass(slots=True)
class PropertySet:
    """A property set: which properties it has, and the values of its constants."""

    name: str
    span: Span
    uses: list[tuple[str, Span]] = field(default_factory=list)
    properties: dict[str, Span] = field(default_factory=dict)
    types: dict[str, Span] = field(default_factory=dict)
    constants: dict[str, AadlValue] = field(default_factory=dict)
