"""The projects of this repository, judged once: hundreds of tests ask a verb about the case study, and to judge it takes longest."""

from __future__ import annotations

import functools
import os
import tempfile
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path
from unittest.mock import patch

from archgen import pipeline
from archgen.checking.checked_project import CheckedProject
from archgen.diagnostics import Diagnostic
from archgen.emit import backend_manifests
from archgen.emit.backend_manifests import Backend

_ROOT = Path(__file__).resolve().parents[1]
_RAMCIP = _ROOT / "example_ramcip"
_SHIPPED_FOLDERS = (_RAMCIP, _ROOT / "examples")
SAID_BY_PACKING = frozenset({"borrowed-call", "borrowed-message"})
"""Rules about what a packed file says for itself: the messages that the shipped mapper gave its types."""
_Key = tuple[object, ...]
_JUDGED: dict[_Key, CheckedProject] = {}
_check_project = pipeline.check_project
_read_manifest = backend_manifests._read_manifest  # noqa: SLF001 - tests change no manifest that ships
_read_shipped_manifest = functools.cache(_read_manifest)


def judge_ramcip() -> CheckedProject:
    """Judge the case study, once for all tests of this process that read what comes out."""
    return judge_shipped(_RAMCIP)


@functools.cache
def judge_shipped(project: Path) -> CheckedProject:
    """Judge a project of this repository, once for all tests of this process that read what comes out."""
    return _check_project(project)


@contextmanager
def judge_shipped_once(*others: Path) -> Iterator[None]:
    """Have verbs judge a shipped project, and those in other folders that are given, again only if it changed."""
    kept_folders = (*_SHIPPED_FOLDERS, *others)
    with (
        patch.object(pipeline, "check_project", functools.partial(_check_once, kept_folders)),
        patch.object(backend_manifests, "_read_manifest", _read_manifest_once),
    ):
        yield


def _read_manifest_once(folder: Path, name: str) -> Backend:
    """Read a manifest; those that ship, of which each verb that makes outputs reads all, once for all tests."""
    return (_read_shipped_manifest if folder.is_relative_to(_ROOT) else _read_manifest)(folder, name)


def _check_once(
    kept_folders: Sequence[Path],
    path: Path | None = None,
    version_cache: pipeline.VersionCache | None = None,
    variants: Sequence[str] | None = None,
) -> CheckedProject:
    folder = path.absolute() if path else Path.cwd()
    # A cache that the caller wants to have filled is none of ours.
    if version_cache or not any(folder.is_relative_to(kept) for kept in kept_folders):
        return _check_project(path, version_cache, variants)
    key = (os.fspath(path) if path else None, Path.cwd(), tuple(variants) if variants else None, *_list_states(folder))
    if key not in _JUDGED:
        _JUDGED[key] = _check_project(path, version_cache, variants)
    return _JUDGED[key]


def _list_states(folder: Path) -> Iterator[tuple[str, int, int]]:
    """Yield the path of each file of a project, with what changes if it is written."""
    for parent, folders, names in os.walk(folder if folder.is_dir() else folder.parent):
        folders[:] = [name for name in folders if name != "archgen-out"]
        for name in names:
            path = os.path.join(parent, name)  # noqa: PTH118 - hundreds of paths
            state = os.stat(path)  # noqa: PTH116 - as above
            yield path, state.st_mtime_ns, state.st_size


def check_text(text: str) -> tuple[Diagnostic, ...]:
    """Check a project of one file, given as text; findings call the file `project.yaml`."""
    with tempfile.TemporaryDirectory(prefix="archgen-") as folder:
        file = Path(folder) / "project.yaml"
        file.write_text(text, encoding="utf-8")
        return pipeline.check_project(file).findings
