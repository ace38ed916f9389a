"""Render a backend's templates in a process of their own, confined, and answer with what they wrote.

Reads one JSON object from standard input and writes one to standard output. Templates are untrusted: they get plain
data, no attribute that leads into Python, no file but those in their own folder, and limited time, memory and output.
"""

from __future__ import annotations

import json
import posixpath
import sys
from collections.abc import Callable, Iterable, Iterator, Mapping
from pathlib import Path
from traceback import walk_tb
from typing import Any, NoReturn

from jinja2 import StrictUndefined, Template, TemplateError, TemplateNotFound, TemplateSyntaxError
from jinja2.loaders import BaseLoader
from jinja2.sandbox import ImmutableSandboxedEnvironment

from archgen.emit.names import is_safe, safe_path
from archgen.emit.text.filters import FILTERS
from archgen.emit.text.limits import Limits, confine

_LARGEST_TEMPLATE = 1_000_000
_ESCAPED = (".html", ".htm", ".xhtml", ".xml", ".svg")


class BoundError(Exception):
    """A template asks for more than it may have, or for what does not exist. The message is for the user."""


class Templates(BaseLoader):
    """Load templates from one folder only: no `..`, and no link that leads out of it."""

    def __init__(self, folder: Path) -> None:
        self.folder = folder.resolve()

    def get_source(self, environment: object, template: str) -> tuple[str, str | None, Callable[[], bool] | None]:
        """Return a template's text, name, and no function that watches it for changes."""
        del environment
        # Resolved before the test, so that a link out of the folder is refused as well.
        path = (self.folder / template).resolve() if is_safe(template) else self.folder
        if not path.is_relative_to(self.folder) or not path.is_file():
            raise TemplateNotFound(template)
        if path.stat().st_size > _LARGEST_TEMPLATE:
            msg = f"the template has more than {_LARGEST_TEMPLATE} bytes"
            raise BoundError(msg)
        return path.read_text("utf-8"), template, None


def environment(folder: Path) -> ImmutableSandboxedEnvironment:
    """Create the sandbox: what is undefined is an error, HTML and XML are escaped, nothing is random."""
    made = ImmutableSandboxedEnvironment(
        loader=Templates(folder),
        autoescape=lambda name: bool(name) and name.removesuffix(".j2").endswith(_ESCAPED),
        undefined=StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
        keep_trailing_newline=True,
    )
    made.filters.update(FILTERS)
    # Random words, random choice: the same input must give the same bytes.
    del made.globals["lipsum"]
    del made.filters["random"]
    return made


def run(request: Mapping[str, Any]) -> dict[str, Any]:
    """Render every file. Return `files` (path, text), or `error` with its `template` and `line`."""
    bounds = Limits(**request["limits"])
    place: dict[str, str] = {}
    try:
        return {"files": list(_render(environment(Path(request["templates"])), request, bounds, place))}
    # MemoryError and RecursionError are caught here too; what is worse ends the process, and the parent explains it.
    except Exception as error:  # noqa: BLE001 - whatever a template raises is the template's mistake
        template, line = _where(error, place)
        return {"error": _said(error, bounds), "template": template, "line": line}


def _said(error: Exception, bounds: Limits) -> str:
    """Describe what went wrong in one line."""
    match error:
        case TemplateSyntaxError():
            message = f"this is no template: {error.message}"
        case TemplateNotFound():
            message = f"there is no template `{error.name}` in templates/"
        case MemoryError():
            message = f"it needs more than {bounds.memory // 1_000_000} MB of memory"
        case RecursionError():
            message = "its templates call each other without end"
        case UnicodeDecodeError():
            message = "it is not UTF-8 text"
        case BoundError() | TemplateError():
            message = str(error)
        case _:
            message = f"{type(error).__name__}: {error}"
    return message[:500]


