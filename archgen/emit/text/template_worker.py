"""Render a backend's templates in a process of their own, confined, and answer with what they wrote.

Reads one marshalled object from standard input and writes one of JSON to standard output: nothing that templates wrote is unpacked otherwise. Templates are untrusted: they get plain
data, no attribute that leads into Python, no file but those in their own folder, and limited time, memory and output.
"""

from __future__ import annotations

import gc
import json
import marshal
import posixpath
import re
import sys
from collections.abc import Callable, Iterable, Iterator, Mapping
from functools import cache
from pathlib import Path
from traceback import walk_tb
from typing import Any, NoReturn

from jinja2 import StrictUndefined, Template, TemplateError, TemplateNotFound, TemplateSyntaxError
from jinja2.loaders import BaseLoader
from jinja2.sandbox import ImmutableSandboxedEnvironment

from archgen.emit.safe_names import explain_long_path, is_safe_path, make_safe_path
from archgen.emit.text.template_filters import TEMPLATE_FILTERS, make_escape_filter
from archgen.emit.text.template_limits import MAX_TEMPLATE_BYTES, TemplateLimits, confine_process
from archgen.frozen import NamedTuple
from archgen.grouping import group_pairs

_ESCAPED_ENDINGS = (".html", ".htm", ".xhtml", ".xml", ".svg")
_MAX_OBJECT_NAME = 200
_MEMORY_ADDRESS = re.compile(r" at (0x[0-9a-f]{6,16})(?:>|&gt;|, file )", re.IGNORECASE)
_OBJECT_START = re.compile(
    r"(?:<|&lt;)(function .*|(?:bound|built-in) method .*|(?:generator|code) object .*|[\w.]+ object)\Z",
    re.IGNORECASE | re.DOTALL,
)
"""How Python prints what is no data (`<generator object sync_do_map at 0x7f3a>`), with its place in memory."""


class TemplateBoundError(Exception):
    """A template asks for more than it may have, or for what does not exist. The message is for the user."""


class TemplateLoader(BaseLoader):
    """Load templates from one folder only: no `..`, and no link that leads out of it."""

    def __init__(self, folder: Path) -> None:
        self.folder = folder.resolve()

    def get_source(self, environment: object, template: str) -> tuple[str, str | None, Callable[[], bool] | None]:
        """Return a template's text, name, and no function that watches it for changes."""
        del environment
        # Resolved before the test, so that a link out of the folder is refused as well.
        path = (self.folder / template).resolve() if is_safe_path(template) else self.folder
        if not path.is_relative_to(self.folder) or not path.is_file():
            raise TemplateNotFound(template)
        if path.stat().st_size > MAX_TEMPLATE_BYTES:
            raise TemplateBoundError(f"the template has more than {MAX_TEMPLATE_BYTES} bytes")
        return path.read_text("utf-8"), template, None


class _Sandbox(ImmutableSandboxedEnvironment):
    """The sandbox of Jinja2, quick where it is safe at once: what is read of plain data is mostly a key of a dict."""

    def getattr(self, obj: Any, attribute: str) -> Any:  # noqa: ANN401 - as Jinja2 says
        """Return the value of a key that is no method of dicts, without asking Python for an attribute first."""
        if obj.__class__ is dict and attribute in obj and attribute not in _DICT_ATTRIBUTES:
            return obj[attribute]
        return super().getattr(obj, attribute)


_DICT_ATTRIBUTES = frozenset(dir(dict))


def create_sandbox(
    folder: Path, escapes: Mapping[str, Mapping[str, str]], project_values: object = None
) -> ImmutableSandboxedEnvironment:
    """Create the sandbox: what is undefined is an error, HTML and XML are escaped, nothing is random.

    `escapes` become filters of these names. The texts in `project_values` are printed whatever they say.
    """
    sandbox = _Sandbox(
        loader=TemplateLoader(folder),
        autoescape=lambda name: bool(name) and name.removesuffix(".j2").endswith(_ESCAPED_ENDINGS),
        undefined=StrictUndefined,
        finalize=lambda value: _refuse_printed_objects(value, project_values),
        trim_blocks=True,
        lstrip_blocks=True,
        keep_trailing_newline=True,
    )
    # Reading the manifest has refused escapes whose name a filter has already.
    sandbox.filters.update({name: make_escape_filter(table) for name, table in escapes.items()})
    sandbox.filters.update(TEMPLATE_FILTERS)
    # Random words, random choice: the same input must give the same bytes.
    del sandbox.globals["lipsum"]
    del sandbox.filters["random"]
    return sandbox


