"""Run a backend's templates in a process of their own, confined, and hand back what they wrote.

Reads one JSON object from standard input and writes one to standard output. Templates are somebody's text: they get
plain data, no attribute that leads into Python, no file but their own folder's, and only so much time, memory and
output.
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
    """A template asks for more than it may have, or for what is not there; says so in our words."""


class Templates(BaseLoader):
    """Reads templates from one folder, and from nowhere else: no `..`, and no link that leads out of it."""

    def __init__(self, folder: Path) -> None:
        self.folder = folder.resolve()

    def get_source(self, environment: object, template: str) -> tuple[str, str | None, Callable[[], bool] | None]:
        """Give a template's text."""
        del environment
        path = (self.folder / template).resolve() if is_safe(template) else self.folder
        if not path.is_relative_to(self.folder) or not path.is_file():
            raise TemplateNotFound(template)
        if path.stat().st_size > _LARGEST_TEMPLATE:
            msg = f"the template has more than {_LARGEST_TEMPLATE} bytes"
            raise BoundError(msg)
        return path.read_text("utf-8"), template, None


def environment(folder: Path) -> ImmutableSandboxedEnvironment:
    """Make the sandbox: what is undefined is an error, HTML and XML are escaped, nothing is left to chance."""
    made = ImmutableSandboxedEnvironment(
        loader=Templates(folder),
        autoescape=lambda name: bool(name) and name.removesuffix(".j2").endswith(_ESCAPED),
        undefined=StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
        keep_trailing_newline=True,
    )
    made.filters.update(FILTERS)
    del made.globals["lipsum"]
    del made.filters["random"]
    return made


def run(request: Mapping[str, Any]) -> dict[str, Any]:
    """Render every file; gives `files` (path, text), or `error` with its `template` and `line`."""
    bounds = Limits(**request["limits"])
    place: dict[str, str] = {}
    try:
        return {"files": list(_render(environment(Path(request["templates"])), request, bounds, place))}
    except Exception as error:  # noqa: BLE001 - whatever a template raises is the template's mistake
        template, line = _where(error, place)
        return {"error": _said(error, bounds), "template": template, "line": line}


def _said(error: Exception, bounds: Limits) -> str:
    """Say what went wrong, in a line."""
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
    """Plan all paths first, so that templates can link to files that come later; then render each file."""
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
    """Give (path, template, item, key) for each file to write; paths are safe, and no two are one."""
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
    """Give the items that a file is written for: one, nothing in particular, where it says no `for_each`."""
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
    """Make the function `href(ref)`: the address of the file written for a page, from this one, or nothing."""
    folder = posixpath.dirname(path) or "."

    def href(ref: str | None) -> str:
        return posixpath.relpath(paths[ref], folder) if ref is not None and ref in paths else ""

    return href


def _bounded(template: Template, values: Mapping[str, Any], left: int) -> str:
    """Render, and stop as soon as it is too much."""
    parts = []
    for part in template.generate(**values):
        left -= len(part)
        if left < 0:
            msg = "it writes more than it may"
            raise BoundError(msg)
        parts.append(part)
    return "".join(parts)


def _where(error: BaseException, place: Mapping[str, str]) -> tuple[str | None, int | None]:
    """Find the template and line that an error comes from: the last frame that Jinja2 rewrote to a template's.

    What is not a file (`<template>`) is a path in the manifest.
    """
    if isinstance(error, TemplateSyntaxError):
        return error.name, error.lineno
    found: tuple[str | None, int | None] = (place.get("template"), None)
    for frame, line in walk_tb(error.__traceback__):
        if "__jinja_exception__" in frame.f_globals:
            name = frame.f_code.co_filename
            found = (None, None) if name.startswith("<") else (name, line)
    return found


def main() -> NoReturn:
    """Answer one request."""
    request = json.load(sys.stdin.buffer)
    confine(Limits(**request["limits"]))
    answer = json.dumps(run(request))
    sys.stdout.write(answer)
    sys.stdout.flush()
    sys.exit(0)
