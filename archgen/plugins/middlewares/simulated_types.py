"""The types of data of a simulation: messages as records of Java and dataclasses of Python, with all that they hold."""

from __future__ import annotations

import ast
import re
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass

from archgen.plugin.findings import NO_SPAN, Diagnostic, Span
from archgen.plugin.generating import (
    find_name_clashes,
    make_identifier_in,
    make_lower_camel_name,
    tell_left_out,
    write_place,
)
from archgen.plugin.model import Architecture
from archgen.plugin.ros import Interface, InterfaceConstant, InterfaceField, is_ros_1
from archgen.plugins.middlewares.java_names import JAVA_CLASS_NAMES, choose_java_spellings

_WHOLE_TYPES = frozenset(
    "byte char int8 uint8 int16 uint16 int32 uint32 int64 uint64 time duration".split()  # noqa: SIM905 - a list of words
)
_NUMBER_TYPES = frozenset(("float32", "float64"))
_BOUND = re.compile(r"\[(<=)?(\d+)\]")
_RECORD_METHODS = frozenset(
    "clone finalize getClass hashCode notify notifyAll toString wait empty equals".split()  # noqa: SIM905
)
_MOST_SLOTS = 250
"""The arguments of a constructor of Java, where numbers of 64 bits count twice: 255 with the object itself."""
_MOST_WHOLE = 2**63
_LARGEST_SIZE = 2**31 - 1


@dataclass(frozen=True, slots=True)
class ValueType:
    """What a value is: `kind` is `whole`, `number`, `truth`, `text`, `anything` or `record`, then with the record's key.

    `most` is None for a list of any length; a value that is no list has `is_list` False.
    """

    kind: str
    record: str = ""
    is_list: bool = False
    least: int = 0
    most: int | None = None


TEXT = ValueType("text")
ANYTHING = ValueType("anything")


