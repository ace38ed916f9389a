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
from archgen.diagnostics.diagnostic import Diagnostic, Rule, Severity
from archgen.diagnostics.source_span import Span

BACKEND_ERROR_RULE = Rule(
    "backend-error",
    Severity.ERROR,
    "A backend of the project cannot be read, or one of its templates fails.\n\n"
    "Why: a backend is a folder in `backends/` with a manifest `backend.yaml` and templates. Where the manifest does not "
    "follow its schema, a template names something that does not exist, or needs more time, memory or output than it may "
    "have, nothing is written for this backend; all other outputs are made.",
    fixed=True,
)
BACKEND_MANIFEST = "backend.yaml"
_MAX_MANIFEST_BYTES = 65_536
_MAX_NESTING = 20


@dataclass(frozen=True, slots=True)
class BackendFile:
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
    files: tuple[BackendFile, ...]
    options: Mapping[str, Any]
    folder: Path
    name: str
    from_project: bool = False
    """Whether the project brings it, rather than archgen."""


class _ManifestError(Exception):
    """A manifest is not valid. Carries the diagnostics."""

    def __init__(self, *diagnostics: Diagnostic) -> None:
        super().__init__()
        self.diagnostics = diagnostics


def read_shipped_backend(name: str) -> Backend:
    """Read a backend that ships with archgen, by the name of its folder."""
    return _read_manifest(resources.resource_path("backends", name), f"backends/{name}")


def find_backends(project: Path) -> tuple[dict[str, Backend], tuple[Diagnostic, ...]]:
    """Find all backends by id: those that ship, then the project's own. Return them with the diagnostics of invalid
    ones.

    A backend of the project may not take the id of one that ships.
    """
    backends = {
        folder.name: read_shipped_backend(folder.name)
        for folder in _list_backend_folders(resources.resource_path("backends"))
    }
    diagnostics: list[Diagnostic] = []
    for folder in _list_backend_folders(project / "backends"):
        try:
            backend = _read_own_backend(folder, backends)
            backends[backend.id] = backend
        except _ManifestError as error:
            diagnostics += error.diagnostics
    return backends, tuple(diagnostics)


def _list_backend_folders(parent: Path) -> list[Path]:
    if not parent.is_dir():
        return []
    return sorted(path for path in parent.iterdir() if path.is_dir() and (path / BACKEND_MANIFEST).exists())


def _read_own_backend(folder: Path, known_backends: Mapping[str, Backend]) -> Backend:
    name = f"backends/{folder.name}"
    # A link could lead out of the project, past what the reviewer of a change sees.
    if folder.is_symlink():
        _refuse_manifest(name, f"`{name}` is a link; a backend's folder stands in the project")
    backend = _read_manifest(folder, name)
    if backend.emitter != "text":
        _refuse_manifest(name, f"a project's own backend has the emitter `text`, not `{backend.emitter}`")
    if backend.id in known_backends:
        _refuse_manifest(
            name, f"there is a backend `{backend.id}` already", "give it another `id`, and its folder the same name"
        )
    return replace(backend, from_project=True)


def _read_manifest(folder: Path, name: str) -> Backend:
    """Read a manifest and check it against its schema."""
    text = _read_manifest_text(folder / BACKEND_MANIFEST, name)
    data, root = _parse_manifest(text, name)
    schema_errors = sorted(
        _load_validator().iter_errors(data), key=lambda error: [str(part) for part in error.instance_path]
    )
    if schema_errors:
        raise _ManifestError(
            *(
                Diagnostic(
                    BACKEND_ERROR_RULE.name, _describe_schema_error(error), _find_span(root, error.instance_path, name)
                )
                for error in schema_errors
            )
        )
    # Outputs and `review.backends` name a backend by its id, people look for its folder: both must agree.
    if data["id"] != folder.name:
        message = f"the id is `{data['id']}`, but the folder is `{folder.name}`"
        _refuse_manifest(name, message, "give both the same name", _find_span(root, ["id"], name))
    views = data["view"]
    return Backend(
        id=data["id"],
        title=data["title"],
        description=data.get("description", ""),
        emitter=data["emitter"],
        views=(views,) if isinstance(views, str) else tuple(views),
        files=tuple(BackendFile(**file) for file in data.get("files", ())),
        options=data.get("options", {}),
        folder=folder,
        name=name,
    )


