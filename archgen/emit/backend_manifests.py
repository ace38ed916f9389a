"""Read the manifests of backends: folders that describe an output. archgen ships some, a project may bring its own.

A backend's folder holds backend.yaml (schemas/backend.schema.json), templates/ and assets/. A project's own backend is
untrusted input, so only the emitter `text` is open to it: its templates run in a sandbox.
"""

from __future__ import annotations

from collections.abc import Collection, Mapping
from pathlib import Path
from typing import Any, Literal

from archgen import resources
from archgen.diagnostics import Diagnostic
from archgen.emit.manifest_parsing import (
    BACKEND_MANIFEST,
    ManifestError,
    ManifestNode,
    find_repeated_key,
    find_span,
    read_valid_manifest,
    refuse_manifest,
)
from archgen.frozen import dataclass, field, replace
from archgen.installed_backends import BACKENDS_FOLDER, list_installed_backends


@dataclass(frozen=True, slots=True)
class BackendFile:
    """A file to write, or one file per item of a list: its template, and the template of its path.

    The fields are the keys of the manifest, and of the request that the template worker reads.
    """

    template: str
    path: str
    for_each: str | None = None
    only: Mapping[str, str] = field(default_factory=dict)
    once: bool = False
    """Whether the file is the user's own as soon as it is there; only in a workspace."""
    executable: bool = False
    expects: str | None = None
    """The template of the words that the user's own file should hold."""
    offers: str | None = None
    """The template of the words that it may use of what is generated."""


@dataclass(frozen=True, slots=True)
class Backend:
    """One backend. `name` is its folder as diagnostics show it (`backends/wiki`), `folder` its path."""

    id: str
    title: str
    description: str
    emitter: str
    views: tuple[str, ...]
    files: tuple[BackendFile, ...]
    options: Mapping[str, Any]
    folder: Path
    name: str
    makes: Literal["documents", "workspace", "file"] = "documents"
    """What it makes; each has a verb of its own: `archgen build`, `generate` and `export`."""
    escapes: Mapping[str, Mapping[str, str]] = field(default_factory=dict)
    """Filters of its own: each is a table from a character to the text in its place."""
    passes: tuple[str, ...] = ()
    """The passes that the architecture goes through before the views are made; only for a workspace."""
    choices: Mapping[str, tuple[str, ...]] = field(default_factory=dict)
    """What some options may be; the first counts where nobody says another."""
    needs: tuple[str, ...] = ()
    """What must hold of the architecture after the passes; only for a workspace."""
    from_project: bool = False
    """Whether the project brings it, rather than archgen or another package."""
    origin: str = ""
    """Who brings it where neither the project nor archgen does: package and version."""


CALLED_EMITTERS = frozenset({"text", "reqif"})
"""The emitters of backends that a verb makes by their names; the others are outputs of archgen itself."""


def read_shipped_backend(name: str) -> Backend:
    """Read a backend that ships with archgen itself, by the name of its folder."""
    return _read_manifest(resources.resource_path(BACKENDS_FOLDER, name), f"{BACKENDS_FOLDER}/{name}")


def find_backends(
    project: Path, names: Collection[str] | None = None
) -> tuple[dict[str, Backend], tuple[Diagnostic, ...]]:
    """Find all backends by id, or those of some names: those that ship, those of other packages, then the project's own.
    Return them with the diagnostics of invalid ones.

    A backend of the project may not take the id of one that is installed.
    """
    backends: dict[str, Backend] = {}
    diagnostics: list[Diagnostic] = []
    for backend_id, installed in list_installed_backends().items():
        if names is not None and backend_id not in names:
            continue
        try:
            backend = replace(_read_manifest(installed.folder, installed.name), origin=installed.origin)
            if installed.origin:
                _refuse_other_emitter(backend, "a backend of another package")
            backends[backend_id] = backend
        except ManifestError as error:
            if not installed.origin:
                raise
            diagnostics += error.diagnostics
    for folder in _list_backend_folders(project / "backends", names):
        try:
            _refuse_links(project / "backends", folder)
            backend = _read_own_backend(folder, backends)
            backends[backend.id] = backend
        except ManifestError as error:
            diagnostics += error.diagnostics
    return backends, tuple(diagnostics)


def _list_backend_folders(parent: Path, names: Collection[str] | None) -> list[Path]:
    """Return the folders of backends, those of some names alone: an id is the name of its folder."""
    if not parent.is_dir():
        return []
    return sorted(
        path
        for path in parent.iterdir()
        if (names is None or path.name in names) and path.is_dir() and (path / BACKEND_MANIFEST).exists()
    )


def _refuse_links(parent: Path, folder: Path) -> None:
    """Refuse a backend that is reached by a link, or whose manifest, templates or assets are links.

    A link could lead out of the project (`templates -> /proc/self`), past what the reviewer of a change sees.
    """
    name = f"backends/{folder.name}"
    for path, path_name in (
        (parent, "backends"),
        (folder, name),
        *((folder / part, f"{name}/{part}") for part in (BACKEND_MANIFEST, "templates", "assets")),
    ):
        if path.is_symlink():
            refuse_manifest(name, f"`{path_name}` is a link; a backend's folder stands in the project")


