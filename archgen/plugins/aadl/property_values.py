"""Find the values of properties where they count, and read them as values of the language."""

from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction

from archgen.plugins.aadl.aadl_tree import (
    AadlLink,
    AadlList,
    AadlName,
    AadlNumber,
    AadlProperty,
    AadlRange,
    AadlString,
    AadlValue,
    Path,
)
from archgen.plugins.aadl.classifier_names import ClassifierNames, fold_property_name
from archgen.plugins.aadl.resolved_classifiers import ClassifierResolver, ResolvedClassifier, ResolvedPart

_UNITS = {"ns": "ns", "us": "us", "ms": "ms", "sec": "s", "s": "s", "min": "min", "hr": "h", "h": "h"}
_SIZES = {"bytes": "B", "kbyte": "kB", "mbyte": "MB", "gbyte": "GB"}
_BYTES_A_SECOND = {
    f"{prefix.lower()}{written}": f"{prefix}{unit}"
    for prefix in ("", "k", "M", "G")
    for written, unit in (("bytesps", "B/s"), ("bitsps", "bit/s"), ("bps", "bit/s"))
}
_INHERITED = ("period", "priority")
"""What counts for all threads in what it is written of."""
_MAX_CONSTANTS = 20
_MAX_PLACES = 18


@dataclass(slots=True)
class PropertyScope:
    """Where a classifier stands: the associations around it count before its own.

    `layers` are what is around it, the outermost first, each with the path from there to it.
    """

    resolver: ClassifierResolver
    inner: ResolvedClassifier | None
    layers: tuple[tuple[ResolvedClassifier, Path], ...] = ()
    hidden: ResolvedClassifier | None = None
    """The type of an instance of which only what is written around it is asked for; `hidden_path` leads on from there."""
    hidden_path: Path = ()

    def find(self, path: Path, name: str) -> AadlProperty | None:
        """Return the association of a property to what stands at a path, or None."""
        found = [outer.properties.get((prefix + path, name)) for outer, prefix in self.layers]
        found.append(self._find_inside(self.inner, path, name) if self.inner else None)
        for association in found:
            # The others are written over: they are not left out.
            self.resolver.mark_used(association)
        return next(filter(None, found), None)

    def _find_inside(self, resolved: ResolvedClassifier, path: Path, name: str) -> AadlProperty | None:
        if found := resolved.properties.get((path, name)):
            self.resolver.mark_used(found)
            return found
        if not path:
            return None
        part = resolved.parts.get(path[0])
        if part is None:
            connection = resolved.connections.get(path[0]) if len(path) == 1 else None
            port = resolved.ports.get(path[0]) if len(path) == 1 else None
            flow = (
                (resolved.flows.get((path[0], False)) or resolved.flows.get((path[0], True)))
                if len(path) == 1
                else None
            )
            written = [*(port.written.properties if port else []), *(connection.properties if connection else [])]
            return self._find_written([*written, *(flow.properties if flow else [])], (), name)
        if found_here := self._find_written(part.written.properties, path[1:], name):
            return found_here
        inner = self.resolver.resolve(part.use)
        return self._find_inside(inner, path[1:], name) if inner else None

    def _find_written(self, written: list[AadlProperty], path: Path, name: str) -> AadlProperty | None:
        for association in reversed(written):
            paths = [tuple(step.lower() for step in target) for target in association.paths] or [()]
            if path in paths and fold_property_name(association.name) == name:
                self.resolver.mark_used(association)
                return association
        return None

    def value(self, path: Path, *names: str) -> AadlValue | None:
        """Return the value of the first of these properties that has one; constants are looked up."""
        for name in names:
            if found := self.find(path, name):
                return fold_value(found.value, self.resolver.names)
        return None

    def find_inherited(self, path: Path, name: str) -> AadlProperty | None:
        """Return the association of a property that counts for all that stands in what it is written of."""
        ways = [path[:length] for length in range(len(path), -1, -1)]
        for way in ways:
            if found := self.find(way, name):
                return found
        if any(self.find_hidden(way, name) for way in ways):
            return None
        for outer, prefix in reversed(self.layers):
            for length in range(len(prefix) - 1, -1, -1):
                if found := outer.properties.get((prefix[:length], name)):
                    self.resolver.mark_used(found)
                    return found
        return None

    def inherited_value(self, path: Path, name: str) -> AadlValue | None:
        """Return the value of such a property; constants are looked up."""
        found = self.find_inherited(path, name)
        return fold_value(found.value, self.resolver.names) if found else None

    def go_into(self, part: ResolvedPart, inner: ResolvedClassifier | None) -> PropertyScope:
        """Return the scope of a subcomponent."""
        name = part.written.name.lower()
        layers = [(outer, (*prefix, name)) for outer, prefix in self.layers]
        if self.inner is not None:
            layers.append((self.inner, (name,)))
        if part.written.properties:
            layers.append((_wrap_properties(part), ()))
        return PropertyScope(self.resolver, inner, tuple(layers))

    def find_hidden(self, path: Path, name: str) -> AadlProperty | None:
        """Return what the type of an instance itself says of it."""
        return self._find_inside(self.hidden, (*self.hidden_path, *path), name) if self.hidden else None

    def go_below(self, part: ResolvedPart) -> PropertyScope:
        """Return what is written around an instance of something in whose type a subcomponent stands, for that."""
        name = part.written.name.lower()
        layers = tuple((outer, (*prefix, name)) for outer, prefix in self.layers)
        return PropertyScope(self.resolver, None, layers, self.hidden, (*self.hidden_path, name))

    def says_anything(self) -> bool:
        """Whether an association around the classifier applies to it or to something in it, or is handed down to it."""
        return any(
            prefix in outer.list_prefixes()
            or any((prefix[:length], name) in outer.properties for length in range(len(prefix)) for name in _INHERITED)
            for outer, prefix in self.layers
        )

    def only_around(self) -> PropertyScope:
        """Return the scope without the classifier's own associations: what is written of this instance alone."""
        return PropertyScope(self.resolver, None, self.layers, self.inner)


