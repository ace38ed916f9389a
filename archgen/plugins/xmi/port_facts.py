"""The ports of components: which interfaces they provide and require, and so which way their data goes."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterable
from dataclasses import dataclass, field

from archgen.plugin.importing import XmlElement
from archgen.plugins.xmi import uml_data_types
from archgen.plugins.xmi.uml_catalogue import UmlCatalogue
from archgen.plugins.xmi.uml_index import Reference, UmlIndex, get_kind, get_name, is_true, list_child_elements

InterfaceKey = XmlElement | str
"""An interface: its element, or its name where it is written only where it is used."""
_DATA_KINDS = frozenset({"DataType", "PrimitiveType", "Enumeration", "Signal", "Class"})


@dataclass(slots=True, eq=False)
class PortFacts:
    """A port, or an interface that a component provides or requires without one."""

    element: XmlElement
    name: str
    provided: list[InterfaceKey] = field(default_factory=list)
    required: list[InterfaceKey] = field(default_factory=list)
    type_name: str = ""
    is_input: bool = False
    is_output: bool = False
    is_port: bool = True
    input_id: str = ""
    output_id: str = ""
    is_told: bool = False
    """Whether a stereotype of SysML says which way its data goes."""
    is_joined: bool = False
    """Whether a connector says what it is connected with."""

    @property
    def is_decided(self) -> bool:
        """Whether something says which way its data goes."""
        return bool(self.provided or self.required) or self.is_told


class InterfaceUses:
    """Who provides and who requires which interfaces, by usages and realizations anywhere in the model."""

    def __init__(self, index: UmlIndex, catalogue: UmlCatalogue) -> None:
        self._index = index
        self._interfaces = frozenset(catalogue.interfaces)
        self._named = {get_name(each): each for each in reversed(catalogue.interfaces) if get_name(each)}
        self.provided: dict[XmlElement, dict[InterfaceKey, None]] = defaultdict(dict)
        self.required: dict[XmlElement, dict[InterfaceKey, None]] = defaultdict(dict)
        self.used_elements: set[XmlElement] = set()
        """The dependencies and realizations that say something here."""
        for usage in catalogue.dependencies:
            if get_kind(usage) == "Usage":
                self._add(usage, self.required, ("client",), ("supplier",))
        for realization in catalogue.realizations:
            clients, contracts = ("client", "implementingClassifier"), ("contract", "supplier")
            self._add(realization, self.provided, clients, contracts)

    def _add(
        self,
        element: XmlElement,
        uses: dict[XmlElement, dict[InterfaceKey, None]],
        client_roles: tuple[str, ...],
        supplier_roles: tuple[str, ...],
    ) -> None:
        parent = self._index.get_parent(element)
        clients = self._index.list_named(element, *client_roles)
        if not clients and parent is not None and get_kind(element) == "InterfaceRealization":
            clients = [parent]
        for client in clients:
            for reference in self._index.list_references(element, *supplier_roles):
                key = self._find_interface(reference)
                if key is not None:
                    self.used_elements.add(element)
                    uses[client][key] = None

    def _find_interface(self, reference: Reference) -> InterfaceKey | None:
        if reference.element is None:
            # An interface of a library that is not among the files: its name joins who uses it.
            return f"outside:{reference.name}" if reference.is_outside and reference.name else None
        if reference.element in self._interfaces:
            return reference.element
        if reference.element.tag in {"provided", "required"}:
            return self._find_written(reference.element)
        return None

    def _find_written(self, element: XmlElement) -> InterfaceKey | None:
        """Return the interface that a child `provided` or `required` stands for, as Enterprise Architect writes it."""
        if element.attributes.get("xmi:idref") or element.attributes.get("href"):
            return None
        name = get_name(element)
        return self._named.get(name) or (f"name:{name}" if name else None)

    def make_port(self, element: XmlElement) -> PortFacts:
        """Return what is known of a port."""
        facts = PortFacts(element, get_name(element))
        facts.provided += self.provided.get(element, ())
        facts.required += self.required.get(element, ())
        for role, interfaces in (("provided", facts.provided), ("required", facts.required)):
            named = self._index.list_named(element, role)
            interfaces.extend(self._list_written(element, role))
            interfaces.extend(each for each in named if each in self._interfaces)
        self._add_by_type(element, facts)
        facts.provided = list(dict.fromkeys(facts.provided))
        facts.required = list(dict.fromkeys(facts.required))
        facts.is_input = bool(facts.required)
        facts.is_output = bool(facts.provided) or not facts.required
        if not facts.is_decided and (direction := self._index.flow_directions.get(element)):
            facts.is_told, facts.is_input, facts.is_output = True, direction == "in", direction == "out"
        return facts

    def _add_by_type(self, element: XmlElement, facts: PortFacts) -> None:
        """Take what the type of a port says: an interface, or a class that provides and requires some."""
        reference = self._index.find_reference(element, "type")
        if reference is None:
            return
        port_type, is_conjugated = reference.element, is_true(element, "isConjugated")
        own, other = (facts.required, facts.provided) if is_conjugated else (facts.provided, facts.required)
        if port_type is None:
            facts.type_name = uml_data_types.name_referenced(reference)
        elif port_type in self._interfaces:
            own.append(port_type)
        elif get_kind(port_type) in _DATA_KINDS:
            provided, required = self.provided.get(port_type, ()), self.required.get(port_type, ())
            own += provided
            other += required
            if not provided and not required:
                facts.type_name = uml_data_types.name_referenced(reference)

    def list_bare_ports(self, owner: XmlElement, ports: Iterable[PortFacts]) -> list[PortFacts]:
        """Return what a component provides and requires itself, where none of its ports does."""
        ports = list(ports)
        bare: dict[InterfaceKey, PortFacts] = {}
        provided = dict.fromkeys((*self.provided.get(owner, ()), *self._list_written(owner, "provided")))
        required = dict.fromkeys((*self.required.get(owner, ()), *self._list_written(owner, "required")))
        provided_by_ports = {key for port in ports for key in port.provided}
        required_by_ports = {key for port in ports for key in port.required}
        for key in provided | required:
            is_output = key in provided and key not in provided_by_ports
            is_input = key in required and key not in required_by_ports
            if is_output or is_input:
                name = get_interface_name(key)
                element = key if isinstance(key, XmlElement) else owner
                facts = PortFacts(element, name, is_port=False, is_input=is_input, is_output=is_output)
                facts.provided, facts.required = [key] * is_output, [key] * is_input
                bare[key] = facts
        return list(bare.values())

    def _list_written(self, owner: XmlElement, tag: str) -> list[InterfaceKey]:
        return [key for child in owner.children if child.tag == tag and (key := self._find_written(child)) is not None]

    def find_data_type(self, port: PortFacts) -> str:
        """Return the type of what a port's interfaces give: what their only `get` operation returns."""
        keys = port.provided or port.required
        names = {self._find_returned(key, port.name) if isinstance(key, XmlElement) else "" for key in keys}
        return min(names) if len(names) == 1 else ""

    def _find_returned(self, interface: XmlElement, port_name: str) -> str:
        operations = list_child_elements(interface, "Operation")
        getters = [each for each in operations if get_name(each).lower().startswith("get")]
        wanted = [each for each in getters if get_name(each)[3:].lstrip("_").lower() == port_name.lower()]
        chosen = wanted[:1] or (getters if len(getters) == 1 else [])
        for parameter in list_child_elements(chosen[0], "Parameter") if chosen else ():
            if parameter.attributes.get("direction") == "return":
                return uml_data_types.find_type_name(self._index, parameter)
        return ""


def get_interface_name(key: InterfaceKey) -> str:
    """Return the name of an interface."""
    return get_name(key) if isinstance(key, XmlElement) else key.partition(":")[2]
