"""Which backends are installed: those of archgen itself, those of its plug-ins, and those of packages of others.

No plug-in is imported to find them: `archgen check` asks, too.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from pathlib import Path

from archgen import resources
from archgen.frozen import dataclass
from archgen.installed_plugins import (
    GENERATORS,
    PluginEntry,
    PluginRefusedError,
    find_package_folder,
    list_entries,
    list_shipped_folders,
)

BACKENDS_FOLDER = "backends"


@dataclass(frozen=True, slots=True)
class InstalledBackend:
    """The folder of a backend; `name` is the folder as diagnostics show it."""

    folder: Path
    name: str
    origin: str = ""
    """Who brings it where it does not ship: package and version."""


def list_installed_backends() -> Mapping[str, InstalledBackend]:
    """Return the backends by id, which is the name of the folder: in the order of their names those that ship, then others.

    Raise PluginRefusedError for a package of others whose backends cannot be used.
    """
    shipped_folders = [resources.resource_path(BACKENDS_FOLDER)]
    shipped_folders += [Path(folder, BACKENDS_FOLDER) for folder in list_shipped_folders()]
    shipped = {folder.name: folder for parent in shipped_folders for folder in _list_folders(parent)}
    backends = {
        backend_id: InstalledBackend(shipped[backend_id], f"{BACKENDS_FOLDER}/{backend_id}")
        for backend_id in sorted(shipped)
    }
    for entry in list_entries(GENERATORS):
        package_folder = find_package_folder(entry)
        for folder in sorted(_list_folders(Path(package_folder, BACKENDS_FOLDER))) if package_folder else ():
            if folder.name in backends:
                _refuse_taken_id(entry, folder.name, backends[folder.name])
            backends[folder.name] = InstalledBackend(
                folder, f"{entry.package}/{BACKENDS_FOLDER}/{folder.name}", entry.origin
            )
    return backends


def _list_folders(parent: Path) -> Iterator[Path]:
    """Yield the folders of backends; what has no manifest is none, such as what git or Python left behind."""
    if parent.is_dir():
        yield from (path for path in parent.iterdir() if (path / "backend.yaml").is_file())


def _refuse_taken_id(entry: PluginEntry, backend_id: str, known: InstalledBackend) -> None:
    raise PluginRefusedError(
        f"the generator `{entry.name}` of {entry.origin} cannot be used: {known.origin or 'archgen'} has a backend "
        f"`{backend_id}` already; uninstall one, or leave out plug-ins with `archgen --no-plugins`"
    )
