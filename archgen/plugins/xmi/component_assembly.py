"""Components put together: where each stands, its parts, its ports, and the types that instances need."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Collection
from dataclasses import dataclass, field

from archgen.plugin.importing import XmlElement, make_id
from archgen.plugins.xmi import uml_data_types
from archgen.plugins.xmi.component_facts import ClassFacts, ClassSorting
from archgen.plugins.xmi.import_ledger import ImportLedger, choose_id, name_parameter
from archgen.plugins.xmi.port_facts import PortFacts
from archgen.plugins.xmi.uml_catalogue import read_description
from archgen.plugins.xmi.uml_index import get_kind, get_name, is_true, list_child_elements

_HARDWARE = frozenset({"Node", "ExecutionEnvironment"})


class ComponentAssembly:
    """The components and component types of a model with their ids, ports and features."""

    def __init__(self, sorting: ClassSorting) -> None:
        self.sorting, self.ledger, self.catalogue = sorting, sorting.ledger, sorting.catalogue
        self._index = self.ledger.index
        self.types: dict[str, ClassFacts] = {}
        self.groups: dict[str, XmlElement] = {}
        """The packages that became groups, by id."""
        self.components: list[ClassFacts] = []
        """All of them, those that stand in others behind these."""
        self.hosted: dict[ClassFacts, XmlElement] = {}
        """The node that a component stands in."""
        self.features: dict[XmlElement, ClassFeatures] = {}
        self._group_of: dict[XmlElement, str] = {}
        self._taken_ids: dict[str, set[str]] = defaultdict(set)
        self._place_types()
        self._find_owners()
        self._add_parts()
        self._cut_containment_circles()
        self._add_devices()
        self._place_components()
        self._port_of: dict[tuple[int, XmlElement], PortFacts] = {}
        for facts in (*self.types.values(), *self.components):
            self._read_ports(facts)
        self._read_features()

    def _place_types(self) -> None:
        for facts in self.sorting.facts.values():
            if facts.sort == "component_type":
                facts.id = choose_id(facts.element, "type", self.types, known_ids=self._index.known_ids)
                facts.path = (facts.id,)
                self.types[facts.id] = facts

    def _find_owners(self) -> None:
        """Find what each component stands in: the class or node around it."""
        known = self.sorting.facts
        for facts in known.values():
            if facts.sort != "component":
                continue
            parent = self._index.get_parent(facts.element)
            while parent is not None:
                if parent in known and known[parent].sort != "data":
                    facts.owner = known[parent]
                    facts.owner.inside.append(facts)
                    break
                if get_kind(parent) in _HARDWARE:
                    self.hosted[facts] = parent
                parent = self._index.get_parent(parent)

    def _add_parts(self) -> None:
        """Add a component for each property that is a place for one: an instance of the property's type."""
        for owner in list(self.sorting.facts.values()):
            if owner.sort == "data":
                continue
            for part in list_child_elements(owner.element, "Property"):
                part_type, arguments = self.sorting.find_part_type(part)
                if part_type is None or part_type.sort != "component_type":
                    continue
                if is_true(part_type.element, "isAbstract"):
                    self.ledger.refuse(part, f"`{get_name(part_type.element)}` is abstract")
                    continue
                facts = ClassFacts(part, "component", owner=owner, base=part_type, base_arguments=arguments)
                owner.inside.append(facts)
                self.sorting.parts[part] = facts

    def _cut_containment_circles(self) -> None:
        """Leave out parts by which a type would contain itself."""
        done: set[int] = set()
        for start in self.types.values():
            self._visit_type(start, done)

    def _visit_type(self, start: ClassFacts, done: set[int]) -> None:
        active: dict[int, None] = {}
        stack: list[tuple[ClassFacts, bool]] = [(start, False)]
        while stack:
            facts, is_left = stack.pop()
            if is_left:
                active.pop(id(facts))
                done.add(id(facts))
                continue
            if id(facts) in done or id(facts) in active:
                continue
            active[id(facts)] = None
            stack.append((facts, True))
            for inner in list(facts.inside):
                if inner.base is not None and any(
                    id(each) in active for each in (inner.base, *inner.base.list_bases())
                ):
                    self.ledger.refuse(inner.element, "the component type would contain itself")
                    facts.inside.remove(inner)
                    self.sorting.parts.pop(inner.element, None)
                else:
                    stack += [(each, False) for each in (inner, inner.base) if each is not None]
            if facts.base is not None and id(facts.base) not in active:
                stack.append((facts.base, False))

    def _add_devices(self) -> None:
        """Make a component on the boundary of each device."""
        for element in self.catalogue.hardware:
            if get_kind(element) == "Device":
                self.sorting.facts[element] = ClassFacts(element, "component", device=True)
                self.ledger.take(element)

    def _place_components(self) -> None:
        outermost = [each for each in self.sorting.facts.values() if each.sort == "component" and each.owner is None]
        for facts in outermost:
            group_id = self._find_group(facts.element)
            facts.id = choose_id(facts.element, "component", self._taken_ids[group_id], known_ids=self._index.known_ids)
            self._taken_ids[group_id].add(facts.id)
            facts.path = (group_id, facts.id)
        stack = [*reversed(self.types.values()), *reversed(outermost)]
        while stack:
            facts = stack.pop()
            if facts.sort == "component":
                self.components.append(facts)
            # A port and a component inside share no name: what is told outside is the port's.
            outer = (facts, *facts.list_bases()) if facts.inside else ()
            taken = {
                make_id(get_name(port), "port") for each in outer for port in list_child_elements(each.element, "Port")
            }
            for inner in facts.inside:
                inner.id = choose_id(inner.element, "component", taken, known_ids=self._index.known_ids)
                taken.add(inner.id)
                inner.path = (*facts.path, inner.id)
            stack += reversed(facts.inside)

    def _find_group(self, element: XmlElement) -> str:
        package = self.catalogue.packages[element]
        group_id = self._group_of.get(package)
        if group_id is None:
            group_id = choose_id(package, "group", self.groups, known_ids=self._index.known_ids)
            self.groups[group_id] = package
            self._group_of[package] = group_id
            self.ledger.take(package)
        return group_id

    def _read_ports(self, facts: ClassFacts) -> None:
        if facts.element in self.sorting.parts:
            return
        ports = [self.sorting.uses.make_port(each) for each in list_child_elements(facts.element, "Port")]
        for port in ports:
            self.ledger.take(port.element)
        # What a class provides to others as code is no port of a component type: only components meet here.
        is_component = facts.sort == "component" or get_kind(facts.element) == "Component"
        facts.ports = [*ports, *(self.sorting.uses.list_bare_ports(facts.element, ports) if is_component else ())]
        self._port_of |= {(id(facts), port.element): port for port in reversed(facts.ports)}

    def _read_features(self) -> None:
        realized: dict[int, set[str]] = defaultdict(set)
        for other in self.sorting.facts.values():
            if other.base is not None:
                realized[id(other.base)] |= {get_name(each) for each in list_child_elements(other.element, "Port")}
        for facts in (*self.types.values(), *self.components):
            if facts.element in self.sorting.parts:
                self.features[facts.element] = ClassFeatures()
                self.ledger.take(facts.element)
                continue
            parts = {inner.element for inner in facts.inside}
            names = {port.name for port in facts.ports} | realized[id(facts)]
            self.features[facts.element] = read_features(self.ledger, facts.element, names, parts)
            kind = "Class" if get_kind(facts.element) == "AssociationClass" else ""
            if not facts.device:
                self.ledger.take(facts.element, kind)

    def list_ports(self) -> list[PortFacts]:
        """Return the ports of all components and component types."""
        return [port for facts in (*self.types.values(), *self.components) for port in facts.ports]

    def find_port(self, facts: ClassFacts, element: XmlElement) -> PortFacts | None:
        """Return the port of a component that an element of it or of one of its types stands for."""
        owners = (facts, *facts.list_bases())
        return next((port for each in owners if (port := self._port_of.get((id(each), element)))), None)


