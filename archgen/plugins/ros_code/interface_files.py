"""A message, service or action as its file says it: fields and constants in the spelling of ROS 1 or ROS 2."""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator

from archgen.plugin.generating import write_place
from archgen.plugin.model import ConceptualType
from archgen.plugin.ros import Interface, InterfaceConstant, InterfaceField

_ROS_1_TIMES = {"builtin_interfaces/msg/Time": "time", "builtin_interfaces/msg/Duration": "duration"}
_ROS_2_TIMES = {ros_1_name: message for message, ros_1_name in _ROS_1_TIMES.items()}
_BOUND = re.compile(r"<=(\d+)")
_FIELD_TYPES = frozenset(
    (
        *("bool", "byte", "char", "float32", "float64", "int8", "uint8", "int16", "uint16", "int32", "uint32", "int64"),
        "uint64",
    )
)
_KNOWN_WORDS = _FIELD_TYPES | {"string", "wstring"} | set(_ROS_2_TIMES)
_QUOTES = ('"', "'")


def record_definition(definition: Interface, definer: ConceptualType | None, ros: int) -> dict[str, object]:
    """Return an interface as a file has it; `ros` is the generation of ROS, `definer` the type that says its fields."""
    package, kind, name = definition.name.split("/")
    constants = definition.constants or ((),) * len(definition.parts)
    return {
        "package": package,
        "kind": kind,
        "name": name,
        "path": f"{kind}/{name}.{kind}",
        "place": write_place(definer.at) if definer else "",
        "type": definer.name if definer else "",
        "comment": (definer.comment if definer else None) or definition.comment,
        "parts": [
            {
                "name": part_name,
                "constants": [_record_constant(each, ros) for each in part_constants],
                "fields": [_record_field(each, package, ros) for each in fields],
            }
            for part_name, fields, part_constants in zip(
                definition.part_names, definition.parts, constants, strict=True
            )
        ],
    }


def list_missing_words(definition: Interface, ros: int) -> Iterator[str]:
    """Yield why a definition cannot be written for a generation of ROS."""
    for part in definition.parts:
        for field in part:
            base_type = field.type.partition("<=")[0]
            if base_type == "wstring" and ros == 1:
                yield f"ROS 1 has no `{base_type}`, which `{field.name}` is"
            elif "/" not in field.type and base_type not in _KNOWN_WORDS:
                yield f"nobody says what `{field.type}` is, which `{field.name}` holds"


def list_used_packages(definitions: Iterable[Interface], package: str, ros: int) -> list[str]:
    """Return the packages of the messages that definitions hold, but for their own; ROS 1 has times without a package."""
    field_types = {field.type for each in definitions for part in each.parts for field in part}
    if ros == 1:
        field_types -= set(_ROS_1_TIMES)
    else:
        field_types = {_ROS_2_TIMES.get(each, each) for each in field_types}
    return sorted({each.partition("/")[0] for each in field_types if "/" in each} - {package})


def _record_field(field: InterfaceField, package: str, ros: int) -> dict[str, object]:
    spellings = {1: _spell_in_ros_1(field, package), 2: _spell_in_ros_2(field, package)}
    remarks = [field.comment] if field.comment else []
    if ros == 1:
        # What ROS 1 cannot say is said to people.
        remarks += [f"at most {bound} characters" for bound in _BOUND.findall(field.type)]
        remarks += [f"at most {bound} of them" for bound in _BOUND.findall(field.array)]
        remarks += [f"{field.default} unless set"] if field.default else []
    return {
        "name": field.name,
        "ros_type": field.type,
        "array": field.array,
        "spelling": spellings[ros],
        "ros_1_spelling": spellings[1],
        "ros_2_spelling": spellings[2],
        "default": field.default if ros == 2 else "",  # noqa: PLR2004 - the generation of ROS
        "comment": "; ".join(remarks),
    }


def _spell_in_ros_2(field: InterfaceField, package: str) -> str:
    return f"{_shorten_message(_ROS_2_TIMES.get(field.type, field.type), package)}{field.array}"


def _spell_in_ros_1(field: InterfaceField, package: str) -> str:
    base_type = _ROS_1_TIMES.get(field.type) or _shorten_message(_BOUND.sub("", field.type), package)
    return f"{base_type}{'[]' if _BOUND.search(field.array) else field.array}"


def _shorten_message(message: str, package: str) -> str:
    """Return a message as files name it: one of the same package by its name alone."""
    if "/" not in message:
        return message
    other_package, _, name = message.split("/")
    return name if other_package == package else f"{other_package}/{name}"


def _record_constant(constant: InterfaceConstant, ros: int) -> dict[str, object]:
    return {
        "name": constant.name,
        "type": constant.type,
        # In ROS 1 the text of a constant is the rest of its line, comments and quotes included.
        "value": _unquote(constant.value) if ros == 1 and constant.type == "string" else constant.value,
        "comment": "" if ros == 1 and constant.type == "string" else constant.comment,
        "remark": constant.comment if ros == 1 and constant.type == "string" else "",
    }


def _unquote(value: str) -> str:
    is_quoted = len(value) > 1 and value[0] in _QUOTES and value[-1] == value[0]
    return value[1:-1].replace(f"\\{value[0]}", value[0]) if is_quoted else value
