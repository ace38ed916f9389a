"""Format what `archgen --version` prints: archgen and the libraries that it uses."""

from __future__ import annotations

import platform
from collections.abc import Iterator
from importlib import metadata

from archgen import __version__
from archgen.cache.program_stamp import WRITER_LIBRARIES
from archgen.installed_plugins import GROUPS, list_all_entries

_LIBRARY_NAMES = ("click", *WRITER_LIBRARIES)


def format_versions() -> str:
    """Return versions, one a line, and whether a fast part is missing; then the plug-ins of others."""
    lines = [f"archgen {__version__}", f"Python {platform.python_version()}"]
    lines += [f"{name} {_installed_version(name)}" for name in _LIBRARY_NAMES]
    return "\n".join([*lines, *_list_plugins()])


def _list_plugins() -> Iterator[str]:
    """Yield a line for each package that brings plug-ins, with what it brings."""
    brought: dict[str, list[str]] = {}
    for entry in list_all_entries():
        kind = f"{entry.group.removeprefix('archgen.')} {entry.name}"
        is_known = entry.group in GROUPS
        brought.setdefault(entry.origin, []).append(kind if is_known else f"{kind} (which this archgen does not know)")
    yield from (f"plug-in {origin}: {', '.join(kinds)}" for origin, kinds in sorted(brought.items()))


def _installed_version(name: str) -> str:
    try:
        library_version = metadata.version(name)
    except metadata.PackageNotFoundError:
        return "is not installed"
    if name == "pyyaml":
        import yaml

        return (
            library_version
            if yaml.__with_libyaml__
            else f"{library_version} (without libyaml: reading is about ten times slower)"
        )
    return library_version
