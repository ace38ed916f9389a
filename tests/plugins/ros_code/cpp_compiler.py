"""Generated packages in C++ put before a compiler, with stand-ins for what no CI has: rclcpp, and messages where there are none."""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any

import yaml

from tests.outside_tools import find_tool, run_judge

STAND_INS = Path(__file__).parent / "rclcpp_stubs"
_MESSAGE = re.compile(r"\b([a-z]\w*)::(msg|srv|action)::([A-Z]\w*)")
_FIELD = re.compile(r"^([\w/]+(?:\[\])?) (\w+)$", re.MULTILINE)
_PARTS = {"msg": (), "srv": ("Request", "Response"), "action": ("Goal", "Result", "Feedback")}
_TYPES = {"bool": "bool", "int": "int64_t", "double": "double", "string": "std::string"}
_KEYS = {"type", "default_value", "description", "read_only", "validation"}


def compile_package(package: Path, folder: Path, include_folders: list[Path] | None = None) -> str:
    """Return what the compiler says of a package. Without folders of real messages there are stand-ins for them."""
    headers = folder / "headers"
    write_parameter_headers(package, headers)
    if include_folders is None:
        write_messages(package, headers)
        include_folders = [STAND_INS / "messages"]
    # One unit for the package: headers are read once.
    lines = []
    for node in sorted(package.glob("src/*_node.cpp")):
        module = node.stem.removesuffix("_node")
        own_names = ("main", "are_among", "tell_values")
        lines += [f"#define {each} {module}_{each}" for each in own_names]
        names = [f"src/{module}_{each}.cpp" for each in ("behaviour", "node", "main")]
        lines += [f'#include "{package / each}"' for each in (*names, f"test/test_{module}_node.cpp")]
        lines += [f"#undef {each}" for each in own_names]
    unit = folder / f"{package.name}.cpp"
    unit.write_text("\n".join(lines) + "\n", encoding="utf-8")
    own = [package / "include", headers]
    system = [STAND_INS, *include_folders]
    command = [
        "-std=c++17",
        "-fsyntax-only",
        "-Wall",
        "-Wextra",
        "-Wpedantic",
        "-Werror",
        "-Wno-unused-function",
    ]
    command += [f"-I{each}" for each in own] + [word for each in system for word in ("-isystem", str(each))]
    return run_judge(find_tool("g++"), *command, unit).stderr


def write_messages(package: Path, headers: Path) -> None:
    """Write a stand-in for each message that a package uses: its name and its parts, with the fields of generated ones."""
    for path in (*package.rglob("*.hpp"), *package.rglob("*.cpp")):
        for space, kind, name in _MESSAGE.findall(path.read_text(encoding="utf-8")):
            if space == "rcl_interfaces":
                continue
            header = headers / space / kind / f"{name_header(name)}.hpp"
            header.parent.mkdir(parents=True, exist_ok=True)
            parts = "".join(_declare_message(part) for part in _PARTS[kind])
            definition = package.parent / space / kind / f"{name}.{kind}"
            text = definition.read_text(encoding="utf-8") if definition.is_file() and not parts else ""
            fields = [(_name_field_type(space, each), field) for each, field in _FIELD.findall(text)]
            body = f"struct {name} {{\n{parts}}};\n" if parts else _declare_message(name, fields)
            used = [match.groups() for each, _ in fields if (match := _MESSAGE.search(each))]
            includes = ["<memory>", "<string>", "<vector>"]
            includes += [f'"{other}/msg/{name_header(each)}.hpp"' for other, _, each in used]
            lines = ["#pragma once", *(f"#include {each}" for each in includes), f"namespace {space}::{kind} {{", body]
            header.write_text("\n".join(lines) + "}\n", encoding="utf-8")


