"""Write text outputs by templates: a backend of the emitter `text` needs no Python, and can do no harm.

The templates run in a process of their own (`template_worker`). What comes back is text with safe paths.
"""

from __future__ import annotations

import json
import marshal
import subprocess
import sys
from collections.abc import Mapping
from dataclasses import asdict
from pathlib import Path
from typing import Any

from archgen.cache.file_store import FileStore
from archgen.diagnostics import Diagnostic, Span
from archgen.emit.backend_manifests import Backend
from archgen.emit.file_tree import FileTree, list_files_below, make_file_tree
from archgen.emit.manifest_parsing import BACKEND_ERROR_RULE
from archgen.emit.safe_names import assign_safe_paths, explain_long_path
from archgen.emit.text.kept_answers import NO_ANSWERS, encode_texts, keep_files, load_files, make_answer_key
from archgen.emit.text.template_limits import TemplateLimits
from archgen.emit.workspace.disk_files import GeneratedFile, find_path_problems
from archgen.resources import worker_environment

DEFAULT_LIMITS = TemplateLimits()
_PACKAGE_ROOT = Path(__file__).resolve().parents[3]
_WORKER_CODE = "import sys; sys.path.insert(0, sys.argv[1]); from archgen.emit.text.template_worker import main; main()"
_MAX_ASSET_BYTES = 64_000_000


def render_backend(
    backend: Backend, views: Mapping[str, object], limits: TemplateLimits = DEFAULT_LIMITS
) -> tuple[FileTree | None, tuple[Diagnostic, ...]]:
    """Render a backend's files. `views` has the shapes by their names in the manifest (`pages`, `record`, ...).

    Where a template fails, there is no tree, but a diagnostic that names the template and the line.
    """
    answer = _render_files(backend, views, limits)
    if "error" in answer:
        return None, (_make_diagnostic(backend, answer),)
    try:
        files = [*_read_assets(backend), *((path, data) for path, data, *_ in answer["files"])]
    except (_AssetError, OSError) as error:
        return None, (_make_diagnostic(backend, {"error": str(error), "template": None, "line": None}),)
    paths = assign_safe_paths(path for path, _ in files)
    return make_file_tree((paths[path], data) for path, data in files), ()


def render_workspace(
    backend: Backend,
    views: Mapping[str, object],
    places: Mapping[str, str] = {},
    limits: TemplateLimits = DEFAULT_LIMITS,
    answer_store: FileStore = NO_ANSWERS,
) -> tuple[tuple[GeneratedFile, ...], tuple[Diagnostic, ...]]:
    """Render the files of a backend that makes a workspace, with the paths that its manifest says.

    Where a template fails or a path is no good there are no files, but diagnostics, with the place where an element is
    written that `places` has for what the view calls so. What templates wrote from the same data is taken from the store.
    """
    answer = _render_files(backend, views, limits, answer_store)
    if "error" in answer:
        return (), (_make_diagnostic(backend, answer),)
    try:
        # What is copied stands where it stands below assets/.
        files = [GeneratedFile(path.removeprefix("assets/"), data) for path, data in _read_assets(backend)]
    except (_AssetError, OSError) as error:
        return (), (_make_diagnostic(backend, {"error": str(error), "template": None, "line": None}),)
    for path, data, position, expected_words, offered_words, place in answer["files"]:
        entry = backend.files[position]
        words = (tuple(expected_words), tuple(offered_words))
        files.append(GeneratedFile(path, data, entry.executable, entry.once, *words, places.get(place, place)))
    problems = tuple(
        _make_diagnostic(backend, {"error": problem, "template": None, "line": None})
        for problem in find_path_problems(files)
    )
    return (() if problems else tuple(files)), problems


