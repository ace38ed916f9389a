"""Read the manifests of backends: folders that describe an output. archgen ships some, a project may bring its own.

A backend's folder holds backend.yaml (schemas/backend.schema.json), templates/ and assets/. A project's own backend is
untrusted input, so only the emitter `text` is open to it: its templates run in a sandbox.
"""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import cache
from pathlib import Path
from typing import Any, NoReturn

from archgen import resources
from archgen.diagnostic import Diagnostic, Rule, Severity
from archgen.source import Span

RULE = Rule(
    "backend-error",
    Severity.ERROR,
    "A backend of the project cannot be read, or one of its templates fails.\n\n"
    "Why: a backend is a folder in `backends/` with a manifest `backend.yaml` and templates. Where the manifest does not "
    "follow its schema, a template names something that does not exist, or needs more time, memory or output than it may "
    "have, nothing is written for this backend; all other outputs are made.",
    fixed=True,
)
MANIFEST = "backend.yaml"
_LARGEST = 65_536
_DEEPEST = 20


@dataclass(frozen=True, slots=True)
class File:
    """A file to write, or one file per item of a list: its template, and the template of its path.

    The fields are the keys of the manifest, and of the request that the template worker reads.
    """

    template: str
    path: str
    for_each: str | None = None
    only: Mapping[str, str] = field(default_factory=dict)


@dataclass(frozen=True, slots=True)
class Backend:
    """One backend. `name` is its folder as diagnostics show it (`backends/wiki`), `folder` its path."""

    id: str
    title: str
    description: str
    emitter: str
    views: tuple[str, ...]
    files: tuple[File, ...]
    options: Mapping[str, Any]
    folder: Path
    name: str
    own: bool = False
    """Whether the project brings it, rather than archgen."""


class _ManifestError(Exception):
    """A manifest is not valid. Carries the diagnostics."""

    def __init__(self, *diagnostics: Diagnostic) -> None:
        super().__init__()
        self.diagnostics = diagnostics


def shipped(name: str) -> Backend:
    """Read a backend that ships with archgen, by the name of its folder."""
    return _read(resources.path("backends", name), f"backends/{name}")


def find(project: Path) -> tuple[dict[str, Backend], tuple[Diagnostic, ...]]:
    """Find all backends by id: those that ship, then the project's own. Return them with the diagnostics of invalid
    ones.

    A backend of the project may not take the id of one that ships.
    """
    found = {folder.name: shipped(folder.name) for folder in _folders(resources.path("backends"))}
    diagnostics: list[Diagnostic] = []
    for folder in _folders(project / "backends"):
        try:
            backend = _own(folder, found)
            found[backend.id] = backend
        except _ManifestError as error:
            diagnostics += error.diagnostics
    return found, tuple(diagnostics)


def _folders(parent: Path) -> list[Path]:
    if not parent.is_dir():
        return []
    return sorted(path for path in parent.iterdir() if path.is_dir() and (path / MANIFEST).exists())


def _own(folder: Path, known: Mapping[str, Backend]) -> Backend:
    name = f"backends/{folder.name}"
    # A link could lead out of the project, past what the reviewer of a change sees.
    if folder.is_symlink():
        _refuse(name, f"`{name}` is a link; a backend's folder stands in the project")
    backend = _read(folder, name)
    if backend.emitter != "text":
        _refuse(name, f"a project's own backend has the emitter `text`, not `{backend.emitter}`")
    if backend.id in known:
        _refuse(
            name, f"there is a backend `{backend.id}` already", "give it another `id`, and its folder the same name"
        )
    return replace(backend, own=True)


def _read(folder: Path, name: str) -> Backend:
    """Read a manifest and check it against its schema."""
    text = _text(folder / MANIFEST, name)
    data, root = _parse(text, name)
    wrong = sorted(_validator().iter_errors(data), key=lambda error: [str(part) for part in error.instance_path])
    if wrong:
        raise _ManifestError(
            *(Diagnostic(RULE.name, _said(error), _span(root, error.instance_path, name)) for error in wrong)
        )
    # Outputs and `review.backends` name a backend by its id, people look for its folder: both must agree.
    if data["id"] != folder.name:
        message = f"the id is `{data['id']}`, but the folder is `{folder.name}`"
        _refuse(name, message, "give both the same name", _span(root, ["id"], name))
    views = data["view"]
    return Backend(
        id=data["id"],
        title=data["title"],
        description=data.get("description", ""),
        emitter=data["emitter"],
        views=(views,) if isinstance(views, str) else tuple(views),
        files=tuple(File(**file) for file in data.get("files", ())),
        options=data.get("options", {}),
        folder=folder,
        name=name,
    )


