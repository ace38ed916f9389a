"""`archgen import orca`: a component type for each definition file, as the components of the Orca Robotics project have them."""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Sequence
from pathlib import Path
from typing import Any

from archgen.plugin import dataclass
from archgen.plugin.importing import (
    ForeignFileError,
    ForeignImport,
    ImportNote,
    Span,
    make_camel_name,
    make_id,
    make_unique_id,
    read_bounded,
    resolve_scalar,
)
from archgen.plugin.model import MAX_NAME_LENGTH

HINT = "orca"
_TAG = "DefaultComponentTag"
_ENDPOINTS = "DefaultComponentEndpoints"
_USUAL_ENDPOINTS = "tcp -t 5000"
_SIDES = {"Provides": "outputs", "Requires": "inputs"}
_SETS = frozenset({"Config", "ExternalConfig"})
_TYPES = {"string": "string", "int": "integer", "double": "float", "angle": "float"}
_WORD = re.compile(r"[^\s.]+\Z")


def read_orca(files: Sequence[Path]) -> ForeignImport:
    """Read definition files, or all files `*.def` below folders. Raise ForeignFileError."""
    paths = [path for given in files for path in (_list_definitions(given) if given.is_dir() else [given])]
    if not paths:
        words = "there is no definition file in it"
        raise ForeignFileError(
            words, Span.of_file(str(files[0]) if files else "."), "give files `*.def`, or a folder with some"
        )
    taken: Counter[str] = Counter()
    notes: list[ImportNote] = []
    component_types: dict[str, Any] = {}
    for path in paths:
        reader = _OrcaReader(read_properties(path), path.name, taken, notes)
        component_id = make_unique_id(make_id(path.stem, "component"), component_types.keys())
        component_types[component_id] = reader.read_component(component_id)
    slices = {"orca_types.yaml": {"component_types": component_types}}
    return ForeignImport(slices, dict(sorted(taken.items())), tuple(notes), "Orca components")


def _list_definitions(folder: Path) -> list[Path]:
    """Return the definition files below a folder; no link is followed."""
    return [path for path in sorted(folder.rglob("*.def")) if path.is_file() and not path.is_symlink()]


