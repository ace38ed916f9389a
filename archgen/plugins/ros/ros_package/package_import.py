"""`archgen import package`: component types with the parameters of a package, and types with its messages.

Messages, services and actions of a package as types with fields; what generate_parameter_library declares, from its YAML
file.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping, Sequence
from math import isfinite
from pathlib import Path
from typing import Any

from archgen.plugin.findings import Diagnostic
from archgen.plugin.importing import (
    ForeignFileError,
    ForeignImport,
    MappingNode,
    ScalarNode,
    Span,
    YamlNode,
    make_id,
    make_unique_id,
    node_to_data,
    parse_yaml,
    read_bounded,
    resolve_scalar,
)
from archgen.plugin.model import is_parameter_name
from archgen.plugin.ros import (
    INVALID_INTERFACE,
    Interface,
    InterfaceConstant,
    InterfaceField,
    ParameterSection,
    load_shipped_interfaces,
    parse_interface_definition,
    read_parameter_text,
)
from archgen.plugins.ros.ros_package.import_account import ImportAccount
from archgen.plugins.ros.ros_package.package_programs import (
    PackageFile,
    PackageManifest,
    find_manifests,
    find_programs,
    read_manifest,
    walk_files,
)

_TYPES = {
    "bool": "boolean",
    "int": "integer",
    "double": "float",
    "string": "string",
}
_KEYS = frozenset({"type", "default_value", "description", "read_only", "validation", "additional_constraints"})
_MAX_DEPTH = 20


def _is_declaration_file(root: MappingNode) -> bool:
    """Whether a YAML file declares parameters: at its top a mapping with, somewhere below, a `type` that the tool knows."""
    return any(isinstance(entry.value, MappingNode) and _find_declaration(entry.value, 0) for entry in root)


def _find_declaration(mapping: MappingNode, depth: int) -> bool:
    if _is_declaration(mapping):
        return True
    inner = [entry.value for entry in mapping if isinstance(entry.value, MappingNode)]
    return depth < _MAX_DEPTH and any(_find_declaration(each, depth + 1) for each in inner)


def _is_parameter_value(value: object) -> bool:
    """Whether a parameter of ROS can have a value: a single one, or a list of such."""
    items = value if isinstance(value, list | tuple) else [value]
    return not any(item is None or isinstance(item, dict | list | tuple) for item in items)


def _is_declaration(mapping: MappingNode) -> bool:
    kind = mapping.get("type")
    return isinstance(kind, ScalarNode) and _read_type(kind.text) is not None and {e.key for e in mapping} <= _KEYS


def _read_type(text: str) -> tuple[str, int | None] | None:
    """Return the language's type for one of the tool, and how long it may be at most; None for another word."""
    base, _, fixed = text.partition("_fixed_")
    is_list = base.endswith("_array")
    known = _TYPES.get(base.removesuffix("_array"))
    if text == "none":
        return "", None
    if known is None or (fixed and not fixed.isdecimal()):
        return None
    return f"{known}[]" if is_list else known, int(fixed) if fixed and len(fixed) < 10 else None  # noqa: PLR2004 - a length


def read_declared_parameters(
    mapping: MappingNode, account: ImportAccount, outer: str = "", depth: int = 0
) -> tuple[dict[str, Any], list[str]]:
    """Return parameters by their dotted names, and the sets below which any parameter is accepted."""
    parameters: dict[str, Any] = {}
    open_sets: list[str] = []
    for entry in mapping if depth < _MAX_DEPTH else ():
        if entry.key.startswith("__map_") and (not outer or is_parameter_name(outer.removesuffix("."))):
            open_sets.append(outer.removesuffix(".") or "*")
            words = f"the parameters below `{entry.key}` stand once for each name in a list: any are accepted"
            account.add_note("__map_", words, entry.key_span, fate="noted")
        elif not isinstance(entry.value, MappingNode):
            account.add_note(entry.key, "it is no parameter", entry.key_span)
        elif _is_declaration(entry.value) and not is_parameter_name(f"{outer}{entry.key}"):
            account.add_note("parameter", f"`{outer}{entry.key}` is no name of a parameter", entry.key_span)
        elif _is_declaration(entry.value):
            parameters[f"{outer}{entry.key}"] = _read_parameter(entry.key, entry.value, account)
            account.count("parameter")
        else:
            inner, inner_sets = read_declared_parameters(entry.value, account, f"{outer}{entry.key}.", depth + 1)
            parameters |= inner
            open_sets += inner_sets
    return parameters, list(dict.fromkeys(open_sets))


