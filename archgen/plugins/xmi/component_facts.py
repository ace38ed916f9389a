"""Which classes are components, which component types and which data, and what each is made from.

The ways from classes up to what they are made from: where they end, and which are too long.
"""

from __future__ import annotations

from collections import Counter, defaultdict
from dataclasses import dataclass, field

from archgen.plugin.importing import XmlElement
from archgen.plugins.xmi.import_ledger import OWN_PREFIX, ImportLedger, name_element
from archgen.plugins.xmi.port_facts import InterfaceUses, PortFacts
from archgen.plugins.xmi.uml_catalogue import UmlCatalogue
from archgen.plugins.xmi.uml_data_types import TemplateClasses, TypeArguments
from archgen.plugins.xmi.uml_index import get_id, get_kind, get_name, is_true, list_child_elements

_TYPE_PREFIX = f"{OWN_PREFIX}component_type."
_LIBRARY_ID = f"{OWN_PREFIX}package.classes"
_COMPONENT_PREFIX = f"{OWN_PREFIX}component."
_DATA_PREFIX = f"{OWN_PREFIX}type."


@dataclass(slots=True, eq=False)
class ClassFacts:
    """A class or component. `element` is a property where it is a part: a place for a component of a type."""

    element: XmlElement
    sort: str
    """`component`, `component_type` or `data`."""
    id: str = ""
    owner: ClassFacts | None = None
    """What it stands in, as a component inside."""
    base: ClassFacts | None = None
    """The component type that it is made from."""
    base_arguments: TypeArguments = ()
    """What the generic names of that type stand for."""
    generic_names: tuple[str, ...] = ()
    ports: list[PortFacts] = field(default_factory=list)
    port_ids: dict[str, str] = field(default_factory=dict)
    """The names of its own ports by their ids."""
    ids_by_port_name: dict[str, str] = field(default_factory=dict)
    inside: list[ClassFacts] = field(default_factory=list)
    device: bool = False
    path: tuple[str, ...] = ()
    """Group and ids down to a component; the type's id and ids down to what stands in a type."""

    @property
    def root(self) -> ClassFacts:
        """The outermost one around it: a component of a group, or a component type."""
        return self.owner.root if self.owner else self

    def say_base(self) -> str:
        """Return the type that it is made from, as `is` says it: `filter<Pose>`."""
        name = self.base.id if self.base is not None else ""
        return f"{name}<{', '.join(self.base_arguments)}>" if self.base_arguments else name

    def list_bases(self) -> list[ClassFacts]:
        """Return the types that it is made from, the nearest first."""
        bases: dict[int, ClassFacts] = {}
        base = self.base
        while base is not None and id(base) not in bases:
            bases[id(base)] = base
            base = base.base
        return list(bases.values())


