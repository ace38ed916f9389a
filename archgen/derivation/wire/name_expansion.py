"""Names as a program writes them become absolute ones, as ROS 2 (rcl) and ROS 1 (rospy, roscpp) do it."""

from __future__ import annotations

import re

_FORBIDDEN_CHARACTER = re.compile(r"[^A-Za-z0-9_]")
_SUBSTITUTION = re.compile(r"\{(?:node|ns|namespace)\}")
_INNER_NAMESPACE = re.compile(r"/\{(?:ns|namespace)\}")
_INNER_NAMESPACE_FAULT = "the namespace begins with a `/` of its own, so that two `/` follow one another"
_FULL_NAME_IN_ROS_2 = re.compile(r"(?:/[A-Za-z_][A-Za-z0-9_]*)+", re.ASCII)


def expand_name(written_name: str, namespace: str, node_name: str, *, ros_1: bool) -> str | None:
    """Return the absolute name that a node gets for what its program writes, None where ROS refuses it."""
    place = "" if namespace == "/" else namespace.rstrip("/")
    if ros_1:
        return _expand_in_ros_1(written_name, place, node_name)
    if written_name.startswith("/") and "{" not in written_name:
        full_name = written_name
    else:
        # The namespace stands there with its `/`: `{ns}/x` is absolute already, and `x/{ns}` no name.
        own = place or "/"
        name = written_name.replace("{node}", node_name).replace("{ns}", own).replace("{namespace}", own)
        if name.startswith("~"):
            # rcl takes `~x`, too, and makes no `/` of it: what nobody means is told as a fault of the name.
            name = f"{place}/{node_name}{name[1:]}"
        full_name = name if name.startswith("/") else f"{place}/{name}"
    return full_name if _FULL_NAME_IN_ROS_2.fullmatch(full_name) else None


def _expand_in_ros_1(written_name: str, place: str, node_name: str) -> str | None:
    is_private = written_name.startswith("~")
    parts = [part for part in written_name.removeprefix("~").split("/") if part]
    if is_private:
        return "/".join((place, node_name, *parts))
    if not parts:
        return None
    return "/".join(("" if written_name.startswith("/") else place, *parts))


def find_name_fault(text: str, *, ros_1: bool = False) -> str | None:
    """Return what is wrong with the name of a topic, service or namespace, or None.

    The rules are those of https://design.ros2.org/articles/topic_and_service_names.html as far as ROS 2 enforces them, and
    of http://wiki.ros.org/Names for ROS 1, where only the first letter of the whole name must not be a digit.
    """
    if not text:
        return "it is empty"
    remaining_name = text
    if text.startswith("~"):
        remaining_name = text[1:]
        # In ROS 1 `~scan` is the private name that launch files and nodes write.
        if remaining_name and not remaining_name.startswith("/") and not ros_1:
            return "`~` is followed by `/`"
    if ros_1:
        # A `/` too many does no harm there.
        remaining_name = re.sub("/+", "/", remaining_name.rstrip("/"))
    if remaining_name in {"", "/"}:
        return None
    if remaining_name.endswith("/"):
        return "it ends with `/`"
    # In ROS 2 substitutions such as `{node}` are replaced by a valid name; other braces remain and are reported.
    tokens = (remaining_name if ros_1 else _SUBSTITUTION.sub("x", remaining_name)).removeprefix("/").split("/")
    may_be_digits = ros_1 and remaining_name.startswith("/")
    faults = (
        _find_token_fault(token, may_start_with_digit=may_be_digits or (ros_1 and position > 0))
        for position, token in enumerate(tokens)
    )
    has_inner_namespace = not ros_1 and _INNER_NAMESPACE.search(remaining_name) is not None
    return next(filter(None, faults), _INNER_NAMESPACE_FAULT if has_inner_namespace else None)


def find_node_name_fault(name: str) -> str | None:
    """Return what is wrong with a node's name, or None."""
    if "/" in name:
        return "it holds `/`: what stands before the name belongs into `namespace`"
    return _find_token_fault(name, may_start_with_digit=False) if name else "it is empty"


def _find_token_fault(token: str, *, may_start_with_digit: bool) -> str | None:
    if not token:
        return "two `/` follow one another"
    forbidden = _FORBIDDEN_CHARACTER.search(token)
    if forbidden:
        character = "a blank" if forbidden[0].isspace() else f"`{forbidden[0]}`"
        return f"it holds {character}, and only letters (a to z), digits and `_` are allowed"
    if token[0].isdigit() and not may_start_with_digit:
        return f"`{token}` begins with a digit"
    return None
