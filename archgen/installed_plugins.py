"""Which plug-ins there are: those that ship are the folders of `archgen/plugins`, those of others are found by entry points.

Entry points are read without `importlib.metadata`, which takes longer to load than they take to read, and looks along
`sys.path`, where the folder of the judged project may stand: a project never brings code of its own. Only folders that an
installer writes to are looked at, and what is imported lies below one of these.
"""

from __future__ import annotations

import importlib
import os
import site
import sys
from collections.abc import Iterator, Mapping
from contextlib import contextmanager, suppress
from functools import cache
from typing import Any

from archgen.frozen import dataclass
from archgen.resources import SWITCH_VARIABLE

API = 1
"""The number of `archgen.plugin`. It grows when a plug-in that was written for it would have to be changed."""
IMPORTERS, GENERATORS, RULES = GROUPS = ("archgen.importers", "archgen.generators", "archgen.rules")
"""The groups of entry points. Each entry leads to a mapping: `api`, and what docs/plugins.md says of its group."""
SHIPPED_PACKAGE = "archgen.plugins"
_SHIPPED_FOLDER = os.path.join(os.path.dirname(os.path.abspath(__file__)), "plugins")  # noqa: PTH100, PTH118, PTH120 - pathlib takes longer to load than all this takes
_GROUP_MARK = b"[archgen."

Facts = Mapping[str, Any]
"""What a plug-in says of itself, as the `PLUGIN` of its package."""


class PluginRefusedError(Exception):
    """A plug-in cannot be used. The message names its package, and says what to do."""


@dataclass(frozen=True, slots=True)
class PluginEntry:
    """An entry point of an installed package: `target` is `module:name`."""

    group: str
    name: str
    target: str
    package: str
    version: str
    folder: str
    """The folder that holds the package's metadata."""

    @property
    def origin(self) -> str:
        """Return who brings it, for messages: `archgen-toy 1.0`."""
        return f"{self.package} {self.version}"


@cache
def list_shipped_plugins() -> Mapping[str, Facts]:
    """Return the facts of the plug-ins that ship, by name: what is taken out of `archgen/plugins` is not there."""
    names = map(os.path.basename, list_shipped_folders())
    return {name: importlib.import_module(f"{SHIPPED_PACKAGE}.{name}").PLUGIN for name in names}


@cache
def list_shipped_folders() -> tuple[str, ...]:
    """Return the folders of the plug-ins that ship, by name, without importing them."""
    try:
        return tuple(sorted(entry.path for entry in os.scandir(_SHIPPED_FOLDER) if _is_plugin(entry)))
    except FileNotFoundError:
        return ()


def _is_plugin(entry: os.DirEntry[str]) -> bool:
    # A folder that git left behind holds no more than compiled files.
    return entry.is_dir() and os.path.isfile(os.path.join(entry.path, "__init__.py"))  # noqa: PTH113, PTH118 - as above


def list_shipped_facts(kind: str) -> Iterator[tuple[str, str, Any]]:
    """Yield what the plug-ins that ship bring of a kind, `importers` for instance: plug-in, name, facts."""
    for plugin, facts in list_shipped_plugins().items():
        for name, own_facts in facts.get(kind, {}).items():
            yield plugin, name, own_facts


def load_reader(purpose: str) -> Any:  # noqa: ANN401 - a function of the purpose's own kind
    """Return the function that reads what a verb takes beside formats: `recordings`, `tables`, `headings`.

    Raise PluginRefusedError where the plug-in that has it is taken out.
    """
    for facts in list_shipped_plugins().values():
        if purpose in facts.get("readers", {}):
            return load_shipped_object(facts["readers"][purpose])
    raise PluginRefusedError(f"there is no plug-in that reads {purpose}: it is taken out of {SHIPPED_PACKAGE}")


def list_entries(group: str) -> tuple[PluginEntry, ...]:
    """Return the entry points of a group, by name and package; none where plug-ins of others are switched off."""
    return tuple(entry for entry in list_all_entries() if entry.group == group)


def list_all_entries() -> tuple[PluginEntry, ...]:
    """Return the entry points of all groups, those of groups that archgen does not know included."""
    return () if os.environ.get(SWITCH_VARIABLE) else _scan_folders()