def _read_parameter(name: str, declaration: MappingNode, account: ImportAccount) -> dict[str, Any]:
    kind = declaration.get("type")
    type_name, length = _read_type(kind.text if isinstance(kind, ScalarNode) else "") or ("", None)
    default = declaration.get("default_value")
    data: dict[str, Any] = {"type": type_name or "string"}
    if not type_name:
        account.add_note("type: none", f"`{name}` has no type of its own", declaration.span, fate="noted")
    value = None if default is None else node_to_data(default)
    if default is not None and value is not None and not _is_parameter_value(value):
        words = f"what `{name}` is by default is no value that a parameter of ROS can have"
        account.add_note("default_value", words, default.span)
    elif value is not None:
        data["value"] = float(value) if type_name == "float" and isinstance(value, int) else value
    if length is not None:
        account.add_note("fixed", f"`{name}` has at most {length} items: a length cannot be said", declaration.span)
    description = declaration.get("description")
    if isinstance(description, ScalarNode) and description.text.strip():
        data["description"] = description.text.strip()
    read_only = declaration.get("read_only")
    if isinstance(read_only, ScalarNode) and read_only.value is True:
        data["read_only"] = True
    validation = declaration.get("validation")
    if isinstance(validation, MappingNode):
        _read_validation(name, validation, data, account)
    return data


def _read_validation(name: str, validation: MappingNode, data: dict[str, Any], account: ImportAccount) -> None:
    least: Any = None
    greatest: Any = None
    for rule, arguments, node in _list_rules(validation):
        is_list = str(data["type"]).endswith("[]")
        is_choice = len(arguments) == 1 and isinstance(arguments[0], list) and _is_parameter_value(arguments[0])
        if rule == "one_of" and is_choice and not is_list:
            data["choices"] = arguments[0]
        elif rule in {"bounds", "element_bounds"} and len(arguments) == 2:  # noqa: PLR2004 - least and greatest
            least, greatest = arguments
        elif rule in {"gt_eq", "lower_bounds", "lower_element_bounds"} and len(arguments) == 1:
            least = arguments[0]
        elif rule in {"lt_eq", "upper_bounds", "upper_element_bounds"} and len(arguments) == 1:
            greatest = arguments[0]
        else:
            shown = f"{rule}: {arguments}" if arguments else rule
            account.add_note(f"validation {rule}", f"`{name}`: `{shown}` cannot be said", node.span)
    if (
        _are_numbers(least, greatest)
        and least <= greatest
        and data["type"] in {"integer", "float", "integer[]", "float[]"}
    ):
        data["range"] = [least, greatest]
    elif least is not None or greatest is not None:
        words = f"`{name}` is at {'least' if greatest is None else 'most'} {least if greatest is None else greatest}: a range has two ends"
        account.add_note("validation", words, validation.span)


def _are_numbers(*values: object) -> bool:
    return all(isinstance(value, int | float) and not isinstance(value, bool) and isfinite(value) for value in values)


def _list_rules(validation: MappingNode) -> Iterator[tuple[str, list[Any], YamlNode]]:
    for entry in validation:
        value = node_to_data(entry.value)
        arguments = value if isinstance(value, list) else [] if value is None else [value]
        # `bounds<>: [0, 1]`; `one_of<>: [[a, b]]`
        yield entry.key.partition("<")[0], list(arguments), entry.value


_HUMP = re.compile(r"(?<=[a-z0-9])(?=[A-Z])|(?<=[A-Z]{2})(?=[A-Z][a-z])")


def make_type_name(message: str) -> str:
    """Return how people call a message: `PlanGrasp` is `Plan grasp`."""
    words = _HUMP.sub(" ", message.rpartition("/")[2].replace("_", " ")).split()
    rest = (word if word.isupper() or not word[1:].islower() else word.lower() for word in words[1:])
    return " ".join([words[0], *rest]) if words else message


def read_message_definition(
    text: str, message: str, shown_path: str, *, is_ros_1: bool, distro: str | None = None
) -> tuple[dict[str, Any], tuple[Diagnostic, ...]]:
    """Return the type that a definition makes, and what is wrong in it. Lines that ROS refuses are left out.

    `distro` is the distribution that the workspace is for, where one is known: it may hold newer messages than that.
    """
    definition = parse_interface_definition(text, message, shown_path, ros1=is_ros_1)
    interface = definition.interface
    data: dict[str, Any] = {"message": message}
    if message in load_shipped_interfaces(distro).names:
        # archgen knows what is in it: written once more it would be another one.
        return data, definition.diagnostics
    if interface.comment.strip():
        data["comment"] = interface.comment.strip()
    if len(interface.parts) == 1:
        data["fields"] = _write_fields(interface, 0)
        data["constants"] = _write_constants(interface, 0)
    else:
        for number, part_name in enumerate(interface.part_names):
            data[_PART_KEYS[part_name]] = _write_fields(interface, number)
    return {
        key: value for key, value in data.items() if value or key not in {"comment", "constants"}
    }, definition.diagnostics


