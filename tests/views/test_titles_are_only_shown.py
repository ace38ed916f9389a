"""What columns and facts are called is only shown: where all are called otherwise, no value is lost anywhere."""

from __future__ import annotations

import gc
import itertools
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest

from archgen.checking.checked_project import CheckedProject
from archgen.pipeline import check_project
from archgen.products.output_options import OutputOptions
from archgen.products.project_views import ProjectViews, make_views
from archgen.views.agreement.partner_agreement import make_agreement
from archgen.views.pages import report_outline
from archgen.views.pages.site_pages import make_pages
from archgen.views.report.printed_report import make_printed_report
from archgen.views.shapes import Column, Fact, Facts
from tests.judged_projects import judge_ramcip
from tests.property_sizes import try_some

EXAMPLES = Path(__file__).resolve().parents[2] / "examples"
MARK = "\u2021"
COMPOSED = """
component_types:
  Arm:
    role: filter
    inputs: {goal: Goal}
    outputs: {pose: {type: Pose, from: driver.pose}}
    components:
      planner: {inputs: {goal: self.goal}, outputs: {path: Path}}
      driver: {inputs: {path: planner.path}, outputs: {pose: Pose}}
groups:
  g:
    components:
      left: {is: Arm, role: source, requirements: [R-1], performance: {speed: {accuracy: 95 %, execution_time: 2 ms}}}
      right: {is: Arm}
      screen: {inputs: {left: left.pose, right: right.pose}}
nodes:
  planning: {implements: [left.planner, right.planner], timing: {left.planner: {rate: 5 Hz}, right.planner: {rate: 9 Hz}}}
  screen: {implements: screen, owner: north, host: pc, package: screens, parameters: {size: 3}}
hosts: {pc: {cores: 2}}
partners: {north: {title: North}}
requirements: {R-1: It moves}
"""


@contextmanager
def _renamed() -> Iterator[None]:
    """Put a mark before the title of each column and fact, of those that are made meanwhile and of those that are there."""
    patch = pytest.MonkeyPatch()
    make_column, make_fact, make_facts = Column.__init__, Fact.__new__, Facts.__init__
    known_columns = [each for each in gc.get_objects() if isinstance(each, Column)]

    def rename_column(column: Column, title: str, *args: Any, **keys: Any) -> None:  # noqa: ANN401 - as Column takes them
        make_column(column, MARK + title, *args, **keys)

    def rename_fact(kind: type[Fact], key: str, title: str, value: Any) -> Fact:  # noqa: ANN401 - as Fact takes it
        return make_fact(kind, key, MARK + title, value)

    def rename_facts(facts: Facts, rows: Any, *args: Any, **keys: Any) -> None:  # noqa: ANN401 - as Facts takes them
        make_facts(facts, tuple((MARK + title, value) for title, value in rows), *args, **keys)

    patch.setattr(Column, "__init__", rename_column)
    patch.setattr(Fact, "__new__", rename_fact)
    patch.setattr(Facts, "__init__", rename_facts)
    for column in known_columns:
        object.__setattr__(column, "title", MARK + column.title)
    try:
        yield
    finally:
        patch.undo()
        for column in known_columns:
            object.__setattr__(column, "title", column.title.removeprefix(MARK))


def _write_documents(views: ProjectViews) -> Iterator[str]:
    """Yield the report, as outline and printed with the ROS side in both places, and the pages of the site."""
    yield repr(report_outline.make_report(views.lookup, views.edition))
    yield repr(make_printed_report(views.lookup, replace(views.edition, ros_place="annex")))
    yield repr(make_printed_report(views.lookup, replace(views.edition, ros_place="inline")))
    yield repr(make_pages(views.lookup, views.edition))
    partners = tuple(views.lookup.architecture.partners)
    for pair in itertools.permutations(partners[:3], 2):
        yield repr(make_agreement(views.lookup, *pair, earlier_revision=("earlier", views.lookup)))


def _write_composed(folder: Path) -> Path:
    file = folder / "robot.yaml"
    file.write_text(COMPOSED, encoding="utf-8")
    return file


@pytest.mark.parametrize(
    "judge",
    try_some(
        [
            pytest.param(lambda _: judge_ramcip(), marks=pytest.mark.slow),
            lambda _: check_project(EXAMPLES / "first_robot"),
            lambda _: check_project(EXAMPLES / "drone"),
            lambda folder: check_project(_write_composed(folder)),
        ],
        2,
    ),
    ids=["ramcip", "first_robot", "drone", "composed"],
)
def test_no_value_is_lost_where_columns_and_facts_are_called_otherwise(
    judge: Callable[[Path], CheckedProject], tmp_path: Path
) -> None:
    views = make_views(judge(tmp_path), OutputOptions(revision="r", show_history=False))
    shown = list(_write_documents(views))
    with _renamed():
        renamed = list(_write_documents(views))
    for before, after in zip(shown, renamed, strict=True):
        assert after.count(MARK) > 10
        # A title inside of a sentence begins with a small letter.
        assert after.replace(MARK, "").casefold() == before.casefold()