def _render(
    made: ImmutableSandboxedEnvironment, request: Mapping[str, Any], bounds: Limits, place: dict[str, str]
) -> Iterator[tuple[str, str]]:
    """Yield path and text of each file. All paths are planned first, so that templates can link to files that come
    later.

    `current_template["template"]` always names the template in work, for the message of an error.
    """
    planned = list(_plan(made, request, bounds, place))
    paths = {item["anchor"]: path for path, _, item, _ in planned if isinstance(item, dict) and "anchor" in item}
    left = bounds.output
    for path, template, item, key in planned:
        place["template"] = template
        values = {**request["data"], "options": request["options"], "path": path, "item": item, "key": key}
        text = _bounded(made.get_template(template), {**values, "href": _href(path, paths)}, left)
        left -= len(text)
        yield path, text


def _plan(
    made: ImmutableSandboxedEnvironment, request: Mapping[str, Any], bounds: Limits, place: dict[str, str]
) -> Iterator[tuple[str, str, Any, Any]]:
    """Yield (path, template, item, key) for each file to write. Paths are safe, and no two are equal."""
    taken: set[str] = set()
    for file in request["files"]:
        place["template"] = file["template"]
        made.get_template(file["template"])
        name = made.from_string(file["path"])
        for key, item in _items(request["data"], file):
            path = safe_path(name.render(**request["data"], options=request["options"], item=item, key=key))
            stem, ending = posixpath.splitext(path)
            number = 2
            while path in taken:
                path, number = f"{stem}-{number}{ending}", number + 1
            taken.add(path)
            if len(taken) > bounds.files:
                msg = f"it writes more than {bounds.files} files"
                raise BoundError(msg)
            yield path, file["template"], item, key


def _items(data: Mapping[str, Any], file: Mapping[str, Any]) -> Iterable[tuple[Any, Any]]:
    """Return (key, item) pairs that a file is written for: a single pair of None where it has no `for_each`."""
    if not file.get("for_each"):
        return [(None, None)]
    found: Any = data
    for name in file["for_each"].split("."):
        if not isinstance(found, dict) or name not in found:
            msg = f"there is no `{file['for_each']}` in the data for `for_each`"
            raise BoundError(msg)
        found = found[name]
    pairs = found.items() if isinstance(found, dict) else enumerate(found if isinstance(found, list) else ())
    wanted = file.get("only") or {}
    return [
        (key, item)
        for key, item in pairs
        if all(isinstance(item, dict) and item.get(name) == value for name, value in wanted.items())
    ]


def _href(path: str, paths: Mapping[str, str]) -> Callable[[str | None], str]:
    """Make templates' function `href(ref)`: the address of a page's file relative to this one, or an empty text."""
    folder = posixpath.dirname(path) or "."

    def href(ref: str | None) -> str:
        return posixpath.relpath(paths[ref], folder) if ref is not None and ref in paths else ""

    return href


def _bounded(template: Template, values: Mapping[str, Any], left: int) -> str:
    """Render a template piece by piece, and stop as soon as it is too much."""
    parts = []
    for part in template.generate(**values):
        left -= len(part)
        if left < 0:
            msg = "it writes more than it may"
            raise BoundError(msg)
        parts.append(part)
    return "".join(parts)


def _where(error: BaseException, place: Mapping[str, str]) -> tuple[str | None, int | None]:
    """Return the template and line that an error comes from: the last frame that Jinja2 rewrote to a template's.

    What is not a file (`<template>`) is a path in the manifest: then both are None.
    """
    if isinstance(error, TemplateSyntaxError):
        return error.name, error.lineno
    found: tuple[str | None, int | None] = (place.get("template"), None)
    for frame, line in walk_tb(error.__traceback__):
        # Jinja2 replaces frames of compiled templates in tracebacks by frames with the template's name and line; this
        # global is how they can be told from others.
        if "__jinja_exception__" in frame.f_globals:
            name = frame.f_code.co_filename
            found = (None, None) if name.startswith("<") else (name, line)
    return found


def main() -> NoReturn:
    """Answer one request. Called by name from the command line of `_run_worker`."""
    request = json.load(sys.stdin.buffer)
    # After the request is read, before the first template is: no file can be opened for writing from here on.
    confine(Limits(**request["limits"]))
    answer = json.dumps(run(request))
    sys.stdout.write(answer)
    sys.stdout.flush()
    sys.exit(0)