def _render_files(
    backend: Backend, views: Mapping[str, object], limits: TemplateLimits, answer_store: FileStore = NO_ANSWERS
) -> Mapping[str, Any]:
    """Render all files in a process of their own, and return them, or those of the same request that are kept, or an `error`."""
    templates = backend.folder / "templates"
    content: dict[str, Any] = {
        "templates": str(templates),
        "files": [asdict(file) for file in backend.files],
        "data": {name: views[name] for name in backend.views},
        "options": dict(backend.options),
        "escapes": {name: dict(table) for name, table in backend.escapes.items()},
        "limits": asdict(limits),
        "is_workspace": backend.makes == "workspace",
    }
    key = make_answer_key(content, templates) if answer_store.folder is not None else ""
    files = load_files(answer_store, key)
    if files is None:
        answer = _run_worker(_pack_request(content), limits)
        if "files" not in answer:
            return answer
        files = encode_texts(answer["files"])
        keep_files(answer_store, key, files)
    return {"files": files}


def _pack_request(content: Mapping[str, Any]) -> bytes:
    """Return a request as bytes: what stands in it many times is written once, unlike in JSON."""
    # Imported here: where nothing changed, nothing is rendered.
    from archgen.views.shapes import shape_to_plain

    return marshal.dumps(shape_to_plain(content))


class _AssetError(Exception):
    """An asset cannot be copied."""


def _run_worker(request: bytes, limits: TemplateLimits) -> Mapping[str, Any]:
    """Run the worker process and return its answer, or an `error` where one of its limits ended it."""
    # -I: neither the current folder nor the environment decides what is imported. -B: a confined process writes no
    # files.
    command = [sys.executable, "-I", "-B", "-c", _WORKER_CODE, str(_PACKAGE_ROOT)]
    try:
        process = subprocess.run(  # noqa: S603 - our own interpreter and code; nothing of the project's is in the command
            command,
            input=request,
            # A template that finds a way to read its process's environment must not find secrets there.
            env=worker_environment(),
            capture_output=True,
            timeout=limits.waiting,
            check=False,
        )
    except subprocess.TimeoutExpired:
        return {"error": f"it takes more than {limits.waiting:g} s", "template": None, "line": None}
    try:
        answer = json.loads(process.stdout)
    except ValueError:
        answer = None
    if isinstance(answer, dict) and process.returncode == 0:
        return answer
    return {"error": _explain_failure(process, limits), "template": None, "line": None}


def _explain_failure(process: subprocess.CompletedProcess[bytes], limits: TemplateLimits) -> str:
    """Describe what ended a worker that could not answer."""
    if b"MemoryError" in process.stderr:
        return f"it needs more than {limits.memory // 1_000_000} MB of memory"
    # Ended by a signal: SIGXCPU or SIGKILL from the limit on computing time.
    if process.returncode < 0:
        return f"its templates were stopped: they may compute for {limits.computing} s"
    last_line = process.stderr.decode("utf-8", "replace").strip().splitlines()[-1:] or ["no reason was given"]
    return f"its templates could not be run: {last_line[0]}"


def _read_assets(backend: Backend) -> list[tuple[str, bytes]]:
    """Read the files in assets/: no link, and not more than `_MAX_ASSET_BYTES` in all."""
    folder = backend.folder / "assets"
    assets, size = [], 0
    for file in list_files_below(folder) if not folder.is_symlink() else ():
        if "/__pycache__/" in f"/{file}":  # pip compiles the programs that it installs
            continue
        path, name = folder / file, f"assets/{file}"
        excess = explain_long_path(name)
        if excess:
            raise _AssetError(excess)
        if path.is_symlink():
            raise _AssetError(f"`{name}` is a link; an asset is a file")
        if path.is_file():
            size += path.stat().st_size
            if size > _MAX_ASSET_BYTES:
                raise _AssetError(f"its assets have more than {_MAX_ASSET_BYTES // 1_000_000} MB")
            assets.append((name, path.read_bytes()))
    return assets


def _make_diagnostic(backend: Backend, answer: Mapping[str, Any]) -> Diagnostic:
    template, line = answer["template"], answer["line"] or 1
    file = f"{backend.name}/templates/{template}" if template else f"{backend.name}/backend.yaml"
    message = f"the backend `{backend.id}` fails: {answer['error']}"
    return Diagnostic(BACKEND_ERROR_RULE.name, message, Span(file, line, 1, line, 1))