def switch_off_others() -> None:
    """Use no plug-ins of others in this process and its workers."""
    os.environ[SWITCH_VARIABLE] = "1"


def load_facts(entry: PluginEntry) -> Facts:
    """Import a plug-in of others and return its facts. Raise PluginRefusedError where it is none, or for another archgen."""
    facts = load_object(entry, entry.target)
    if not isinstance(facts, Mapping):
        msg = f"{_name_entry(entry)} is no mapping with `api`: `{entry.target}` is of the type {type(facts).__name__}"
        raise PluginRefusedError(msg)
    if facts.get("api") != API:
        raise PluginRefusedError(
            f"{_name_entry(entry)} is written for api {facts.get('api')!r} of archgen.plugin, and this archgen has {API}: "
            "install a version of it that fits, or leave out plug-ins with `archgen --no-plugins`"
        )
    return facts


def load_object(entry: PluginEntry, target: str) -> Any:  # noqa: ANN401 - whatever stands there
    """Import what `module:name` names in the package of an entry point. Raise PluginRefusedError."""
    module_name, _, name = target.partition(":")
    with _leave_out_current_folder():
        _refuse_foreign_origin(entry, module_name)
        try:
            found = importlib.import_module(module_name)
            for part in name.split("."):
                found = getattr(found, part)
        except Exception as error:  # whatever a stranger's module raises is said in a sentence
            raise PluginRefusedError(
                f"{_name_entry(entry)} cannot be loaded: `{target}`: {type(error).__name__}: {error}; "
                "mend or uninstall it, or leave out plug-ins with `archgen --no-plugins`"
            ) from error
    return found


def load_shipped_object(target: str) -> Any:  # noqa: ANN401 - whatever stands there
    """Import what `module:name` names in a plug-in that ships."""
    module_name, _, name = target.partition(":")
    return getattr(importlib.import_module(module_name), name)


def list_module_files() -> tuple[str, ...]:
    """Return the files and folders of the modules that plug-ins of others begin with; nothing is imported."""
    found: dict[str, None] = {}
    for entry in list_all_entries():
        top = entry.target.partition(":")[0].partition(".")[0]
        paths = (
            os.path.join(folder, name)  # noqa: PTH118
            for folder in _list_trusted_folders(entry)
            for name in (top, f"{top}.py")
        )
        found |= dict.fromkeys(path for path in paths if os.path.exists(path))  # noqa: PTH110
    return tuple(found)


def _list_trusted_folders(entry: PluginEntry) -> tuple[str, ...]:
    return (*list_package_folders(), *_list_path_file_folders(), *_list_editable_folder(entry))


def _name_entry(entry: PluginEntry) -> str:
    return f"the plug-in `{entry.name}` ({entry.group}) of {entry.origin}"


def find_package_folder(entry: PluginEntry) -> str | None:
    """Return the folder of the package that an entry point leads to, without importing it; None where it is a single file.

    Raise PluginRefusedError where it lies elsewhere than what is installed.
    """
    with _leave_out_current_folder():
        folder, file = os.path.split(_refuse_foreign_origin(entry, entry.target.partition(":")[0]))
    return folder if file.startswith("__init__.") else None


def _refuse_foreign_origin(entry: PluginEntry, module_name: str) -> str:
    """Return the file of a top-level module. Refuse one that would come from elsewhere than where installers write: a file of the project, for instance."""
    from importlib import util

    top = module_name.partition(".")[0]
    try:
        spec = util.find_spec(top)
    except (ImportError, ValueError):
        spec = None
    if spec is None or spec.origin is None:
        msg = f"{_name_entry(entry)} cannot be loaded: there is no module `{top}`; install the package again"
        raise PluginRefusedError(msg)
    origin = os.path.realpath(spec.origin)
    folders = (os.path.join(os.path.realpath(folder), "") for folder in _list_trusted_folders(entry))  # noqa: PTH118
    if not origin.startswith(tuple(folders)):
        msg = f"{_name_entry(entry)} is not loaded: `{top}` would be {origin}, which lies in no folder of installed packages"
        raise PluginRefusedError(msg)
    return origin