def _refuse_printed_objects(value: object, project_values: object) -> object:
    """Return what a template prints, unless it is a function or the like: its place in memory is another in each run.

    Filters and `~` make text of an object before it is printed, so texts are searched too. In a text of the project's own,
    such as a quoted message of Python, the place is one that the project names.
    """
    text = value if isinstance(value, str) else "" if isinstance(value, int) else str(value)
    if "0x" not in text and "0X" not in text:
        return value
    for address in _MEMORY_ADDRESS.finditer(text):
        printed_object = _OBJECT_START.search(text, max(0, address.start() - _MAX_OBJECT_NAME), address.start())
        if printed_object and not _holds_text(project_values, address[1].lower()):
            msg = f"it prints what is no text: a {printed_object[1]}; a function is called with `()`, a list is made with `|list`"
            raise TemplateBoundError(msg)
    return value


def _holds_text(value: object, lower_text: str) -> bool:
    """Whether a text stands in plain data, as a part of a key or a value, in letters of either case."""
    if isinstance(value, dict):
        return any(_holds_text(part, lower_text) for pair in value.items() for part in pair)
    if isinstance(value, list):
        return any(_holds_text(part, lower_text) for part in value)
    return isinstance(value, str) and lower_text in value.lower()


class PlannedFile(NamedTuple):
    """A file to write: its path, its entry in the manifest with the position there, and what it is written for."""

    path: str
    entry: Mapping[str, Any]
    position: int
    item: Any
    key: Any

    @property
    def place(self) -> str:
        """Where the element stands that it is written for, if the view says so."""
        return str(self.item["place"]) if isinstance(self.item, dict) and self.item.get("place") else ""


def render_request(request: Mapping[str, Any]) -> dict[str, Any]:
    """Render every file. Return `files`, or `error` with its `template` and `line`.

    A file is its path, text, position in the manifest, expected and offered words, and the place of what it is written for.
    """
    limits = TemplateLimits(**request["limits"])
    current_template: dict[str, str] = {}
    try:
        return {
            "files": list(
                _render_files(
                    create_sandbox(
                        Path(request["templates"]), request["escapes"], [request["data"], request["options"]]
                    ),
                    request,
                    limits,
                    current_template,
                )
            )
        }
    # MemoryError and RecursionError are caught here too; what is worse ends the process, and the parent explains it.
    except Exception as error:  # noqa: BLE001 - whatever a template raises is the template's mistake
        template, line = _locate_error(error, current_template)
        return {"error": _describe_error(error, limits), "template": template, "line": line}


def _describe_error(error: Exception, limits: TemplateLimits) -> str:
    """Describe what went wrong in one line."""
    match error:
        case TemplateSyntaxError():
            message = f"this is no template: {error.message}"
        case TemplateNotFound():
            message = f"there is no template `{error.name}` in templates/"
        case MemoryError():
            message = f"it needs more than {limits.memory // 1_000_000} MB of memory"
        case RecursionError():
            message = "its templates call each other without end"
        case UnicodeDecodeError():
            message = "it is not UTF-8 text"
        case UnicodeEncodeError():
            message = f"it prints half a character (U+{ord(error.object[error.start]):04X}), which no file can hold"
        case TemplateBoundError() | TemplateError():
            message = str(error)
        case _:
            message = f"{type(error).__name__}: {error}"
    return message[:500]


def _render_files(
    sandbox: ImmutableSandboxedEnvironment,
    request: Mapping[str, Any],
    limits: TemplateLimits,
    current_template: dict[str, str],
) -> Iterator[tuple[str, str, int, list[str], list[str], str]]:
    """Yield each file. All paths are planned first, so that templates can link to files that come later.

    `current_template["template"]` always names the template in work, for the message of an error.
    """
    planned = list(_plan_files(sandbox, request, limits, current_template))
    paths = {
        file.item["anchor"]: file.path for file in planned if isinstance(file.item, dict) and "anchor" in file.item
    }
    remaining = limits.output
    # Compiled once for each entry: compiling takes longer than most files.
    contracts = [
        [sandbox.from_string(entry.get(key) or "") for key in ("expects", "offers")] for entry in request["files"]
    ]
    finders = _make_finders(request["data"])
    for file in planned:
        current_template["template"] = file.entry["template"]
        values = {**finders, **_list_values(request, file.item, file.key), "path": file.path}
        values["href"] = _make_href(file.path, paths)
        text = _render_bounded(sandbox.get_template(file.entry["template"]), values, remaining)
        remaining -= len(text)
        text.encode()  # half a character is a mistake of this template
        current_template.clear()
        expected_words, offered_words = (each.render(**values).split() for each in contracts[file.position])
        yield file.path, text, file.position, expected_words, offered_words, file.place


def _list_values(request: Mapping[str, Any], item: object, key: object) -> dict[str, Any]:
    return {**request["data"], "options": request["options"], "item": item, "key": key}