def _read_manifest_text(path: Path, name: str) -> str:
    try:
        if not path.is_file():
            _refuse_manifest(name, f"`{BACKEND_MANIFEST}` is not a file")
        if path.stat().st_size > _MAX_MANIFEST_BYTES:
            _refuse_manifest(name, f"`{BACKEND_MANIFEST}` has more than {_MAX_MANIFEST_BYTES} bytes")
        return path.read_text("utf-8")
    except UnicodeDecodeError:
        _refuse_manifest(name, f"`{BACKEND_MANIFEST}` is not UTF-8 text")
    except OSError as error:
        _refuse_manifest(name, f"`{BACKEND_MANIFEST}` cannot be read: {error.strerror}")


def _parse_manifest(text: str, name: str) -> tuple[Any, Any]:
    """Parse YAML into data (every scalar a string) and the node tree that knows positions. Refuse aliases and deep
    nesting.
    """
    import yaml

    # The base loaders make strings of all scalars: `no` or `1.0` in a manifest is never a boolean or a float.
    loader = getattr(yaml, "CBaseLoader", yaml.BaseLoader)
    try:
        # Checked on the event stream, before anything is built: aliases that nest make data of exponential size.
        _check_yaml_events(yaml.parse(text, Loader=loader), name)
        reader = loader(text)
        root = reader.get_single_node()
        return (reader.construct_document(root) if root else {}), root
    except yaml.MarkedYAMLError as error:
        mark = error.problem_mark
        line, column = (mark.line + 1, mark.column + 1) if mark else (1, 1)
        span = Span(f"{name}/{BACKEND_MANIFEST}", line, column, line, column + 1)
        _refuse_manifest(name, f"this is not YAML: {error.problem or error.context}", span=span)
    except yaml.YAMLError as error:
        _refuse_manifest(name, f"this is not YAML: {str(error).splitlines()[0]}")


def _check_yaml_events(events: Any, name: str) -> None:  # noqa: ANN401 - the library has no types
    import yaml

    depth = 0
    for event in events:
        depth += isinstance(event, yaml.CollectionStartEvent) - isinstance(event, yaml.CollectionEndEvent)
        line = event.start_mark.line + 1
        if isinstance(event, yaml.AliasEvent) or depth > _MAX_NESTING:
            problem = f"nested more than {_MAX_NESTING} deep" if depth > _MAX_NESTING else "an alias"
            _refuse_manifest(
                name,
                f"a manifest is plain: this is {problem}",
                span=Span(f"{name}/{BACKEND_MANIFEST}", line, 1, line, 1),
            )


@cache
def _load_validator() -> Any:  # noqa: ANN401 - the library's own class
    import jsonschema_rs

    schema = json.loads(resources.resource_path("schemas", "backend.schema.json").read_text("utf-8"))
    return jsonschema_rs.validator_for(schema)


def _describe_schema_error(error: Any) -> str:  # noqa: ANN401 - the library's own class
    """Describe an error of the JSON Schema library in words for the user."""
    dotted_path = ".".join(str(part) for part in error.instance_path)
    subject = f"`{dotted_path}`" if dotted_path else "the manifest"
    kind = error.kind
    error_name = type(kind).__name__.rpartition("_")[2]
    if error_name == "AdditionalProperties":
        return f"{subject} has an unknown key {', '.join(f'`{key}`' for key in kind.unexpected)}"
    if error_name == "Required":
        return f"{subject} lacks the key `{kind.property}`"
    if error_name == "Enum":
        return f"{subject} must be one of {', '.join(f'`{option}`' for option in kind.options)}"
    if error_name == "AnyOf":
        return f"{subject} must be `outline`, `pages`, `record`, `graphs` or `tables`, or a list of these"
    return f"{subject} is not as the schema of backends asks ({error_name})"


def _find_span(node: Any, path: Sequence[str | int], name: str) -> Span:  # noqa: ANN401 - the library has no types
    """Return the span of the value at a path: that of its key where it has one."""
    marked_node = node
    for part in path:
        if isinstance(part, int):
            marked_node = node = node.value[part]
        else:
            marked_node, node = next(pair for pair in node.value if pair[0].value == part)
    if marked_node is None:
        return Span.of_file(f"{name}/{BACKEND_MANIFEST}")
    start, end = marked_node.start_mark, marked_node.end_mark
    return Span(f"{name}/{BACKEND_MANIFEST}", start.line + 1, start.column + 1, end.line + 1, end.column + 1)


def _refuse_manifest(name: str, message: str, help: str | None = None, span: Span | None = None) -> NoReturn:  # noqa: A002
    raise _ManifestError(
        Diagnostic(BACKEND_ERROR_RULE.name, message, span or Span.of_file(f"{name}/{BACKEND_MANIFEST}"), help=help)
    )