class _OrcaReader:
    def __init__(self, properties: list[OrcaProperty], file: str, taken: Counter[str], notes: list[ImportNote]) -> None:
        self._properties = properties
        self._file = file
        self._taken = taken
        self._notes = notes
        self._known: set[str] = set()

    def read_component(self, component_id: str) -> dict[str, Any]:
        """Return the component type. Raise ForeignFileError where the file defines none."""
        values = {each.key: each for each in self._properties}
        tag = values.get(_TAG)
        if tag is None or not tag.value:
            words = f"it has no `{_TAG}`"
            raise ForeignFileError(words, Span.of_file(self._file), "give a definition file of a component of Orca")
        self._known |= {_TAG, _ENDPOINTS}
        comments = [each.value for key, each in sorted(values.items()) if key.startswith("Component.Comment")]
        self._known |= {key for key in values if key.startswith("Component.Comment")}
        hints: dict[str, Any] = {} if make_camel_name(component_id) == tag.value else {"tag": tag.value}
        endpoints = values.get(_ENDPOINTS)
        if endpoints and endpoints.value and endpoints.value != _USUAL_ENDPOINTS:
            hints["endpoints"] = endpoints.value
        ports = {side: self._read_ports(word, values) for word, side in _SIDES.items()}
        parameters, untagged = self._read_parameters(values)
        if untagged:
            hints["untagged"] = untagged
        self._tell_unknown()
        self._taken["component"] += 1
        data: dict[str, Any] = {
            "description": "\n".join(comments),
            "inputs": ports["inputs"],
            "outputs": ports["outputs"],
            "parameters": parameters,
            "hints": {HINT: hints} if hints else {},
        }
        return {key: value for key, value in data.items() if value or key in {"inputs", "outputs"}}

    def _read_ports(self, word: str, values: dict[str, OrcaProperty]) -> dict[str, Any]:
        tags = [parts[1] for key in values if (parts := key.split("."))[0] == word and len(parts) == 3]  # noqa: PLR2004 - `Provides.NAME.Type`
        ports: dict[str, Any] = {}
        for tag in dict.fromkeys(tags):
            properties = {
                key: values[f"{word}.{tag}.{key}"] for key in _PORT_KEYS[word] if f"{word}.{tag}.{key}" in values
            }
            self._known |= {f"{word}.{tag}.{key}" for key in properties}
            names = [
                properties[key].value
                for key in ("DefaultName", "DefaultInterface")
                if key in properties and properties[key].value
            ]
            port_id = make_unique_id(make_id(names[0] if names else tag, "port"), ports.keys())
            if names and names[0] != port_id:
                self._add_note("DefaultName", f"`{names[0]}` is called `{port_id}`", properties, fate="noted")
            ports[port_id] = self._write_port(tag, port_id, properties)
            self._taken[word] += 1
        return ports

    def _write_port(self, tag: str, port_id: str, properties: dict[str, OrcaProperty]) -> Any:  # noqa: ANN401 - the short or the long form
        type_name = properties["Type"].value.rpartition("::")[2].strip() if "Type" in properties else ""
        if not type_name:
            self._add_note("Type", f"`{tag}` has no type", properties)
        proxy = properties.get("DefaultProxy")
        data = {
            "type": type_name,
            # Not the hint of the backend: that stands for what is outside of the architecture.
            "description": f"By default it is connected to `{proxy.value}`." if proxy and proxy.value else "",
            "hints": {} if make_camel_name(port_id) == tag else {HINT: {"tag": tag}},
        }
        kept = {key: value for key, value in data.items() if value}
        return type_name if set(kept) == {"type"} else kept or None

    def _read_parameters(self, values: dict[str, OrcaProperty]) -> tuple[dict[str, Any], list[str]]:
        parameters: dict[str, Any] = {}
        untagged: list[str] = []
        for each in self._properties:
            word, *path = each.key.split(".")
            if word not in _SETS or len(path) < 2 or path.pop() != "Default" or not all(map(_WORD.match, path)):  # noqa: PLR2004
                continue
            if len(each.key) > MAX_NAME_LENGTH:
                self._add_note("Config", f"`{each.key[:60]}...` is too long for the name of a parameter", {"": each})
                continue
            prefix = each.key.removesuffix("Default")
            facts = {
                key: values[f"{prefix}{key}"] for key in ("Comment", "Type", "External") if f"{prefix}{key}" in values
            }
            self._known |= {each.key, *(f"{prefix}{key}" for key in facts)}
            is_external = word == "ExternalConfig" or ("External" in facts and facts["External"].value not in {"", "0"})
            names = path if is_external else [make_id(part, "parameter") for part in path]
            if is_external:
                untagged.append(path[0])
            elif [make_camel_name(name) for name in names[:-1]] != path[:-1]:
                words = f"the set of `{'.'.join(path)}` is called `{'.'.join(names[:-1])}`"
                self._add_note("Config", words, {"": each}, fate="noted")
            parameters[".".join(names)] = self._write_parameter(
                each, path[-1], names[-1], facts, is_external=is_external
            )
            self._taken[word] += 1
        return parameters, list(dict.fromkeys(untagged))

    def _write_parameter(
        self, default: OrcaProperty, tag: str, name: str, facts: dict[str, OrcaProperty], *, is_external: bool
    ) -> Any:  # noqa: ANN401 - a value, or a declaration
        kind = _TYPES.get(facts["Type"].value, "") if "Type" in facts else ""
        if "Type" in facts and not kind:
            self._add_note("Type", f"`{facts['Type'].value}` is no type of Orca", facts)
        read = default.value if kind == "string" else resolve_scalar(default.value) if default.value else ""
        value = float(read) if kind == "float" and isinstance(read, int) and not isinstance(read, bool) else read
        data = {
            "type": kind,
            "value": default.value if value is None else value,
            "description": facts["Comment"].value if "Comment" in facts else "",
            "hints": {} if is_external or make_camel_name(name) == tag else {HINT: {"tag": tag}},
        }
        kept = {key: each for key, each in data.items() if key == "value" or each}
        return kept["value"] if set(kept) == {"value"} else kept

    def _tell_unknown(self) -> None:
        for each in self._properties:
            if each.key not in self._known:
                self._notes.append(
                    ImportNote(each.key.partition(".")[0], f"`{each.key}` is no key of a definition", each.span)
                )

    def _add_note(self, kind: str, message: str, properties: dict[str, OrcaProperty], fate: str = "not taken") -> None:
        span = next((each.span for each in properties.values()), Span.of_file(self._file))
        self._notes.append(ImportNote(kind, message, span, fate=fate))


_PORT_KEYS = {"Provides": ("Type", "DefaultName", "DefaultInterface"), "Requires": ("Type", "DefaultProxy")}


_MAX_BYTES = 4_000_000
_KEPT = frozenset("\\=# ")


@dataclass(frozen=True, slots=True)
class OrcaProperty:
    """A property with its place."""

    key: str
    value: str
    span: Span


def read_properties(path: Path) -> list[OrcaProperty]:
    """Return the properties of a file in its order. Raise ForeignFileError for what is no such file."""
    data = read_bounded(path, _MAX_BYTES)
    try:
        text = data.decode("utf-8-sig")
    except UnicodeDecodeError:
        # Files of that time are of western encodings; comments alone hold such letters.
        text = data.decode("latin-1")
    if "\0" in text:
        words = "it is no text"
        raise ForeignFileError(
            words, Span.of_file(path.name), "give a definition file: lines such as `Config.Rate.Default=5`"
        )
    found: list[OrcaProperty] = []
    for number, line in enumerate(text.replace("\r\n", "\n").split("\n"), 1):
        code = _take_comment(line.rstrip("\r"))
        if code.strip():
            key, value = _split_pair(code)
            found.append(OrcaProperty(key, value, Span(path.name, number, 1, number, len(line) + 1)))
    return found


def _take_comment(line: str) -> str:
    """Return a line up to its comment."""
    position = 0
    while position < len(line) and line[position] != "#":
        position += 2 if line[position] == "\\" else 1
    return line[:position]


def _split_pair(code: str) -> tuple[str, str]:
    position = 0
    while position < len(code) and code[position] != "=":
        position += 2 if code[position] == "\\" else 1
    return _unescape(code[:position].strip()), _unescape(code[position + 1 :].strip())


def _unescape(text: str) -> str:
    kept: list[str] = []
    position = 0
    while position < len(text):
        is_escape = text[position] == "\\" and position + 1 < len(text) and text[position + 1] in _KEPT
        position += is_escape
        kept.append(text[position])
        position += 1
    return "".join(kept)
