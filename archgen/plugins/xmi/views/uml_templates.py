"""Generic component types as template classes, and what their instances are made of as classes bound to them."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from archgen.plugin.generating import title_from_id
from archgen.plugin.model import read_generic_name
from archgen.plugins.xmi.views.uml_signatures import make_signature
from archgen.plugins.xmi.views.uml_tree import IdRegistry, UmlTree, make_id_word, make_tree, read_mapping
from archgen.plugins.xmi.views.uml_types import UmlTypes


class UmlTemplates:
    """Writes the signatures of generic component types, and a bound class for each `filter<Pose>`."""

    def __init__(self, registry: IdRegistry, types: UmlTypes, component_types: Mapping[str, Any]) -> None:
        self._registry, self._types = registry, types
        self._names: dict[str, list[str]] = {}
        self._signature_ids: dict[str, str] = {}
        self._formal_ids: dict[str, list[str]] = {}
        for name, body in component_types.items():
            if generic := read_mapping(body).get("generic"):
                self._names[name] = [str(each) for each in generic]
                self._signature_ids[name] = registry.claim(f"signature.{name}")
                self._formal_ids[name] = [registry.claim(f"formal.{name}.{each}") for each in self._names[name]]
        self.bound_classes: list[UmlTree] = []
        """The classes for what generic types were bound to."""
        self._bound_ids: dict[tuple[str, str], str] = {}
        self._scope = ""

    def open_scope(self, type_name: str) -> list[UmlTree]:
        """Return the signature of a component type, if it is generic. Until the scope is closed its names are types."""
        names = self._names.get(type_name, [])
        if not names:
            return []
        self._scope = type_name
        signature, element_ids = make_signature(self._signature_ids[type_name], names, self._formal_ids[type_name])
        self._types.generic_ids |= element_ids
        return [signature]

    @property
    def is_in_scope(self) -> bool:
        """Whether names of a generic type stand for types just now."""
        return self._scope != ""

    def close_scope(self) -> None:
        """Forget the names of the generic type that was written."""
        self._types.generic_ids.clear()
        self._scope = ""

    def find_bound_class(self, type_name: str) -> str | None:
        """Return the id of the class for `filter<Pose>`; None for what binds no generic type."""
        base, arguments = read_generic_name(type_name)
        if len(arguments) != len(self._names.get(base, ())) or not arguments:
            return None
        # The `T` of a type around means another one in each type.
        key = (self._scope, type_name)
        if key not in self._bound_ids:
            self._bound_ids[key] = self._bind(type_name, base, arguments)
        return self._bound_ids[key]

    def _bind(self, type_name: str, base: str, arguments: tuple[str, ...]) -> str:
        slug = make_id_word(type_name)
        class_id = self._registry.claim(f"bound.{slug}")
        title = f"{title_from_id(base.rpartition('.')[2])}<{', '.join(arguments)}>"
        bound = make_tree("packagedElement", "Class", class_id, title)
        binding_id = self._registry.claim(f"binding.{slug}")
        binding = make_tree("templateBinding", "TemplateBinding", binding_id, signature=self._signature_ids[base])
        for formal_id, argument in zip(self._formal_ids[base], arguments, strict=True):
            words = {"formal": formal_id, "actual": self._types.refer(argument)}
            substitution_id = self._registry.claim(f"substitution.{slug}.{formal_id.rpartition('.')[2]}")
            binding["children"].append(
                make_tree("parameterSubstitution", "TemplateParameterSubstitution", substitution_id, **words)
            )
        bound["children"].append(binding)
        self.bound_classes.append(bound)
        return class_id
