"""Classifiers with all that they have from what they extend; what prototypes stand for is put in.

Classifiers of AADL written out: what each is used for, its ports and parts, and all that it inherits.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, replace

from archgen.plugin.importing import WorkBudget
from archgen.plugins.aadl.aadl_tree import (
    AadlConnection,
    AadlFeature,
    AadlFlow,
    AadlList,
    AadlProperty,
    AadlValue,
    Classifier,
    Modes,
    Path,
    PrototypeBinding,
    Subcomponent,
)
from archgen.plugins.aadl.classifier_names import ClassifierNames, KnownClassifier, fold_property_name
from archgen.plugins.aadl.import_notes import NoteList

UNBOUND = "prototype"
"""The category of a prototype for which nothing stands."""
_MAX_PARENTS = 150
"""So many classifiers may extend one another: more than any model has, and less than Python can go down."""
_MAX_STEPS = 200_000
"""So many things may be inherited, all classifiers together."""


class ClassifierResolver:
    """Writes classifiers out, each once for the values of its prototypes."""

    def __init__(self, names: ClassifierNames, notes: NoteList) -> None:
        self.names, self.notes = names, notes
        self.used: set[int] = set()
        """Associations that were taken, by identity, so that the others can be told."""
        self.overridden: set[int] = set()
        """Associations, by identity, that others write over where they stand."""
        self._resolved: dict[tuple[str, str], ResolvedClassifier] = {}
        self._open: set[int] = set()
        self._budget = WorkBudget(_MAX_STEPS)

    def mark_used(self, association: AadlProperty | None) -> None:
        """Remember an association that was taken, with what it was put together from."""
        waiting = [association] if association else []
        while waiting:
            each = waiting.pop()
            self.used.add(id(each))
            waiting += each.made_from

    def resolve_known(self, known_classifier: KnownClassifier) -> ResolvedClassifier:
        """Return a classifier of the files with all that it inherits."""
        use = ClassifierUse(known_classifier.full_name, known_classifier)
        return self.resolve(use) or ResolvedClassifier(known_classifier)

    def resolve(self, use: ClassifierUse) -> ResolvedClassifier | None:
        """Return what is used with all that it inherits, or None where it is in no file."""
        if use.known is None:
            return None
        key = (use.known.key, _name_bindings(use.bindings))
        if key not in self._resolved:
            self._resolved[key] = self._write_out(use.known, use.bindings)
        return self._resolved[key]

    def find_use(
        self,
        name: str,
        bindings: Mapping[str, PrototypeBinding],
        place: KnownClassifier,
        env: Mapping[str, ClassifierUse],
    ) -> ClassifierUse:
        """Return what a name means at a place; a prototype's is what it stands for."""
        if name.lower() in env:
            return env[name.lower()]
        known = self.names.find(name, place.package)
        values = {key: self._bind(binding, place, env) for key, binding in bindings.items()}
        return ClassifierUse(name, known, values)

    def _bind(
        self, binding: PrototypeBinding, place: KnownClassifier, env: Mapping[str, ClassifierUse]
    ) -> ClassifierUse:
        use = self.find_use(binding.classifier, binding.bindings, place, env) if binding.classifier else ClassifierUse()
        return replace(use, category=binding.category)

    def _write_out(
        self, known_classifier: KnownClassifier, bindings: Mapping[str, ClassifierUse]
    ) -> ResolvedClassifier:
        resolved = ResolvedClassifier(known_classifier)
        classifier = known_classifier.classifier
        if id(classifier) in self._open:
            words = f"{known_classifier.full_name} extends itself in the end; what it extends is left out here"
            self.notes.add_contradiction("extends", words, classifier.span)
            return resolved
        if len(self._open) > _MAX_PARENTS:
            self.notes.add_contradiction(
                "extends", f"more than {_MAX_PARENTS} classifiers extend one another", classifier.span
            )
            return resolved
        self._open.add(id(classifier))
        env = {
            prototype.name.lower(): self.find_use(prototype.classifier, {}, known_classifier, {})
            if prototype.classifier
            else ClassifierUse(prototype.name, category=UNBOUND)
            for prototype in classifier.prototypes
        } | dict(bindings)
        for parent in self._list_parents(known_classifier, env):
            if len(parent.ancestors) > _MAX_PARENTS:
                self.notes.add_counted(
                    "extends", f"more than {_MAX_PARENTS} classifiers extend one another", classifier.span
                )
            elif self._budget.pay(parent.count_members()):
                self._add_inherited(resolved, parent)
            elif words := self._budget.tell_excess():
                self.notes.add("extends", words, classifier.span)
        self._open.discard(id(classifier))
        resolved.prototypes |= env
        resolved.initial_mode = classifier.initial_mode.lower() or resolved.initial_mode
        self._add_own(resolved, classifier, resolved.prototypes)
        return resolved

    def _list_parents(
        self, known_classifier: KnownClassifier, env: Mapping[str, ClassifierUse]
    ) -> list[ResolvedClassifier]:
        classifier = known_classifier.classifier
        uses: list[tuple[str, Mapping[str, PrototypeBinding]]] = []
        if classifier.is_implementation:
            uses.append((classifier.name.partition(".")[0], {}))
        if classifier.extends:
            uses.append((classifier.extends, classifier.bindings))
        parents: list[ResolvedClassifier] = []
        for name, own_bindings in uses:
            use = self.find_use(name, own_bindings, known_classifier, {})
            if use.known is None:
                self.notes.add_unknown_classifier(name, classifier.span)
                continue
            values = {key: self._bind(binding, known_classifier, env) for key, binding in own_bindings.items()}
            if parent := self.resolve(ClassifierUse(name, use.known, {**env, **values})):
                parents.append(parent)
        return parents

    def _add_own(self, resolved: ResolvedClassifier, classifier: Classifier, env: Mapping[str, ClassifierUse]) -> None:
        known = resolved.known
        for feature in classifier.features:
            self._add_feature(resolved, feature, env)
        for written in classifier.subcomponents:
            name = written.name.lower()
            earlier = resolved.parts.get(name)
            use = (
                self.find_use(written.classifier, written.bindings, known, env)
                if written.classifier
                else ClassifierUse()
            )
            if earlier and not written.classifier:
                use = earlier.use
            if use.name and use.known is None and use.category != UNBOUND:
                self.notes.add_unknown_classifier(use.name, written.span)
            resolved.parts[name] = ResolvedPart(written, use, written.category, known)
        _add_connections(resolved, classifier)
        _add_flows(resolved, classifier)
        resolved.calls += classifier.calls
        resolved.annexes += [name for name, _ in classifier.annexes if name not in resolved.annexes]
        for association in classifier.properties:
            for path in association.paths or ((),):
                key = (
                    tuple(step.lower() for step in path if step.lower() != "self"),
                    fold_property_name(association.name),
                )
                chosen = _choose_value(association, resolved.initial_mode)
                resolved.properties[key] = self._override(resolved, resolved.properties.get(key), chosen)

    def _override(
        self, resolved: ResolvedClassifier, earlier: AadlProperty | None, association: AadlProperty
    ) -> AadlProperty:
        """Return what counts of two associations to the same; `+=>` goes on behind the list that was there."""
        if earlier is None:
            return association
        if association.modes and not _counts_in(association.modes, resolved.initial_mode):
            # The earlier one counts in the initial mode, or was written first.
            self.overridden.add(id(association))
            return earlier
        if association.appended:
            items = [*_list_items(earlier.value), *_list_items(association.value)]
            return replace(association, value=AadlList(tuple(items)), made_from=(earlier, association))
        self.overridden.add(id(earlier))
        return association

    def _add_inherited(self, resolved: ResolvedClassifier, parent: ResolvedClassifier) -> None:
        resolved.ancestors = tuple(dict.fromkeys((*resolved.ancestors, parent.known, *parent.ancestors)))
        if resolved.known.classifier.is_implementation and not parent.known.classifier.is_implementation:
            resolved.own_type = parent
        resolved.initial_mode = parent.initial_mode or resolved.initial_mode
        resolved.prototypes.update(parent.prototypes)
        # Its own type came before, and says more of features than the type of what it extends.
        resolved.ports = {
            **resolved.ports,
            **{name: port for name, port in parent.ports.items() if name not in resolved.ports},
        }
        resolved.parts.update(parent.parts)
        resolved.connections.update(parent.connections)
        for key, flow in parent.flows.items():
            if key[1] or key not in resolved.flows:
                resolved.flows[key] = flow
        for place, association in parent.properties.items():
            is_of_type = parent.own_type is not None and parent.own_type.properties.get(place) is association
            if not is_of_type or place not in resolved.properties:
                resolved.properties[place] = association
        resolved.calls += [call for call in parent.calls if call not in resolved.calls]
        resolved.annexes += [name for name in parent.annexes if name not in resolved.annexes]

    def _add_feature(
        self, resolved: ResolvedClassifier, feature: AadlFeature, env: Mapping[str, ClassifierUse]
    ) -> None:
        earlier = resolved.ports.get(feature.name.lower())
        use = self.find_use(feature.classifier, {}, resolved.known, env) if feature.classifier else ClassifierUse()
        if earlier and not feature.classifier:
            use = earlier.use
        kind = feature.kind
        if earlier and kind == "feature":
            kind = earlier.kind
        direction = feature.direction or (earlier.direction if earlier else "")
        resolved.ports[feature.name.lower()] = ResolvedPort(feature, use, kind, direction, resolved.known)


