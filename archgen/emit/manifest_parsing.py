"""Read the text of a backend's manifest: YAML with the place of every value, checked against its schema."""

from __future__ import annotations

import json
from collections.abc import Iterator, Sequence
from functools import cache
from pathlib import Path
from typing import Any, NoReturn

from archgen import resources
from archgen.diagnostics import Diagnostic, Rule, Severity, Span
from archgen.views.generation import list_view_names

BACKEND_ERROR_RULE = Rule(
    "backend-error",
    Severity.ERROR,
    "A backend of the project cannot be read, or one of its templates fails.",
    fixed=True,
)
BACKEND_MANIFEST = "backend.yaml"
_MAX_MANIFEST_BYTES = 65_536
_MAX_NESTING = 20
_FLAG_KEYS = frozenset({"once", "executable"})


ManifestNode = Any
"""A node of the YAML library's tree, which has no types; None for an empty manifest."""


class ManifestError(Exception):
    """A manifest is not valid. Carries the diagnostics."""

    def __init__(self, *diagnostics: Diagnostic) -> None:
        # For a manifest that ships: nobody catches its error, and who writes one wants to read what is wrong.
        super().__init__("; ".join(f"{each.span}: {each.message}" for each in diagnostics))
        self.diagnostics = diagnostics


def read_valid_manifest(folder: Path, name: str) -> tuple[Any, ManifestNode]:
    """Read the manifest in a folder and check it against its schema. `name` is the folder as diagnostics show it.

    Return its data (every scalar a string) and the tree that knows positions. Raise ManifestError.
    """
    data, root = _parse_manifest(_read_manifest_text(folder / BACKEND_MANIFEST, name), name)
    view_names = _list_allowed_views(data)
    schema_errors = sorted(
        _load_validator(view_names).iter_errors(data), key=lambda error: [str(part) for part in error.instance_path]
    )
    if schema_errors:
        raise ManifestError(
            *(
                Diagnostic(
                    BACKEND_ERROR_RULE.name,
                    _describe_schema_error(error, view_names),
                    _find_error_span(root, error, name),
                )
                for error in schema_errors
            )
        )
    return data, root


def find_repeated_key(root: ManifestNode, path: Sequence[str | int], name: str) -> tuple[str, Span] | None:
    """Return the first key that stands twice in the mapping at a path, and the span of its second place."""
    *_, (_, mapping) = _walk_path(root, path)
    known_keys: set[str] = set()
    for key_node, _ in mapping.value:
        if key_node.value in known_keys:
            return key_node.value, _span_of(key_node, name)
        known_keys.add(key_node.value)
    return None


def _read_manifest_text(path: Path, name: str) -> str:
    try:
        if not path.is_file():
            refuse_manifest(name, f"`{BACKEND_MANIFEST}` is not a file")
        if path.stat().st_size > _MAX_MANIFEST_BYTES:
            refuse_manifest(name, f"`{BACKEND_MANIFEST}` has more than {_MAX_MANIFEST_BYTES} bytes")
        return path.read_text("utf-8")
    except UnicodeDecodeError:
        refuse_manifest(name, f"`{BACKEND_MANIFEST}` is not UTF-8 text")
    except OSError as error:
        refuse_manifest(name, f"`{BACKEND_MANIFEST}` cannot be read: {error.strerror}")


def _parse_manifest(text: str, name: str) -> tuple[Any, ManifestNode]:
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
        return _read_flags(reader.construct_document(root) if root else {}), root
    except yaml.MarkedYAMLError as error:
        mark = error.problem_mark
        line, column = (mark.line + 1, mark.column + 1) if mark else (1, 1)
        span = Span(f"{name}/{BACKEND_MANIFEST}", line, column, line, column + 1)
        refuse_manifest(name, f"this is not YAML: {error.problem or error.context}", span=span)
    except yaml.YAMLError as error:
        refuse_manifest(name, f"this is not YAML: {str(error).splitlines()[0]}")


def _read_flags(data: Any) -> Any:  # noqa: ANN401 - what the file holds
    """Return data with booleans for the flags of files, which are the only values in a manifest that are no text."""
    files = data.get("files") if isinstance(data, dict) else None
    for file in files if isinstance(files, list) else ():
        for key in sorted(_FLAG_KEYS & file.keys()) if isinstance(file, dict) else ():
            file[key] = {"true": True, "false": False}.get(file[key], file[key]) if isinstance(file[key], str) else None
    return data


def _check_yaml_events(events: Any, name: str) -> None:  # noqa: ANN401 - the library has no types
    import yaml

    depth = 0
    for event in events:
        depth += isinstance(event, yaml.CollectionStartEvent) - isinstance(event, yaml.CollectionEndEvent)
        line = event.start_mark.line + 1
        if isinstance(event, yaml.AliasEvent) or depth > _MAX_NESTING:
            problem = f"nested more than {_MAX_NESTING} deep" if depth > _MAX_NESTING else "an alias"
            refuse_manifest(
                name,
                f"a manifest is plain: this is {problem}",
                span=Span(f"{name}/{BACKEND_MANIFEST}", line, 1, line, 1),
            )


