"""What templates wrote is taken again where nothing changed that decides it, and only there."""

from __future__ import annotations

import os
from collections.abc import Mapping
from pathlib import Path
from types import MappingProxyType
from typing import Any

import pytest

from archgen.cache.file_store import FileStore
from archgen.emit import text
from archgen.emit.backend_manifests import Backend, BackendFile
from archgen.emit.text import kept_answers
from archgen.emit.text.kept_answers import make_answer_key, open_answer_store
from archgen.emit.text.template_limits import TemplateLimits

DATA = {"name": "robot"}


@pytest.fixture
def backend(tmp_path: Path) -> Backend:
    templates = tmp_path / "mine" / "templates"
    templates.mkdir(parents=True)
    (templates / "a.j2").write_text("{% import 'more.j2' as more %}{{ record.name }} {{ options.x }}")
    (templates / "more.j2").write_text("")
    files = (BackendFile("a.j2", "a.txt", once=True, expects="one two"),)
    return Backend(
        "mine", "Mine", "", "text", ("record",), files, {"x": "1"}, templates.parent, "backends/mine", "workspace"
    )


@pytest.fixture
def store(tmp_path: Path) -> FileStore:
    return open_answer_store(tmp_path / "cache")


@pytest.fixture
def runs(monkeypatch: pytest.MonkeyPatch) -> list[bytes]:
    """Return a list that gets the request of each worker that is started."""
    requests: list[bytes] = []
    run_worker = text._run_worker  # noqa: SLF001 - whether it runs is what is asked here

    def counted(request: bytes, limits: TemplateLimits) -> Mapping[str, Any]:
        requests.append(request)
        return run_worker(request, limits)

    monkeypatch.setattr(text, "_run_worker", counted)
    return requests


def render(backend: Backend, store: FileStore, data: Mapping[str, object] = DATA) -> str:
    files, problems = text.render_workspace(backend, {"record": data}, answer_store=store)
    return problems[0].message if problems else files[0].data.decode()


def test_nothing_is_rendered_twice(backend: Backend, store: FileStore, runs: list[bytes]) -> None:
    first, _ = text.render_workspace(backend, {"record": DATA}, answer_store=store)
    again, _ = text.render_workspace(backend, {"record": DATA}, answer_store=store)
    assert (first, len(runs)) == (again, 1)
    assert first[0].expected_words == ("one", "two")
    assert first[0].once


def test_all_that_decides_is_looked_at(backend: Backend, store: FileStore, runs: list[bytes]) -> None:
    templates = backend.folder / "templates"
    assert render(backend, store) == "robot 1"
    assert render(backend, store, {"name": "arm"}) == "arm 1"
    assert render(Backend(**{**fields_of(backend), "options": {"x": "2"}}), store) == "robot 2"
    (templates / "a.j2").write_text("{{ record.name }}!")
    assert render(backend, store) == "robot!"
    (templates / "a.j2").write_text("{% import 'more.j2' as more %}{{ more.word }}")
    (templates / "more.j2").write_text("{% set word = 'from more' %}")
    assert render(backend, store) == "from more"
    (templates / "more.j2").unlink()
    (templates / "other.j2").write_text("{% set word = 'from a link' %}")
    (templates / "more.j2").symlink_to("other.j2")
    assert render(backend, store) == "from a link"
    (templates / "other.j2").write_text("{% set word = 'changed behind it' %}")
    assert render(backend, store) == "changed behind it"
    assert len(runs) == 7


def fields_of(backend: Backend) -> dict[str, Any]:
    return {name: getattr(backend, name) for name in Backend.__dataclass_fields__}


def test_other_code_renders_again(
    backend: Backend, store: FileStore, runs: list[bytes], monkeypatch: pytest.MonkeyPatch
) -> None:
    render(backend, store)
    monkeypatch.setattr(kept_answers, "stamp_program", lambda: "another version")
    assert (render(backend, store), len(runs)) == ("robot 1", 2)


def test_a_mistake_is_told_each_time(backend: Backend, store: FileStore, runs: list[bytes]) -> None:
    (backend.folder / "templates" / "a.j2").write_text("{{ nothing }}")
    assert render(backend, store) == render(backend, store)
    assert len(runs) == 2


def test_a_damaged_file_counts_as_none(backend: Backend, store: FileStore, runs: list[bytes]) -> None:
    render(backend, store)
    assert store.folder is not None
    (kept,) = store.folder.iterdir()
    for damage in (b"", b"{}", kept.read_bytes()[:-3]):
        kept.write_bytes(damage)
        assert render(backend, store) == "robot 1"
    assert len(runs) == 4


def test_without_a_cache_each_run_renders(backend: Backend, runs: list[bytes]) -> None:
    assert [render(backend, open_answer_store(None)) for _ in range(2)] == ["robot 1", "robot 1"]
    assert len(runs) == 2


@pytest.mark.skipif(not hasattr(os, "mkfifo"), reason="this system has no pipes with names")
def test_nothing_outside_of_the_templates_is_opened(backend: Backend, store: FileStore, tmp_path: Path) -> None:
    templates = backend.folder / "templates"
    os.mkfifo(templates / "pipe")
    os.mkfifo(tmp_path / "other")
    (templates / "link").symlink_to(tmp_path / "other")
    (templates / "folder").symlink_to(tmp_path)
    assert render(backend, store) == "robot 1"


def test_what_is_no_plain_data_is_not_kept(backend: Backend, store: FileStore, runs: list[bytes]) -> None:
    shape = MappingProxyType(DATA)
    assert [render(backend, store, shape) for _ in range(2)] == ["robot 1", "robot 1"]
    assert len(runs) == 2


def make_key(view: object, folder: Path) -> str:
    return make_answer_key({"data": {"record": view}}, folder)


def test_equal_data_has_one_key_whatever_shares_what(tmp_path: Path) -> None:
    shared: dict[str, object] = {"name": "robot_"[:-1], "rate": 1.5, "none": None}
    other = {"name": "robot", "rate": 1.5, "none": None}
    first = make_key({"programs": [shared], "packages": [{"programs": [shared]}]}, tmp_path)
    assert first == make_key({"programs": [other], "packages": [{"programs": [other.copy()]}]}, tmp_path)
    changed = {**other, "rate": 1.25}
    assert first != make_key({"programs": [shared], "packages": [{"programs": [changed]}]}, tmp_path)
    assert first != make_key({"programs": [changed], "packages": [{"programs": [shared]}]}, tmp_path)


@pytest.mark.parametrize("value", [{"a": 1}, {"a": 2}, 3, "text", ["text"], ["text", "text"], [], [[1]], (1,), None])
def test_what_is_called_like_a_list_of_the_view_counts_whole(tmp_path: Path, value: object) -> None:
    others = [{"a": 1}, {"a": 2}, 3, "text", ["text"], ["text", "text"], [], [[1]], None]
    keys = {make_key({"programs": [], "packages": [{"programs": each}]}, tmp_path) for each in others}
    assert len(keys) == len(others)
    key = make_key({"programs": [], "packages": [{"programs": value}]}, tmp_path)
    assert (key in keys) == (value in others)


def test_a_view_counts_by_its_name(tmp_path: Path) -> None:
    names = ("record", "other")
    assert len({make_answer_key({"data": {name: DATA}}, tmp_path) for name in names}) == len(names)
