"""The formats that `archgen import` reads, as plug-ins tell them: each one's reader is imported when it is asked for."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from functools import partial
from pathlib import Path
from typing import Any

from archgen.frozen import dataclass, fields
from archgen.installed_plugins import (
    IMPORTERS,
    PluginEntry,
    PluginRefusedError,
    list_entries,
    list_shipped_facts,
    load_facts,
    load_object,
    load_shipped_object,
)


@dataclass(frozen=True, slots=True)
class ImportFormat:
    """A format: what it is, how its files end, and who reads it."""

    name: str
    summary: str
    """What it is, for `archgen import --help`."""
    endings: tuple[str, ...]
    """Endings of files that are of this format and of no other, in lower case."""
    load_reader: Callable[[], Any]
    """Returns the function that takes the files and returns what they hold, or raises ForeignFileError."""
    takes_arguments: bool = False
    """Whether values of launch arguments may be given: `NAME:=VALUE`."""
    takes_environment: bool = False
    """Whether the function takes `environment`, too: variables of the environment by their names."""
    takes_launch_files: bool = False
    """Whether the function takes `launch_files` and `distro`, too: which of a workspace's launch files start the robot, and its ROS."""
    keeps_ids: bool = False
    """Whether the function takes `known_ids`, too: ids that elements have since an earlier import, by the other tool's."""
    has_dated_files: bool = False
    """Whether the names of its files say nothing: each is the same robot at another time."""
    has_requirements: bool = False
    """Whether the function takes one file and the project's requirements, and returns ImportedRequirements: they go into a
    slice of a project that is there.
    """
    origin: str = ""
    """Who brings it where it does not ship: package and version."""


_SWITCHES = [each.name for each in fields(ImportFormat) if each.default is False]
_FACTS = frozenset({"api", "summary", "endings", "reader", "rank", *_SWITCHES})
_NEEDED_FACTS = frozenset({"summary", "endings", "reader"})


def list_import_formats() -> dict[str, ImportFormat]:
    """Return the formats by name: those that ship in the order of their ranks, then those of others.

    Raise PluginRefusedError for a plug-in of others that is none, or whose format has a name that is taken.
    """
    shipped = sorted(list_shipped_facts("importers"), key=lambda item: item[2]["rank"])
    formats = {
        name: _make_format(name, facts, partial(load_shipped_object, facts["reader"])) for _, name, facts in shipped
    }
    for entry in list_entries(IMPORTERS):
        facts = load_facts(entry)
        _refuse_facts(entry, facts, formats)
        formats[entry.name] = _make_format(
            entry.name, facts, partial(load_object, entry, facts["reader"]), entry.origin
        )
    return formats


def _make_format(name: str, facts: Mapping[str, Any], load_reader: Callable[[], Any], origin: str = "") -> ImportFormat:
    switches = {key: facts.get(key, False) for key in _SWITCHES}
    return ImportFormat(name, facts["summary"], tuple(facts["endings"]), load_reader, **switches, origin=origin)


def _refuse_facts(entry: PluginEntry, facts: Mapping[str, Any], formats: Mapping[str, ImportFormat]) -> None:
    if missing := sorted(_NEEDED_FACTS - set(facts)):
        problem = f"it does not say {', '.join(missing)}"
    elif unknown := sorted(set(facts) - _FACTS):
        problem = f"an importer has no {', '.join(unknown)}"
    elif entry.name in formats:
        problem = f"{formats[entry.name].origin or 'archgen'} has a format of this name already"
    else:
        return
    raise PluginRefusedError(f"the importer `{entry.name}` of {entry.origin} cannot be used: {problem}")


def guess_format(file: Path, formats: Mapping[str, ImportFormat]) -> ImportFormat | None:
    """Return the format whose files end as this one does, or None."""
    name = file.name.lower()
    return next((known for known in formats.values() if name.endswith(known.endings)), None)