def _wrap_properties(part: ResolvedPart) -> ResolvedClassifier:
    """Return the associations in the braces of a subcomponent, as if they were a classifier's."""
    wrapped = ResolvedClassifier(part.owner)
    for association in part.written.properties:
        for path in association.paths or ((),):
            key = (tuple(step.lower() for step in path), fold_property_name(association.name))
            wrapped.properties[key] = association
    return wrapped


def fold_value(value: AadlValue, names: ClassifierNames) -> AadlValue:
    """Return a value with constants looked up."""
    for _ in range(_MAX_CONSTANTS):
        if not isinstance(value, AadlName) or "::" not in value.name:
            break
        constant = names.find_constant(value.name)
        if constant is None:
            break
        value = constant
    if isinstance(value, AadlRange):
        return AadlRange(fold_value(value.low, names), fold_value(value.high, names))
    return value


def read_texts(value: AadlValue | None) -> list[str]:
    """Return the texts of a list of texts, or of one."""
    if isinstance(value, AadlString):
        return [value.text]
    if isinstance(value, AadlList):
        return [item.text for item in value.items if isinstance(item, AadlString)]
    return []


def read_first_text(value: AadlValue | None) -> str:
    """Return the text of a value, the first of a list, or nothing."""
    return next(iter(read_texts(value)), "")


def read_word(value: AadlValue | None) -> str:
    """Return a word of an enumeration in lower case, or nothing; of a list with one word that word."""
    if isinstance(value, AadlList) and len(value.items) == 1:
        value = value.items[0]
    return value.name.lower() if isinstance(value, AadlName) else ""


def read_count(value: AadlValue | None) -> int | None:
    """Return a whole number that is not negative, or None."""
    if isinstance(value, AadlNumber) and not value.unit and value.value.denominator == 1 and value.value >= 0:
        return int(value.value)
    return None


def read_references(value: AadlValue | None) -> list[Path]:
    """Return the paths of references in lower case."""
    items = value.items if isinstance(value, AadlList) else (value,)
    return [
        tuple(step.lower() for step in item.path)
        for item in items
        if isinstance(item, AadlLink) and item.kind == "reference"
    ]


def read_duration(value: AadlValue | None) -> str | None:
    """Return a time as the language writes it, or None."""
    if isinstance(value, AadlNumber) and value.unit.lower() == "ps":
        return write_number(value.value / 1000, "ns") if value.value >= 0 else None
    return _read_quantity(value, _UNITS)


def _read_quantity(value: AadlValue | None, units: dict[str, str]) -> str | None:
    if not isinstance(value, AadlNumber) or value.value < 0 or value.unit.lower() not in units:
        return None
    return write_number(value.value, units[value.unit.lower()])


def read_time_range(value: AadlValue | None) -> tuple[str | None, str | None]:
    """Return the lower and the upper end of a time; of a single time both are it."""
    if isinstance(value, AadlRange):
        return read_duration(value.low), read_duration(value.high)
    single = read_duration(value)
    return single, single


def read_size(value: AadlValue | None) -> str | None:
    """Return a size of data as the language writes it, or None."""
    return _read_quantity(value, _SIZES)


def read_bandwidth(value: AadlValue | None) -> str | None:
    """Return data a second as the language writes it, or None."""
    return _read_quantity(value, _BYTES_A_SECOND) if isinstance(value, AadlNumber) and value.value > 0 else None


def write_number(number: Fraction, unit: str) -> str | None:
    """Return a number with its unit if the language can write it exactly, else None."""
    for places in range(_MAX_PLACES + 1):
        scaled = number * 10**places
        if scaled.denominator == 1:
            whole, rest = divmod(int(scaled), 10**places)
            if whole >= 10**_MAX_PLACES:
                return None
            decimals = f".{rest:0{places}}" if places else ""
            return f"{whole}{decimals} {unit}"
    return None
