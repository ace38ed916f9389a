"""Commands that run xacro, as launch files in Python ask for its output."""

from __future__ import annotations

from collections.abc import Mapping

from archgen.plugins.ros.launch.launch_values import LaunchValue, Substitution


def make_xacro_command(path: LaunchValue, mappings: Mapping[LaunchValue, LaunchValue] | None = None) -> Substitution:
    """Return the command whose output is what xacro makes of a file."""
    return Substitution("command", (["xacro ", path, *write_mappings(mappings or {})],))


def write_mappings(mappings: Mapping[LaunchValue, LaunchValue]) -> list[LaunchValue]:
    """Return what is given for the arguments of a file, as words behind the command."""
    return [part for name, value in mappings.items() for part in (f" {name}:=", value)]