def _list_allowed_views(data: Any) -> tuple[str, ...]:  # noqa: ANN401 - what the file holds
    """Return the views that a manifest may name: those of the schema whose plug-ins are there, then those of others."""
    view = data.get("view") if isinstance(data, dict) else None
    named = view if isinstance(view, list) else [view]
    known_names = list_view_names([each for each in named if isinstance(each, str)])
    shown_names: list[str] = _read_schema()["$defs"]["view"]["enum"]
    return (
        *(each for each in shown_names if each in known_names),
        *(each for each in known_names if each not in shown_names),
    )


@cache
def _read_schema() -> Any:  # noqa: ANN401 - what the file holds
    return json.loads(resources.resource_path("schemas", "backend.schema.json").read_text("utf-8"))


@cache
def _load_validator(view_names: tuple[str, ...]) -> Any:  # noqa: ANN401 - the library's own class
    import jsonschema_rs

    schema = _read_schema()
    return jsonschema_rs.validator_for({**schema, "$defs": {**schema["$defs"], "view": {"enum": list(view_names)}}})


def _describe_schema_error(error: Any, view_names: Sequence[str]) -> str:  # noqa: ANN401 - the library's own class
    """Describe an error of the JSON Schema library in words for the user."""
    dotted_path = ".".join(str(part) for part in error.instance_path)
    subject = f"`{dotted_path}`" if dotted_path else "the manifest"
    kind = error.kind
    error_name = _name_of_error(error)
    match error_name:
        case "AdditionalProperties":
            predicate = f"has an unknown key {', '.join(f'`{key}`' for key in kind.unexpected)}"
        case "Required":
            predicate = f"lacks the key `{kind.property}`"
        case "Enum":
            predicate = f"must be one of {', '.join(f'`{option}`' for option in kind.options)}"
        case "AnyOf" if error.instance_path[:1] == ["view"]:
            predicate = f"must be one of {', '.join(f'`{name}`' for name in view_names)}, or a list of these"
        case "PropertyNames":
            predicate = _describe_wrong_key(kind.error.instance, is_filter=error.instance_path == ["escapes"])
        case "Type" if error.instance_path[-1:] and error.instance_path[-1] in _FLAG_KEYS:
            predicate = "must be `true` or `false`"
        case "MaxProperties":
            predicate = f"has more than {kind.limit} entries"
        case "MaxLength":
            predicate = f"is longer than {kind.limit} characters"
        case _:
            predicate = f"is not as the schema of backends asks ({error_name})"
    return f"{subject} {predicate}"


def _name_of_error(error: Any) -> str:  # noqa: ANN401 - the library's own class
    return type(error.kind).__name__.rpartition("_")[2]


def _describe_wrong_key(key: str, *, is_filter: bool) -> str:
    """Describe a key in `escapes`, or in one of its tables, that the schema does not allow."""
    quoted_key = f"the key `{key}`" if key else "an empty key"
    wanted_key = "a filter has a lower-case name such as `plantuml`" if is_filter else "a key is one character"
    return f"has {quoted_key}: {wanted_key}"


def _find_error_span(root: ManifestNode, error: Any, name: str) -> Span:  # noqa: ANN401 - the library's own class
    """Return the span of what an error of the JSON Schema library is about."""
    # An error about a key carries the path of its mapping.
    wrong_keys = [error.kind.error.instance] if _name_of_error(error) == "PropertyNames" else []
    return find_span(root, [*error.instance_path, *wrong_keys], name)


def find_span(root: ManifestNode, path: Sequence[str | int], name: str) -> Span:
    """Return the span of the value at a path: that of its key where it has one."""
    *_, (key_node, node) = _walk_path(root, path)
    marked_node = key_node or node
    return Span.of_file(f"{name}/{BACKEND_MANIFEST}") if marked_node is None else _span_of(marked_node, name)


def _walk_path(root: ManifestNode, path: Sequence[str | int]) -> Iterator[tuple[ManifestNode, ManifestNode]]:
    """Yield the nodes along a path, each as (key, value); the root and items of lists have no key (None)."""
    yield None, root
    node = root
    for part in path:
        if isinstance(part, int):
            key_node, node = None, node.value[part]
        else:
            # The last one: of a key that stands twice the parser takes that.
            key_node, node = next(pair for pair in reversed(node.value) if pair[0].value == part)
        yield key_node, node


def _span_of(node: ManifestNode, name: str) -> Span:
    start, end = node.start_mark, node.end_mark
    return Span(f"{name}/{BACKEND_MANIFEST}", start.line + 1, start.column + 1, end.line + 1, end.column + 1)


def refuse_manifest(name: str, message: str, help: str | None = None, span: Span | None = None) -> NoReturn:  # noqa: A002
    """Raise ManifestError with one diagnostic; without a span it is about the whole file."""
    raise ManifestError(
        Diagnostic(BACKEND_ERROR_RULE.name, message, span or Span.of_file(f"{name}/{BACKEND_MANIFEST}"), help=help)
    )
