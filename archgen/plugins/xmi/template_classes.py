"""Templates of UML: a class with names that stand for types is a generic component type, a bound class is made from it."""

from __future__ import annotations

import re

from archgen.plugin.importing import XmlElement
from archgen.plugins.xmi.import_ledger import OWN_PREFIX, ImportLedger, name_element
from archgen.plugins.xmi.uml_catalogue import UmlCatalogue
from archgen.plugins.xmi.uml_index import UmlIndex, get_id, get_name, list_child_elements
from archgen.plugins.xmi.uml_values import find_field_type, name_referenced

SIGNATURE_KINDS = ("TemplateSignature", "RedefinableTemplateSignature")
_PARAMETER_KINDS = ("ClassifierTemplateParameter", "TemplateParameter", "Parameter")
_BOUND_PREFIX = f"{OWN_PREFIX}bound."
_GENERIC_NAME = re.compile(r"[A-Z][A-Za-z0-9]{0,63}\Z")
"""As the language has it. Numbers that C++ hands to a template have other names, and are no types."""
TypeArguments = tuple[str, ...]
"""What the generic names of a template stand for, in their order; none where it is no template."""


def read_generic_names(index: UmlIndex, signature: XmlElement) -> tuple[str, ...]:
    """Return the names of a template that stand for types; none where some are no names of types, or two the same."""
    formals = list_child_elements(signature, *_PARAMETER_KINDS)
    references = [index.find_reference(each, "parameteredElement", "ownedParameteredElement") for each in formals]
    names = tuple(each.name if each else "" for each in references)
    is_usable = all(_GENERIC_NAME.match(name) for name in names) and len(set(names)) == len(names)
    return names if is_usable else ()


class TemplateClasses:
    """The classes that are templates, with their generic names, and the classes that are bound to them."""

    def __init__(self, ledger: ImportLedger, catalogue: UmlCatalogue) -> None:
        self._index, self._ledger = ledger.index, ledger
        self.generic_names: dict[XmlElement, tuple[str, ...]] = {}
        self._formals: dict[XmlElement, list[XmlElement]] = {}
        self._signatures: dict[XmlElement, XmlElement] = {}
        for element in catalogue.classes:
            for signature in list_child_elements(element, *SIGNATURE_KINDS):
                self._read_signature(element, signature)
        self.bindings: dict[XmlElement, tuple[XmlElement, TypeArguments]] = {}
        for element in catalogue.classes:
            for binding in list_child_elements(element, "TemplateBinding"):
                self._read_binding(element, binding)
        self.classes = [each for each in catalogue.classes if not self._is_name_only(each)]
        """All classes, without those by which archgen writes `filter<Pose>`."""

    def _is_name_only(self, element: XmlElement) -> bool:
        return element in self.bindings and get_id(element).startswith(_BOUND_PREFIX)

    def _read_signature(self, owner: XmlElement, signature: XmlElement) -> None:
        names = read_generic_names(self._index, signature)
        if not names or owner in self.generic_names:
            words = f"{name_element(owner)} is no generic component type: its template's parameters need a name each, as `T`"
            self._ledger.leave(signature, words)
            return
        self.generic_names[owner] = names
        self._formals[owner] = list_child_elements(signature, *_PARAMETER_KINDS)
        self._signatures[signature] = owner
        self._ledger.take(signature)

    def _read_binding(self, owner: XmlElement, binding: XmlElement) -> None:
        signature = self._index.find_reference(binding, "signature")
        template = self._signatures.get(signature.element) if signature and signature.element else None
        if template is None or owner in self.bindings or template is owner:
            words = f"{name_element(owner)} is not bound to a template: a component type is made from one class of these files"
            self._ledger.leave(binding, words)
            return
        actuals: dict[XmlElement, str] = {}
        for substitution in list_child_elements(binding, "TemplateParameterSubstitution"):
            formal = self._index.find_reference(substitution, "formal")
            actual = self._index.find_reference(substitution, "actual", "ownedActual")
            if formal and formal.element and actual:
                name = name_referenced(actual)
                actuals[formal.element] = find_field_type(name) or name
        arguments = tuple(actuals.get(each, "") for each in self._formals[template])
        if not all(arguments):
            names = ", ".join(f"`{name}`" for name in self.generic_names[template])
            words = f"{name_element(owner)} is not bound to `{get_name(template)[:80]}`: it does not say what {names} stands for"
            self._ledger.leave(binding, words)
            return
        self.bindings[owner] = template, arguments
        self._ledger.take(binding)

    def resolve(self, element: XmlElement) -> tuple[XmlElement, TypeArguments]:
        """Return the class that an element stands for, with what its generic names stand for."""
        return self.bindings[element] if self._is_name_only(element) else (element, ())

    def describe_unbound(self, element: XmlElement) -> str:
        """Return why nothing can be made from what an element stands for; empty where something can."""
        template, arguments = self.resolve(element)
        names = self.generic_names.get(template, ())
        if not names or arguments:
            return ""
        return f"nothing says what {', '.join(f'`{name}`' for name in names)} of `{get_name(template)[:80]}` stands for"