_PERIOD_NAME = "sample"
_VISIBILITIES = frozenset({"public", "protected", "private"})
_ANSWERS = frozenset({"return", "out"})


@dataclass(slots=True)
class ClassFeatures:
    """What the features of a class become."""

    parameters: dict[str, object] = field(default_factory=dict)
    operations: dict[str, object] = field(default_factory=dict)
    timing: dict[str, object] = field(default_factory=dict)
    data_types: dict[str, str] = field(default_factory=dict)
    """The types of its protected properties by name: the data of ports of these names."""

    def list_sections(self) -> dict[str, object]:
        """Return the keys of a component for what there is."""
        sections = {"parameters": self.parameters, "operations": self.operations, "timing": self.timing}
        return {key: value for key, value in sections.items() if value}


def read_features(
    ledger: ImportLedger, owner: XmlElement, port_names: Collection[str], parts: Collection[XmlElement]
) -> ClassFeatures:
    """Return the features of a class. `port_names` are those of its ports, `parts` what is a component inside of it."""
    reader = _FeatureReader(ledger, port_names)
    for child in list_child_elements(owner, "Property", "Operation"):
        if child in parts:
            continue
        if get_kind(child) == "Operation":
            reader.read_operation(child)
        elif child.tag in {"ownedAttribute", "attribute", "ownedMember"}:
            reader.read_property(child)
    return reader.features


