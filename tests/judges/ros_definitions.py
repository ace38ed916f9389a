"""What ROS itself makes of interface definitions. The system's Python runs this file: it has Debian's packages.

In: a JSON list of `[ros1, "pkg/msg/Name", text]`. Out: a JSON list of the same length with null where the definition is
refused, else a list of parts, each a list of `[name, type, array]`. ROS 1 (genmsg) judges messages and services, ROS 2
(rosidl_adapter) actions too.
"""

from __future__ import annotations

import contextlib
import importlib
import io
import json
import sys
from typing import Any

Parts = list[list[list[str]]]
TIMES = {"time": "builtin_interfaces/msg/Time", "duration": "builtin_interfaces/msg/Duration"}


def rosidl(name: str, text: str) -> Parts:
    """Let ROS 2 read a definition."""
    parser = importlib.import_module("rosidl_adapter.parser")
    package, kind, short = name.split("/")
    if kind == "msg":
        parts = [parser.parse_message_string(package, short, text)]
    elif kind == "srv":
        service = parser.parse_service_string(package, short, text)
        parts = [service.request, service.response]
    else:
        action = parser.parse_action_string(package, short, text)
        parts = [action.goal, action.result, action.feedback]
    return [[[field.name, *_rosidl_type(field.type)] for field in part.fields] for part in parts]


def _rosidl_type(type_: Any) -> tuple[str, str]:  # noqa: ANN401  # rosidl_adapter has no types
    base = type_.type if type_.pkg_name is None else f"{type_.pkg_name}/msg/{type_.type}"
    bound = f"<={type_.string_upper_bound}" if type_.string_upper_bound else ""
    size = "" if type_.array_size is None else str(type_.array_size)
    return TIMES.get(base, base) + bound, f"[{'<=' if type_.is_upper_bound else ''}{size}]" if type_.is_array else ""


def genmsg(name: str, text: str) -> Parts:
    """Let ROS 1 read a definition."""
    loader = importlib.import_module("genmsg.msg_loader")
    package, kind, short = name.split("/")
    context = loader.MsgContext.create_default()
    if kind == "msg":
        parts = [loader.load_msg_from_string(context, text, f"{package}/{short}")]
    else:
        service = loader.load_srv_from_string(context, text, f"{package}/{short}")
        parts = [service.request, service.response]
    return [[_genmsg_field(field) for field in part.parsed_fields()] for part in parts]


def _genmsg_field(field: Any) -> list[str]:  # noqa: ANN401  # genmsg has no types
    size = "" if field.array_len is None else str(field.array_len)
    return [field.name, field.base_type.replace("/", "/msg/"), f"[{size}]" if field.is_array else ""]


def judge(ros1: bool, name: str, text: str) -> Parts | None:  # noqa: FBT001  # as it stands in the JSON
    """Give what ROS reads, None where it refuses."""
    try:
        return (genmsg if ros1 else rosidl)(name, text)
    except ImportError as error:
        package = "python3-genmsg" if ros1 else "python3-rosidl"
        sys.exit(f"{error}: install Debian's package {package}")
    except Exception:  # noqa: BLE001  # they refuse with whatever their code runs into
        return None


def main() -> None:
    """Judge all definitions of the standard input. What the judges print on the way is dropped."""
    cases = json.load(sys.stdin)
    out = sys.stdout
    with contextlib.redirect_stderr(io.StringIO()), contextlib.redirect_stdout(io.StringIO()):
        verdicts = [judge(*case) for case in cases]
    json.dump(verdicts, out)


if __name__ == "__main__":
    main()