def _text(path: Path, name: str) -> str:
    try:
        if not path.is_file():
            _refuse(name, f"`{MANIFEST}` is not a file")
        if path.stat().st_size > _LARGEST:
            _refuse(name, f"`{MANIFEST}` has more than {_LARGEST} bytes")
        return path.read_text("utf-8")
    except UnicodeDecodeError:
        _refuse(name, f"`{MANIFEST}` is not UTF-8 text")
    except OSError as error:
        _refuse(name, f"`{MANIFEST}` cannot be read: {error.strerror}")


def _parse(text: str, name: str) -> tuple[Any, Any]:
    """Parse YAML into data (every scalar a string) and the node tree that knows positions. Refuse aliases and deep
    nesting.
    """
    import yaml

    # The base loaders make strings of all scalars: `no` or `1.0` in a manifest is never a boolean or a float.
    loader = getattr(yaml, "CBaseLoader", yaml.BaseLoader)
    try:
        # Checked on the event stream, before anything is built: aliases that nest make data of exponential size.
        _check_events(yaml.parse(text, Loader=loader), name)
        reader = loader(text)
        root = reader.get_single_node()
        return (reader.construct_document(root) if root else {}), root
    except yaml.MarkedYAMLError as error:
        mark = error.problem_mark
        line, column = (mark.line + 1, mark.column + 1) if mark else (1, 1)
        span = Span(f"{name}/{MANIFEST}", line, column, line, column + 1)
        _refuse(name, f"this is not YAML: {error.problem or error.context}", span=span)
    except yaml.YAMLError as error:
        _refuse(name, f"this is not YAML: {str(error).splitlines()[0]}")


def _check_events(events: Any, name: str) -> None:  # noqa: ANN401 - the library has no types
    import yaml

    depth = 0
    for event in events:
        depth += isinstance(event, yaml.CollectionStartEvent) - isinstance(event, yaml.CollectionEndEvent)
        line = event.start_mark.line + 1
        if isinstance(event, yaml.AliasEvent) or depth > _DEEPEST:
            what = f"nested more than {_DEEPEST} deep" if depth > _DEEPEST else "an alias"
            _refuse(name, f"a manifest is plain: this is {what}", span=Span(f"{name}/{MANIFEST}", line, 1, line, 1))


@cache
def _validator() -> Any:  # noqa: ANN401 - the library's own class
    import jsonschema_rs

    schema = json.loads(resources.path("schemas", "backend.schema.json").read_text("utf-8"))
    return jsonschema_rs.validator_for(schema)


def _said(error: Any) -> str:  # noqa: ANN401 - the library's own class
    """Describe an error of the JSON Schema library in words for the user."""
    where = ".".join(str(part) for part in error.instance_path)
    place = f"`{where}`" if where else "the manifest"
    kind = error.kind
    name = type(kind).__name__.rpartition("_")[2]
    if name == "AdditionalProperties":
        return f"{place} has an unknown key {', '.join(f'`{key}`' for key in kind.unexpected)}"
    if name == "Required":
        return f"{place} lacks the key `{kind.property}`"
    if name == "Enum":
        return f"{place} must be one of {', '.join(f'`{option}`' for option in kind.options)}"
    if name == "AnyOf":
        return f"{place} must be `outline`, `pages`, `record`, `graphs` or `tables`, or a list of these"
    return f"{place} is not as the schema of backends asks ({name})"


def _span(node: Any, path: Sequence[str | int], name: str) -> Span:  # noqa: ANN401 - the library has no types
    """Return the span of the value at a path: that of its key where it has one."""
    place = node
    for part in path:
        if isinstance(part, int):
            place = node = node.value[part]
        else:
            place, node = next(pair for pair in node.value if pair[0].value == part)
    if place is None:
        return Span.of_file(f"{name}/{MANIFEST}")
    start, end = place.start_mark, place.end_mark
    return Span(f"{name}/{MANIFEST}", start.line + 1, start.column + 1, end.line + 1, end.column + 1)


def _refuse(name: str, message: str, help: str | None = None, span: Span | None = None) -> NoReturn:  # noqa: A002
    raise _ManifestError(Diagnostic(RULE.name, message, span or Span.of_file(f"{name}/{MANIFEST}"), help=help))