class _FeatureReader:
    def __init__(self, ledger: ImportLedger, port_names: Collection[str]) -> None:
        self.features = ClassFeatures()
        self._index, self._ledger, self._port_names = ledger.index, ledger, port_names

    def read_property(self, element: XmlElement) -> None:
        name, type_name = get_name(element), uml_data_types.find_type_name(self._index, element)
        if name in self._port_names:
            # A port gives access to it: it is the port's data, and no parameter.
            self.features.data_types[name] = type_name
            self._ledger.take(element)
        elif not name:
            self._ledger.refuse(element, "it has no name")
        elif name.lower() == _PERIOD_NAME and (text := uml_data_types.read_default(self._index, element)) is not None:
            self._read_period(element, text)
        else:
            self._read_parameter(element, name, type_name)

    def _read_period(self, element: XmlElement, text: str) -> None:
        default = element.find("defaultValue")
        # archgen keeps the words of a period as the literal's name.
        words = get_name(default) if default is not None else ""
        timing = uml_data_types.read_period(words) if words else None
        timing = uml_data_types.read_period(text) if timing is None else timing
        if timing is None:
            why = f"`{text[:60]}` of `{get_name(element)}` is no period in seconds"
            self._ledger.leave(element, why, "write a number, such as `0.02`")
        else:
            self.features.timing |= timing
            self._ledger.take(element)

    def _read_parameter(self, element: XmlElement, name: str, type_name: str) -> None:
        reference = self._index.find_reference(element, "type")
        enumeration = reference.element if reference and reference.element is not None else None
        choices = (
            [get_name(each) for each in list_child_elements(enumeration, "EnumerationLiteral") if get_name(each)]
            if enumeration is not None and get_kind(enumeration) == "Enumeration"
            else []
        )
        kind = "string" if choices else uml_data_types.find_parameter_type(type_name)
        key = name_parameter(name)
        if kind is None:
            why = f"its type `{type_name[:60]}` is no value" if type_name else "nothing says what type it has"
            self._ledger.leave(element, f"the property `{name[:80]}` is no parameter: {why}")
            return
        if key in self.features.parameters:
            self._ledger.refuse(element, "there is another one of this name")
            return
        is_list = uml_data_types.is_many(element)
        parameter: dict[str, object] = {"choices": choices} if choices else {"type": kind}
        parameter |= {"type": f"{kind}[]"} if is_list else {}
        parameter |= self._read_value(element, kind, choices, is_list=is_list)
        parameter |= read_description(self._ledger, element)
        if is_true(element, "isReadOnly"):
            parameter["read_only"] = True
        if (visibility := element.attributes.get("visibility", "")) in _VISIBILITIES:
            parameter["visibility"] = visibility
        self.features.parameters[key] = parameter
        self._ledger.take(element)

    def _read_value(self, element: XmlElement, kind: str, choices: list[str], *, is_list: bool) -> dict[str, object]:
        """Return the `value` of a parameter; nothing where it has no default, or one that does not fit."""
        text = uml_data_types.read_default(self._index, element)
        if text is None:
            return {}
        words = (
            [word for each in text.strip().strip("[]{}").split(",") if (word := each.strip())] if is_list else [text]
        )
        default = f"the default `{text[:60]}` of `{get_name(element)}`"
        try:
            values = [uml_data_types.convert_value(each, kind) for each in words]
        except ValueError:
            self._ledger.leave(element, f"{default} is no {kind}: the parameter has no value")
            return {}
        if choices and not set(values) <= set(choices):
            self._ledger.leave(element, f"{default} is none of its enumeration's values")
            return {}
        return {"value": values if is_list else values[0]}

    def read_operation(self, element: XmlElement) -> None:
        name = get_name(element)
        if not name:
            self._ledger.refuse(element, "it has no name")
            return
        operation_id = choose_id(element, "operation", self.features.operations)
        # Code calls an operation by its id where it has no other name.
        operation: dict[str, object] = {} if name == operation_id else {"title": name}
        request: dict[str, object] = {}
        answers: dict[str, object] = {}
        for parameter in list_child_elements(element, "Parameter"):
            direction = parameter.attributes.get("direction", "in")
            type_name = uml_data_types.find_type_name(self._index, parameter)
            type_name = uml_data_types.find_field_type(type_name) or type_name
            type_name += uml_data_types.write_array(parameter) if type_name else ""
            self._ledger.take(parameter)
            if direction == "return" and not type_name:
                continue
            sides = answers if direction in _ANSWERS else request
            answer_id = "return" if direction == "return" and "return" not in sides else ""
            sides[answer_id or choose_id(parameter, "value", sides)] = type_name or None
            if direction == "inout":
                answers[choose_id(parameter, "value", answers)] = type_name or None
        if request:
            operation["request"] = request
        if answers:
            # An answer alone needs no name.
            operation["response"] = answers.get("return") if answers.keys() == {"return"} else answers
        visibility = element.attributes.get("visibility", "")
        if visibility == "protected" and name.lower().startswith(("get", "set")):
            operation["call"] = "synchronous" if name.lower().startswith("get") else "asynchronous"
        if visibility in _VISIBILITIES:
            operation["visibility"] = visibility
        self.features.operations[operation_id] = operation | read_description(self._ledger, element)
        self._ledger.take(element)
