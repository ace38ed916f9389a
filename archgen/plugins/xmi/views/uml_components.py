"""Groups, components and component types as packages, components and classes, with their ports.

The parameters, operations and period of a component or component type as features of a class.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from decimal import Decimal
from typing import Any

from archgen.plugin.generating import make_camel_name, title_from_id
from archgen.plugin.model import Architecture, Component, parse_quantity, read_generic_name
from archgen.plugins.xmi.views.uml_types import (
    TYPE_PREFIX,
    IdRegistry,
    UmlTree,
    UmlTypes,
    make_comments,
    make_id_word,
    make_signature,
    make_tree,
    read_hints,
    read_mapping,
)

_DECLARATION_KEYS = frozenset(
    {"type", "value", "unit", "range", "choices", "description", "read_only", "visibility", "from", "hints"}
)


class UmlFeatures:
    """Writes the features of classes and components."""

    def __init__(self, registry: IdRegistry, types: UmlTypes) -> None:
        self._registry, self._types = registry, types

    def write_features(self, path: str, body: Mapping[str, Any], declared: Mapping[str, str]) -> list[UmlTree]:
        """Return attributes and operations. `declared` are the types of parameters that its type declares."""
        features = [
            tree
            for name, parameter in list_declarations(read_mapping(body.get("parameters")))
            if (tree := self._write_parameter(path, name, parameter, declared)) is not None
        ]
        features += self._write_period(path, read_mapping(body.get("timing")))
        operations = read_mapping(body.get("operations"))
        return features + [self._write_operation(path, name, read_mapping(each)) for name, each in operations.items()]

    def _write_parameter(
        self, path: str, name: str, parameter: Mapping[str, Any], declared: Mapping[str, str]
    ) -> UmlTree | None:
        if "from" in parameter:
            # A value that the component around hands in: UML has no words for it.
            return None
        choices: list[Any] = parameter.get("choices") or []
        value = parameter.get("value")
        if isinstance(value, str) and "$(" in value:
            # A text with a value of the component around in it is no value by itself.
            value = None
        written = parameter.get("type") or declared.get(name) or find_value_type(value)
        written = written or (find_value_type(choices[0]) if choices else None)
        if written is None or (value is None and not parameter.get("type") and not choices):
            return None
        kind, is_list = written.removesuffix("[]"), written.endswith("[]")
        element_id = self._registry.claim(f"parameter.{path}.{name}")
        has_names = (
            bool(choices) and kind == "string" and not is_list and all(isinstance(each, str) for each in choices)
        )
        type_id = self._types.add_choices(f"{path}.{name}", choices) if has_names else self._types.refer_parameter(kind)
        flags = {"isReadOnly": "true" if parameter.get("read_only") else None}
        tree = make_tree(
            "ownedAttribute", "Property", element_id, name, visibility=parameter.get("visibility"), **flags
        )
        tree["attributes"].append(["type", type_id])
        tree["children"] += make_comments(element_id, parameter)
        if is_list:
            tree["children"] += self._types.write_bounds(element_id, "[]")
        if isinstance(value, list):
            text = ", ".join(("true" if each else "false") if isinstance(each, bool) else str(each) for each in value)
            is_readable = all(_reads_back(each) for each in value)
            tree["children"] += [self._types.write_default(element_id, "string", f"[{text}]")] if is_readable else []
        elif value is not None and not isinstance(value, Mapping):
            tree["children"].append(self._types.write_default(element_id, kind, value))
        return tree

    def _write_period(self, path: str, timing: Mapping[str, Any]) -> list[UmlTree]:
        """Return the property `sample`: the period in seconds, 0 where an arrival or a call sets it off."""
        words = str(timing.get("period") or timing.get("rate") or "")
        if period := parse_quantity(words, "duration"):
            nanoseconds = period.value
        elif rate := parse_quantity(words, "frequency"):
            nanoseconds = 10**9 / rate.value if rate.value else rate.value
        else:
            return []
        element_id = self._registry.claim(f"parameter.{path}.sample")
        real = self._types.refer_parameter("float")
        tree = make_tree("ownedAttribute", "Property", element_id, "sample", visibility="public", type=real)
        number = format(Decimal(round(nanoseconds)).scaleb(-9).normalize(), "f")
        tree["children"].append(self._types.write_default(element_id, "float", number, name=words))
        return [tree]

    def _write_operation(self, path: str, name: str, body: Mapping[str, Any]) -> UmlTree:
        element_id = self._registry.claim(f"operation.{path}.{name}")
        title = str(body.get("title") or name)
        tree = make_tree("ownedOperation", "Operation", element_id, title, visibility=body.get("visibility"))
        tree["children"] += make_comments(element_id, body)
        tree["children"] += self._write_arguments(element_id, body.get("request"), "in")
        tree["children"] += self._write_arguments(element_id, body.get("response"), "out")
        return tree

    def _write_arguments(self, operation_id: str, side: object, direction: str) -> Iterator[UmlTree]:
        if side is None:
            return
        named = side if isinstance(side, Mapping) else {"return" if direction == "out" else "value": side}
        for name, type_name in named.items():
            is_return = direction == "out" and not isinstance(side, Mapping)
            argument_id = self._registry.claim(f"argument.{operation_id}.{'return.' * is_return}{name}")
            attributes = {"direction": "return" if is_return else direction if direction == "out" else None}
            written = str(type_name or "")
            type_id = self._types.refer(written.removesuffix("[]")) if written else None
            tree = make_tree("ownedParameter", "Parameter", argument_id, name, type=type_id, **attributes)
            if written.endswith("[]"):
                tree["children"] += self._types.write_bounds(argument_id, "[]")
            yield tree


def list_declarations(parameters: Mapping[str, Any], prefix: str = "") -> Iterator[tuple[str, Mapping[str, Any]]]:
    """Yield the parameters with their dotted names: what is no declaration is a set of them."""
    for name, body in parameters.items():
        is_declaration = not isinstance(body, Mapping) or (
            body.keys() <= _DECLARATION_KEYS and bool(body.keys() & {"value", "type", "choices", "from"})
        )
        if is_declaration:
            yield f"{prefix}{name}", body if isinstance(body, Mapping) else {"value": body}
        else:
            yield from list_declarations(body, f"{prefix}{name}.")


def find_value_type(value: object) -> str | None:
    """Return the type of a parameter that its value shows; None where there is none."""
    if isinstance(value, list):
        inner = find_value_type(value[0]) if value else None
        return f"{inner}[]" if inner else None
    kinds = ((bool, "boolean"), (int, "integer"), (float, "float"), (str, "string"))
    return next((kind for python_type, kind in kinds if isinstance(value, python_type)), None)


def _reads_back(value: object) -> bool:
    """Whether an item of a list is read again as it was: a text with a comma would be two."""
    return not isinstance(value, str) or (
        bool(value.strip()) and value == value.strip() and not set(value) & set(",[]{}\"'")
    )


PortPath = tuple[str, str]
"""A component's or type's path, and the id of a port of it."""


class UmlComponents:
    """Writes classes and components, and knows the ids of all ports."""

    def __init__(
        self,
        architecture: Architecture,
        registry: IdRegistry,
        types: UmlTypes,
        wants: Callable[[str], bool],
        component_types: Mapping[str, Any],
    ) -> None:
        self._architecture, self._registry, self._types = architecture, registry, types
        self._wants = wants
        self._features = UmlFeatures(registry, types)
        self._bodies = component_types
        self.port_ids: dict[PortPath, str] = {}
        self.outputs: dict[PortPath, object] = {}
        """The hints of each output."""
        self.inputs: dict[PortPath, object] = {}
        self.written_sources: dict[PortPath, object] = {}
        """What each input reads, as it is written."""
        self.class_ids: dict[str, str] = {}
        self.component_ids: dict[str, str] = {}
        for name, body in component_types.items():
            self.class_ids[name] = registry.claim(f"component_type.{name}", read_mapping(body).get("hints"))
        self.templates = UmlTemplates(registry, types, component_types)
        self.samples = {each.type_name: each.id for each in reversed(list(architecture.shells.values()))}
        """The first composed component of each type: it shows what stands inside of the type."""

    def write_type(self, name: str) -> UmlTree:
        """Return a component type as a class."""
        body = read_mapping(self._bodies[name])
        element_id = self.class_ids[name]
        title = str(body.get("title") or title_from_id(name.rpartition(".")[2]))
        is_abstract = "true" if body.get("abstract") in {True, "true"} else None
        tree = make_tree("packagedElement", "Class", element_id, title, isAbstract=is_abstract)
        tree["children"] += make_comments(element_id, body)
        tree["children"] += self.templates.open_scope(name)
        base = str(body.get("is") or "")
        if general := self._find_class(base):
            general_id = self._registry.claim(f"generalization.{name}")
            tree["children"].append(make_tree("generalization", "Generalization", general_id, general=general))
        declared = self._list_parameter_types(base)
        tree["children"] += self._write_ports(f"{TYPE_PREFIX}{name}", body, inherited={})
        tree["children"] += self._features.write_features(f"{TYPE_PREFIX}{name}", body, declared)
        sample = self.samples.get(name, "")
        tree["children"] += self._write_inside(f"{TYPE_PREFIX}{name}", body, sample, "nestedClassifier")
        self.templates.close_scope()
        return tree

    def _find_class(self, type_name: str) -> str | None:
        """Return the id of the class for the name of a type, `filter<Pose>` too; None where there is none."""
        return self.templates.find_bound_class(type_name) or self.class_ids.get(type_name)

    def _list_parameter_types(self, type_name: str) -> dict[str, str]:
        component_type = self._architecture.component_types.get(type_name.partition("<")[0])
        parameters = component_type.parameters if component_type else {}
        return {name: each.type for name, each in parameters.items() if each.type}

    def write_group(self, group_id: str, body: Mapping[str, Any]) -> UmlTree:
        """Return a group as a package with its components."""
        element_id = self._registry.claim(f"group.{group_id}", body.get("hints"))
        tree = make_tree("packagedElement", "Package", element_id, str(body.get("title") or title_from_id(group_id)))
        tree["children"] += make_comments(element_id, body)
        for name, component in read_mapping(body.get("components")).items():
            path = f"{group_id}.{name}"
            if self._wants(path):
                tree["children"].append(self._write_component(path, read_mapping(component), path, "packagedElement"))
        return tree

    def _write_component(self, path: str, body: Mapping[str, Any], place: str, tag: str) -> UmlTree:
        """Return a component. `place` is its complete id in the architecture, that of an instance inside of a type."""
        hints = body.get("hints")
        element_id = self._registry.claim(f"component.{path}", hints)
        self.component_ids[path] = element_id
        kind = "Device" if read_hints(hints).get("kind") == "Device" else "Component"
        title = str(body.get("title") or title_from_id(path.rpartition(".")[2]))
        tree = make_tree(tag, kind, element_id, title)
        type_name = str(body.get("is") or body.get("same_as") or "")
        component = self._find_component(place)
        class_id = self._find_class(type_name)
        if type_name and class_id is None and component is not None:
            # What `same_as` names has no class: what the component has from there is its own.
            body = {**_write_out(component), **body}
        tree["children"] += make_comments(element_id, body)
        known = _list_ports(component) if component else self._list_declared_ports(type_name)
        known = known if type_name else {}
        if self.templates.is_in_scope:
            # An instance shows which ports there are, but its types are not those of the generic type.
            known = dict.fromkeys(known, "")
        tree["children"] += self._write_ports(path, body, known)
        tree["children"] += self._features.write_features(path, body, self._list_parameter_types(type_name))
        if not type_name:
            tree["children"] += self._write_inside(path, body, place, "packagedElement")
        if class_id is not None and kind == "Component":
            tree["children"].append(
                make_tree(
                    *("realization", "ComponentRealization", self._registry.claim(f"realization.{path}")),
                    supplier=element_id,
                    client=class_id,
                    realizingClassifier=class_id,
                )
            )
        return tree

    def _list_declared_ports(self, type_name: str) -> dict[tuple[str, str], str]:
        """Return the ports of a type and of all that it is made from: nothing shows them where it has no instance."""
        ports: dict[tuple[str, str], str] = {}
        seen: set[str] = set()
        base = type_name.partition("<")[0]
        while base in self._bodies and base not in seen:
            seen.add(base)
            body = read_mapping(self._bodies[base])
            ports |= {(side, name): "" for side in ("inputs", "outputs") for name in read_mapping(body.get(side))}
            base = str(body.get("is") or "").partition("<")[0]
        return ports

    def _find_component(self, place: str) -> Component | None:
        return self._architecture.components.get(place) or self._architecture.shells.get(place)

    def _write_inside(self, path: str, body: Mapping[str, Any], place: str, tag: str) -> list[UmlTree]:
        inside = read_mapping(body.get("components"))
        return [
            self._write_component(f"{path}.{name}", read_mapping(each), f"{place}.{name}", tag)
            for name, each in inside.items()
            if path.startswith(TYPE_PREFIX) or self._wants(f"{path}.{name}")
        ]

    def _write_ports(
        self, path: str, body: Mapping[str, Any], inherited: Mapping[tuple[str, str], str]
    ) -> list[UmlTree]:
        """Return the ports of a component or class. `inherited` are those of the type that an instance repeats."""
        ports: dict[str, UmlTree] = {}
        for side, known in (("inputs", self.inputs), ("outputs", self.outputs)):
            written = read_mapping(body.get(side))
            names = dict.fromkeys((*(name for each, name in inherited if each == side), *written))
            for name in names:
                port = read_mapping(written.get(name))
                known[path, name] = port.get("hints")
                if side == "inputs":
                    self.written_sources[path, name] = port.get("from")
                type_name = str(port.get("type") or inherited.get((side, name)) or "")
                if side == "inputs" and self._reads_others(path, name, type_name):
                    type_name = ""
                if name not in ports:
                    ports[name] = self._write_port(path, name, port, body)
                if type_name and not any(key == "type" for key, _ in ports[name]["attributes"]):
                    ports[name]["attributes"].append(["type", self._types.refer(type_name)])
        return list(ports.values())

    def _reads_others(self, path: str, name: str, type_name: str) -> bool:
        """Whether an input reads a whole component or group, and not all of it is of the type that it expects."""
        reader = self._architecture.inputs.get(f"{path}.{name}")
        connections = reader.connections if reader else ()
        outputs = (output for each in connections if each.kind != "output" for output in each.outputs)
        return any((self._architecture.outputs[each].type or type_name) != type_name for each in outputs)

    def _write_port(self, path: str, name: str, port: Mapping[str, Any], body: Mapping[str, Any]) -> UmlTree:
        other = read_mapping(read_mapping(body.get("outputs")).get(name))
        port_id = self._registry.claim(f"port.{path}.{name}", other.get("hints") or port.get("hints"))
        self.port_ids[path, name] = port_id
        tree = make_tree("ownedAttribute", "Port", port_id, name, aggregation="composite")
        tree["children"] += make_comments(port_id, port)
        return tree


def _write_out(component: Component) -> dict[str, Any]:
    """Return what a component has from its type, as if it were written there."""
    parameters = {
        name: {"type": each.type, "value": each.value, "visibility": each.visibility}
        for name, each in component.parameters.items()
    }
    return {"functionality": component.functionality, "description": component.description, "parameters": parameters}


def _list_ports(component: Component) -> dict[tuple[str, str], str]:
    """Return the types of the ports that an instance has, by side and id."""
    inputs = {("inputs", name): each.type or "" for name, each in component.inputs.items()}
    return inputs | {("outputs", name): each.type or "" for name, each in component.outputs.items()}


def name_output_interface(path: str, port: str) -> str:
    """Return the name of the interface of an output that has none of its own: `CameraImage`."""
    return make_camel_name(f"{path.rpartition('.')[2]}_{port}")


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
