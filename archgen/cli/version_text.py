"""Format what `archgen --version` prints: archgen and the libraries that it uses."""

from __future__ import annotations

import platform
from importlib import metadata

from archgen import __version__
from archgen.cache.program_stamp import WRITER_LIBRARIES

_LIBRARY_NAMES = ("click", *WRITER_LIBRARIES)


def format_versions() -> str:
    """Return versions, one a line, and whether a fast part is missing."""
    lines = [f"archgen {__version__}", f"Python {platform.python_version()}"]
    lines += [f"{name} {_installed_version(name)}" for name in _LIBRARY_NAMES]
    return "\n".join(lines)


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
