"""What ROS itself makes of interface definitions. The system's Python runs this file: it has Debian's packages.

In: a JSON list of `[ros1, "pkg/msg/Name", text]`. Out: a JSON list of the same length with null where the definition is
refused, else a list of parts, each a list of `[name, type, array]`. ROS 1 judges messages and services (genmsg).
"""

import importlib
import json
import os
import sys


def _rosidl_type(type_):
    base = type_.type if type_.pkg_name is None else f"{type_.pkg_name}/msg/{type_.type}"
    base = {"time": "builtin_interfaces/msg/Time", "duration": "builtin_interfaces/msg/Duration"}.get(base, base)
    bound = f"<={type_.string_upper_bound}" if type_.string_upper_bound else ""
    size = "" if type_.array_size is None else str(type_.array_size)
    return [base + bound, f"[{'<=' if type_.is_upper_bound else ''}{size}]" if type_.is_array else ""]


def _rosidl(name, text):
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


def _genmsg(name, text):
    loader = importlib.import_module("genmsg.msg_loader")
    package, kind, short = name.split("/")
    context = loader.MsgContext.create_default()
    if kind == "msg":
        parts = [loader.load_msg_from_string(context, text, f"{package}/{short}")]
    else:
        service = loader.load_srv_from_string(context, text, f"{package}/{short}")
        parts = [service.request, service.response]
    return [[_genmsg_field(field) for field in part.parsed_fields()] for part in parts]


def _genmsg_field(field):
    base = field.base_type if "/" not in field.base_type else "/msg/".join(field.base_type.split("/"))
    size = "" if field.array_len is None else str(field.array_len)
    return [field.name, base, f"[{size}]" if field.is_array else ""]


def main():
    """Judge all definitions that stand in the standard input."""
    verdicts = []
    with open(os.devnull, "w", encoding="utf-8") as nowhere:
        sys.stderr = nowhere
        for ros1, name, text in json.load(sys.stdin):
            try:
                verdicts.append((_genmsg if ros1 else _rosidl)(name, text))
            except ImportError as error:
                sys.exit(f"{error.name.split('.')[0]} is missing")
            except Exception:  # the judges refuse with whatever their code runs into
                verdicts.append(None)
    json.dump(verdicts, sys.stdout)


main()
