"""Format what `archgen --version` prints: archgen and the libraries that it uses."""

from __future__ import annotations

import platform
from importlib import metadata

from archgen import __version__

_LIBRARIES = ("click", "jinja2", "jsonschema-rs", "lxml", "markdown-it-py", "pygraphviz", "pyyaml")


def version() -> str:
    """Return versions, one a line, and whether a fast part is missing."""
    lines = [f"archgen {__version__}", f"Python {platform.python_version()}"]
    lines += [f"{name} {_installed(name)}" for name in _LIBRARIES]
    return "\n".join(lines)


def _installed(name: str) -> str:
    try:
        found = metadata.version(name)
    except metadata.PackageNotFoundError:
        return "is not installed"
    if name == "pyyaml":
        import yaml

        return found if yaml.__with_libyaml__ else f"{found} (without libyaml: reading is about ten times slower)"
    return found