def _plan_files(
    sandbox: ImmutableSandboxedEnvironment,
    request: Mapping[str, Any],
    limits: TemplateLimits,
    current_template: dict[str, str],
) -> Iterator[PlannedFile]:
    """Yield each file to write. In a workspace paths are as the manifest makes them; else they are safe, and no two equal."""
    taken_paths: set[str] = set()
    count = 0
    for position, file in enumerate(request["files"]):
        current_template["template"] = file["template"]
        sandbox.get_template(file["template"])
        # What is wrong from here on is the manifest's mistake.
        current_template.clear()
        path_template = sandbox.from_string(file["path"])
        for key, item in _select_items(request["data"], file):
            path = path_template.render(**_list_values(request, item, key))
            if request["is_workspace"]:
                path = path.strip()
                if not path:
                    continue
            else:
                path = _choose_safe_path(path, taken_paths)
            count += 1
            if count > limits.files:
                raise TemplateBoundError(f"it writes more than {limits.files} files")
            yield PlannedFile(path, file, position, item, key)


def _choose_safe_path(written_path: str, taken_paths: set[str]) -> str:
    """Make a safe path that is not taken, and take it."""
    path = make_safe_path(written_path)
    excess = explain_long_path(path)
    if excess:
        raise TemplateBoundError(excess)
    stem, ending = posixpath.splitext(path)
    number = 2
    while path in taken_paths:
        path, number = f"{stem}-{number}{ending}", number + 1
    taken_paths.add(path)
    return path


def _select_items(data: Mapping[str, Any], file: Mapping[str, Any]) -> Iterable[tuple[Any, Any]]:
    """Return (key, item) pairs that a file is written for: a single pair of None where it has no `for_each`."""
    if not file.get("for_each"):
        return [(None, None)]
    collection: Any = data
    for name in file["for_each"].split("."):
        if not isinstance(collection, dict) or name not in collection:
            raise TemplateBoundError(f"there is no `{file['for_each']}` in the data for `for_each`")
        collection = collection[name]
    pairs = (
        collection.items()
        if isinstance(collection, dict)
        else enumerate(collection if isinstance(collection, list) else ())
    )
    required_values = file.get("only") or {}
    return [
        (key, item)
        for key, item in pairs
        if all(isinstance(item, dict) and _has_value(item, name, value) for name, value in required_values.items())
    ]


def _has_value(item: Mapping[str, Any], name: str, value: str) -> bool:
    """Whether an item has a value, which the manifest writes as text: `true`, `2`."""
    found = item.get(name)
    if isinstance(found, bool | int):
        found = str(found).lower()
    return bool(found == value)


def _make_href(path: str, paths: Mapping[str, str]) -> Callable[[str | None], str]:
    """Make templates' function `href(ref)`: the address of a page's file relative to this one, or an empty text."""
    folder = posixpath.dirname(path) or "."

    def href(ref: str | None) -> str:
        return posixpath.relpath(paths[ref], folder) if ref is not None and ref in paths else ""

    return href


def _make_finders(data: Mapping[str, Any]) -> dict[str, Callable[..., Any]]:
    """Make templates' functions that find a picture and the pages below one: no page looks through those of all others."""

    @cache
    def index_pictures() -> dict[str, Any]:
        return {picture["id"]: picture for picture in (*data.get("graphs", ()), *data.get("sequences", ()))}

    @cache
    def index_pages() -> Mapping[str, list[Any]]:
        return group_pairs((page["crumbs"][-1][1], page) for page in data.get("pages", ()) if page["crumbs"])

    return {
        "picture_of": lambda picture_id: index_pictures().get(picture_id),
        "pages_below": lambda anchor: index_pages().get(anchor, []),
    }


def _render_bounded(template: Template, values: Mapping[str, Any], remaining: int) -> str:
    """Render a template piece by piece, and stop as soon as it is too much."""
    parts = []
    for part in template.generate(**values):
        remaining -= len(part)
        if remaining < 0:
            raise TemplateBoundError("it writes more than it may")
        parts.append(part)
    return "".join(parts)


def _locate_error(error: BaseException, current_template: Mapping[str, str]) -> tuple[str | None, int | None]:
    """Return the template and line that an error comes from: the last frame that Jinja2 rewrote to a template's.

    What is not a file (`<template>`) is a path in the manifest: then both are None.
    """
    if isinstance(error, TemplateSyntaxError):
        return error.name, error.lineno
    location: tuple[str | None, int | None] = (current_template.get("template"), None)
    for frame, line in walk_tb(error.__traceback__):
        # Jinja2 replaces frames of compiled templates in tracebacks by frames with the template's name and line; this
        # global is how they can be told from others.
        if "__jinja_exception__" in frame.f_globals:
            name = frame.f_code.co_filename
            location = (None, None) if name.startswith("<") else (name, line)
    return location


def main() -> NoReturn:
    """Answer one request. Called by name from the command line of `_run_worker`."""
    # What is read stays: nobody need look for circles in it, neither while it is read nor later.
    gc.disable()
    request = marshal.loads(sys.stdin.buffer.read())  # noqa: S302 - the parent wrote it
    gc.freeze()
    gc.enable()
    # After the request is read, before the first template is: no file can be opened for writing from here on.
    confine_process(TemplateLimits(**request["limits"]))
    answer = json.dumps(render_request(request))
    sys.stdout.write(answer)
    sys.stdout.flush()
    sys.exit(0)
