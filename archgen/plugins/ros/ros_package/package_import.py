"""`archgen import package`: component types with the parameters of a package, and types with its messages.

Messages, services and actions of a package as types with fields.
"""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from archgen.plugin.findings import Diagnostic
from archgen.plugin.importing import (
    ForeignFileError,
    ForeignImport,
    MappingNode,
    Span,
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
from archgen.plugins.ros.ros_package.declared_parameters import (
    is_declaration_file,
    is_parameter_value,
    read_declared_parameters,
)
from archgen.plugins.ros.ros_package.import_account import ImportAccount
from archgen.plugins.ros.ros_package.package_files import (
    PackageFile,
    PackageManifest,
    find_manifests,
    read_manifest,
    walk_files,
)
from archgen.plugins.ros.ros_package.package_programs import find_programs

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
        if document is None or not is_declaration_file(document.root):
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
            if value.value is not None and is_parameter_name(value.name) and is_parameter_value(value.value):
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
