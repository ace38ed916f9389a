"""The data of components for a middleware: records in C++ and IDL, each behind those that it holds.

Values that are no records, as three middlewares have them, and the words that others have for them.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import replace
from typing import Any

from archgen.plugin.findings import NO_SPAN, Diagnostic, Severity, Span
from archgen.plugin.generating import read_own_hints, tell_left_out, write_place
from archgen.plugin.model import Architecture
from archgen.plugin.ros import Interface, InterfaceField
from archgen.plugins.middlewares.middleware_names import (
    drop_clashes,
    make_class_name,
    name_data_space,
    name_inside,
    name_member,
)

_LIST = re.compile(r"(?:(?<!\s)\s++)?+\[[^\[\]]*+\]\Z")
_FOREIGN_TYPE = re.compile(r"[A-Za-z_]\w*(?:::[A-Za-z_]\w*)*\Z", re.ASCII)
_FOREIGN_FILE = re.compile(r"[A-Za-z0-9_][\w.+-]*(?:/[\w+-][\w.+-]*)*\Z", re.ASCII)
_TEXT_TYPE = "string"
_HELP_FOR_UNKNOWN = (
    "write `fields` at the type or its package's message file, or in `hints` the class that others define"
)
_IDL_BACKEND = "openrtm"


class MiddlewareTypes:
    """The types that components exchange, and the records that are made for them."""

    def __init__(self, architecture: Architecture, space: str, backend: str) -> None:
        """Take the architecture, the namespace of all that is made, and the backend whose hints count."""
        self._architecture = architecture
        self._backend = backend
        self.space = space
        self._definers = {each.message: each for each in architecture.types.values() if each.message}
        self._records: dict[str, dict[str, Any] | None] = {}
        self._lists: dict[str, dict[str, Any]] = {}
        self._timed: dict[str, str] = {}
        self._told: set[str] = set()
        self._taken: dict[str, str] = {}
        self.findings: list[Diagnostic] = []

    @property
    def records(self) -> list[dict[str, Any]]:
        """The records, each behind those that it holds."""
        return [each for each in self._records.values() if each]

    @property
    def lists(self) -> list[dict[str, Any]]:
        """The types of the items of lists, which have a name in IDL."""
        return list(self._lists.values())

    @property
    def timed(self) -> list[dict[str, str]]:
        """What ports hold in IDL, each to be sent with its time."""
        return [{"name": name, "idl": self._timed[name]} for name in sorted(self._timed)]

    def find_port_type(self, type_name: str | None, port_hints: Mapping[str, object], span: Span) -> dict[str, Any]:
        """Return what a port holds: what its own hints or those of its type say, else its message, else text."""
        declared = self._architecture.types.get(type_name or "")
        type_hints = read_own_hints(declared.annotations.hints, self._backend) if declared else {}
        found = self._find_data(type_name)
        own_hints = {**type_hints, **read_own_hints(port_hints, self._backend)}
        interface = record_interface(own_hints.get("interface"))
        if "interface" in own_hints and interface is None:
            self._tell(f"`{own_hints['interface']}` is no interface of Player with data", span, str(type_name))
        found["interface"] = interface
        foreign = self._read_foreign(own_hints, span, str(type_name))
        if foreign:
            return {**found, **foreign}
        if not interface:
            self._tell_unknown(type_name, span)
        if found["rtm"].startswith(f"{self.space}::"):
            self._timed.setdefault(found["rtm"].rpartition("::")[2], found["idl"])
        return found

    def find_called_type(self, written: str | None, span: Span) -> dict[str, Any]:
        """Return what an operation takes or answers: what hints of its type say, else what it holds.

        OpenRTM-aist has IDL for operations, which needs other words for a class than the class itself.
        """
        declared = None if self._backend == _IDL_BACKEND else self._architecture.types.get(written or "")
        hints = read_own_hints(declared.annotations.hints, self._backend) if declared else {}
        foreign = self._read_foreign(hints, span, str(written))
        return {**self._find_data(written), **foreign} if foreign else self.find_written_type(written, span)

    def find_written_type(self, written: str | None, span: Span) -> dict[str, Any]:
        """Return what a conceptual type, a message or a primitive type holds; of what nobody says the fields it is text, which is told."""
        self._tell_unknown(written, span)
        return self._find_data(written)

    def _find_data(self, written: str | None) -> dict[str, Any]:
        base, is_list = _split_list(written)
        message = self._find_message(base)
        if message is not None:
            record = self._find_record(message, 0)
            if record:
                return self._describe_record(record, is_list=is_list)
        word = base.casefold()
        return self.describe_primitive(ALIASES.get(word, word if word in PRIMITIVES else _TEXT_TYPE), is_list=is_list)

    def _find_message(self, base: str) -> str | None:
        """Return the message whose fields a type has, None where nobody says them."""
        declared = self._architecture.types.get(base)
        message = (declared.message if declared else None) or base
        return message if message in self._architecture.interfaces.definitions else None

    def _tell_unknown(self, written: str | None, span: Span) -> None:
        """Tell that a type is text because nobody says its fields: a receiver could not know what the text means."""
        base, _ = _split_list(written)
        word = base.casefold()
        if base and word not in ALIASES and word not in PRIMITIVES and self._find_message(base) is None:
            declared = self._architecture.types.get(base)
            message = (declared.message if declared else None) or base
            text = f"nobody says the fields of `{message}`: it is text in what is generated"
            self._tell(text, declared.at if declared else span, base, Severity.NOTE, _HELP_FOR_UNKNOWN)

    def find_call_parts(self, type_name: str | None, span: Span) -> list[dict[str, Any] | None]:
        """Return the request and the answer of a service or an action: None for one without fields, and of what nobody says
        the fields they are text.
        """
        declared = self._architecture.types.get(type_name or "")
        definition = self._architecture.interfaces.definitions.get((declared.message if declared else None) or "")
        if definition is None:
            texts = (declared.request, declared.response) if declared else ("", "")
            return [self.find_written_type(each, span) for each in texts]
        parts: list[dict[str, Any] | None] = []
        for number in range(2):
            record = self._find_record(definition.name, number) if definition.parts[number] else None
            parts.append(self._describe_record(record) if record and record["fields"] else None)
        return parts

    def add_answer(self, name: str, fields: Iterable[tuple[str, dict[str, Any]]], span: Span) -> dict[str, Any]:
        """Return a record of its own for what an operation takes or answers, with the types of its fields by name."""
        record = self._start_record(f"calls/{name}", "calls", make_class_name(name), name, span)
        record["fields"] = self._record_fields(record, [(field, field_type, "") for field, field_type in fields], span)
        record["is_fixed"] = all(each["type"]["is_fixed"] for each in record["fields"])
        self._records[record["key"]] = record
        return self._describe_record(record)

    def describe_primitive(self, primitive: str, *, is_list: bool = False) -> dict[str, Any]:
        """Return what is no record, or a list of it."""
        kind, cpp, idl, corba = PRIMITIVES[primitive]
        return self._describe(kind, (cpp, idl, f"CORBA::{corba}", corba), is_list=is_list, is_fixed=kind != "text")

    def _describe_record(self, record: Mapping[str, Any], *, is_list: bool = False) -> dict[str, Any]:
        cpp = f"{self.space}::{record['space']}::{record['name']}"
        word = f"{record['space']}_{record['name']}"
        return self._describe("record", (cpp, f"::{cpp}", cpp, word), is_list=is_list, is_fixed=record["is_fixed"])

    def _describe(
        self, kind: str, names: tuple[str, str, str, str], *, is_list: bool, is_fixed: bool
    ) -> dict[str, Any]:
        """Return a type by its names in C++, in IDL, in the mapping of IDL, and as a part of names."""
        cpp, idl, corba, word = names
        is_shipped = kind != "record" and word not in {"LongLong", "ULongLong"}
        rtm = f"RTC::Timed{word}" if is_shipped else f"{self.space}::timed::{word}"
        item = {"kind": kind, "cpp": cpp, "idl": idl, "corba": corba, "is_list": False, "is_fixed": is_fixed}
        item.update(rtm=rtm, header="", typekit="", interface=None, is_foreign=False)
        if not is_list:
            return item
        name = f"list_of_{word}"
        self._lists.setdefault(name, {"name": name, "idl": idl, "cpp": cpp, "record": cpp if kind == "record" else ""})
        listed = f"{self.space}::{name}"
        return {
            **item,
            "cpp": f"std::vector<{cpp}>",
            "idl": f"::{listed}",
            "corba": listed,
            "is_list": True,
            "is_fixed": False,
            "item": item,
            "rtm": f"{self.space}::timed::{name}",
        }

    def _read_foreign(self, hints: Mapping[str, object], span: Span, name: str) -> dict[str, Any]:
        """Return what hints say of a type that others define, with the faults of what no compiler would take told."""
        texts = {key: str(hints.get(key) or "") for key in ("type", "header", "typekit")}
        for key, pattern in (("type", _FOREIGN_TYPE), ("header", _FOREIGN_FILE), ("typekit", _FOREIGN_FILE)):
            if texts[key] and not pattern.match(texts[key]):
                self._tell(
                    f"the hint `{key}` is no {'class of C++' if key == 'type' else 'name of a file'}", span, name
                )
                return {}
        if not texts["type"]:
            return {}
        foreign = {"kind": "record", "cpp": texts["type"], "corba": texts["type"], "rtm": texts["type"]}
        idl = f"::{texts['type']}"
        own = {"header": texts["header"], "typekit": texts["typekit"], "is_list": False, "is_fixed": False}
        return {**foreign, **own, "idl": idl, "is_foreign": True}

    def _find_record(self, message: str, part: int) -> dict[str, Any] | None:
        """Return the record of a message, or of a part of a service; None for what has none, or holds itself."""
        definition = self._architecture.interfaces.definitions[message]
        if part >= len(definition.parts):
            return None
        key = f"{message} {definition.part_names[part]}".rstrip()
        if key not in self._records:
            for held in self._list_held_messages(definition, part):
                self._records[held] = self._make_record(held, self._architecture.interfaces.definitions[held], 0)
            self._records[key] = self._make_record(key, definition, part)
        return self._records[key]

    def _list_held_messages(self, definition: Interface, part: int) -> list[str]:
        """Return the messages that a part of one holds and that have no record yet, each behind those that it holds.

        Messages may hold one another to any depth: no call waits for another one here.
        """
        definitions = self._architecture.interfaces.definitions
        held: list[str] = []
        begun = {definition.name}
        path: list[tuple[str, Iterator[InterfaceField]]] = [(definition.name, iter(definition.parts[part]))]
        while path:
            name, fields = path[-1]
            base = next((each.type.partition("<=")[0] for each in fields), None)
            if base is None:
                path.pop()
                held.append(name)
            elif base in definitions and base not in begun and base not in self._records:
                begun.add(base)
                path.append((base, iter(definitions[base].parts[0])))
        return held[:-1]

    def _make_record(self, key: str, definition: Interface, part: int) -> dict[str, Any] | None:
        """Return the record of a part of a message; None where another one has its name."""
        package, _, name = definition.name.split("/")
        definer = self._definers.get(definition.name)
        span = definer.at if definer else NO_SPAN
        record = self._start_record(
            key,
            name_data_space(package, self.space),
            make_class_name(f"{name} {definition.part_names[part]}"),
            definition.name,
            span,
        )
        record["comment"] = (definer.comment if definer else None) or definition.comment
        fields = [
            (each.name, field_type, each.comment)
            for each in definition.parts[part]
            if (field_type := self._find_field_type(each, key, span)) is not None
        ]
        record["fields"] = self._record_fields(record, fields, span)
        record["is_fixed"] = all(each["type"]["is_fixed"] for each in record["fields"])
        return record if self._is_free(record) else None

    def _is_free(self, record: Mapping[str, Any]) -> bool:
        """Whether no other record has the name of a record, letters of either case; if one has, tell it."""
        name, key = f"{record['space']}::{record['name']}", str(record["key"])
        first = self._taken.setdefault(name.casefold(), key)
        if first != key:
            definer = self._definers.get(key.partition(" ")[0])
            span = definer.at if definer else NO_SPAN
            self._tell(f"`{first}` and `{key}` give the same record `{name}`: the second one is text", span, key)
        return first == key

    def _start_record(self, key: str, space: str, name: str, title: str, span: Span) -> dict[str, Any]:
        place = write_place(span)
        return {"key": key, "space": space, "name": name, "title": title, "comment": "", "place": place, "fields": []}

    def _record_fields(
        self, record: Mapping[str, Any], fields: Iterable[tuple[str, dict[str, Any], str]], span: Span
    ) -> list[dict[str, Any]]:
        listed, key = list(fields), record["title"]
        members = {name: name_inside(name_member(name), record["name"]) for name, _, _ in listed}
        names = [(members[name], f"{key}.{name}", span) for name, _, _ in listed]
        clashing, clashes = drop_clashes(names, "field")
        self.findings += clashes
        return [
            {"name": members[name], "title": name, "type": field_type, "comment": comment}
            for name, field_type, comment in listed
            if f"{key}.{name}" not in clashing
        ]

    def _find_field_type(self, field: InterfaceField, key: str, span: Span) -> dict[str, Any] | None:
        base = field.type.partition("<=")[0]
        is_list = bool(field.array)
        if "/" not in base:
            return self.describe_primitive(base if base in PRIMITIVES else _TEXT_TYPE, is_list=is_list)
        if base not in self._architecture.interfaces.definitions:
            self._tell_unknown(base, span)
            return self.describe_primitive(_TEXT_TYPE, is_list=is_list)
        if base not in self._records:
            # What it holds has its record already, unless it holds this one.
            self._tell(f"the field `{field.name}` of `{key}` is left out: by it `{key}` would hold itself", span, key)
            return None
        record = self._records[base]
        return (
            self._describe_record(record, is_list=is_list)
            if record
            else self.describe_primitive(_TEXT_TYPE, is_list=is_list)
        )

    def _tell(
        self, message: str, span: Span, element: str, severity: Severity = Severity.ERROR, help_line: str | None = None
    ) -> None:
        if message not in self._told:
            self._told.add(message)
            told = tell_left_out(message, span, element=element, help_line=help_line)
            self.findings.append(replace(told, severity=severity))


def _split_list(written: str | None) -> tuple[str, bool]:
    """Return what a type is, or its items are, and whether it is a list."""
    text = (written or "").strip()
    return _LIST.sub("", text), bool(_LIST.search(text))


PRIMITIVES: Mapping[str, tuple[str, str, str, str]] = {
    "bool": ("truth", "bool", "boolean", "Boolean"),
    "byte": ("whole", "std::uint8_t", "octet", "Octet"),
    "char": ("whole", "std::uint8_t", "octet", "Octet"),
    "uint8": ("whole", "std::uint8_t", "octet", "Octet"),
    "int8": ("whole", "std::int8_t", "short", "Short"),
    "int16": ("whole", "std::int16_t", "short", "Short"),
    "uint16": ("whole", "std::uint16_t", "unsigned short", "UShort"),
    "int32": ("whole", "std::int32_t", "long", "Long"),
    "uint32": ("whole", "std::uint32_t", "unsigned long", "ULong"),
    "int64": ("whole", "std::int64_t", "long long", "LongLong"),
    "uint64": ("whole", "std::uint64_t", "unsigned long long", "ULongLong"),
    "time": ("whole", "std::int64_t", "long long", "LongLong"),
    "duration": ("whole", "std::int64_t", "long long", "LongLong"),
    "float32": ("number", "float", "float", "Float"),
    "float64": ("number", "double", "double", "Double"),
    "string": ("text", "std::string", "string", "String"),
    "wstring": ("text", "std::string", "string", "String"),
}
"""What values are that are no records: their kind, and what C++, IDL and the mapping of IDL call them."""
ALIASES = {
    **dict.fromkeys(("double", "real", "edouble"), "float64"),
    **dict.fromkeys(("float", "efloat"), "float32"),
    **dict.fromkeys(("int", "integer", "eint"), "int32"),
    **dict.fromkeys(("boolean", "eboolean"), "bool"),
    **dict.fromkeys(("text", "estring"), "string"),
    "long": "int64",
    "short": "int16",
    "octet": "uint8",
    "unlimitednatural": "uint32",
}
"""What UML and programming languages call such values."""


# From libplayerinterface/interfaces/*.def of Player 3.1; where there are several, the first counts.
_INTERFACES: Mapping[str, tuple[str, str]] = {
    "actarray": ("STATE actarray_data", "POS actarray_position_cmd"),
    "aio": ("STATE aio_data", "STATE aio_cmd"),
    "audio": ("WAV_REC audio_wav", "WAV_PLAY audio_wav"),
    "blinkenlight": ("STATE blinkenlight_data", "STATE blinkenlight_cmd"),
    "blobfinder": ("BLOBS blobfinder_data", ""),
    "bumper": ("STATE bumper_data", ""),
    "camera": ("STATE camera_data", ""),
    "dio": ("VALUES dio_data", "VALUES dio_cmd"),
    "fiducial": ("SCAN fiducial_data", ""),
    "gps": ("STATE gps_data", ""),
    "gripper": ("STATE gripper_data", ""),
    "health": ("STATE health_data", ""),
    "imu": ("STATE imu_data_state", ""),
    "ir": ("RANGES ir_data", ""),
    "joystick": ("STATE joystick_data", ""),
    "laser": ("SCAN laser_data", ""),
    "limb": ("STATE limb_data", "SETPOSE limb_setpose_cmd"),
    "localize": ("HYPOTHS localize_data", ""),
    "opaque": ("STATE opaque_data", "DATA opaque_data"),
    "planner": ("STATE planner_data", "GOAL planner_cmd"),
    "pointcloud3d": ("STATE pointcloud3d_data", ""),
    "position1d": ("STATE position1d_data", "VEL position1d_cmd_vel"),
    "position2d": ("STATE position2d_data", "VEL position2d_cmd_vel"),
    "position3d": ("STATE position3d_data", "SET_VEL position3d_cmd_vel"),
    "power": ("STATE power_data", ""),
    "ptz": ("STATE ptz_data", "STATE ptz_cmd"),
    "ranger": ("RANGE ranger_data_range", ""),
    "rfid": ("TAGS rfid_data", ""),
    "sonar": ("RANGES sonar_data", ""),
    "speech": ("", "SAY speech_cmd"),
    "speech_recognition": ("STRING speech_recognition_data", ""),
    "stereo": ("STATE stereo_data", ""),
    "wifi": ("STATE wifi_data", ""),
    "wsn": ("STATE wsn_data", "DEVSTATE wsn_cmd"),
}
OPAQUE = "opaque"


def record_interface(name: object) -> dict[str, str] | None:
    """Return the words that a driver needs for an interface; None for one that carries nothing, or that there is not.

    `data_struct` or `command_struct` is empty where it has no data, or no command with any.
    """
    if not isinstance(name, str) or name not in _INTERFACES:
        return None
    data, command = ([*each.split(), "", ""][:2] for each in _INTERFACES[name])
    prefix = f"PLAYER_{name.upper()}"
    return {
        "name": name,
        "code": f"{prefix}_CODE",
        "data": f"{prefix}_DATA_{data[0]}" if data[0] else "",
        "data_struct": f"player_{data[1]}_t" if data[0] else "",
        "command": f"{prefix}_CMD_{command[0]}" if command[0] else "",
        "command_struct": f"player_{command[1]}_t" if command[0] else "",
    }