class ClassSorting:
    """Sorts the classes of a model, and finds what each is made from."""

    def __init__(self, ledger: ImportLedger, catalogue: UmlCatalogue, uses: InterfaceUses) -> None:
        self.ledger, self.catalogue, self.uses, self._index = ledger, catalogue, uses, ledger.index
        self._templates = TemplateClasses(ledger, catalogue)
        self._arguments: dict[XmlElement, TypeArguments] = {}
        """What the generic names of the class stand for that each class or component is made from."""
        self._generals = self._find_generals()
        self._realizers = self._find_realizers()
        self.with_ports = {each for each in self._templates.classes if self._has_ports(each)}
        """Components, and classes with ports."""
        self._joined_parts = self._find_joined_parts()
        self.facts: dict[XmlElement, ClassFacts] = {}
        self.parts: dict[XmlElement, ClassFacts] = {}
        self._sort_classes()

    def _has_ports(self, element: XmlElement) -> bool:
        return get_kind(element) == "Component" or bool(list_child_elements(element, "Port"))

    def _find_generals(self) -> dict[XmlElement, XmlElement]:
        """Return the class that each is made from; the first of several, none that closes a circle or is too far up."""
        written: dict[XmlElement, XmlElement] = {}
        generals: dict[XmlElement, XmlElement] = {}
        tops: dict[XmlElement, XmlElement] = {}
        known = frozenset(self._templates.classes)
        for element in self._templates.classes:
            if element in self._templates.bindings:
                generals[element], self._arguments[element] = self._templates.bindings[element]
                tops[element] = generals[element]
            for generalization in list_child_elements(element, "Generalization"):
                reference = self._index.find_reference(generalization, "general")
                unbound = self._templates.describe_unbound(reference.element) if reference and reference.element else ""
                general, arguments = (
                    self._templates.resolve(reference.element) if reference and reference.element else (None, ())
                )
                if unbound:
                    self.ledger.leave(generalization, f"{name_element(element)} is made from a template: {unbound}")
                elif general is None or general not in known:
                    words = f"{name_element(element)} is made from a class that is not among the classes of these files"
                    self.ledger.leave(generalization, words)
                elif element in generals:
                    words = f"{name_element(element)} is made from `{get_name(general)}`, too: a component type is made from one"
                    self.ledger.leave(generalization, words)
                elif find_top(tops, general) is element:
                    words = (
                        f"{name_element(element)} would be made from itself: the generalizations go round in a circle"
                    )
                    self.ledger.leave(generalization, words, "take out one of them")
                else:
                    generals[element], written[element] = general, generalization
                    self._arguments[element] = arguments
                    tops[element] = general
        for element in list_beyond(generals):
            words = f"{name_element(element)} is made from a class that is made from a class, more than {MAX_GENERALS} times"
            self.ledger.leave(written.get(element, element), words, "name a class further up")
            del generals[element]
        for generalization in (written[each] for each in generals if each in written):
            self.ledger.take(generalization)
        return generals

    def _find_realizers(self) -> dict[XmlElement, XmlElement]:
        """Return the class that realizes each component; the first of several."""
        realizers: dict[XmlElement, XmlElement] = {}
        classes = frozenset(self.catalogue.classes)  # with those that stand for bound templates
        for realization in self.catalogue.realizations:
            if realization in self.uses.used_elements:
                continue
            kind, parent = get_kind(realization), self._index.get_parent(realization)
            components = self._index.list_named(realization, "abstraction", "supplier")
            if not components and parent is not None and kind == "ComponentRealization":
                components = [parent]
            realizing = self._index.list_named(realization, "realizingClassifier", "client")
            realizing = [each for each in realizing if each in classes and each not in components]
            components = [each for each in components if get_kind(each) == "Component"]
            if realizing and (unbound := self._templates.describe_unbound(realizing[0])):
                self.ledger.refuse(realization, unbound)
                continue
            for component in components:
                for each in realizing[:1]:
                    if component in realizers:
                        words = f"{name_element(component)} is realized by `{get_name(each)}`, too: a component is made from one type"
                        self.ledger.leave(realization, words)
                    else:
                        realizers[component], self._arguments[component] = self._templates.resolve(each)
                        self.ledger.take(realization)
            if len(realizing) > 1 and components:
                names = ", ".join(get_name(each) for each in realizing[1:3])
                words = f"{name_element(components[0])} is realized by {names[:100]}, too: a component is made from one type"
                self.ledger.leave(realization, words)
            if not components or not realizing:
                self.ledger.refuse(realization, "it does not lead from a class to a component")
        return realizers

    def _sort_classes(self) -> None:
        classes = self._templates.classes
        assemblies, part_types = self._find_parts()
        realizing = set(self._realizers.values())
        generals = set(self._generals.values())
        data_uses = self._count_data_uses()
        component_family = self._find_family(realizing | self.with_ports)
        for element in classes:
            own_id = get_id(element)
            if element in self.with_ports:
                is_type = (
                    own_id.startswith(_TYPE_PREFIX)
                    or self._is_in_library(element)
                    or is_true(element, "isAbstract")
                    or element in part_types
                    or element in self._templates.generic_names
                    or element in generals
                    or element in realizing
                )
                sort = "component_type" if is_type and not own_id.startswith(_COMPONENT_PREFIX) else "component"
            elif own_id.startswith(_DATA_PREFIX):
                sort = "data"
            else:
                is_data = (
                    data_uses[element]
                    and not self._is_template(element)
                    and element not in component_family
                    and not own_id.startswith(OWN_PREFIX)
                )
                has_methods = bool(list_child_elements(element, "Operation"))
                sort = "data" if is_data and not has_methods else "component_type"
                is_free = not (
                    is_true(element, "isAbstract")
                    or self._is_template(element)
                    or data_uses[element]
                    or element in generals | realizing
                )
                if is_free and element in assemblies and not own_id.startswith(OWN_PREFIX):
                    # What only puts parts together, and is no part itself, is there once: the system.
                    sort = "component"
            names = self._templates.generic_names.get(element, ())
            self.facts[element] = ClassFacts(element, sort, generic_names=names)
        for element, facts in self.facts.items():
            base = self._realizers.get(element) or self._generals.get(element)
            if base is not None and self.facts[base].sort == "component_type":
                facts.base, facts.base_arguments = self.facts[base], self._arguments.get(element, ())
        self._cut_circles()

    def _cut_circles(self) -> None:
        """Leave out bases that lead round: a component may be realized by a class that is made from it."""
        for facts in self.facts.values():
            bases = facts.list_bases()
            if any(base is facts for base in bases):
                words = f"{name_element(facts.element)} would be made from itself"
                self.ledger.leave(facts.element, words, "take out one of the generalizations and realizations")
                facts.base = None

    def _is_in_library(self, element: XmlElement) -> bool:
        """Whether archgen wrote a class as a component type that has its id from another tool."""
        package = self._index.get_parent(element)
        return package is not None and get_id(package) == _LIBRARY_ID

    def _is_template(self, element: XmlElement) -> bool:
        return element in self._templates.generic_names or element in self._templates.bindings

    def find_part_type(self, part: XmlElement) -> tuple[ClassFacts | None, TypeArguments]:
        """Return the class of a property that is a place for a component; None where it is none, and a note why."""
        reference = self._index.find_reference(part, "type")
        if reference is None or reference.element is None or not self.is_place(part):
            return None, ()
        element, arguments = self._templates.resolve(reference.element)
        if element not in self.with_ports:
            return None, ()
        if unbound := self._templates.describe_unbound(reference.element):
            self.ledger.refuse(part, unbound)
            return None, ()
        return self.facts.get(element), arguments

    def is_place(self, element: XmlElement) -> bool:
        """Whether a property is a place for a component inside: others only refer to one that stands elsewhere."""
        return element.attributes.get("aggregation") == "composite" or element in self._joined_parts

    def _find_joined_parts(self) -> set[XmlElement]:
        """Return the properties that connectors join: they stand inside, whatever else is written of them."""
        return {
            part
            for connector in self.catalogue.connectors
            for end in list_child_elements(connector, "ConnectorEnd")
            for part in self._index.list_named(end, "partWithPort", "role")
        }

    def _find_parts(self) -> tuple[set[XmlElement], set[XmlElement]]:
        """Return the classes that have parts with ports, and the classes of these parts."""
        pairs = [
            (owner, self._templates.resolve(reference.element)[0])
            for owner in self._templates.classes
            for part in list_child_elements(owner, "Property")
            if self.is_place(part)
            and (reference := self._index.find_reference(part, "type"))
            and reference.element is not None
            and self._templates.resolve(reference.element)[0] in self.with_ports
        ]
        return {owner for owner, _ in pairs}, {part for _, part in pairs}

    def _find_family(self, members: set[XmlElement]) -> set[XmlElement]:
        """Return classes with all that they are made from and all that is made from them."""
        family = set(members)
        for member in members:
            current = self._generals.get(member)
            while current is not None and current not in family:
                family.add(current)
                current = self._generals.get(current)
        derived = defaultdict(list)
        for special, general in self._generals.items():
            derived[general].append(special)
        stack = list(family)
        while stack:
            for special in derived[stack.pop()]:
                if special not in family:
                    family.add(special)
                    stack.append(special)
        return family

    def _count_data_uses(self) -> Counter[XmlElement]:
        """Count how often a class is the type of a port, a property or a parameter."""
        uses: Counter[XmlElement] = Counter()
        owners = (*self.catalogue.classes, *self.catalogue.interfaces, *self.catalogue.data_types)
        for owner in owners:
            for feature in list_child_elements(owner, "Property", "Port", "Operation"):
                typed = list_child_elements(feature, "Parameter") if get_kind(feature) == "Operation" else [feature]
                uses.update(each for element in typed for each in self._index.list_named(element, "type"))
        return uses


MAX_GENERALS = 50
"""So many classes may stand one above another: the language reads 60 types, and a component is realized by one more."""


def find_top(tops: dict[XmlElement, XmlElement], element: XmlElement) -> XmlElement:
    """Return the class at the end of the way from each class to what it is made from; ways that were gone get shorter."""
    passed = []
    while element in tops:
        passed.append(element)
        element = tops[element]
    for each in passed:
        tops[each] = element
    return element


def list_beyond(generals: dict[XmlElement, XmlElement]) -> list[XmlElement]:
    """Return the classes whose way up is to be cut, so that none is longer than `MAX_GENERALS`."""
    beyond = []
    lengths: dict[XmlElement, int] = {}
    for start in generals:
        way = []
        current: XmlElement | None = start
        while current is not None and current not in lengths:
            way.append(current)
            current = generals.get(current)
        length = lengths[current] if current is not None else -1
        for each in reversed(way):
            length = length + 1
            if length > MAX_GENERALS:
                beyond.append(each)
                length = 0
            lengths[each] = length
    return beyond