def _choose_value(association: AadlProperty, initial_mode: str) -> AadlProperty:
    """Return an association with the value that it has in the initial mode: its own, else the one of all other modes."""
    values = ((association.value, association.modes), *association.other_values)
    chosen = next((index for index, (_, modes) in enumerate(values) if _counts_in(modes, initial_mode)), None)
    if chosen is None:
        chosen = next((index for index, (_, modes) in enumerate(values) if not modes), 0)
    if not chosen:
        return association
    value, modes = values[chosen]
    rest = (*values[:chosen], *values[chosen + 1 :])
    return replace(association, value=value, modes=modes, other_values=rest, made_from=(association,))


def _counts_in(modes: Modes, initial_mode: str) -> bool:
    return initial_mode in {mode.lower() for mode in modes}


def _list_items(value: AadlValue) -> tuple[AadlValue, ...]:
    return value.items if isinstance(value, AadlList) else (value,)


def _name_bindings(bindings: Mapping[str, ClassifierUse]) -> str:
    """Return a text that is equal for equal values of prototypes."""
    return ",".join(
        f"{name}={use.full_name.lower()}({_name_bindings(use.bindings)})" for name, use in sorted(bindings.items())
    )


def _add_connections(resolved: ResolvedClassifier, classifier: Classifier) -> None:
    for index, written in enumerate(classifier.connections):
        name = written.name.lower() or f"{resolved.known.key}#{index}"
        earlier, connection = resolved.connections.get(name), written
        if written.refined and earlier and not written.source:
            connection = replace(written, source=earlier.source, target=earlier.target)
        resolved.connections[name] = connection


