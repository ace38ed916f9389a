"""Find the files of a package, and what its package.xml says."""

from __future__ import annotations

import os
import re
from collections.abc import Iterator
from pathlib import Path

from archgen.plugin import dataclass
from archgen.plugin.importing import ForeignFileError, Span, XmlElement, parse_xml, read_bounded

MANIFEST = "package.xml"
_MAX_MANIFEST = 1_000_000
_MAX_PARTS = 100_000
_WEBSITE = re.compile(r"https?://[^\s<>\"]{1,1990}\Z")
_SKIPPED = frozenset({"build", "install", "log", "node_modules", "test", "tests"})


@dataclass(frozen=True, slots=True)
class PackageFile:
    """A file of a package: where it lies, and how messages name it."""

    path: Path
    shown: str


@dataclass(frozen=True, slots=True)
class PackageManifest:
    """What a package.xml says. `is_ros_1` is whether it is built by catkin."""

    folder: Path
    name: str
    version: str
    description: str
    licenses: tuple[str, ...]
    website: str
    is_ros_1: bool
    span: Span
    dependency_count: int


def find_manifests(paths: tuple[Path, ...]) -> list[Path]:
    """Return the package.xml of files and of folders, of a folder without one those of the packages below it."""
    found: list[Path] = []
    for path in paths:
        if path.is_dir():
            below = [path / MANIFEST] if (path / MANIFEST).is_file() else []
            found += below or sorted(file.path for file in walk_files(path) if file.path.name == MANIFEST)
        else:
            found.append(path)
    return list(dict.fromkeys(found))


def walk_files(folder: Path) -> Iterator[PackageFile]:
    """Yield the files below a folder; what is built, hidden or tested is left out, and no link is followed.

    Raise ForeignFileError where there are too many.
    """
    count = 0
    for top, folders, names in os.walk(folder):
        inner = Path(top).relative_to(folder)
        folders[:] = sorted(name for name in folders if not name.startswith(".") and name not in _SKIPPED)
        count += len(folders) + len(names)
        if count > _MAX_PARTS:
            words = f"more than {_MAX_PARTS:,} files and folders lie below it"
            raise ForeignFileError(words, Span.of_file(str(folder)), "give the folders of the packages instead")
        is_other = bool(inner.parts) and MANIFEST in names
        if is_other:
            # What is in another package is its own.
            folders.clear()
        for name in [MANIFEST] if is_other else sorted(names):
            path = Path(top) / name
            if not path.is_symlink():
                yield PackageFile(path, (Path(folder.name) / inner / name).as_posix())


def read_manifest(path: Path) -> PackageManifest:
    """Return what a package.xml says. Raise ForeignFileError."""
    shown = (Path(path.resolve().parent.name) / path.name).as_posix()
    root = parse_xml(shown, read_bounded(path, _MAX_MANIFEST))
    name = root.find("name")
    if root.tag != "package" or name is None or not name.text.strip():
        words = "it is no package.xml: there is no `name` in a `package`"
        raise ForeignFileError(words, root.span(shown), "give the package.xml of a package of ROS, or its folder")
    export = root.find("export")
    build_types = [each.text.strip() for each in export.find_all("build_type")] if export is not None else []
    tools = [*build_types, *(each.text.strip() for each in root.find_all("buildtool_depend"))]
    return PackageManifest(
        folder=path.resolve().parent,
        name=name.text.strip(),
        version=_read_child_text(root, "version"),
        description=" ".join(_read_child_text(root, "description").split()),
        licenses=tuple(text for each in root.find_all("license") if (text := each.text.strip())),
        website=next((each.text.strip() for each in root.find_all("url") if _is_website(each)), ""),
        # What is built by either is a package of both: then its messages are written as ROS 2 has them.
        is_ros_1="catkin" in tools and not any(tool.startswith("ament") for tool in tools),
        span=root.span(shown),
        dependency_count=sum(child.tag.endswith("depend") for child in root.children),
    )


def _read_child_text(root: XmlElement, tag: str) -> str:
    found = root.find(tag)
    return "" if found is None else found.text.strip()


def _is_website(url: XmlElement) -> bool:
    return url.attributes.get("type", "website") == "website" and _WEBSITE.match(url.text.strip()) is not None