class SimulatedTypes:
    """The types that ports of a simulation have, and the records that are made for them."""

    def __init__(self, architecture: Architecture, base: str) -> None:
        """Take the architecture, and the package of Java below which records stand."""
        self._architecture = architecture
        self._base = base
        self._definers = {each.message: each for each in architecture.types.values() if each.message}
        self._records: dict[str, dict[str, object]] = {}
        self._left_out: set[str] = set()
        self.findings: list[Diagnostic] = []

    def find_port_type(self, type_name: str | None) -> ValueType:
        """Return what a port of a conceptual type holds; of what nobody says the fields it is a text."""
        mapped = self._architecture.types.get(type_name or "")
        return self._find_message(mapped.message if mapped else None, 0)

    def find_call_types(self, type_name: str | None) -> tuple[ValueType, ...]:
        """Return the parts of a service or an action: request and answer, of an action what is told in between behind them."""
        mapped = self._architecture.types.get(type_name or "")
        message = mapped.message if mapped else None
        definition = self._architecture.interfaces.definitions.get(message or "")
        if definition is None or message is None:
            return TEXT, TEXT, TEXT
        return tuple(self._find_message(message, number) for number in range(len(definition.parts)))

    def list_records(self) -> list[dict[str, object]]:
        """Return the records, in the order of their packages and names."""
        return [self._records[key] for key in sorted(self._records)]

    def spell_in_java(self, types: Iterable[ValueType], package: str, own_names: Iterable[str]) -> dict[str, str]:
        """Return how a file of Java names records, by their keys, and what it imports, by the full names."""
        names = {each.record: self.name_java_class(each.record) for each in types if each.kind == "record"}
        return choose_java_spellings(names, package, own_names)

    def list_java_imports(self, types: Iterable[ValueType], spellings: Mapping[str, str], package: str) -> list[str]:
        """Return what a file of Java imports of other packages to name records as `spell_in_java` says."""
        keys = {each.record for each in types if each.kind == "record"}
        return sorted(
            {
                self.name_java_class(key)
                for key in keys
                if "." not in spellings[key] and self._records[key]["java_package"] != package
            }
        )

    def list_modules(self, types: Iterable[ValueType]) -> list[str]:
        """Return the modules of Python that hold the records among some types."""
        return sorted({str(self._records[each.record]["module"]) for each in types if each.kind == "record"})

    def name_java_class(self, key: str) -> str:
        """Return the full name of a record in Java."""
        record = self._records[key]
        return f"{record['java_package']}.{record['class_name']}"

    def describe(self, value_type: ValueType, spellings: Mapping[str, str]) -> dict[str, object]:
        """Return a type as templates take it: `java` and `java_boxed` are what it is called in Java."""
        simple = {
            "whole": ("long", "Long"),
            "number": ("double", "Double"),
            "truth": ("boolean", "Boolean"),
            "text": ("String", "String"),
            "anything": ("Object", "Object"),
        }
        java, boxed = simple.get(value_type.kind) or (spellings[value_type.record],) * 2
        record = self._records.get(value_type.record, {})
        return {
            "kind": value_type.kind,
            "is_list": value_type.is_list,
            "least": value_type.least,
            "most": value_type.most,
            "java": f"List<{boxed}>" if value_type.is_list else java,
            "java_boxed": boxed,
            "module": record.get("module"),
            "python_class": record.get("python_class"),
        }

    def _find_message(self, message: str | None, part: int) -> ValueType:
        definition = self._architecture.interfaces.definitions.get(message or "")
        if message is None or definition is None or part >= len(definition.parts):
            return TEXT
        part_name = definition.part_names[part]
        key = f"{message} {part_name}" if part_name else message
        if key in self._left_out:
            return TEXT
        if key not in self._records:
            self._add_record(key, definition, part)
        return TEXT if key in self._left_out else ValueType("record", key)

    def _add_record(self, key: str, definition: Interface, part: int) -> None:
        package, _, name = definition.name.split("/")
        definer = self._definers.get(definition.name)
        span = definer.at if definer else NO_SPAN
        class_name = make_identifier_in("java", f"{name}{definition.part_names[part].capitalize()}")
        if class_name in JAVA_CLASS_NAMES:
            class_name = f"{class_name}Message"
        java_package = f"{self._base}.data.{make_identifier_in('java', package)}"
        record: dict[str, object] = {
            "key": key,
            "message": definition.name,
            "part": definition.part_names[part],
            "java_package": java_package,
            "module": make_identifier_in("python", package),
            "class_name": class_name,
            "python_class": make_identifier_in("python", class_name),
            "title": definer.name if definer else definition.name,
            "comment": (definer.comment if definer else None) or definition.comment,
            "place": write_place(span),
        }
        # In its place before its fields are looked at: a message may hold a list of its own kind.
        self._records[key] = record
        fields = definition.parts[part]
        slots = sum(2 for _ in fields)
        if slots > _MOST_SLOTS:
            self._leave_out(key, f"`{key}` has {len(fields)} fields, more than a record of Java can have", span)
            return
        names = [(name_java_field(each.name), f"{key}.{each.name}", span) for each in fields]
        clashes = list(find_name_clashes(names, "field"))
        self.findings += clashes
        clashing = {each.element for each in clashes}
        kept = [each for each in fields if f"{key}.{each.name}" not in clashing]
        constants = list(
            self._keep_constants(key, kept, definition.constants[part] if definition.constants else (), span)
        )
        types = {each.name: self._find_field_type(each) for each in kept}
        own_names = [class_name, "List", "Collections", "Named", "Values"]
        spellings = self.spell_in_java(types.values(), java_package, own_names)
        record["java_imports"] = self.list_java_imports(types.values(), spellings, java_package)
        record["modules"] = [each for each in self.list_modules(types.values()) if each != record["module"]]
        record["fields"] = [
            self._record_field(each, types[each.name], spellings, self._find_default(definition.name, each))
            for each in kept
        ]
        record["constants"] = [
            {"name": each.name, "kind": _name_kind(each.type), "value": value, "comment": each.comment}
            for each in constants
            if (value := _read_default(each.value, _name_kind(each.type))) is not None
        ]

    def _keep_constants(
        self, key: str, fields: Iterable[InterfaceField], constants: Iterable[InterfaceConstant], span: Span
    ) -> Iterator[InterfaceConstant]:
        """Yield the constants of a record whose names are those of nothing else in it; report the others."""
        taken = {
            name for each in fields for name in (name_java_field(each.name), make_identifier_in("python", each.name))
        }
        for each in constants:
            name = make_identifier_in("java", each.name)
            if name in taken:
                self.findings.append(
                    tell_left_out(
                        f"the constant `{each.name}` of `{key}` is left out: another name in it gives `{name}`, too",
                        span,
                        element=key.partition(" ")[0],
                        help_line="give it another name",
                    )
                )
            else:
                taken.add(name)
                yield each

    def _leave_out(self, key: str, message: str, span: Span) -> None:
        self._left_out.add(key)
        del self._records[key]
        self.findings.append(tell_left_out(message, span, element=key.partition(" ")[0]))

    def _find_field_type(self, field: InterfaceField) -> ValueType:
        base = field.type.partition("<=")[0]
        found = self._find_message(base, 0) if "/" in base else ValueType(_name_kind(base))
        if not field.array:
            return found
        bound = _BOUND.fullmatch(field.array)
        size = min(int(bound[2]), _LARGEST_SIZE) if bound else None
        return ValueType(
            found.kind, found.record, is_list=True, least=size or 0 if bound and not bound[1] else 0, most=size
        )

    def _find_default(self, message: str, field: InterfaceField) -> str:
        """Return the default of a field as written; of ROS 2's own messages the one that begins with another value than 0."""
        if field.default or is_ros_1(self._architecture.distro):
            return field.default
        return _ROS_2_DEFAULTS.get(f"{message}.{field.name}", "")

    def _record_field(
        self, field: InterfaceField, value_type: ValueType, spellings: Mapping[str, str], default: str
    ) -> dict[str, object]:
        python_name = make_identifier_in("python", field.name)
        return {
            "name": field.name,
            "java_name": name_java_field(field.name),
            "java_method": f"with{name_java_field(field.name)[0].upper()}{name_java_field(field.name)[1:]}",
            "python_name": python_name,
            "type": self.describe(value_type, spellings),
            "default": _read_field_default(default, value_type),
            "comment": field.comment,
        }