_PART_KEYS = {
    "request": "request",
    "response": "response",
    "goal": "request",
    "result": "response",
    "feedback": "feedback",
}


def _write_fields(interface: Interface, number: int) -> dict[str, Any]:
    return {each.name: _write_field(each) for each in interface.parts[number]}


def _write_field(each: InterfaceField) -> Any:  # noqa: ANN401 - the short or the long form
    type_name = f"{each.type}{each.array}"
    more = {"default": _read_literal(each.default) if each.default else None, "comment": each.comment or None}
    kept = {key: value for key, value in more.items() if value is not None}
    return {"type": type_name, **kept} if kept else type_name


def _write_constants(interface: Interface, number: int) -> dict[str, Any]:
    constants = interface.constants[number] if interface.constants else ()
    return {each.name: _write_constant(each) for each in constants}


def _write_constant(each: InterfaceConstant) -> Mapping[str, Any]:
    value = each.value.strip("'\"") if each.type.startswith(("string", "wstring")) else _read_literal(each.value)
    return {"type": each.type, "value": value, **({"comment": each.comment} if each.comment else {})}


def _read_literal(text: str) -> Any:  # noqa: ANN401 - a value of any type
    stripped = text.strip()
    if stripped[:1] in {"[", '"', "'"}:
        document, problems = parse_yaml("value", f"value: {stripped}")
        node = document.root.get("value") if document and not problems else None
        return text if node is None else node_to_data(node)
    return resolve_scalar(stripped) if stripped else text


HINT = "package"
_MAX_BYTES = 4_000_000
_MESSAGE_KINDS = {".msg": "msg", ".srv": "srv", ".action": "action"}
_YAML = (".yaml", ".yml")


def read_packages(files: Sequence[Path]) -> ForeignImport:
    """Read packages of ROS: package.xml files, folders of packages, folders with packages in them. Raise ForeignFileError."""
    manifests = find_manifests(tuple(files))
    if not manifests:
        words = "there is no package.xml in it"
        raise ForeignFileError(
            words, Span.of_file(str(files[0]) if files else "."), "give the folder of a package of ROS"
        )
    account = ImportAccount()
    slices: dict[str, dict[str, Any]] = {}
    type_names: set[str] = set()
    ids: set[str] = set()
    names: set[str] = set()
    title = ""
    for path in manifests:
        manifest = read_manifest(path)
        title = title or manifest.name
        sections = _PackageReader(manifest, account, ids, type_names).read_sections()
        account.count("package")
        if sections:
            name = make_unique_id(make_id(manifest.name, "package"), names)
            names.add(name)
            slices[f"{name}.yaml"] = sections
    taken = dict(sorted((+account.taken).items()))
    return ForeignImport(slices, taken, tuple(account.notes), title)


