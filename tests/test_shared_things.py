"""What tests share is what each would have made for itself: drawing processes, judged projects, verbs in this process."""

from __future__ import annotations

from pathlib import Path

import pytest

from archgen import pipeline
from archgen.emit.graphviz import worker_pool
from archgen.emit.graphviz.drawing_worker import DrawingTask
from archgen.views.picture_shapes import Box, Graph
from tests import judged_projects
from tests.kept_workers import KeptWorker
from tests.running import archgen, archgen_here

TASK = DrawingTask(Graph("tiny", "Tiny", "flow", (Box("a", "A"),), (), kind="overview"), {}, ("svg", "png"))
PROJECT = "archgen: 1\ngroups: {g: {components: {a: {outputs: {o: T}}, b: {inputs: {i: a.p}}}}}\n"


def _draw(folder: Path, kind: type[worker_pool.DrawingWorker], monkeypatch: pytest.MonkeyPatch) -> object:
    monkeypatch.setattr(worker_pool, "DrawingWorker", kind)
    return worker_pool.draw_tasks([TASK], folder, workers=1)


def test_a_kept_process_draws_what_a_fresh_one_draws(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    fresh = _draw(tmp_path, KeptWorker.__mro__[1], monkeypatch)
    assert [_draw(tmp_path, KeptWorker, monkeypatch) for _ in range(2)] == [fresh, fresh]


def test_a_process_is_given_back_unless_it_broke(tmp_path: Path) -> None:
    environment = worker_pool.create_worker(tmp_path)._environment  # noqa: SLF001 - how it is started
    first = KeptWorker(worker_pool.worker_command(), environment)
    process = first.start_process()
    first.request_picture(TASK, 600)
    first.stop_process()
    second = KeptWorker(worker_pool.worker_command(), environment)
    assert second.start_process() is process
    process.kill()
    process.wait()
    second.stop_process()
    third = KeptWorker(worker_pool.worker_command(), environment)
    assert third.start_process() is not process
    third.stop_process()


def test_a_project_is_judged_again_where_it_changed(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(judged_projects, "_SHIPPED_FOLDERS", (tmp_path,))
    (tmp_path / "archgen.yaml").write_text(PROJECT, "utf-8")
    with judged_projects.judge_shipped_once():
        first = pipeline.check_project(tmp_path)
        assert pipeline.check_project(tmp_path) is first
        (tmp_path / "archgen.yaml").write_text(PROJECT.replace("a.p", "a.o"), "utf-8")
        assert pipeline.check_project(tmp_path).findings != first.findings
    assert pipeline.check_project(tmp_path) is not pipeline.check_project(tmp_path)


def test_a_verb_says_here_what_it_says_in_a_process_of_its_own(tmp_path: Path) -> None:
    (tmp_path / "archgen.yaml").write_text(PROJECT, "utf-8")
    runs = [run("check", cwd=tmp_path, status=1) for run in (archgen, archgen_here)]
    assert runs[0].stdout == runs[1].stdout
    assert runs[0].stderr == runs[1].stderr
    refusals = [run("chek", cwd=tmp_path, status=2).stderr for run in (archgen, archgen_here)]
    assert refusals[0] == refusals[1] != b""