def _read_own_backend(folder: Path, known_backends: Mapping[str, Backend]) -> Backend:
    name = f"backends/{folder.name}"
    backend = _read_manifest(folder, name)
    _refuse_other_emitter(backend, "a project's own backend")
    if backend.id in known_backends:
        refuse_manifest(
            name, f"there is a backend `{backend.id}` already", "give it another `id`, and its folder the same name"
        )
    return replace(backend, from_project=True)


def _refuse_other_emitter(backend: Backend, kind: str) -> None:
    if backend.emitter != "text":
        refuse_manifest(backend.name, f"{kind} has the emitter `text`, not `{backend.emitter}`")


def _read_manifest(folder: Path, name: str) -> Backend:
    """Read a manifest and check what its schema cannot say."""
    data, root = read_valid_manifest(folder, name)
    # Outputs and `review.backends` name a backend by its id, people look for its folder: both must agree.
    if data["id"] != folder.name:
        message = f"the id is `{data['id']}`, but the folder is `{folder.name}`"
        refuse_manifest(name, message, "give both the same name", find_span(root, ["id"], name))
    _check_escapes(data.get("escapes", {}), root, name)
    views = data["view"]
    options, choices = data.get("options", {}), dict[str, tuple[str, ...]]()
    if data["emitter"] == "text":
        choices = {key: tuple(value) for key, value in options.items() if _is_choice(value)}
        options = {**options, **{key: values[0] for key, values in choices.items()}}
    backend = Backend(
        id=data["id"],
        title=data["title"],
        description=data.get("description", ""),
        emitter=data["emitter"],
        views=(views,) if isinstance(views, str) else tuple(views),
        files=tuple(BackendFile(**file) for file in data.get("files", ())),
        options=options,
        folder=folder,
        name=name,
        makes=data.get("makes", "documents"),
        escapes=data.get("escapes", {}),
        passes=tuple(data.get("passes", ())),
        needs=tuple(data.get("needs", ())),
        choices=choices,
    )
    if backend.makes != "workspace":
        _refuse_workspace_keys(data, root, name)
    if backend.makes == "file":
        _check_single_file(backend, root)
    return backend


def _is_choice(value: object) -> bool:
    """Whether an option is a list of texts: what it may be."""
    return isinstance(value, list) and bool(value) and all(isinstance(each, str) for each in value)


def _refuse_workspace_keys(data: Mapping[str, Any], root: ManifestNode, name: str) -> None:
    """Refuse what only the writer of workspaces knows: elsewhere it would do nothing."""
    paths: list[list[str | int]] = [[key] for key in ("passes", "needs") if key in data]
    for position, file in enumerate(data.get("files", ())):
        paths += [["files", position, key] for key in ("once", "executable", "expects") if key in file]
    for path in paths:
        message = f"`{path[-1]}` goes with `makes: workspace`"
        refuse_manifest(name, message, "add that, or take the key away", find_span(root, path, name))


def _check_escapes(escapes: Mapping[str, Mapping[str, str]], root: ManifestNode, name: str) -> None:
    """Refuse escapes that would replace a filter, and tables in which a character stands twice."""
    if not escapes:
        return
    # Jinja2 is imported for manifests with escapes only: most runs never need it.
    from jinja2.filters import FILTERS

    from archgen.emit.text.template_filters import TEMPLATE_FILTERS

    for filter_name in escapes:
        # A filter that means something else in one backend would mislead whoever reads its templates.
        if filter_name in TEMPLATE_FILTERS or filter_name in FILTERS:
            message = f"there is a filter `{filter_name}` already"
            refuse_manifest(
                name, message, "give this escape another name", find_span(root, ["escapes", filter_name], name)
            )
        repeated_key = find_repeated_key(root, ["escapes", filter_name], name)
        if repeated_key:
            # YAML's parser takes the last one, and nobody sees which escape is lost.
            character, span = repeated_key
            refuse_manifest(name, f"`escapes.{filter_name}` has the character `{character}` twice", span=span)


def _check_single_file(backend: Backend, root: ManifestNode) -> None:
    """Refuse a backend that makes a file, but writes none or several."""
    place = find_span(root, ["makes"], backend.name)
    if backend.emitter == "reqif":
        return
    if backend.emitter != "text":
        refuse_manifest(backend.name, "`makes: file` is for the emitter `text`", span=place)
    if len(backend.files) != 1 or backend.files[0].for_each:
        message = "`makes: file` goes with exactly one entry in `files`, without `for_each`"
        refuse_manifest(backend.name, message, "several files are `documents` or a `workspace`", place)
    if (backend.folder / "assets").exists():
        message = "`makes: file` goes without `assets/`: they would be further files"
        refuse_manifest(backend.name, message, "several files are `documents` or a `workspace`", place)