class _PackageReader:
    """Reads one package. Ids and names of types are unique over all packages."""

    def __init__(self, manifest: PackageManifest, account: ImportAccount, ids: set[str], type_names: set[str]) -> None:
        self._manifest = manifest
        self._account = account
        self._ids = ids
        self._type_names = type_names
        self._types: dict[str, Any] = {}
        self._component_types: dict[str, dict[str, Any]] = {}
        self._sources: dict[str, str] = {}
        """The ids of the component types by the names of nodes, programs and declarations."""

    def read_sections(self) -> dict[str, Any]:
        """Return the sections of the package's slice."""
        files = list(walk_files(self._manifest.folder))
        for name, node in find_programs(self._manifest, files, self._account).items():
            self._add_component(name, {"node": node})
        for file in files:
            suffix = file.path.suffix.lower()
            if suffix in _MESSAGE_KINDS and file.path.parent.name == _MESSAGE_KINDS[suffix]:
                self._read_message(file, _MESSAGE_KINDS[suffix])
            elif suffix in _YAML:
                self._read_yaml(file)
        self._tell_manifest()
        for name, data in self._component_types.items():
            self._component_types[name] = self._finish_component(data)
        sections = {"component_types": self._component_types, "types": self._types}
        return {name: section for name, section in sections.items() if section}

    def _tell_manifest(self) -> None:
        manifest = self._manifest
        if manifest.dependency_count:
            count = manifest.dependency_count
            what = "dependency on another package has" if count == 1 else "dependencies on other packages have"
            words = f"{count} {what} no counterpart"
            self._account.add_note("depend", words, manifest.span)

    def _finish_component(self, data: dict[str, Any]) -> dict[str, Any]:
        manifest = self._manifest
        facts: dict[str, Any] = {"name": manifest.name}
        if manifest.licenses:
            facts["license"] = ", ".join(manifest.licenses)
        if manifest.description:
            facts["description"] = manifest.description
        hints = {**facts, **data.pop("hints", {})}
        return {
            **({"version": manifest.version} if manifest.version else {}),
            **({"urls": {"website": manifest.website}} if manifest.website else {}),
            **{key: value for key, value in data.items() if value not in ({}, [])},
            "hints": {HINT: hints},
        }

    def _add_component(self, name: str, more: dict[str, Any]) -> None:
        """Add what a file says about a node; what other files said of it before stays."""
        component_id = self._sources.get(name)
        if component_id is None:
            component_id = make_unique_id(make_id(name, "component"), self._ids)
            self._ids.add(component_id)
            self._sources[name] = component_id
        data = self._component_types.setdefault(component_id, {"status": "existing"})
        for key, value in more.items():
            if isinstance(value, dict):
                data[key] = _merge_trees(data.get(key, {}), value)
            else:
                data.setdefault(key, value)

    def _read_text(self, file: PackageFile) -> str | None:
        try:
            return read_bounded(file.path, _MAX_BYTES).decode("utf-8-sig")
        except (ForeignFileError, UnicodeDecodeError) as error:
            words = error.message if isinstance(error, ForeignFileError) else "it is no UTF-8"
            self._account.add_note("file", words, Span.of_file(file.shown))
            return None

    def _read_message(self, file: PackageFile, kind: str) -> None:
        text = self._read_text(file)
        message = f"{self._manifest.name}/{kind}/{file.path.stem}"
        if text is None:
            return
        data, problems = read_message_definition(text, message, file.shown, is_ros_1=self._manifest.is_ros_1)
        for problem in problems:
            self._account.add_note(INVALID_INTERFACE, problem.message, problem.span, problem.help or "")
        name = make_type_name(message)
        if name in self._type_names:
            name = message
        self._type_names.add(name)
        self._types[name] = data
        self._account.count(kind)

    def _read_yaml(self, file: PackageFile) -> None:
        text = self._read_text(file)
        if text is None or ("ros__parameters" not in text and "type:" not in text):
            return
        if "ros__parameters" in text:
            self._read_parameter_file(file, text)
            return
        document, _ = parse_yaml(file.shown, text)
        if document is None or not _is_declaration_file(document.root):
            return
        for entry in document.root:
            if isinstance(entry.value, MappingNode):
                parameters, open_sets = read_declared_parameters(entry.value, self._account)
                more = {"parameters": parameters, "hints": {"declared_in": file.shown}}
                self._add_component(entry.key, {**more, **({"open": open_sets} if open_sets else {})})
                self._account.count("generate_parameter_library")

    def _read_parameter_file(self, file: PackageFile, text: str) -> None:
        parameter_text = read_parameter_text(file.shown, text)
        if parameter_text.problem:
            self._account.add_note("parameter file", parameter_text.problem, Span.of_file(file.shown))
            return
        is_for_any = len(parameter_text.sections) == 1 and not _find_node_name(parameter_text.sections[0])
        for section in parameter_text.sections:
            name = _find_node_name(section)
            values = self._read_values(section)
            span = section.values[0].name_at if section.values else Span.of_file(file.shown)
            if not name and is_for_any:
                name = file.path.name.partition(".")[0]
                words = f"it is for whatever node reads it: what it sets is called `{name}`, as the file"
                self._account.add_note("parameter file", words, span, fate="noted")
            elif not name:
                words = f"what is for `{section.name}` belongs to no single node"
                self._account.add_note("parameter file", words, span)
                continue
            self._add_component(name, {"parameters": values, "hints": {"parameters_in": file.shown}})
            self._account.count("parameter", len(values))

    def _read_values(self, section: ParameterSection) -> dict[str, Any]:
        """Return the values of a section by their dotted names: a set of them might be read as a declaration."""
        values: dict[str, Any] = {}
        for value in section.values:
            if value.value is not None and is_parameter_name(value.name) and _is_parameter_value(value.value):
                values[value.name] = value.value
            elif value.value is not None or not is_parameter_name(value.name):
                what = (
                    "value that a parameter of ROS can have" if is_parameter_name(value.name) else "name of a parameter"
                )
                self._account.add_note("parameter", f"`{value.name}` is no {what}", value.name_at)
        return values


def _find_node_name(section: ParameterSection) -> str:
    """Return the name of the node that a section is for; empty where that is a wildcard."""
    name = section.pattern[-1] if section.pattern else ""
    return "" if name in {"*", "**"} else name


def _merge_trees(first: dict[str, Any], second: dict[str, Any]) -> dict[str, Any]:
    """Return what both say. Where they differ the first one counts, but a declaration more than a value alone."""
    merged = dict(first)
    for key, value in second.items():
        if key not in merged or (isinstance(value, dict) and not isinstance(merged[key], dict)):
            merged[key] = value
    return merged
