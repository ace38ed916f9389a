"""Where the facts about the component types that ship with archgen were read: repository, version, date, file and line.

`ros_library/sources/` has a file for each distribution. It is read only when somebody asks: no check of a project does.
"""

from __future__ import annotations

from collections.abc import Mapping
from functools import cache
from typing import Any

from archgen import resources
from archgen.frozen import NamedTuple

SOURCE_KINDS = ("documentation", "source text", "recording")
"""Words for what was read: what people wrote about the package, the package's own files, or a running node."""


class ShippedSource(NamedTuple):
    """A state of a repository from which facts about a type were read."""

    address: str
    """The repository's, without the commit."""
    version: str
    released: str
    """The version that the distribution has; the one that was read, unless that one was not at hand."""
    commit: str
    date: str
    """The commit's, as YYYY-MM-DD."""
    kind: str
    files: Mapping[str, Mapping[str, int]]
    """The line of each fact, by the file's path in the repository and the fact's path in the type."""

    def format_link(self, file: str = "", line: int | None = None) -> str:
        """Return the address of a line, a file, or the whole commit."""
        if not file:
            return f"{self.address}/tree/{self.commit}"
        return f"{self.address}/blob/{self.commit}/{file}" + (f"#L{line}" if line else "")


@cache
def read_shipped_sources(distro: str) -> Mapping[str, tuple[ShippedSource, ...]]:
    """Return the sources of each type that ships for a distribution, by its name; read once."""
    import yaml

    # Not archgen's own parser: the file ships with archgen, and no position in it is ever reported.
    loader = getattr(yaml, "CSafeLoader", yaml.SafeLoader)
    path = resources.resource_path("ros_library", "sources", f"{distro}.yaml")
    data = yaml.load(path.read_text("utf-8"), loader)  # noqa: S506 - safe ones
    return {name: tuple(_read_source(source) for source in sources) for name, sources in data.items()}


def _read_source(source: dict[str, Any]) -> ShippedSource:
    return ShippedSource(
        source["address"],
        source["version"],
        source.get("released", source["version"]),
        source["commit"],
        str(source["date"]),
        source["kind"],
        source["files"],
    )