def _add_flows(resolved: ResolvedClassifier, classifier: Classifier) -> None:
    for written in classifier.flows:
        key = (written.name.lower(), classifier.is_implementation and written.kind != "end to end")
        earlier, flow = resolved.flows.get(key), written
        if written.refined and earlier and not written.steps:
            flow = replace(written, steps=earlier.steps)
        resolved.flows[key] = flow


@dataclass(frozen=True, slots=True)
class ClassifierUse:
    """A classifier as it is used: its name as written, what it is (None if that is in no file), its prototypes' values."""

    name: str = ""
    known: KnownClassifier | None = None
    bindings: Mapping[str, ClassifierUse] = field(default_factory=dict)
    category: str = ""

    @property
    def full_name(self) -> str:
        """Return the complete name, or the one that is written."""
        return self.known.full_name if self.known else self.name


@dataclass(slots=True)
class ResolvedPart:
    """A subcomponent, its classifier looked up, with the package in which it is written."""

    written: Subcomponent
    use: ClassifierUse
    category: str
    owner: KnownClassifier


@dataclass(slots=True)
class ResolvedPort:
    """A feature, its classifier looked up."""

    written: AadlFeature
    use: ClassifierUse
    kind: str
    direction: str
    owner: KnownClassifier


@dataclass(slots=True, eq=False)
class ResolvedClassifier:
    """A classifier with all that it inherits, by names in lower case."""

    known: KnownClassifier
    ancestors: tuple[KnownClassifier, ...] = ()
    """What it extends and what it implements, the nearest first."""
    prototypes: dict[str, ClassifierUse] = field(default_factory=dict)
    """What its prototypes stand for."""
    ports: dict[str, ResolvedPort] = field(default_factory=dict)
    parts: dict[str, ResolvedPart] = field(default_factory=dict)
    connections: dict[str, AadlConnection] = field(default_factory=dict)
    flows: dict[tuple[str, bool], AadlFlow] = field(default_factory=dict)
    """By name, and whether it is a flow of an implementation."""
    properties: dict[tuple[Path, str], AadlProperty] = field(default_factory=dict)
    """The last association of each property, by the path that it applies to."""
    initial_mode: str = ""
    """In lower case; empty where it has no modes."""
    own_type: ResolvedClassifier | None = None
    """The type of an implementation."""
    calls: list[Subcomponent] = field(default_factory=list)
    annexes: list[str] = field(default_factory=list)
    _prefixes: set[Path] | None = None

    def count_members(self) -> int:
        """Return how much one that extends it inherits."""
        members = (*self.ports, *self.parts, *self.connections, *self.flows, *self.properties, *self.calls)
        return len(members) + len(self.ancestors) + len(self.prototypes)

    def list_prefixes(self) -> set[Path]:
        """Return all beginnings of paths to which associations apply."""
        if self._prefixes is None:
            self._prefixes = {path[:size] for path, _ in self.properties for size in range(len(path) + 1)}
        return self._prefixes

    @property
    def category(self) -> str:
        """Return its category."""
        return self.known.classifier.category

    def is_made_from(self, *names: str) -> bool:
        """Whether it or what it extends is called so (in lower case, without package and implementation)."""
        return any(entry.classifier.name.lower().partition(".")[0] in names for entry in (self.known, *self.ancestors))