@contextmanager
def _leave_out_current_folder() -> Iterator[None]:
    """Leave the current folder out of the search for modules, unless an installer named it.

    `python -m archgen` puts it first: there, a file of the project would be imported in place of the plug-in's.
    """
    current = _find_current_folder()
    named = _list_path_file_folders()
    kept = sys.path[:]
    if not sys.flags.safe_path:
        sys.path[:] = [path for path in kept if path in named or (path and os.path.abspath(path) != current)]  # noqa: PTH100
    try:
        yield
    finally:
        sys.path[:] = kept


def _find_current_folder() -> str:
    try:
        return os.getcwd()  # noqa: PTH109 - pathlib takes longer to load than all this takes
    except FileNotFoundError:
        # Somebody took it away: then nothing is in it.
        return os.sep


@cache
def _scan_folders() -> tuple[PluginEntry, ...]:
    current = os.path.realpath(_find_current_folder())
    found: dict[tuple[str, str, str], PluginEntry] = {}
    for folder in (*list_package_folders(), *_list_path_file_folders()):
        if os.path.realpath(folder) == current:
            continue
        for entry in _scan_folder(folder):
            # Of a package that is installed twice Python imports the first.
            found.setdefault((entry.group, entry.name, entry.package), entry)
    return tuple(found[key] for key in sorted(found))


def _scan_folder(folder: str) -> Iterator[PluginEntry]:
    for name in _list_names(folder):
        if name.endswith(".dist-info"):
            try:
                # Unbuffered: there are as many of these files as there are packages.
                with open(f"{folder}/{name}/entry_points.txt", "rb", buffering=0) as stream:  # noqa: PTH123
                    data = stream.read()
            except OSError:
                continue
            if _GROUP_MARK in data:
                package, _, version = name.removesuffix(".dist-info").partition("-")
                yield from _parse_entries(data, package, version, folder)


def _parse_entries(data: bytes, package: str, version: str, folder: str) -> Iterator[PluginEntry]:
    group = ""
    for line in map(str.strip, data.decode("utf-8", "replace").splitlines()):
        if line.startswith("["):
            group = line.strip("[]").strip()
        elif group.startswith("archgen.") and "=" in line and not line.startswith(("#", ";")):
            name, _, target = line.partition("=")
            # Behind the object there may be extras in brackets.
            target = target.partition("[")[0].replace(" ", "")
            yield PluginEntry(group, name.strip(), target, package.replace("_", "-"), version, folder)


def list_package_folders() -> tuple[str, ...]:
    """Return the folders that installers write to and that Python looks into: of the installation, of the user if switched on."""
    own_folders = [site.USER_SITE] if site.ENABLE_USER_SITE and site.USER_SITE else []
    known = {*site.getsitepackages(), *own_folders}
    return tuple(path for path in sys.path if path in known)


@cache
def _list_path_file_folders() -> tuple[str, ...]:
    """Return the folders that `.pth` files add to these: packages that are installed to be edited lie there."""
    found: dict[str, None] = {}
    for folder in list_package_folders():
        for name in _list_names(folder):
            if name.endswith(".pth"):
                with (
                    suppress(OSError),  # one that cannot be read adds nothing to Python's search either
                    open(os.path.join(folder, name), encoding="utf-8", errors="replace") as stream,  # noqa: PTH118, PTH123
                ):
                    lines = [line.strip() for line in stream if not line.startswith(("#", "import ", "import\t"))]
                    found |= dict.fromkeys(os.path.join(folder, line) for line in lines if line)  # noqa: PTH118
    return tuple(path for path in sys.path if path in found)


def _list_names(folder: str) -> list[str]:
    """Return the names in a folder in order; none of one that cannot be read."""
    try:
        return sorted(os.listdir(folder))  # noqa: PTH208 - names are enough
    except OSError:
        return []


def _list_editable_folder(entry: PluginEntry) -> tuple[str, ...]:
    """Return where a package lies that is installed to be edited, as its installer wrote down: some add no `.pth` line."""
    import json
    from urllib.parse import unquote, urlsplit

    stem = f"{entry.package.replace('-', '_')}-{entry.version}.dist-info"
    try:
        with open(os.path.join(entry.folder, stem, "direct_url.json"), encoding="utf-8") as stream:  # noqa: PTH118, PTH123
            record = json.load(stream)
    except (OSError, ValueError):
        return ()
    is_editable = record.get("dir_info", {}).get("editable", False)
    return (unquote(urlsplit(record["url"]).path),) if is_editable else ()