def name_header(name: str) -> str:
    """Return the file of a message, with an underscore where a word begins: `PointCloud2` is in `point_cloud2`."""
    written = ""
    for position, letter in enumerate(name):
        before, after = name[position - 1 : position], name[position + 1 : position + 2]
        is_start = letter.isupper() and position > 0 and (not before.isupper() or after.islower())
        written += ("_" if is_start else "") + letter.lower()
    return written


def _declare_message(name: str, fields: list[tuple[str, str]] | None = None) -> str:
    members = "".join(
        f"  using _{field}_type = {field_class};\n  _{field}_type {field};\n" for field_class, field in fields or ()
    )
    return (
        f"struct {name} {{\n{members}  using SharedPtr = std::shared_ptr<{name}>;\n"
        f"  using ConstSharedPtr = std::shared_ptr<const {name}>;\n  using UniquePtr = std::unique_ptr<{name}>;\n}};\n"
    )


def _name_field_type(package: str, field_type: str) -> str:
    base = field_type.removesuffix("[]")
    plain = {"string": "std::string", "float64": "double"}
    named = plain.get(base) or (base if "/" in base else f"{package}/{base}").replace("/", "::msg::")
    return f"std::vector<{named}>" if field_type.endswith("[]") else named


def write_parameter_headers(package: Path, headers: Path) -> None:
    """Write what generate_parameter_library makes of each file of parameters, as far as nodes use it."""
    for path in package.glob("src/*_parameters.yaml"):
        ((space, tree),) = yaml.safe_load(path.read_text(encoding="utf-8")).items()
        header = headers / package.name / f"{path.stem}.hpp"
        header.parent.mkdir(parents=True, exist_ok=True)
        header.write_text(
            f"#pragma once\n#include <limits>\n#include <string>\n#include <vector>\nnamespace {space} {{\n"
            + "\n".join(_declare_struct("Params", tree))
            + "\nclass ParamListener {\npublic:\n  ParamListener(\n"
            "    const std::shared_ptr<rclcpp::node_interfaces::NodeParametersInterface> &, rclcpp::Logger);\n"
            "  Params get_params() const;\n};\n}\n",
            encoding="utf-8",
        )


def _declare_struct(name: str, tree: Mapping[str, Any]) -> Iterator[str]:
    yield f"struct {name} {{"
    for key, entry in tree.items():
        if isinstance(next(iter(entry.values())), dict):
            # The library names the struct of a group so.
            struct = "".join(word.title() for word in key.split("_"))
            yield from _declare_struct(struct, entry)
            yield f"{struct} {key};"
            continue
        assert entry.keys() <= _KEYS
        base, _, array = entry["type"].partition("_")
        cpp_type = f"std::vector<{_TYPES[base]}>" if array else _TYPES[base]
        yield f"{cpp_type} {key}{' = ' + _write_value(entry['default_value']) if 'default_value' in entry else ''};"
        for values in (entry.get("validation") or {}).values():
            yield (
                f"void check_{key}({cpp_type} value = {_write_value(values[0] if array else values[-1])});"
                if (array)
                else f"void check_{key}(std::vector<{_TYPES[base]}> values = {_write_value(_flatten(values))});"
            )
        yield f'const char * {key}_description = "{_escape(entry.get("description", ""))}";'
    yield "};"


def _flatten(values: list[Any]) -> list[Any]:
    return values[0] if isinstance(values[0], list) else values


def _escape(description: str) -> str:
    """Return a description as the library puts it between quotes: it minds backslashes, and no quotes."""
    return description.replace("\\", "\\\\").replace("`", "").replace("\n", "\\n")


def _write_value(value: object) -> str:
    """Return a value as the library writes it: texts are put between quotes as they are."""
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, list):
        return "{" + ", ".join(_write_value(each) for each in value) + "}"
    if isinstance(value, str):
        return f'"{value}"'
    named = {"inf": "std::numeric_limits<double>::infinity()", "-inf": "-std::numeric_limits<double>::infinity()"}
    named["nan"] = "std::numeric_limits<double>::quiet_NaN()"
    return named.get(str(value), str(value))
