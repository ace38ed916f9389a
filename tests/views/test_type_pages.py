"""The page of a type: who gives it and who reads it, with the partners whom a change of it concerns."""

from __future__ import annotations

from pathlib import Path

from archgen import pipeline
from archgen.views.lookup import make_lookup
from archgen.views.pages import context_pages
from archgen.views.shapes import Bullets

ROBOT = """\
partners: {p: {title: Partner P}, q: {title: Partner Q}}
groups:
  g:
    components:
      eye: {title: Eye, owner: p, outputs: {o: Image}}
      brain: {title: Brain, owner: [q, p], inputs: {i: eye.o}}
      free: {title: Free, inputs: {i: eye.o}}
"""


def test_readers_and_producers_stand_with_their_partners(tmp_path: Path) -> None:
    (tmp_path / "robot.yaml").write_text(ROBOT, encoding="utf-8")
    lookup = make_lookup(pipeline.check_project(tmp_path / "robot.yaml").architecture)
    page = next(page for page in context_pages.make_context_pages(lookup, tuple) if page.title == "Image")
    lists = [
        ["".join(run.text for run in item) for item in block.items]
        for block in page.section.blocks
        if isinstance(block, Bullets)
    ]
    assert lists == [["Eye · o (Partner P)"], ["Brain · i (Partner Q, Partner P)", "Free · i"]]