_ROS_2_DEFAULTS = {"geometry_msgs/msg/Quaternion.w": "1"}
"""What the definitions of ROS 2's common interfaces say of fields that do not begin with 0."""


def name_java_field(name: str) -> str:
    """Return a name of the model as Java names fields and methods: `maxSpeed`."""
    java_name = make_lower_camel_name(name)
    java_name = make_identifier_in("java", java_name)
    return f"{java_name}_" if java_name in _RECORD_METHODS else java_name


def _name_kind(base_type: str) -> str:
    if base_type == "bool":
        return "truth"
    if base_type in _NUMBER_TYPES:
        return "number"
    return "whole" if base_type in _WHOLE_TYPES else "text"


def _read_field_default(written: str, value_type: ValueType) -> object:
    """Return the default of a field as a value; None where it has none that is one."""
    if not written or value_type.kind == "record":
        return None
    if not value_type.is_list:
        return _read_default(written, value_type.kind)
    try:
        items = ast.literal_eval(re.sub(r"\b(true|false)\b", lambda match: match[0].capitalize(), written))
    except (ValueError, SyntaxError, RecursionError, MemoryError):
        return None
    values = (
        [_read_default(str(each), value_type.kind) for each in items] if isinstance(items, list | tuple) else [None]
    )
    fits = value_type.least <= len(values) <= (_LARGEST_SIZE if value_type.most is None else value_type.most)
    return values if fits and None not in values else None


def _read_default(written: str, kind: str) -> object:
    try:
        if kind == "truth":
            return {"true": True, "1": True, "false": False, "0": False}.get(written.lower())
        if kind == "whole":
            value = int(written, 0)
            return value if -_MOST_WHOLE <= value < _MOST_WHOLE else None
        if kind == "number":
            return float(written)
    except ValueError:
        return None
    is_quoted = len(written) > 1 and written[0] in "\"'" and written[-1] == written[0]
    return written[1:-1].replace(f"\\{written[0]}", written[0]) if is_quoted else written
